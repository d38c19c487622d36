use glam::{DQuat, DVec3, Quat, Vec3};

use crate::PointMotion;

/// A rigid pose in f64: engines round their own in f32 with every product.
///
/// An obstacle that moves and turns keeps two of them, of the last tick and of this one, and material points in the
/// body's own space; [`RigidPose::motion_since`] is its [`Obstacle::motion`](crate::Obstacle::motion):
///
/// ```
/// use clamber_world::RigidPose;
/// use clamber_world::glam::{DQuat, DVec3};
///
/// let before = RigidPose::IDENTITY;
/// let now = RigidPose {
///     rotation: DQuat::from_rotation_y(0.1),
///     translation: DVec3::X * 0.5,
/// };
/// let local = DVec3::new(0.0, 1.0, 2.0);
/// let motion = now.motion_since(&before, local, DVec3::ZERO, 1.0 / 60.0).unwrap();
/// assert_eq!(motion.previous_position, local);
/// assert_eq!(motion.position, now.transform(local));
/// assert!(motion.turn.angle_between(now.rotation) < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidPose {
    /// A unit quaternion.
    pub rotation: DQuat,
    /// Metres.
    pub translation: DVec3,
}

impl RigidPose {
    /// At the origin, not turned.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// From an engine's pose; the rotation is normalised.
    pub fn new(rotation: Quat, translation: Vec3) -> Self {
        Self {
            rotation: rotation.as_dquat().normalize(),
            translation: translation.as_dvec3(),
        }
    }

    /// The product `self * inner`: a point goes through `inner` first.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation: self.transform(inner.translation),
        }
    }

    /// Undoes this pose.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self {
            rotation,
            translation: rotation * -self.translation,
        }
    }

    /// A point of the body, in the space that the pose places it in.
    pub fn transform(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// Undoes [`RigidPose::transform`].
    pub fn inverse_transform(&self, point: DVec3) -> DVec3 {
        self.rotation.conjugate() * (point - self.translation)
    }

    /// How a point of the body moves that was placed by `before` a tick of `dt` seconds ago, and by `self` now.
    /// `origin` is where the engine's own stands in the world. `None` unless `dt` is positive and the point's position
    /// now is finite; `before` is not checked.
    pub fn motion_since(
        &self,
        before: &Self,
        local: DVec3,
        origin: DVec3,
        dt: f64,
    ) -> Option<PointMotion> {
        let position = self.transform(local) + origin;
        let previous_position = before.transform(local) + origin;
        let usable = dt > 0.0 && position.is_finite();
        usable.then(|| PointMotion {
            position,
            previous_position,
            velocity: (position - previous_position) / dt,
            // An engine does not tell a body that was put elsewhere from one that stands still.
            placed: before == self,
            frame: Some(self.rotation),
            turn: (self.rotation * before.rotation.conjugate()).normalize(),
            area_ratio: 1.0,
            stretches: [1.0, 1.0],
        })
    }
}
