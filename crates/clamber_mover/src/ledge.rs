use clamber_world::WorldCapsule;
use glam::DVec3;

use crate::{Mover, MoverBody, Touch, slope};

/// Where a ledge is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedgeProbe {
    /// What is to hang from it.
    pub body: MoverBody,
    /// Unit vector.
    pub up: DVec3,
    /// Unit vector, level: towards the wall.
    pub facing: DVec3,
    /// How far above the position a ledge may be, metres.
    pub reach_up: f64,
    /// How far beyond the body's ball the wall may be, metres.
    pub reach: f64,
    /// Steepest slope of a ledge's top, radians from level.
    pub max_slope: f64,
}

/// Radius of a hand, as a share of the body's radius: what is narrower is no ledge.
const HAND: f64 = 0.15;

/// How far beyond the edge hands are put, as a share of the body's radius.
const BEYOND: f64 = 0.25;

impl LedgeProbe {
    /// From the body's position to the contact of its hands, while it hangs at the wall, along the facing, metres.
    pub fn hands_ahead(&self) -> f64 {
        self.body.radius * (1.0 + HAND + BEYOND)
    }
}

/// A ledge that a body can hang from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Ledge {
    /// The contact of a hand with the ledge's top, a hand beyond the edge.
    pub touch: Touch,
    /// Unit vector, level: straight at the wall.
    pub facing: DVec3,
}

/// Cosine of the most oblique angle at which a wall is still in front: 72 degrees.
const OBLIQUE: f64 = 0.309;

impl Mover<'_> {
    /// The ledge in front of a position, with room for the hand on the way there.
    pub fn find_ledge(&mut self, probe: &LedgeProbe, position: DVec3) -> Option<Ledge> {
        let LedgeProbe { body, up, .. } = *probe;
        let hand_radius = HAND * body.radius;
        let reach = body.radius + probe.reach;
        let height = up * probe.reach_up;
        // The wall, wherever it is highest up front.
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

/// The level direction straight at a wall; `None` if the probe faces it too obliquely.
fn straight_at(wall: &Touch, probe: &LedgeProbe) -> Option<DVec3> {
    let normal = wall.normal;
    let level = normal - probe.up * normal.dot(probe.up);
    let straight = (-level).normalize_or(probe.facing);
    (straight.dot(probe.facing) >= OBLIQUE).then_some(straight)
}
