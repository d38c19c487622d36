//! What is underfoot.

use clamber_world::{SweepContact, WorldCapsule};
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
    /// The ground below a position, as far as `reach` below its feet, or beside it, no steeper than one who stands may
    /// stand on.
    pub(super) fn ground_below(&mut self, position: DVec3, reach: f64) -> Option<Ground> {
        let reach = reach.max(UNDERFOOT);
        self.ground_straight_below(position, reach)
            .or_else(|| self.ground_beside(position, reach))
    }

    /// What a ball comes down on first, if that is ground.
    pub(super) fn ground_straight_below(&mut self, position: DVec3, reach: f64) -> Option<Ground> {
        let down = -self.config.up() * (reach + self.config.body.skin_width);
        let (touch, hit) = self.ground_towards(position, down)?;
        // Up again, so that the whole ball touches what its core has met.
        let up = self.config.up();
        let rise = (self.config.body.radius - touch.contact.distance) / touch.away.dot(up);
        let position = position + down * hit.time + up * rise;
        Some(Ground { touch, position })
    }

    /// The nearest of what is no steeper than `limit`, where what is below is steeper.
    fn ground_beside(&mut self, position: DVec3, reach: f64) -> Option<Ground> {
        let (up, limit) = (self.config.up(), self.stood_on());
        let slope_of = |away: DVec3| libm::acos(away.dot(up).clamp(-1.0, 1.0));
        let body = &self.config.body;
        let (radius, core) = (body.radius, body.hard_radius());
        let ball = WorldCapsule::ball(position, radius + reach);
        let mut best: Option<Touch> = None;
        for touch in self.world.touching(&ball) {
            let nearer = best.is_none_or(|best| touch.contact.distance < best.contact.distance);
            if nearer && slope_of(touch.away) <= limit {
                best = Some(*touch);
            }
        }
        let best = best?;
        // A triangle's nearest point may be on an edge within a wall, and look like a ledge: only what the ball comes to
        // first is there.
        let way = (best.contact.distance - core).max(0.0) + UNDERFOOT;
        let toward = -best.away * way;
        let (touch, hit) = self.ground_towards(position, toward)?;
        let position =
            position + toward * hit.time + touch.away * (radius - touch.contact.distance);
        Some(Ground { touch, position })
    }

    /// What the core of the body meets first on a way, if that is ground.
    fn ground_towards(&mut self, position: DVec3, way: DVec3) -> Option<(Touch, SweepContact)> {
        let body = super::body(self.config, &self.state).moved(position - self.state.position);
        let core = body.with_radius(self.config.body.hard_radius());
        let (touch, hit) = self.world.cast(&core, way)?;
        let is_ground = !hit.started_inside && self.config.slope(touch.away) <= self.stood_on();
        is_ground.then_some((touch, hit))
    }

    /// The steepest slope that one who stands stays on.
    pub(super) fn stood_on(&self) -> f64 {
        self.config.ground.max_slope + SLOPE_HYSTERESIS
    }

    /// Of what the last movement touched, what holds the climber up. It stands on it then: what turns while it lands
    /// keeps it off by some millimetres.
    pub(super) fn held_up_by(&mut self, slope_limit: f64) -> Option<Touch> {
        let met = self.holding_up(slope_limit)?;
        let mut touch = self.underfoot(&met);
        let gap = touch.contact.distance - self.config.body.radius;
        if gap > 0.0 && gap <= self.config.body.skin_width {
            self.state.position -= touch.away * gap;
            touch.contact.distance -= gap;
        }
        Some(touch)
    }

    /// Level ground, else the least steep of slopes that leave it no way down.
    pub(super) fn holding_up(&self, slope_limit: f64) -> Option<Touch> {
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

    /// What was met on the way, where the ball now stands on it: since they met it has slid on along it.
    fn underfoot(&mut self, met: &Touch) -> Touch {
        let body = &self.config.body;
        let ball = WorldCapsule::ball(self.state.position, body.radius + body.skin_width);
        let mut best: Option<Touch> = None;
        for touch in self.world.touching(&ball) {
            let nearer = best.is_none_or(|best| touch.contact.distance < best.contact.distance);
            let is_met = touch.obstacle == met.obstacle && touch.away.dot(met.away) > SAME_SIDE;
            if nearer && is_met {
                best = Some(*touch);
            }
        }
        best.unwrap_or(*met)
    }
}

/// Cosine of how far the ground may have turned under what slides over it in a tick: 45 degrees.
const SAME_SIDE: f64 = 0.7;

/// Most slopes that are looked at together.
const WEDGE: usize = 16;
