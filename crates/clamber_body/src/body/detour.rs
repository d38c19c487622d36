//! Hands and feet on their way stay out of what they move along.

use glam::DVec3;

use super::carry::Carry;
use super::context::Context;
use super::hold::Hold;
use super::limb::Swing;
use crate::figure::Place;

/// How deep in something a hand or foot is still led out of it, metres.
const THROUGH: f64 = 0.15;

/// How fast a detour changes where the skin does not make it: a way that begins deep in something, or leads through it,
/// metres a second.
const CHANGES: f64 = 4.0;

/// The last share of a step, in which the detour ends.
const LANDS: f64 = 0.2;

/// How far a step goes around, away from the skin, and how far from the middle of its way that is looked for, metres.
const LIFT: f64 = 0.05;
const AROUND: f64 = 0.4;

/// To where and how far a step goes around in the middle of its way: out of what it would lead through.
pub(crate) fn bow(context: &Context<'_>, from: &Place, to: &Hold) -> DVec3 {
    let size = context.size();
    let bow = to.normal() * (LIFT * size);
    let middle = from.point(to.touching).midpoint(to.point()) + bow;
    let Some(near) = context.around.nearest(middle, AROUND * size) else {
        return bow;
    };
    let normal = near.contact.normal;
    let depth = (near.contact.point - middle).dot(normal);
    if depth > 0.0 {
        bow + normal * (depth + LIFT * size)
    } else {
        bow
    }
}

/// How far a hand or foot is led aside.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Detour {
    way: DVec3,
    /// How deep it would be in something without that, metres; `None` if nothing was near.
    depth: Option<f64>,
}

impl Detour {
    pub(crate) fn carry(&mut self, carry: &Carry) {
        self.way = carry.vector(self.way);
    }

    /// Leads a point that comes to be in something back to its surface. The detour grows as fast as the point would
    /// sink in; if it is deep already, or comes out on another side, by [`CHANGES`].
    pub(crate) fn step(&mut self, context: &Context<'_>, touching: DVec3) {
        let size = context.size();
        let near = context.around.nearest(touching, THROUGH * size);
        let depth = near.map(|found| {
            let normal = found.contact.normal;
            ((found.contact.point - touching).dot(normal), normal)
        });
        let wanted = depth.map_or(DVec3::ZERO, |(depth, normal)| normal * depth.max(0.0));
        let sinks = match (self.depth, depth) {
            (Some(before), Some((depth, _))) => (depth.max(0.0) - before.max(0.0)).abs(),
            _ => 0.0,
        };
        let most = sinks + CHANGES * size * context.dt;
        self.way += (wanted - self.way).clamp_length_max(most);
        self.depth = depth.map(|(depth, _)| depth);
    }

    /// Leads a hand that is free; `None` if it is in nothing's way.
    pub(crate) fn lead_free(&self, place: &Place) -> Option<Place> {
        (self.way != DVec3::ZERO).then(|| Place {
            position: place.position + self.way,
            ..*place
        })
    }

    /// Where a hand or foot is on its way.
    pub(crate) fn lead(&self, swing: &Swing) -> Place {
        let mut place = swing.place();
        let left = 1.0 - (swing.time / swing.duration).clamp(0.0, 1.0);
        place.position += self.way * (left / LANDS).min(1.0);
        place
    }
}
