use glam::DVec3;

use super::World;
use crate::planes::{Plane, nearest_above};

/// Most planes that stop a velocity together.
const STOPS: usize = 24;

impl World<'_> {
    /// A velocity without what of it goes into anything that the last movement touched, relative to that, or beyond
    /// one more plane.
    ///
    /// Never faster than the body and the fastest of these together: between planes that close like scissors, all
    /// but opposite, the nearest velocity above both has no bound.
    pub(crate) fn stopped(&self, velocity: DVec3, more: Option<Plane>) -> DVec3 {
        let mut planes = [Plane {
            normal: DVec3::Y,
            offset: 0.0,
        }; STOPS];
        let mut count = 0;
        let mut fastest = 0.0f64;
        if let Some(plane) = more {
            planes[0] = plane;
            fastest = plane.offset.abs();
            count = 1;
        }
        for touch in self.touched().iter().take(STOPS - count) {
            let own = self.velocity_of(touch);
            planes[count] = Plane {
                normal: touch.away,
                offset: touch.away.dot(own),
            };
            fastest = fastest.max(own.length());
            count += 1;
        }
        let stopped = nearest_above(velocity, &planes[..count]).point;
        stopped.clamp_length_max(velocity.length() + fastest)
    }
}
