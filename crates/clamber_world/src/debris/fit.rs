//! The rigid motion that best fits the motion of some points over a tick.

use glam::{DMat3, DVec3};

/// Fraction of the inertia's trace that is added to the inertia. If all points are on one axis, the rotation about it
/// is not determined; with this addition, it comes out as zero.
const FLAT: f64 = 1e-6;

/// A linear velocity at the origin, and an angular velocity, axis times radians a second.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RigidMotion {
    pub(super) linear: DVec3,
    pub(super) angular: DVec3,
}

impl RigidMotion {
    /// Fits by least squares over points: their weights, their previous positions, and their positions after `dt`
    /// seconds.
    ///
    /// A rotation by an angle a about an axis changes differences of points by `2 tan(a / 2)` times the axis, crossed
    /// with the mean of before and after (Cayley). This is linear, so large rotations are fitted as exactly as small
    /// ones. The linear velocity is the constant velocity of the origin while the body turns at a constant rate, as
    /// rapier moves bodies.
    pub(super) fn fit(points: impl Iterator<Item = (f64, DVec3, DVec3)> + Clone, dt: f64) -> Self {
        let (mut weight, mut middle, mut moved) = (0.0, DVec3::ZERO, DVec3::ZERO);
        for (w, before, now) in points.clone() {
            weight += w;
            middle += (before + now) * (0.5 * w);
            moved += (now - before) * w;
        }
        if weight <= 0.0 {
            return Self::default();
        }
        let (middle, moved) = (middle / weight, moved / weight);
        let (mut inertia, mut turned) = (DMat3::ZERO, DVec3::ZERO);
        for (w, before, now) in points {
            let arm = (before + now) * 0.5 - middle;
            let outer = DMat3::from_cols(arm * arm.x, arm * arm.y, arm * arm.z);
            inertia += (DMat3::from_diagonal(DVec3::splat(arm.length_squared())) - outer) * w;
            turned += arm.cross(now - before - moved) * w;
        }
        // All points coincide: the rotation is not determined, and nothing turns.
        let size = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
        if size <= 0.0 {
            return Self {
                linear: moved / dt,
                angular: DVec3::ZERO,
            };
        }
        let inertia = inertia + DMat3::from_diagonal(DVec3::splat(size * FLAT));
        let twice_tangent = inertia.inverse() * turned;
        let length = twice_tangent.length();
        let angle = 2.0 * libm::atan(length * 0.5);
        let axis = twice_tangent.normalize_or_zero();
        // The displacement of the origin: the midpoint of its path turns like all others.
        let arm = {
            // (now + before) / 2 - middle of the origin, from now - before = moved + t x arm and
            // before = 0: arm = (moved + t x arm) / 2 - middle.
            let rhs = moved * 0.5 - middle;
            let half = twice_tangent * 0.5;
            let cross = DMat3::from_cols(
                DVec3::new(0.0, half.z, -half.y),
                DVec3::new(-half.z, 0.0, half.x),
                DVec3::new(half.y, -half.x, 0.0),
            );
            (DMat3::IDENTITY - cross).inverse() * rhs
        };
        Self {
            linear: (moved + twice_tangent.cross(arm)) / dt,
            angular: axis * (angle / dt),
        }
    }

    /// Displacement of a point in `dt` seconds.
    pub(super) fn displacement(&self, point: DVec3, dt: f64) -> DVec3 {
        let angle = self.angular.length() * dt;
        let turned = if angle > 0.0 {
            let axis = self.angular.normalize_or_zero();
            clamber_surface::geometry::rotation_from_axis_angle(axis, angle) * point
        } else {
            point
        };
        self.linear * dt + turned - point
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_surface::geometry::rotation_from_axis_angle;

    /// Points that are not in one plane, metres.
    const POINTS: [DVec3; 5] = [
        DVec3::new(0.5, 0.1, 0.2),
        DVec3::new(-0.4, 0.3, 0.1),
        DVec3::new(0.2, -0.6, -0.3),
        DVec3::new(0.1, 0.2, 0.7),
        DVec3::new(-0.3, -0.2, 0.4),
    ];

    #[test]
    fn rigid_motions_are_recovered_for_any_angle() {
        let dt = 1.0 / 60.0;
        for angle in [0.0, 1e-9, 0.01, 0.5, 2.0] {
            let turn = rotation_from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle);
            let shift = DVec3::new(1.0, -2.0, 0.5);
            let pairs = POINTS.iter().map(|p| (1.0 + p.x, *p, turn * *p + shift));
            let motion = RigidMotion::fit(pairs, dt);
            for p in POINTS.into_iter().chain([DVec3::ZERO]) {
                let off = motion.displacement(p, dt) - (turn * p + shift - p);
                assert!(off.length() < 1e-5, "{angle} at {p}: {off}");
            }
        }
    }

    #[test]
    fn coplanar_collinear_and_single_points_get_no_undetermined_rotation() {
        let shift = DVec3::new(0.0, 0.3, 0.0);
        for count in [1, 2, 3] {
            let pairs = POINTS[..count].iter().map(|p| (1.0, *p, *p + shift));
            let motion = RigidMotion::fit(pairs, 0.1);
            assert!(
                (motion.linear - DVec3::Y * 3.0).length() < 1e-9,
                "{motion:?}"
            );
            assert!(motion.angular.length() < 1e-6, "{motion:?}");
        }
        let none = RigidMotion::fit(std::iter::empty(), 0.1);
        assert_eq!(none, RigidMotion::default());
    }

    #[test]
    fn stretching_is_neither_a_shift_nor_a_turn() {
        let corners = [DVec3::X, -DVec3::X, DVec3::Z, -DVec3::Z];
        let pairs = corners.iter().map(|p| (1.0, *p, *p * 1.1));
        let motion = RigidMotion::fit(pairs, 0.1);
        assert!(motion.linear.length() < 1e-12 && motion.angular.length() < 1e-12);
    }
}
