//! Inverse kinematics: solvers turn joints so that a hand, a foot or a gaze reaches its target.
//!
//! All solvers work on a [`Pose`](clamber_surface::rig::Pose) and take targets in model space. They change only
//! rotations, so bones keep their lengths. Solutions are exact under mirrored and uniformly scaled parents. [`TwoBone`]
//! and [`Chain`] solve in the space of the chain's parent, which may scale unevenly; a joint *within* their chain must
//! scale uniformly. [`aim`], [`orient`] and [`LookAt`] need uniform scale in all parents. Otherwise the error is
//! [`IkError::Sheared`].

mod aim;
mod bend;
mod chain;
mod error;
mod limits;
mod look_at;
mod pole;
mod two_bone;

pub use aim::{aim, orient};
pub use bend::{Bend, ReachResult, bend, soft_distance};
pub use chain::Chain;
pub use error::IkError;
pub use limits::SwingTwist;
pub use look_at::{LookAt, LookLimits, LookMemory};
pub use pole::PoleMemory;
pub use two_bone::{TwoBone, TwoBoneGoal};

use glam::{DQuat, DVec3};

/// The smallest rotation from one unit vector to another, without trigonometry. For opposite vectors it is half a turn
/// about any perpendicular axis.
pub(crate) fn arc(from: DVec3, to: DVec3) -> DQuat {
    half_way(from, to).normalize()
}

/// As [`arc`], but not normalised.
fn half_way(from: DVec3, to: DVec3) -> DQuat {
    // A rotation quaternion holds the cosine and the sine of half its angle. The vector half way between both gives
    // these.
    let half = from + to;
    // Below this length the cross product consists of rounding errors.
    if half.length_squared() < 1e-20 {
        let axis = from.any_orthonormal_vector();
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    let axis = from.cross(half);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, from.dot(half))
}

/// The rotation that maps one pair of perpendicular unit vectors to another pair.
pub(crate) fn frame_turn(from: [DVec3; 2], to: [DVec3; 2]) -> DQuat {
    let first = half_way(from[0], to[0]);
    // The second vector after the rotation `first`. A quaternion that is not normalised also scales, by its squared
    // length.
    let (axis, real) = (DVec3::new(first.x, first.y, first.z), first.w);
    let across = axis.cross(from[1]);
    let share = 2.0 / first.length_squared();
    let second = from[1] + (across * real + axis.cross(across)) * share;
    // The rotation about the first vector of the pair, by the angle between the second vectors.
    let cos = second.dot(to[1]);
    let sin = second.cross(to[1]).dot(to[0]);
    let turn = DQuat::from_xyzw(to[0].x * sin, to[0].y * sin, to[0].z * sin, 1.0 + cos);
    let turn = if turn.length_squared() > 1e-20 {
        turn
    } else {
        DQuat::from_xyzw(to[0].x, to[0].y, to[0].z, 0.0)
    };
    (turn * first).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_turned_onto_each_other() {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut unit = || {
            let v = DVec3::from([(); 3].map(|()| rng.f64() * 2.0 - 1.0));
            v.normalize_or(DVec3::X)
        };
        for k in 0..10_000 {
            let mut pair = || {
                let a = unit();
                let b = unit();
                [
                    a,
                    (b - a * a.dot(b)).normalize_or(a.any_orthonormal_vector()),
                ]
            };
            let (from, mut to) = (pair(), pair());
            if k % 4 == 0 {
                to = [-from[0], from[1]];
            } else if k % 4 == 1 {
                to = [from[0], -from[1]];
            }
            let turn = frame_turn(from, to);
            assert!((turn.length() - 1.0).abs() < 1e-12);
            for (from, to) in from.into_iter().zip(to) {
                assert!(
                    (turn * from - to).length() < 1e-7,
                    "{from} {to}: {}",
                    turn * from
                );
            }
        }
    }
}
