//! Three looping clips, idle, walk and shake: defined as functions of a phase, stored as cubic splines.

use core::f64::consts::TAU;

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_surface::rig::{Channel, Clip, Interpolation, JointId, Keyframes, RigError};
use glam::{DQuat, DVec3};

use super::body::Bone;

/// Number of key frames of one cycle.
const KEYFRAMES: usize = 32;

/// Length of one walking cycle, seconds.
const WALK_SECONDS: f64 = 3.2;

/// How far the legs swing forwards and backwards, radians.
const SWING: f64 = 0.3;

/// Speed of the walk, metres a second: a leg of 11 m sweeps twice its swing on the ground in half a cycle.
pub(super) const WALK_SPEED: f64 = 2.0 * 11.0 * SWING / (WALK_SECONDS / 2.0);

/// A bone's deviation from rest: angles about X (pitch, positive nose down), Y (yaw, positive to the
/// creature's left) and Z (roll), radians, applied in the order Z, X, Y, and a shift, metres. Only the
/// root bone is shifted.
#[derive(Clone, Copy, Default)]
struct Movement {
    pitch: f64,
    yaw: f64,
    roll: f64,
    shift: DVec3,
}

/// Gives the movement of a bone at a phase of 0 to 1.
type Motion = fn(name: &str, phase: f64) -> Movement;

pub(super) fn clips(bones: &[Bone]) -> Result<Vec<Clip>, RigError> {
    let motions: [(&str, f64, Motion); 3] = [
        ("idle", 5.0, idle),
        ("walk", WALK_SECONDS, walk),
        ("shake", 2.0, shake),
    ];
    motions
        .into_iter()
        .map(|(name, seconds, motion)| clip(bones, name, seconds, motion))
        .collect()
}

/// Breathing, and a slow look around.
fn idle(name: &str, phase: f64) -> Movement {
    let breath = libm::sin(TAU * phase);
    match name {
        "root" => Movement {
            shift: DVec3::Y * (0.08 * breath),
            ..Movement::default()
        },
        "spine3" => Movement {
            pitch: 0.02 * breath,
            ..Movement::default()
        },
        "neck1" | "neck2" => Movement {
            pitch: -0.03 * breath,
            yaw: 0.1 * libm::sin(TAU * phase + 1.0),
            ..Movement::default()
        },
        _ => tail(name, phase, 0.05),
    }
}

/// A lateral-sequence walk: each foot a quarter cycle after the one before.
fn walk(name: &str, phase: f64) -> Movement {
    let step = |offset: f64| TAU * (phase + offset);
    let trunk = Movement {
        yaw: 0.03 * libm::sin(step(0.0)),
        roll: 0.025 * libm::cos(step(0.0)),
        ..Movement::default()
    };
    if let Some((bone, side)) = name.rsplit_once('.') {
        let hind = matches!(bone, "hip" | "thigh" | "shin" | "ankle" | "hindfoot");
        let offset = match (hind, side) {
            (true, "l") => 0.0,
            (false, "l") => 0.25,
            (true, _) => 0.5,
            (false, _) => 0.75,
        };
        return leg(bone, step(offset));
    }
    match name {
        "root" => Movement {
            shift: DVec3::new(0.0, 0.12 * libm::sin(2.0 * step(0.1)), 0.0),
            roll: 0.02 * libm::sin(step(0.0)),
            ..Movement::default()
        },
        "spine1" | "spine3" => trunk,
        "spine2" | "spine4" => Movement {
            yaw: -trunk.yaw,
            pitch: 0.015 * libm::sin(2.0 * step(0.0)),
            ..Movement::default()
        },
        "neck1" | "neck2" | "neck3" => Movement {
            pitch: 0.04 * libm::sin(2.0 * step(0.2)),
            ..Movement::default()
        },
        _ => tail(name, phase, 0.09),
    }
}

/// One leg at an angle of its cycle: it swings like a sine, and lifts the foot while it moves forward.
fn leg(bone: &str, angle: f64) -> Movement {
    // The foot's forward speed follows the cosine; the foot is lifted where that is positive.
    let lift = libm::cos(angle).max(0.0);
    let swing = SWING * libm::sin(angle);
    let pitch = match bone {
        "arm" | "thigh" => -swing - 0.25 * lift,
        "forearm" => 0.2 * lift,
        "shin" => 0.5 * lift,
        "wrist" => 0.35 * lift + 0.5 * swing,
        "ankle" => -0.2 * lift + 0.5 * swing,
        "forefoot" | "hindfoot" => 0.5 * swing,
        _ => 0.0,
    };
    Movement {
        pitch,
        ..Movement::default()
    }
}

/// Rolls the trunk from side to side five times in a cycle. The wave runs from the root along the spine to the neck,
/// and along the tail.
fn shake(name: &str, phase: f64) -> Movement {
    let wave = |lag: f64| libm::sin(TAU * (5.0 * phase - lag));
    let roll = |size: f64, lag: f64| Movement {
        roll: size * wave(lag),
        ..Movement::default()
    };
    match name {
        "root" => Movement {
            shift: DVec3::X * (0.15 * wave(0.0)),
            roll: 0.08 * wave(0.0),
            ..Movement::default()
        },
        "spine2" => roll(0.05, 0.05),
        "spine3" => roll(0.05, 0.1),
        "spine4" | "spine5" => roll(0.05, 0.15),
        "neck1" | "neck2" | "neck3" => Movement {
            yaw: 0.12 * wave(0.25),
            roll: 0.1 * wave(0.2),
            ..Movement::default()
        },
        _ => tail(name, 5.0 * phase, 0.08),
    }
}

/// Swings the tail; the wave runs from its root to its tip.
fn tail(name: &str, phase: f64, size: f64) -> Movement {
    let number = name
        .strip_prefix("tail")
        .and_then(|digits| digits.parse::<f64>().ok());
    number.map_or_else(Movement::default, |number| Movement {
        yaw: size * libm::sin(TAU * (phase - 0.08 * number)),
        ..Movement::default()
    })
}

fn clip(bones: &[Bone], name: &str, seconds: f64, motion: Motion) -> Result<Clip, RigError> {
    let times: Vec<f32> = (0..=KEYFRAMES)
        .map(|k| (seconds * k as f64 / KEYFRAMES as f64) as f32)
        .collect();
    let interval = seconds / KEYFRAMES as f64;
    let mut channels = Vec::new();
    for (index, bone) in bones.iter().enumerate() {
        let at = |k: isize| {
            let phase = k.rem_euclid(KEYFRAMES as isize) as f64 / KEYFRAMES as f64;
            motion(&bone.name, phase)
        };
        let joint = JointId(index as u32);
        let rotation = |k: isize| rotation(at(k));
        let spline = hermite(rotation, interval);
        channels.push(Channel::new(
            joint,
            Interpolation::CubicSpline,
            times.clone(),
            Keyframes::Rotation(spline.into_iter().map(|q| q.as_quat()).collect()),
        )?);
        if bone.parent.is_none() {
            let position = |k: isize| bone.at + at(k).shift;
            let spline = hermite(position, interval);
            channels.push(Channel::new(
                joint,
                Interpolation::CubicSpline,
                times.clone(),
                Keyframes::Translation(spline.into_iter().map(|p| p.as_vec3()).collect()),
            )?);
        }
    }
    Ok(Clip::new(name, channels))
}

/// In-tangent, value and out-tangent of each key frame, with Catmull-Rom tangents over a closed cycle.
fn hermite<T>(value: impl Fn(isize) -> T, interval: f64) -> Vec<T>
where
    T: Copy + std::ops::Sub<Output = T> + std::ops::Mul<f64, Output = T>,
{
    (0..=KEYFRAMES as isize)
        .flat_map(|k| {
            let tangent = (value(k + 1) - value(k - 1)) * (0.5 / interval);
            [tangent, value(k), tangent]
        })
        .collect()
}

fn rotation(movement: Movement) -> DQuat {
    // The angles are small, so the quaternions of consecutive key frames never differ in sign.
    rotation_from_axis_angle(DVec3::Y, movement.yaw)
        * rotation_from_axis_angle(DVec3::X, movement.pitch)
        * rotation_from_axis_angle(DVec3::Z, movement.roll)
}
