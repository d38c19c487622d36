//! What is underfoot.

use clamber_world::WorldCapsule;
use glam::DVec3;

use super::{SLOPE_HYSTERESIS, Step};
use crate::mover::Touch;
use crate::planes::{Plane, nearest_above};

/// Ground that a climber can stand on, and where it would stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ground {
    pub(super) touch: Touch,
    pub(super) position: DVec3,
}

/// Ground this little below is underfoot, however little it snaps, metres: far above the rounding of f32, by which one who
/// stands may be above it, and far below what one sees.
const UNDERFOOT: f64 = 1e-3;

/// What is left of a step down where slopes on all sides support: sine of some degrees.
const SUPPORTED: f64 = 0.1;

impl Step<'_> {
    /// The ground below a position, as far as `reach` below its feet, no steeper than one who stands may stand on.
    pub(super) fn ground_below(&mut self, position: DVec3, reach: f64) -> Option<Ground> {
        let body = &self.config.body;
        let (radius, core) = (body.radius, body.hard_radius());
        let up = self.config.up();
        let reach = reach.max(UNDERFOOT);
        let limit = self.config.ground.max_slope + SLOPE_HYSTERESIS;
        let down = -up * (reach + body.skin_width);
        let ball = WorldCapsule::ball(position, core);
        if let Some((touch, hit)) = self.world.cast(&ball, down)
            && !hit.started_inside
            && self.config.slope(touch.away) <= limit
        {
            // Up again, so that the whole ball touches what its core has met.
            let rise = (radius - touch.contact.distance) / touch.away.dot(up);
            let position = position + down * hit.time + up * rise;
            return Some(Ground { touch, position });
        }
        self.ground_beside(position, radius + reach, limit)
    }

    /// The nearest contact of the ball that is no steeper than `limit`.
    fn ground_beside(&mut self, position: DVec3, reach: f64, limit: f64) -> Option<Ground> {
        let slope_of = |up: DVec3, away: DVec3| libm::acos(away.dot(up).clamp(-1.0, 1.0));
        let up = self.config.up();
        let radius = self.config.body.radius;
        let ball = WorldCapsule::ball(position, reach);
        let mut best: Option<Touch> = None;
        for touch in self.world.touching(&ball) {
            let nearer = best.is_none_or(|best| touch.contact.distance < best.contact.distance);
            if nearer && slope_of(up, touch.away) <= limit {
                best = Some(*touch);
            }
        }
        best.map(|touch| Ground {
            position: position + touch.away * (radius - touch.contact.distance),
            touch,
        })
    }

    /// Of what the last movement touched, what holds the climber up: level ground, else the least steep of slopes
    /// that leave it no way down.
    pub(super) fn held_up_by(&mut self, slope_limit: f64) -> Option<Touch> {
        let up = self.config.up();
        let flattest = |touches: &[Touch]| {
            touches.iter().copied().reduce(|best, touch| {
                if touch.away.dot(up) > best.away.dot(up) {
                    touch
                } else {
                    best
                }
            })
        };
        let best = flattest(self.world.touched())?;
        if self.config.slope(best.away) <= slope_limit {
            return Some(best);
        }
        let mut slopes = [Plane {
            normal: up,
            offset: 0.0,
        }; WEDGE];
        let mut count = 0;
        for touch in self.world.touched() {
            if count < WEDGE && touch.away.dot(up) > 0.0 {
                slopes[count].normal = touch.away;
                count += 1;
            }
        }
        let down = nearest_above(-up, &slopes[..count]).point;
        (down.length() < SUPPORTED).then_some(best)
    }
}

/// Most slopes that are looked at together.
const WEDGE: usize = 16;
