use clamber_world::WorldPath;
use glam::DVec3;

use crate::half_spaces::{MovePlane, project_where_it_pays};
use crate::slide::STEEPEST_PUSH;
use crate::{Mover, MoverContact};

/// Maximum number of half-spaces that limit a velocity together. Further contacts are ignored.
const STOPS: usize = 24;

fn velocity_in(motion: Option<&WorldPath>) -> DVec3 {
    motion.map_or(DVec3::ZERO, |motion| motion.velocity)
}

impl Mover<'_> {
    /// Velocity of the material at a contact, metres a second; zero if the material has no motion.
    pub fn velocity_of(&self, touch: &MoverContact) -> DVec3 {
        let known = self.touched().iter().zip(&self.memory.velocities);
        let mut same = known.filter(|(other, velocity)| {
            let is_same = other.contact.material == touch.contact.material;
            other.obstacle == touch.obstacle && is_same && velocity.is_some()
        });
        let known = same.next().and_then(|(_, velocity)| *velocity);
        known.unwrap_or_else(|| {
            let motion = self.path_of(touch);
            velocity_in(motion.as_ref())
        })
    }

    /// Stores the velocity of the contact that was touched last.
    pub(crate) fn know_velocity(&mut self, motion: Option<&WorldPath>) {
        let before = self.touched().len().saturating_sub(1);
        self.memory.velocities.resize(before, None);
        self.memory.velocities.push(Some(velocity_in(motion)));
    }

    /// Computes the velocities of all contacts of a movement once, since they are needed several times.
    pub(crate) fn know_velocities(&mut self) {
        let mut velocities = std::mem::take(&mut self.memory.velocities);
        velocities.resize(self.touched().len(), None);
        for (velocity, touch) in velocities.iter_mut().zip(self.touched()) {
            velocity.get_or_insert_with(|| self.velocity_of(touch));
        }
        self.memory.velocities = velocities;
    }

    /// The velocity closest to `velocity` that does not move into any contact of the last movement. The result may
    /// follow obstacles that recede. `limit` is one more half-space that the result must be in. Velocities are in
    /// metres a second, in world space.
    ///
    /// `frame` is the velocity of the support, or of the frame that the body is in. Relative to `frame`, the result is
    /// never faster than the sum of the body's speed and the speed of the fastest obstacle: between half-spaces that
    /// close like scissors, the nearest velocity has no bound.
    pub fn clip_velocity(&self, velocity: DVec3, frame: DVec3, limit: Option<MovePlane>) -> DVec3 {
        self.clip_velocity_with(velocity, frame, limit, |_, of_material| of_material)
    }

    /// [`Mover::clip_velocity`] among contacts that move at other velocities than their material did over the last
    /// tick, such as bodies that the movement has pushed. `velocity_of` gets each contact and its material's velocity.
    pub fn clip_velocity_with(
        &self,
        velocity: DVec3,
        frame: DVec3,
        limit: Option<MovePlane>,
        velocity_of: impl Fn(&MoverContact, DVec3) -> DVec3,
    ) -> DVec3 {
        if limit.is_none() && self.touched().is_empty() {
            return velocity;
        }
        let mut half_spaces = [MovePlane {
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
            let own = velocity_of(touch, self.velocity_of(touch));
            half_spaces[count] = MovePlane {
                normal: touch.normal,
                offset: touch.normal.dot(own),
            };
            fastest = fastest.max(own.distance(frame));
            count += 1;
        }
        let own = velocity.distance(frame);
        let limit = own + fastest;
        let half_spaces = &half_spaces[..count];
        let clipped =
            project_where_it_pays(velocity, half_spaces, own + limit, STEEPEST_PUSH).point;
        let relative = clipped - frame;
        if relative.length() > limit {
            frame + relative.clamp_length_max(limit)
        } else {
            clipped
        }
    }
}
