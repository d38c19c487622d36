use glam::{DQuat, DVec3, Quat, Vec3};

use crate::PointMotion;

/// A rigid pose (rotation and translation) in f64. Engines compose poses in f32, which rounds with every product.
///
/// An obstacle that moves and turns stores two poses, one of the last tick and one of this tick, and keeps material
/// points in the body's local space. [`RigidPose::motion_since`] then implements its
/// [`Obstacle::motion`](crate::Obstacle::motion):
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
    /// Rotation, a unit quaternion.
    pub rotation: DQuat,
    /// Position of the body's local origin in the space of the pose, metres. [`RigidPose::transform`] rotates a point
    /// first and then adds this.
    pub translation: DVec3,
}

impl RigidPose {
    /// The pose at the origin without rotation.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// Converts an engine's f32 pose; the rotation is normalised.
    pub fn new(rotation: Quat, translation: Vec3) -> Self {
        Self {
            rotation: rotation.as_dquat().normalize(),
            translation: translation.as_dvec3(),
        }
    }

    /// The product `self * inner`: applies `inner` first, then `self`.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        Self {
            rotation: self.rotation * inner.rotation,
            translation: self.transform(inner.translation),
        }
    }

    /// The inverse pose.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self {
            rotation,
            translation: rotation * -self.translation,
        }
    }

    /// Transforms a point from the body's local space to the space of the pose.
    pub fn transform(&self, point: DVec3) -> DVec3 {
        self.rotation * point + self.translation
    }

    /// Transforms a point to the body's local space; the inverse of [`RigidPose::transform`].
    pub fn inverse_transform(&self, point: DVec3) -> DVec3 {
        self.rotation.conjugate() * (point - self.translation)
    }

    /// Motion of the body's point `local`, in its local space, over a tick of `dt` seconds. The body's pose was
    /// `before` at the start of the tick and is `self` now. `origin` is the world position of the poses' origin. `None`
    /// unless `dt` is positive and the current position is finite; `before` is not checked.
    ///
    /// If the two poses are equal, the point counts as [teleported](PointMotion::was_teleported).
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
            // An engine's poses do not tell a teleported body from one at rest.
            was_teleported: before == self,
            frame: Some(self.rotation),
            turn: (self.rotation * before.rotation.conjugate()).normalize(),
            area_ratio: 1.0,
            stretches: [1.0, 1.0],
        })
    }
}
