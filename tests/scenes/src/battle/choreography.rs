//! The timetable of a creature in a ride: which clip plays when, and where the creature is. It depends only on the
//! ticks that have passed.

use clamber_animation::SeamProbe;
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_surface::rig::{Clip, Palette, Playback, Pose, RigError};
use glam::DVec3;

use super::SceneError;
use super::repeat::Repeat;
use crate::{Creature, valley};

/// Seconds over which one clip fades into the next.
const FADE: f64 = 0.6;

/// Radius of the circle that the creature walks on, metres.
const PATH: f64 = 50.0;

/// Walking speed for creatures whose walk clip has no known speed, metres a second for each metre of height: slow.
const SPEED_PER_HEIGHT: f64 = 0.2;

/// Seconds for which a creature that lacks an idle or a walk clip holds still at first: longer than a rider falls.
const LANDING: f64 = 2.0;

/// A period with one clip.
struct Act {
    clip: Option<usize>,
    seconds: f64,
    /// The creature moves along its path, rather than staying where it is.
    walks: bool,
    repeat: Repeat,
}

/// A creature that plays its clips by a timetable.
pub(super) struct Choreography<'a> {
    creature: &'a Creature,
    acts: Vec<Act>,
    /// Metres per model unit.
    scale: f64,
    /// Lowest y of the skin in the first pose, in model space.
    lowest: f64,
    /// Walking speed, metres a second.
    speed: f64,
    /// Time of the clips, seconds.
    pub(super) time: f64,
    /// Distance that the creature has walked, metres.
    pub(super) walked: f64,
    /// The palette of the last [`Choreography::pose`].
    pub(super) palette: Palette,
}

impl<'a> Choreography<'a> {
    /// A creature that is scaled to be `height` metres tall in its first pose.
    pub(super) fn new(creature: &'a Creature, height: f64) -> Result<Self, SceneError> {
        let mut acts = acts(creature);
        let rest = creature.rig.skeleton.rest_pose();
        let first = acts[0].clip.map(|clip| &creature.rig.clips[clip]);
        let first = first.map(|clip| clip.sample(&rest, 0.0, Playback::Loop));
        let (low, high) = creature.bounds(first.transpose()?.as_ref().unwrap_or(&rest))?;
        let tall = f64::from(high.y) - f64::from(low.y);
        let scale = height / tall;
        if !(scale.is_normal() && scale > 0.0) {
            return Err(no_height(creature, height));
        }
        let probe = SeamProbe::new(&creature.rig.skeleton, &creature.rig.collider, tall);
        for act in acts.iter_mut().filter(|act| act.repeat != Repeat::Hold) {
            if let Some(clip) = act.clip {
                act.repeat = Repeat::of(probe.measure(&creature.rig.clips[clip])?);
            }
        }
        let speed = creature.walk_speed.map(|speed| speed * scale);
        Ok(Self {
            creature,
            acts,
            scale,
            lowest: f64::from(low.y),
            speed: speed.unwrap_or(SPEED_PER_HEIGHT * height),
            time: 0.0,
            walked: 0.0,
            palette: Palette::default(),
        })
    }

    /// Advances the time by `dt` seconds, and moves the creature along its path. Poses nothing.
    pub(super) fn advance(&mut self, dt: f64) {
        self.time += dt;
        let (now, before, share) = self.moment();
        let walking = |act: usize| f64::from(u8::from(self.acts[act].walks));
        let pace = walking(before) * (1.0 - share) + walking(now) * share;
        self.walked += pace * self.speed * dt;
    }

    /// Poses the creature for the current tick: its palette, and its place in the world.
    pub(super) fn pose(&mut self) -> Result<(&Palette, Similarity), SceneError> {
        let (now, before, share) = self.moment();
        let mut pose = self.sample(before)?;
        if share > 0.0 && now != before {
            pose.blend_in(&self.sample(now)?, share)?;
        }
        let skeleton = &self.creature.rig.skeleton;
        skeleton.palette_into(&pose, &mut self.palette)?;
        Ok((&self.palette, self.world_from_model()))
    }

    /// The pose of an act now.
    fn sample(&self, act: usize) -> Result<Pose, RigError> {
        let mut pose = self.creature.rig.skeleton.rest_pose();
        if let Some((clip, time)) = self.clip(act) {
            clip.sample_into(time, Playback::Clamp, &mut pose)?;
        }
        Ok(pose)
    }

    /// The current clip and the time in it, as text for messages.
    pub(super) fn playing(&self) -> String {
        let (now, before, share) = self.moment();
        let Some((clip, time)) = self.clip(now) else {
            return "at rest".into();
        };
        let fading = if share < 1.0 { self.clip(before) } else { None };
        let fading = fading.map_or(String::new(), |(from, _)| {
            format!(", {:.0} % faded in from {}", share * 100.0, from.name)
        });
        format!("{} at {time:.2} s{fading}", clip.name)
    }

    /// The clip that an act plays, and the time in it, seconds.
    fn clip(&self, act: usize) -> Option<(&'a Clip, f64)> {
        let clip = &self.creature.rig.clips[self.acts[act].clip?];
        Some((clip, self.acts[act].repeat.time(self.time, clip.duration())))
    }

    /// The current act, the act that it fades in from, and how far it has faded in, 0 to 1.
    fn moment(&self) -> (usize, usize, f64) {
        let total: f64 = self.acts.iter().map(|act| act.seconds).sum();
        let mut within = self.time % total;
        let mut now = 0;
        while within >= self.acts[now].seconds && now + 1 < self.acts.len() {
            within -= self.acts[now].seconds;
            now += 1;
        }
        let before = if self.time < self.acts[0].seconds {
            now
        } else {
            (now + self.acts.len() - 1) % self.acts.len()
        };
        // Smoothstep, so that the fade begins and ends without a jerk.
        let t = (within / FADE).min(1.0);
        let share = t * t * (3.0 - 2.0 * t);
        if share >= 1.0 || before == now {
            (now, now, 1.0)
        } else {
            (now, before, share)
        }
    }

    /// The creature's place on its circle through the valley, with its feet on the ground.
    fn world_from_model(&self) -> Similarity {
        let angle = self.walked / PATH;
        let (x, z) = (PATH * libm::cos(angle), PATH * libm::sin(angle));
        // The mean height of the ground under the body.
        let heights = [(0.0, 0.0), (5.0, 0.0), (-5.0, 0.0), (0.0, 5.0), (0.0, -5.0)]
            .map(|(dx, dz)| valley::height(x + dx, z + dz));
        let ground = heights.iter().sum::<f64>() / heights.len() as f64;
        Similarity {
            // Facing along the circle: +Z turned by the angle walked.
            rotation: rotation_from_axis_angle(DVec3::Y, -angle),
            scale: self.scale,
            translation: DVec3::new(x, ground - self.lowest * self.scale, z),
        }
    }
}

/// The creature cannot be scaled to a height, metres.
pub(super) fn no_height(creature: &Creature, height: f64) -> SceneError {
    let name = &creature.name;
    format!("{name} has no height in its first pose, so it cannot be scaled to {height} m").into()
}

/// The acts, by the names of the creature's clips.
///
/// Idle, walk, and if there is a shake, shake and walk. Without idle and walk: the first pose of the first clip, and
/// then every clip in turn, except deaths.
fn acts(creature: &Creature) -> Vec<Act> {
    let act = |clip, seconds, walks| Act {
        clip,
        seconds,
        walks,
        repeat: Repeat::Loop,
    };
    let idle = creature.clip_index(&["idle"]);
    let walk = creature.clip_index(&["walk", "run"]);
    if idle.is_some() && walk.is_some() {
        let mut acts = vec![act(idle, 6.0, false), act(walk, 16.0, true)];
        let shake = creature.clip_index(&["shake", "attack"]);
        if shake.is_some() {
            acts.extend([act(shake, 4.0, false), act(walk, 12.0, true)]);
        }
        return acts;
    }
    let lively = creature.rig.clips.iter().enumerate().filter(|(_, clip)| {
        let name = clip.name.to_lowercase();
        !name.contains("death") && !name.contains("die")
    });
    let clips: Vec<_> = lively.map(|(clip, _)| Some(clip)).collect();
    let Some(first) = clips.first() else {
        return vec![act(None, 8.0, false)];
    };
    // Still until a rider has landed: some clips begin with an attack, at 70 m/s.
    let still = Act {
        repeat: Repeat::Hold,
        ..act(*first, LANDING, false)
    };
    let others = clips.iter().map(|clip| act(*clip, 8.0, false));
    std::iter::once(still).chain(others).collect()
}
