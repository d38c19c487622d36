//! A vault over a wall of up to 1.2 m: up along the wall, then over it, and down onto it or behind it.

use clamber::climber::{ClimberMode, CustomMode, ModeContext, NextMode};
use clamber::glam::DVec3;
use clamber::mover::LedgeProbe;

/// Index into [`ModeContext::memory`] of the seconds since the vault began.
const TAKEN: usize = 2;

/// Time after which the vault is given up if an obstacle is in the way, seconds.
const PATIENCE: f64 = 1.5;

pub(crate) struct Vault {
    /// Bit of the input's `actions` that begins the vault while the climber walks at the wall.
    pub(crate) action: u32,
    /// Height of the highest wall above the feet, metres. Walls lower than a step are walked over.
    pub(crate) height: f64,
    /// Largest distance of the wall from the body, metres.
    pub(crate) reach: f64,
    /// Speed of the vault, metres a second.
    pub(crate) speed: f64,
}

impl Default for Vault {
    fn default() -> Self {
        Self {
            action: 2,
            height: 1.2,
            reach: 0.5,
            speed: 4.0,
        }
    }
}

impl CustomMode for Vault {
    fn id(&self) -> u16 {
        2
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        let input = *context.input();
        let stands = context.state().mode == ClimberMode::Standing;
        let (body, up, position) = (context.body(), context.up(), context.position());
        let facing = (input.walk - up * input.walk.dot(up)).normalize_or_zero();
        if !stands || input.actions & self.action == 0 || facing == DVec3::ZERO {
            return false;
        }
        let probe = LedgeProbe {
            body,
            up,
            facing,
            reach_up: self.height - body.radius,
            reach: self.reach,
            max_slope: context.config().ground.max_slope,
        };
        let Some(ledge) = context.mover().find_ledge(&probe, position) else {
            return false;
        };
        let to_top = ledge.touch.contact.point - position;
        let rise = to_top.dot(up) + body.radius + 2.0 * body.margin;
        // There must be room above the climber, and from there to above the wall.
        let core = body.core_at(position);
        let over = ledge.facing * (to_top.dot(ledge.facing) + body.radius);
        let mover = context.mover();
        let has_room =
            mover.is_free(&core, up * rise) && mover.is_free(&core.moved(up * rise), over);
        if !has_room || rise <= context.config().ground.step_height {
            return false;
        }
        // A wall that moves takes the climber with it.
        context.attach(&ledge.touch);
        context.face(ledge.facing);
        context.custom_slots()[TAKEN] = 0.0;
        true
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        context.custom_slots()[TAKEN] += context.dt();
        let is_late = context.custom_slots()[TAKEN] > PATIENCE;
        let (up, heading) = (context.up(), context.state().heading);
        let support = context.state().support;
        let (Some(wall), None, false) = (support, context.knockback(), is_late) else {
            return context.let_go();
        };
        let (body, base) = (context.body(), context.base_velocity());
        let to_top = wall.attachment.point - context.position();
        if -to_top.dot(heading) > body.radius {
            return context.fall(base + heading * context.config().ground.walk_speed);
        }
        let rise = to_top.dot(up) + body.radius + 2.0 * body.margin;
        let own = if rise > body.margin {
            up * self.speed.min(rise / context.dt())
        } else {
            heading * self.speed
        };
        context.move_by(base + own);
        NextMode::Stay
    }
}
