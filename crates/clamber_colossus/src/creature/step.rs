//! One step of a creature, in the order of its phases.

use clamber_animation::rig::Playback;
use clamber_animation::{Animator, ClipId, LayerKind};
use clamber_surface::geometry::Similarity;
use glam::DVec3;

use super::report::CreatureEvent;
use super::state::Playing;
use super::{Creature, Surroundings};
use crate::brain::{Act, StateId};
use crate::error::ColossusError;
use crate::feet::Ground;

/// Share of the walking speed below which the creature has come to a stand, so that an act of another kind can begin.
const STANDS: f64 = 0.12;

/// Time that a creature of `GIANT` height needs to come to rest when it falls asleep, seconds.
const SETTLES: f64 = 0.8;

/// Longest time that a creature of `GIANT` height waits for its feet to stand and its gaze to end when it falls asleep,
/// seconds.
const MOST_SETTLES: f64 = 16.0;

/// Weight of the gaze below which the head is at rest.
const AWAY: f64 = 0.01;

impl Creature {
    /// Advances the creature by one tick of its brain: [`Creature::step_itself`], then [`Creature::step_from_afar`].
    ///
    /// With several creatures, call the first function for all of them before the second one for any. Then the shots of
    /// one creature meet the others where they are in this tick. Step creatures before the climbers on them.
    ///
    /// # Errors
    /// As [`Creature::step_itself`].
    pub fn step(&mut self, around: &Surroundings<'_>) -> Result<&CreatureReport, ColossusError> {
        self.step_itself(around)?;
        Ok(self.step_from_afar(around))
    }

    /// Advances the creature by one tick, without its waves, shots and beam.
    ///
    /// The order is: moving ground carries the creature; it senses its surroundings at the end of the last tick; the
    /// brain takes its step; the act of the brain's state begins or goes on; the clips advance; the creature moves; it
    /// is posed, with feet on the ground and the head turned; the skin follows; limbs strike people. For a creature
    /// that sleeps and is still, the step ends after the brain.
    ///
    /// # Errors
    /// [`ColossusError::Surface`] if the skin cannot be posed, for example because the creature has left the range of
    /// numbers.
    pub fn step_itself(&mut self, around: &Surroundings<'_>) -> Result<(), ColossusError> {
        let dt = self.kind.brain().tick();
        self.report.events.clear();
        self.report.events.append(&mut self.state.told);
        self.report.blows.clear();
        self.report.beam = None;
        self.state.ticks = self.state.ticks.wrapping_add(1);
        let is_carried = self.be_carried(around, dt);
        self.feel(around);
        self.think();
        if self.sleeps(is_carried)? {
            return Ok(());
        }
        self.is_still = false;
        self.act(around)?;
        self.move_on(around, dt)?;
        let world_from_model = self.state.world_from_model(self.size.scale);
        self.take_pose(&world_from_model, around, dt)?;
        self.surface.advance(&self.palette, world_from_model)?;
        self.strike(around, dt);
        Ok(())
    }

    /// Advances the creature's waves and shots by the same tick; they strike people even if the creature does something
    /// else by now. Then the current attack's beam strikes, and its new waves and shots start.
    ///
    /// Call it once after each [`Creature::step_itself`]. The other creatures in `around` have to be where they are at
    /// the end of this tick.
    pub fn step_from_afar(&mut self, around: &Surroundings<'_>) -> &CreatureReport {
        let dt = self.kind.brain().tick();
        self.go_on_from_afar(around, dt);
        self.strike_from_afar(around, dt);
        &self.report
    }

    /// Sets one of the game's own senses, by its name in the file. Returns false if there is no such sense.
    pub fn set_sense(&mut self, name: &str, value: f64) -> bool {
        let index = self
            .kind
            .brain()
            .own_senses()
            .iter()
            .position(|known| known == name);
        if let Some(index) = index {
            self.state.senses.set_own(index, value);
        }
        index.is_some()
    }

    /// Steps the brain, with the markers that the clips passed in the last tick.
    fn think(&mut self) {
        let kind = &self.kind;
        let passed: Vec<&str> = self
            .state
            .passed
            .iter()
            .filter_map(|[clip, marker]| {
                let clip = kind.clips().clip(ClipId(*clip)).ok()?;
                clip.markers()
                    .get(*marker as usize)
                    .map(|marker| marker.name.as_str())
            })
            .collect();
        let events = &mut self.report.events;
        let (mut changed, mut interrupts) = (false, false);
        kind.brain().step(
            &mut self.state.brain,
            &self.state.senses,
            &passed,
            |entered| {
                changed = true;
                interrupts |= entered.interrupts;
                events.push(CreatureEvent::Entered {
                    from: entered.from,
                    to: entered.to,
                });
            },
        );
        if changed {
            self.state.acting = None;
            self.state.halts = interrupts;
            self.state.senses.begin_act();
            if kind.brain().is_final(self.state.brain.current()) {
                self.drop_errand();
            }
        }
    }

    /// Begins the act of the current state once the creature stands, or continues it. A walk begins at once, and so
    /// does an act after an interrupting transition, for which the creature stops abruptly.
    fn act(&mut self, around: &Surroundings<'_>) -> Result<(), ColossusError> {
        if let Some(errand) = &mut self.state.errand {
            errand.has_begun = true;
            self.state.halts = false;
            return Ok(());
        }
        let state = self.state.brain.current();
        if self.state.acting == Some(state) {
            return Ok(());
        }
        let kind = std::sync::Arc::clone(&self.kind);
        let act = kind.brain().act(state);
        let walks = matches!(act, Some(Act::Walk(_)));
        let speed = kind.gait().map_or(0.0, |gait| self.full_speed(gait));
        let is_moving = self.state.speed.abs() > STANDS * speed;
        // An attack aims once, and would strike elsewhere if the creature turned on.
        let turns = matches!(act, Some(Act::Attack(_))) && self.is_turning();
        if !walks && !self.state.halts && (is_moving || turns) {
            return Ok(());
        }
        self.state.acting = Some(state);
        // The creature stops abruptly while the act already plays.
        self.state.halts = !walks && self.state.speed != 0.0;
        self.state.struck.clear();
        self.state.ranged.begin();
        self.state.aim = DVec3::ZERO;
        (self.state.walked.is_blocked, self.state.walked.tried) = (false, 0);
        match act {
            Some(Act::Walk(_) | Act::Turn(_)) => self.begin_way(),
            Some(Act::Play(_)) => self.begin(state, Playback::Loop)?,
            Some(Act::Once(_)) => self.begin(state, Playback::Clamp)?,
            Some(Act::Attack(_)) => self.begin_attack(state, around)?,
            Some(Act::Sleep) => self.fall_asleep(),
            None => self.play(Playing::Idle, 1.0, kind.brain().fade(state))?,
        }
        // Clips that sleep has stopped go on only now, so that the fade to the new clip begins without motion.
        let is_way = matches!(act, Some(Act::Walk(_) | Act::Turn(_))) && kind.gait().is_some();
        if !is_way && !matches!(act, Some(Act::Sleep)) {
            self.wake();
        }
        Ok(())
    }

    /// True if the current act is to sleep.
    pub(super) fn is_put_to_sleep(&self) -> bool {
        let act = self
            .state
            .acting
            .and_then(|state| self.kind.brain().act(state));
        matches!(act, Some(Act::Sleep))
    }

    /// Begins an attack, unless a part of the creature would go through rock or another creature in it.
    fn begin_attack(
        &mut self,
        state: StateId,
        around: &Surroundings<'_>,
    ) -> Result<(), ColossusError> {
        let kind = std::sync::Arc::clone(&self.kind);
        if let Some(strike) = &kind.act(state).strike {
            self.aim(strike);
            self.mark_prey();
            if !self.may_strike(strike, around) {
                self.state.walked.is_blocked = true;
                if kind.gait().is_none() {
                    self.state.playing = Playing::Idle;
                }
                return self.play(Playing::Idle, 1.0, kind.brain().fade(state));
            }
        }
        self.begin(state, Playback::Clamp)
    }

    /// True if the creature is asleep, and so still that nothing has to be posed.
    fn sleeps(&mut self, is_carried: bool) -> Result<bool, ColossusError> {
        let state = self.state.brain.current();
        let sleeps = self.is_put_to_sleep() && self.state.acting == Some(state);
        let rests = self.state.speed == 0.0 && self.state.yaw_rate == 0.0;
        if !sleeps || self.state.animator.is_fading() || !rests {
            self.state.sleeps = 0;
            return Ok(false);
        }
        self.state.sleeps = self.state.sleeps.saturating_add(1);
        // Feet and head come to rest first.
        let since = self.state.sleeps as f64 * self.kind.brain().tick() / self.size.pace.max(1e-3);
        let is_quiet = self.state.gaze_weight.value.abs() < AWAY
            && self
                .state
                .feet
                .iter()
                .all(|foot| foot.is_planted() && !foot.wants_step());
        if since <= SETTLES || since <= MOST_SETTLES && !is_quiet {
            return Ok(false);
        }
        // The first still tick poses the skin again, so that it has no motion.
        if self.is_still && !is_carried {
            return Ok(true);
        }
        let world_from_model = self.state.world_from_model(self.size.scale);
        self.surface.advance(&self.palette, world_from_model)?;
        self.is_still = !is_carried;
        Ok(true)
    }

    fn begin(&mut self, state: StateId, playback: Playback) -> Result<(), ColossusError> {
        let Some(clip) = self.kind.act(state).clip else {
            return Ok(());
        };
        self.state.playing = Playing::Act(state);
        let fade = self.kind.brain().fade(state);
        change(
            &mut self.state.animator,
            &self.kind,
            (clip, playback),
            [0.0, 1.0],
            fade,
        )
    }

    /// Stops the clips at their current times.
    pub(super) fn fall_asleep(&mut self) {
        for layer in self.state.animator.layers_mut() {
            layer.speed = 0.0;
        }
    }

    /// Lets stopped clips go on.
    pub(super) fn wake(&mut self) {
        for layer in self.state.animator.layers_mut() {
            if layer.speed == 0.0 {
                layer.speed = 1.0;
            }
        }
    }

    /// Plays a clip of the gait, unless it already plays.
    pub(super) fn play(
        &mut self,
        playing: Playing,
        speed: f64,
        fade: f64,
    ) -> Result<(), ColossusError> {
        let Some(gait) = self.kind.gait() else {
            return Ok(());
        };
        let clip = match (playing, gait.turn) {
            (Playing::Walk, _) => gait.walk,
            (Playing::Turn(side), Some(turn)) => turn[usize::from(side.min(1))],
            _ => gait.idle,
        };
        // After a change of the brain, a clip that is not in this gait may still play.
        let layer = self.state.animator.layers().first();
        let is_played =
            matches!(playing, Playing::Act(_)) || layer.is_some_and(|layer| layer.clip == clip);
        if self.state.playing == playing && is_played {
            return Ok(());
        }
        self.state.playing = playing;
        let time = self.step_in();
        change(
            &mut self.state.animator,
            &self.kind,
            (clip, Playback::Loop),
            [time, speed],
            fade,
        )
    }

    /// Poses the creature at its place, without motion.
    pub(super) fn place(&mut self) -> Result<(), ColossusError> {
        let (skeleton, pose) = (self.kind.skeleton(), &self.state.pose);
        skeleton.palette_into(pose, &mut self.palette)?;
        let world_from_model = self.state.world_from_model(self.size.scale);
        self.surface.place(&self.palette, world_from_model)?;
        Ok(())
    }

    fn take_pose(
        &mut self,
        world: &Similarity,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<(), ColossusError> {
        self.state.animator.pose_into(
            self.kind.clips(),
            &mut self.state.pose,
            &mut self.buffers,
        )?;
        let ground = Ground {
            terrain: around.terrain,
            reach: 0.5 * self.size.height,
        };
        self.put_feet(world, &ground, dt);
        self.turn_head(world, around, dt);
        self.lean(world, dt);
        self.kind
            .skeleton()
            .palette_into(&self.state.pose, &mut self.palette)?;
        Ok(())
    }
}

use super::CreatureReport;

/// Plays a clip on the lowest layer from a time on, at a speed. The fade has to know the speed of the new clip.
fn change(
    animator: &mut Animator,
    kind: &crate::kind::CreatureKind,
    (clip, playback): (ClipId, Playback),
    [time, speed]: [f64; 2],
    fade: f64,
) -> Result<(), ColossusError> {
    animator.change(kind.clips(), fade, |layers| {
        // The breathing layer is off while a clip plays once.
        let breath = if playback == Playback::Loop { 1.0 } else { 0.0 };
        for layer in layers.iter_mut() {
            layer.speed = 1.0;
            if layer.kind == LayerKind::Additive {
                layer.weight = breath;
            }
        }
        if let Some(layer) = layers.first_mut() {
            (layer.clip, layer.playback) = (clip, playback);
            (layer.time, layer.speed) = (time, speed);
        }
    })?;
    Ok(())
}
