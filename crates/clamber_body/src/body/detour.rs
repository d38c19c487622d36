//! Keeps hands and feet out of obstacles while they are on their way.

use glam::DVec3;

use super::carry::Carry;
use super::context::Context;
use super::hold::Hold;
use super::limb::Swing;
use crate::figure::Place;

/// Largest depth inside an obstacle from which a hand or foot is led out, metres.
const MAX_DETOUR_DEPTH: f64 = 0.15;

/// Speed at which a detour changes beyond the rate at which the point sinks in, metres a second. It limits detours for
/// paths that begin deep inside an obstacle or lead through one.
const DETOUR_CHANGE_SPEED: f64 = 4.0;

/// Last share of a step, over which the detour fades out.
const FADE_OUT_SHARE: f64 = 0.2;

/// Displacement of the middle of a step's path away from the skin, metres.
const PATH_LIFT: f64 = 0.05;

/// Distance from the middle of a step's path within which obstacles are looked for, metres.
const PATH_SEARCH_RADIUS: f64 = 0.4;

/// Displacement of the middle of a step's path, away from the skin and out of an obstacle that the path would cross.
pub(crate) fn bow(context: &Context<'_>, from: &Place, to: &Hold) -> DVec3 {
    let size = context.size();
    let bow = to.normal() * (PATH_LIFT * size);
    let middle = from.point(to.touching).midpoint(to.point()) + bow;
    let Some(near) = context.around.nearest(middle, PATH_SEARCH_RADIUS * size) else {
        return bow;
    };
    let normal = near.contact.normal;
    let depth = (near.contact.point - middle).dot(normal);
    if depth > 0.0 {
        bow + normal * (depth + PATH_LIFT * size)
    } else {
        bow
    }
}

/// Displacement that leads a hand or foot out of an obstacle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Detour {
    way: DVec3,
    /// Depth inside an obstacle without the displacement, metres; negative outside. `None` if no surface was near.
    depth: Option<f64>,
}

impl Detour {
    pub(crate) fn carry(&mut self, carry: &Carry) {
        self.way = carry.vector(self.way);
    }

    /// Leads a point inside an obstacle back to the surface. The displacement grows as fast as the point sinks in. It
    /// changes by [`DETOUR_CHANGE_SPEED`] if the point is deep already or comes out on another side.
    pub(crate) fn step(&mut self, context: &Context<'_>, touching: DVec3) {
        let size = context.size();
        let near = context.around.nearest(touching, MAX_DETOUR_DEPTH * size);
        let depth = near.map(|found| {
            let normal = found.contact.normal;
            ((found.contact.point - touching).dot(normal), normal)
        });
        let wanted = depth.map_or(DVec3::ZERO, |(depth, normal)| normal * depth.max(0.0));
        let sinks = match (self.depth, depth) {
            (Some(before), Some((depth, _))) => (depth.max(0.0) - before.max(0.0)).abs(),
            _ => 0.0,
        };
        let most = sinks + DETOUR_CHANGE_SPEED * size * context.dt;
        self.way += (wanted - self.way).clamp_length_max(most);
        self.depth = depth.map(|(depth, _)| depth);
    }

    /// Leads a free hand; `None` without a displacement.
    pub(crate) fn lead_free(&self, place: &Place) -> Option<Place> {
        (self.way != DVec3::ZERO).then(|| Place {
            position: place.position + self.way,
            ..*place
        })
    }

    /// The place of a hand or foot on its way, with the displacement.
    pub(crate) fn lead(&self, swing: &Swing) -> Place {
        let mut place = swing.place();
        let left = 1.0 - (swing.time / swing.duration).clamp(0.0, 1.0);
        place.position += self.way * (left / FADE_OUT_SHARE).min(1.0);
        place
    }
}
