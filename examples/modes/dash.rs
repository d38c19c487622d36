//! A dash: a quarter of a second at 12 m/s in the direction that the climber faces, with a cooldown of one second.
//!
//! On the ground the dash follows the ground, and is relative to it: a turning platform turns the dash. In the air it
//! is level.

use clamber::climber::{ClimberMode, CustomMode, ModeContext, NextMode};

/// Index into [`ModeContext::memory`] of the seconds that are left of the dash.
const LEFT: usize = 0;
/// Index into [`ModeContext::memory`] of the seconds until the next dash may begin.
const REST: usize = 1;

pub(crate) struct Dash {
    /// Bit of [`ClimberInput::actions`](clamber::climber::ClimberInput::actions) that begins the dash.
    pub(crate) action: u32,
    /// Speed of the dash, metres a second.
    pub(crate) speed: f64,
    /// Length of the dash, seconds.
    pub(crate) duration: f64,
    /// Time from the end of a dash until the next one may begin, seconds.
    pub(crate) cooldown: f64,
}

impl Default for Dash {
    fn default() -> Self {
        Self {
            action: 1,
            speed: 12.0,
            duration: 0.25,
            cooldown: 1.0,
        }
    }
}

impl CustomMode for Dash {
    fn id(&self) -> u16 {
        1
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        let rest = (context.custom_slots()[REST] - context.dt()).max(0.0);
        context.custom_slots()[REST] = rest;
        let input = *context.input();
        let is_free = matches!(
            context.state().mode,
            ClimberMode::Standing | ClimberMode::Sliding | ClimberMode::Falling
        );
        if !is_free || rest > 0.0 || input.actions & self.action == 0 {
            return false;
        }
        context.face(input.walk);
        context.custom_slots()[LEFT] = self.duration;
        true
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        context.custom_slots()[REST] = self.cooldown;
        if context.knockback().is_some() {
            return context.let_go();
        }
        let left = context.custom_slots()[LEFT] - context.dt();
        context.custom_slots()[LEFT] = left.max(0.0);
        // Half a tick of slack: the duration need not be a whole number of ticks, and sums of ticks are rounded.
        let is_last = left < 0.5 * context.dt();
        let ground = context.config().ground;
        // The heading turns with the ground that the climber stands on.
        let along = context.state().heading;
        let target = context.position() + along * (self.speed * context.dt());
        // The last tick ends at walking speed; otherwise the climber would slide on.
        let speed = if is_last {
            ground.walk_speed
        } else {
            self.speed
        };
        let velocity = context.base_velocity() + along * speed;
        context.move_to(target, velocity);
        let was_on_ground = context.state().support.is_some();
        let reach = if was_on_ground {
            ground.snap_distance
        } else {
            0.0
        };
        match context.ground_below(reach) {
            Some(ground) if is_last => return context.stand_on(&ground),
            Some(ground) => context.attach_to_ground(&ground),
            None if is_last => return context.let_go(),
            None => context.detach(),
        }
        NextMode::Stay
    }
}
