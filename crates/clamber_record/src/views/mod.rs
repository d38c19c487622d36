//! Views for people, as foxglove's own messages.

mod frames;
mod log;
mod scene;
mod skin;

pub(crate) use frames::Frames;
pub(crate) use log::line;
pub(crate) use scene::Scene;
pub(crate) use skin::Skin;

use foxglove::messages::{Color, Pose, Quaternion, Timestamp, Vector3};
use glam::{DQuat, DVec3};

/// The frame of world space.
const WORLD: &str = "world";

/// The creature's frame: model space times its scale, in metres, rotated and translated into the world.
const CREATURE: &str = "creature";

/// The climber's frame: its centre, with +Z along its heading.
const CLIMBER: &str = "climber";

/// A frame with Z up, for viewers that expect that.
const Z_UP: &str = "z_up";

/// Converts a time, which wraps after 136 years.
fn timestamp(nanoseconds: u64) -> Timestamp {
    let second = 1_000_000_000;
    Timestamp::new((nanoseconds / second) as u32, (nanoseconds % second) as u32)
}

fn vector(v: DVec3) -> Vector3 {
    Vector3 {
        x: v.x,
        y: v.y,
        z: v.z,
    }
}

fn rotation(q: DQuat) -> Quaternion {
    Quaternion {
        x: q.x,
        y: q.y,
        z: q.z,
        w: q.w,
    }
}

fn pose(position: DVec3) -> Pose {
    Pose {
        position: Some(vector(position)),
        orientation: Some(rotation(DQuat::IDENTITY)),
    }
}

fn color(r: f64, g: f64, b: f64, a: f64) -> Color {
    Color { r, g, b, a }
}
