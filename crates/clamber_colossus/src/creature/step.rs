//! One step of a creature, in the order of its phases.

use clamber_surface::geometry::Similarity;
use serde::{Deserialize, Serialize};

use super::{Creature, CreatureReport, Surroundings};
use crate::brain::StateAction;
use crate::error::ColossusError;
use crate::feet::Ground;

/// Time that a creature of `GIANT_HEIGHT` needs to come to rest when it falls asleep, seconds.
const FALL_ASLEEP_TIME: f64 = 0.8;

/// Longest time that a creature of `GIANT_HEIGHT` waits for its feet to stand and its gaze to end when it falls asleep,
/// seconds.
const LONGEST_FALL_ASLEEP: f64 = 16.0;

/// The ticks of a creature.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Clock {
    /// Ticks for which the creature has been asleep without moving.
    asleep: u32,
    /// Ticks since the creature was created or last put somewhere.
    ticks: u64,
}

impl Clock {
    pub(super) fn ticks(&self) -> u64 {
        self.ticks
    }

    /// True before the second tick: the creature was just placed.
    pub(super) fn is_first(&self) -> bool {
        self.ticks <= 1
    }

    /// True if the creature has been asleep without moving.
    pub(super) fn is_asleep(&self) -> bool {
        self.asleep > 0
    }
}

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

    /// Advances the creature by one tick of its brain ([`Brain::tick`](crate::Brain::tick)), without its waves, shots
    /// and beam, which [`Creature::step_from_afar`] advances.
    ///
    /// The order is: moving ground carries the creature; it senses what is around it, as it was at the end of the last
    /// tick; the brain takes its step; the act of the brain's state begins or goes on; the clips advance; the creature
    /// moves; it is posed, with feet on the ground and the head turned; the skin follows; limbs strike people. If the
    /// creature sleeps ([`StateAction::Sleep`]) and has come to rest, the step ends after the brain.
    ///
    /// # Errors
    /// [`ColossusError::Surface`] if the skin cannot be posed, for example because the creature has left the range of
    /// numbers. A part of the step is done then.
    pub fn step_itself(&mut self, around: &Surroundings<'_>) -> Result<(), ColossusError> {
        let dt = self.kind.brain().tick();
        self.report.events.clear();
        self.state.damage.report(&mut self.report.events);
        self.report.blows.clear();
        self.report.beam = None;
        self.state.clock.ticks = self.state.clock.ticks.wrapping_add(1);
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

    /// Sets one of the game's own senses, by its name in the file. Returns false and changes nothing if there is no
    /// such sense, or if the value is not finite.
    pub fn set_sense(&mut self, name: &str, value: f64) -> bool {
        let index = self
            .kind
            .brain()
            .own_senses()
            .iter()
            .position(|known| known == name);
        let Some(index) = index.filter(|_| value.is_finite()) else {
            return false;
        };
        self.state.senses.set_own(index, value);
        true
    }

    /// True if the current act is to sleep.
    pub(super) fn is_put_to_sleep(&self) -> bool {
        let act = self
            .state
            .acting
            .state()
            .and_then(|state| self.kind.brain().act(state));
        matches!(act, Some(StateAction::Sleep))
    }

    /// True if the creature is asleep, and so still that nothing has to be posed.
    fn sleeps(&mut self, is_carried: bool) -> Result<bool, ColossusError> {
        let state = self.state.brain.current();
        let sleeps = self.is_put_to_sleep() && self.state.acting.has_begun(state);
        let rests = self.state.motion.is_at_rest();
        if !sleeps || self.state.animator().is_fading() || !rests {
            self.state.clock.asleep = 0;
            return Ok(false);
        }
        self.state.clock.asleep = self.state.clock.asleep.saturating_add(1);
        // Feet and head come to rest first.
        let since =
            self.state.clock.asleep as f64 * self.kind.brain().tick() / self.size.pace.max(1e-3);
        let is_quiet = self.state.head.is_at_rest()
            && self
                .state
                .feet
                .iter()
                .all(|foot| foot.is_planted() && !foot.wants_step());
        if since <= FALL_ASLEEP_TIME || since <= LONGEST_FALL_ASLEEP && !is_quiet {
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

    /// Poses the creature at its place, without motion.
    pub(super) fn place(&mut self) -> Result<(), ColossusError> {
        let (skeleton, pose) = (self.kind.skeleton(), &self.state.pose);
        skeleton.palette_into(pose, &mut self.palette)?;
        let world_from_model = self.state.world_from_model(self.size.scale);
        self.surface.teleport(&self.palette, world_from_model)?;
        Ok(())
    }

    fn take_pose(
        &mut self,
        world: &Similarity,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<(), ColossusError> {
        let animator = self.state.clips.animator();
        animator.pose_into(self.kind.clips(), &mut self.state.pose, &mut self.buffers)?;
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
