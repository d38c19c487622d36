use clamber_world::WorldCapsule;
use glam::DVec3;

use crate::{Mover, MoverBody, Touch, slope};

/// Parameters of [`Mover::find_ledge`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedgeProbe {
    /// The body that is to hang from the ledge.
    pub body: MoverBody,
    /// Unit vector that points up.
    pub up: DVec3,
    /// Level unit vector towards the wall.
    pub facing: DVec3,
    /// Largest height of a ledge above the position, metres.
    pub reach_up: f64,
    /// Largest distance of the wall beyond the body's ball, metres.
    pub reach: f64,
    /// Steepest slope of a ledge's top, radians from level.
    pub max_slope: f64,
}

/// Radius of a hand, as a fraction of the body's radius. A narrower top is no ledge.
const HAND: f64 = 0.15;

/// Distance of the hands beyond the edge, as a fraction of the body's radius.
const BEYOND: f64 = 0.25;

impl LedgeProbe {
    /// Distance along the facing from the body's position to the contact of its hands, while it hangs at the wall,
    /// metres.
    pub fn hands_ahead(&self) -> f64 {
        self.body.radius * (1.0 + HAND + BEYOND)
    }
}

/// A ledge that a body can hang from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Ledge {
    /// The contact of a hand with the ledge's top, beyond the edge.
    pub touch: Touch,
    /// Level unit vector straight towards the wall.
    pub facing: DVec3,
}

/// Cosine of the largest angle between the facing and the direction straight towards a wall: 72 degrees.
const OBLIQUE: f64 = 0.309;

impl Mover<'_> {
    /// Finds the ledge in front of a position, with room for the hand on its way there.
    pub fn find_ledge(&mut self, probe: &LedgeProbe, position: DVec3) -> Option<Ledge> {
        let LedgeProbe { body, up, .. } = *probe;
        let hand_radius = HAND * body.radius;
        let reach = body.radius + probe.reach;
        let height = up * probe.reach_up;
        // The first wall in front, at any height within reach.
        let hand = WorldCapsule {
            ends: [position, position + height],
            radius: hand_radius,
        };
        let ahead = self.cast(&hand, probe.facing * (reach / OBLIQUE))?;
        if ahead.started_inside {
            return None;
        }
        let facing = straight_at(&ahead.touch, probe)?;
        let wall = self.cast(&hand, facing * reach)?;
        if wall.started_inside {
            return None;
        }
        let to_wall = reach * wall.time + hand_radius;
        let above = WorldCapsule::ball(position + height + up * hand_radius, hand_radius);
        let inward = facing * (to_wall + hand_radius + BEYOND * body.radius);
        if !self.is_free(&above, inward) {
            return None;
        }
        let top = self.cast(&above.moved(inward), -height)?;
        let is_top = !top.started_inside && slope(top.touch.normal, up) <= probe.max_slope;
        is_top.then_some(Ledge {
            touch: top.touch,
            facing,
        })
    }
}

/// The level direction straight towards a wall; `None` if the probe faces the wall too obliquely.
fn straight_at(wall: &Touch, probe: &LedgeProbe) -> Option<DVec3> {
    let normal = wall.normal;
    let level = normal - probe.up * normal.dot(probe.up);
    let straight = (-level).normalize_or(probe.facing);
    (straight.dot(probe.facing) >= OBLIQUE).then_some(straight)
}
