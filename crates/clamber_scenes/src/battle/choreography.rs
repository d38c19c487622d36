//! What the creature does: which clip plays when, and where it stands. A pure function of the
//! ticks gone by.

use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_surface::rig::{Clip, Palette, Playback, Pose};
use glam::DVec3;

use super::BattleError;
use crate::{Creature, valley};

/// Seconds over which one clip fades into the next.
const FADE: f64 = 0.6;

/// Radius of the circle that the creature walks on, metres.
const PATH: f64 = 50.0;

/// Metres a second for each metre of height, for creatures whose walk says no speed: a slow walk.
const SPEED_PER_HEIGHT: f64 = 0.2;

/// A stretch of time with one clip.
struct Act {
    clip: Option<usize>,
    seconds: f64,
    walks: bool,
}

/// The creature's part in the battle.
pub struct Choreography<'a> {
    creature: &'a Creature,
    acts: Vec<Act>,
    rest: Pose,
    /// World metres per model unit.
    scale: f64,
    /// Model height of the lowest point at the beginning.
    lowest: f64,
    speed: f64,
    time: f64,
    walked: f64,
    /// Of the current tick, and memory for the fade.
    pose: Pose,
    fading: Pose,
    palette: Palette,
}

impl<'a> Choreography<'a> {
    /// A creature scaled so that it is `height` metres tall in its first pose.
    ///
    /// # Errors
    /// [`BattleError::NoHeight`], [`BattleError::Creature`].
    pub fn new(creature: &'a Creature, height: f64) -> Result<Self, BattleError> {
        let acts = acts(creature);
        let rest = creature.skeleton.rest_pose();
        let mut first = rest.clone();
        if let Some(clip) = acts[0].clip {
            creature.clips[clip].sample_into(0.0, Playback::Loop, &mut first)?;
        }
        let (low, high) = creature.bounds(&first)?;
        let tall = f64::from(high.y) - f64::from(low.y);
        let scale = height / tall;
        if !(scale.is_normal() && scale > 0.0) {
            return Err(BattleError::NoHeight {
                creature: creature.name.clone(),
                height,
            });
        }
        let speed = creature
            .walk_speed
            .map_or(SPEED_PER_HEIGHT * height, |speed| speed * scale);
        Ok(Self {
            creature,
            acts,
            pose: first.clone(),
            fading: first,
            rest,
            scale,
            lowest: f64::from(low.y),
            speed,
            time: 0.0,
            walked: 0.0,
            palette: Palette::default(),
        })
    }

    /// Goes on by `dt` seconds.
    ///
    /// # Errors
    /// [`BattleError::Creature`] if a clip does not fit the skeleton.
    pub fn advance(&mut self, dt: f64) -> Result<(), BattleError> {
        self.time += dt;
        let (now, before, share) = self.moment();
        let walking = |act: usize| if self.acts[act].walks { 1.0 } else { 0.0 };
        let pace = walking(before) * (1.0 - share) + walking(now) * share;
        self.walked += pace * self.speed * dt;
        Ok(())
    }

    /// The palette of the current tick and where the creature stands.
    ///
    /// # Errors
    /// [`BattleError::Creature`] if a clip does not fit the skeleton.
    pub fn pose(&mut self) -> Result<(&Palette, Similarity), BattleError> {
        let (now, before, share) = self.moment();
        self.pose.clone_from(&self.rest);
        if let Some(clip) = self.clip(before) {
            clip.sample_into(self.time, Playback::Loop, &mut self.pose)?;
        }
        if share > 0.0 && now != before {
            self.fading.clone_from(&self.rest);
            if let Some(clip) = self.clip(now) {
                clip.sample_into(self.time, Playback::Loop, &mut self.fading)?;
            }
            self.pose.blend_in(&self.fading, share)?;
        }
        let skeleton = &self.creature.skeleton;
        skeleton.palette_into(&self.pose, &mut self.palette)?;
        Ok((&self.palette, self.world_from_model()))
    }

    /// Seconds gone by and metres walked: all that changes.
    pub(super) fn progress(&self) -> (f64, f64) {
        (self.time, self.walked)
    }

    /// Goes to where [`Choreography::progress`] was.
    pub(super) fn go_to(&mut self, (time, walked): (f64, f64)) {
        (self.time, self.walked) = (time, walked);
    }

    /// The palette of the last [`Choreography::pose`].
    pub fn palette(&self) -> &Palette {
        &self.palette
    }

    /// Who plays.
    pub fn creature(&self) -> &Creature {
        self.creature
    }

    fn clip(&self, act: usize) -> Option<&'a Clip> {
        Some(&self.creature.clips[self.acts[act].clip?])
    }

    /// The act now, the one that it fades in from, and how far it has faded in.
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
        // Smooth at both ends, so that nothing jerks.
        let t = (within / FADE).min(1.0);
        let share = t * t * (3.0 - 2.0 * t);
        if share >= 1.0 || before == now {
            (now, now, 1.0)
        } else {
            (now, before, share)
        }
    }

    /// On its circle through the valley, feet on the ground.
    fn world_from_model(&self) -> Similarity {
        let angle = self.walked / PATH;
        let (x, z) = (PATH * libm::cos(angle), PATH * libm::sin(angle));
        // The ground under the middle of the body, evened out over its length.
        let heights = [(0.0, 0.0), (5.0, 0.0), (-5.0, 0.0), (0.0, 5.0), (0.0, -5.0)]
            .map(|(dx, dz)| valley::height(x + dx, z + dz));
        let ground = heights.iter().sum::<f64>() / heights.len() as f64;
        Similarity {
            // Along the circle: +Z turned by the angle that the path has turned.
            rotation: rotation_from_axis_angle(DVec3::Y, -angle),
            scale: self.scale,
            translation: DVec3::new(x, ground - self.lowest * self.scale, z),
        }
    }
}

/// Idle, walk, shake, walk, where clips are named so; every clip but dying in turn where not.
fn acts(creature: &Creature) -> Vec<Act> {
    let index = |words: &[&str]| {
        let clip = creature.clip_like(words)?;
        creature
            .clips
            .iter()
            .position(|other| std::ptr::eq(other, clip))
    };
    let act = |clip, seconds, walks| Act {
        clip: Some(clip),
        seconds,
        walks,
    };
    if let (Some(idle), Some(walk)) = (index(&["idle"]), index(&["walk", "run"])) {
        let mut acts = vec![act(idle, 6.0, false), act(walk, 16.0, true)];
        if let Some(shake) = index(&["shake", "attack"]) {
            acts.extend([act(shake, 4.0, false), act(walk, 12.0, true)]);
        }
        return acts;
    }
    let lively = creature.clips.iter().enumerate().filter(|(_, clip)| {
        let name = clip.name.to_lowercase();
        !name.contains("death") && !name.contains("die")
    });
    let mut acts: Vec<Act> = lively.map(|(clip, _)| act(clip, 8.0, false)).collect();
    if acts.is_empty() {
        acts.push(Act {
            clip: None,
            seconds: 8.0,
            walks: false,
        });
    }
    acts
}
