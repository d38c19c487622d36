use glam::DVec3;

use crate::Mover;
use crate::half_spaces::{HalfSpace, project_onto_half_spaces};

/// Most half-spaces that stop a velocity together.
const STOPS: usize = 24;

impl Mover<'_> {
    /// The nearest velocity that does not lead into anything that the last movement touched, as fast as that moves
    /// itself; `limit` is one more half-space of velocities to stay in.
    ///
    /// Relative to `frame`, the velocity of the support or of the frame that the body is in, never faster than the body and
    /// the fastest of the obstacles together: between half-spaces that close like scissors the nearest velocity has no
    /// bound.
    pub fn clip_velocity(&self, velocity: DVec3, frame: DVec3, limit: Option<HalfSpace>) -> DVec3 {
        let mut half_spaces = [HalfSpace {
            normal: DVec3::Y,
            offset: 0.0,
        }; STOPS];
        let mut count = 0;
        let mut fastest = 0.0f64;
        if let Some(half_space) = limit {
            half_spaces[0] = half_space;
            fastest = (half_space.offset - half_space.normal.dot(frame)).abs();
            count = 1;
        }
        for touch in self.touched().iter().take(STOPS - count) {
            let own = self.velocity_of(touch);
            half_spaces[count] = HalfSpace {
                normal: touch.normal,
                offset: touch.normal.dot(own),
            };
            fastest = fastest.max(own.distance(frame));
            count += 1;
        }
        let clipped = project_onto_half_spaces(velocity, &half_spaces[..count]).point;
        let relative = clipped - frame;
        let limit = velocity.distance(frame) + fastest;
        if relative.length() > limit {
            frame + relative.clamp_length_max(limit)
        } else {
            clipped
        }
    }
}
