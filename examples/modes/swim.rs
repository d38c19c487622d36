//! Swimming in a box of water, which may flow or move. Y is up.

use clamber::climber::{ClimberMode, CustomMode, ModeContext, NextMode};
use clamber::glam::DVec3;

/// Depth below the floating position at which swimming begins, metres.
const BEGINS: f64 = 0.1;
/// Depth above which the climber stands up on the shore, metres. It is less than [`BEGINS`], so that the mode does not
/// flicker.
const ENDS: f64 = 0.05;

/// Largest gap between feet and ground at which the climber stands up on the shore, metres.
const SHORE: f64 = 0.05;

/// The handler of swimming. Handlers have no state: make a new one for each tick if the water moves.
pub(crate) struct Swim {
    /// Lowest and highest corner of the water at the tick's end, in world space; the top is the water's surface.
    pub(crate) water: [DVec3; 2],
    /// Velocity of the water, metres a second.
    pub(crate) current: DVec3,
    /// Bit of the input's `actions` that dives while it is held. `jump_held` rises; a jump at the surface leaves the
    /// water.
    pub(crate) dive: u32,
    /// Depth of the climber's position below the surface while it floats, metres.
    pub(crate) float: f64,
    /// Swimming speed, metres a second.
    pub(crate) speed: f64,
    /// Acceleration towards the wanted velocity, metres a second squared.
    pub(crate) acceleration: f64,
}

impl Swim {
    pub(crate) fn new(water: [DVec3; 2], current: DVec3) -> Self {
        Self {
            water,
            current,
            dive: 8,
            float: 0.2,
            speed: 2.0,
            acceleration: 10.0,
        }
    }

    /// Depth below the floating position, metres; `None` outside the water.
    fn depth(&self, position: DVec3) -> Option<f64> {
        let [low, high] = self.water;
        let level = DVec3::new(1.0, 0.0, 1.0);
        let is_inside = (position * level).clamp(low * level, high * level) == position * level;
        (is_inside && position.y >= low.y).then_some(high.y - self.float - position.y)
    }
}

impl CustomMode for Swim {
    fn id(&self) -> u16 {
        4
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        let mode = context.state().mode;
        let is_free = mode == ClimberMode::Standing || mode == ClimberMode::Falling;
        let depth = self.depth(context.position());
        is_free && depth.is_some_and(|depth| depth > BEGINS)
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        let (input, velocity, dt) = (*context.input(), context.velocity(), context.dt());
        context.detach();
        context.set_base_velocity(self.current);
        let depth = self.depth(context.position());
        let (Some(depth), None) = (depth, context.knockback()) else {
            return context.fall(velocity);
        };
        if input.jump && depth < ENDS {
            let jump = context.config().ground.jump_speed;
            return context.fall(velocity + DVec3::Y * jump);
        }
        let dives = input.actions & self.dive != 0;
        let rise = f64::from(u8::from(input.jump_held)) - f64::from(u8::from(dives));
        let wanted = DVec3::new(input.walk.x, 0.0, input.walk.z).clamp_length_max(1.0);
        let wanted = (wanted + DVec3::Y * rise) * self.speed;
        let mut own = (velocity - self.current).move_towards(wanted, self.acceleration * dt);
        // The climber does not rise out of the water.
        own.y = own.y.min((depth / dt).max(-self.speed));
        context.move_by(self.current + own);
        let depth = self.depth(context.state().position);
        if depth.is_some_and(|depth| depth < ENDS)
            && let Some(ground) = context.ground_below(SHORE)
        {
            return context.stand_on(&ground);
        }
        NextMode::Stay
    }
}
