//! What lies between two poses that are little apart, as of two frames.
//!
//! Rotations along the arc by a series in its cosine (Eberly 2011, "A Fast and Accurate Algorithm for Computing
//! SLERP"), which takes no trigonometry.

use clamber_surface::geometry::slerp;
use clamber_surface::rig::{Pose, RigError, Transform};
use glam::{DQuat, Vec3};

/// How far from 1 the cosine of half the turn may be for the series: below 0.4 radians of turn, where it is off by
/// less than 1e-12.
const SMALL: f64 = 0.02;

/// How far from 1 the squared length of a rotation may be and still be taken for it. It is normalised later.
const UNIT: f64 = 1e-5;

/// Terms of the series, the last first: `[1 / (n (2 n + 1)), n / (2 n + 1)]` of the n-th.
const TERMS: [[f64; 2]; 5] = [
    [1.0 / 55.0, 5.0 / 11.0],
    [1.0 / 36.0, 4.0 / 9.0],
    [1.0 / 21.0, 3.0 / 7.0],
    [1.0 / 10.0, 2.0 / 5.0],
    [1.0 / 3.0, 1.0 / 3.0],
];

/// Sets what lies between two poses, at a fraction from 0 to 1 of the way.
pub(crate) fn set_between(
    pose: &mut Pose,
    from: &Pose,
    to: &Pose,
    fraction: f64,
) -> Result<(), RigError> {
    pose.transforms.clear();
    for (from, to) in from.transforms.iter().zip(&to.transforms) {
        pose.transforms.extend(between(from, to, fraction));
    }
    if pose.transforms.len() == from.transforms.len().max(to.transforms.len()) {
        return Ok(());
    }
    pose.transforms.clone_from(&from.transforms);
    pose.blend_in(to, fraction)
}

/// `None` if it is not finite, or a rotation has no length.
fn between(from: &Transform, to: &Transform, fraction: f64) -> Option<Transform> {
    if from == to {
        return Some(*from);
    }
    let (a, b) = (from.rotation.as_dquat(), to.rotation.as_dquat());
    let mixed = Transform {
        translation: lerp(from.translation, to.translation, fraction),
        rotation: turn(a, b, fraction).as_quat(),
        scale: lerp(from.scale, to.scale, fraction),
    };
    mixed.is_valid().then_some(mixed)
}

/// Along the shorter arc.
fn turn(a: DQuat, b: DQuat, fraction: f64) -> DQuat {
    let is_unit = |q: DQuat| (q.length_squared() - 1.0).abs() < UNIT;
    let cos = a.dot(b);
    if is_unit(a) && is_unit(b) && 1.0 - cos.abs() < SMALL {
        let (here, there) = (share(1.0 - fraction, cos.abs()), share(fraction, cos.abs()));
        return a * here + b * there.copysign(cos);
    }
    slerp(a.normalize(), b.normalize(), fraction)
}

/// `sin(t w) / sin(w)` of an angle by its cosine.
fn share(t: f64, cos: f64) -> f64 {
    let mut sum = 1.0;
    for [u, v] in TERMS {
        sum = 1.0 + (u * t * t - v) * (cos - 1.0) * sum;
    }
    t * sum
}

fn lerp(from: Vec3, to: Vec3, fraction: f64) -> Vec3 {
    from.as_dvec3().lerp(to.as_dvec3(), fraction).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_surface::geometry::rotation_from_axis_angle;
    use glam::DVec3;

    fn turned(angle: f64) -> Transform {
        Transform {
            translation: Vec3::new(angle as f32, 1.0, -3.0),
            rotation: rotation_from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle).as_quat(),
            scale: Vec3::new(1.0, 2.0, 1.0 + angle as f32),
        }
    }

    #[test]
    fn the_arc_is_that_of_slerp_whatever_the_signs() {
        for angle in [0.0, 1e-6, 0.01, 0.3, 0.39, 0.41, 0.9, 2.5] {
            for (sign, fraction) in [(1.0, 0.0), (1.0, 0.3), (-1.0, 0.5), (-1.0, 0.9), (1.0, 1.0)] {
                let (from, mut to) = (turned(0.4), turned(0.4 + angle));
                to.rotation *= sign;
                let pose = |t| Pose {
                    transforms: vec![t],
                };
                let mut found = Pose::default();
                set_between(&mut found, &pose(from), &pose(to), fraction).unwrap();
                let found = found.transforms[0];
                let (a, b) = (from.rotation.as_dquat(), to.rotation.as_dquat());
                let exact = slerp(a.normalize(), b.normalize(), fraction);
                let apart = 1.0 - exact.dot(found.rotation.as_dquat().normalize()).abs();
                assert!(apart < 1e-13, "{angle} {sign} {fraction}: {apart}");
                let blended = pose(from).blend(&pose(to), fraction).unwrap().transforms[0];
                let off = (found.translation - blended.translation).length();
                assert!(off < 1e-6 && (found.scale - blended.scale).length() < 1e-6);
            }
        }
    }

    /// Of a unit, where both are one: rounding to f32 would hide ten thousand times as much.
    #[test]
    fn the_series_is_off_by_less_than_it_says_as_far_as_it_is_used() {
        let mut worst = 0.0_f64;
        for step in 1..=200 {
            let cos = 1.0 - SMALL * f64::from(step) / 200.0;
            let angle = libm::acos(cos);
            for part in 0..=100 {
                let t = f64::from(part) / 100.0;
                let exact = libm::sin(t * angle) / libm::sin(angle);
                worst = worst.max((share(t, cos) - exact).abs());
            }
        }
        assert!(worst < 1e-12, "{worst:e}");
    }

    #[test]
    fn nonsense_is_an_error() {
        let good = Pose {
            transforms: vec![turned(0.1); 3],
        };
        let mut bad = good.clone();
        bad.transforms[1].translation.y = f32::NAN;
        let mut pose = Pose::default();
        assert!(set_between(&mut pose, &good, &bad, 0.5).is_err());
        bad.transforms.pop();
        assert!(set_between(&mut pose, &good, &bad, 0.5).is_err());
        assert!(set_between(&mut pose, &good, &good, 0.5).is_ok());
    }
}
