//! Views for people, as foxglove's own messages.

mod brain;
mod figure;
mod frames;
mod log;
mod scene;
mod scenery;
mod skin;

pub(crate) use brain::{brain, brain_lines, line as creature_line};
pub(crate) use figure::{FigureJoints, TakenFigure};
pub(crate) use frames::{frame, frame_of_climber, z_up};
pub(crate) use log::{gap_line, left_out, line, log};
pub(crate) use scene::{BodyShape, Scene, from_z_to};
pub use scenery::SceneryView;
pub(crate) use scenery::{Sceneries, SceneryNames, TakenScenery};
pub(crate) use skin::{no_skin, skin};

use foxglove::messages::{
    Color, Point3, Pose, Quaternion, SceneEntity, SceneEntityDeletion, Timestamp,
    TriangleListPrimitive, Vector3, scene_entity_deletion,
};
use glam::{DMat3, DQuat, DVec3};

/// Names of frames and entities in an arena's recording that creatures and fighters must not have.
pub(crate) const RESERVED: [&str; 4] = [WORLD, Z_UP, PROJECTILES, ATTACKS];

/// Name of the frame of world space.
const WORLD: &str = "world";

/// Name of the entity of an arena's arrows and stones.
pub(crate) const PROJECTILES: &str = "projectiles";
/// Name of the entity of the creatures' shots, waves and beams.
pub(crate) const ATTACKS: &str = "attacks";

/// Name of the creature's frame: model space times its scale, in metres, rotated and translated into the world.
pub(crate) const CREATURE: &str = "creature";

/// Name of the climber's frame: its centre, with +Z along its heading.
pub(crate) const CLIMBER: &str = "climber";

/// Name of the frame with Z up, for viewers that expect Z up.
const Z_UP: &str = "z_up";

/// Converts a time in nanoseconds. It wraps after 136 years.
pub(crate) fn timestamp(nanoseconds: u64) -> Timestamp {
    let second = 1_000_000_000;
    Timestamp::new((nanoseconds / second) as u32, (nanoseconds % second) as u32)
}

pub(crate) fn vector(DVec3 { x, y, z }: DVec3) -> Vector3 {
    Vector3 { x, y, z }
}

pub(crate) fn rotation(DQuat { x, y, z, w }: DQuat) -> Quaternion {
    Quaternion { x, y, z, w }
}

pub(crate) fn pose(position: DVec3, turn: DQuat) -> Pose {
    Pose {
        position: Some(vector(position)),
        orientation: Some(rotation(turn)),
    }
}

pub(crate) fn color(r: f64, g: f64, b: f64, a: f64) -> Color {
    Color { r, g, b, a }
}

fn point(DVec3 { x, y, z }: DVec3) -> Point3 {
    Point3 { x, y, z }
}

/// Triangles of one colour, each with the indices of three points.
fn triangle_list(points: Vec<Point3>, indices: Vec<u32>, color: Color) -> TriangleListPrimitive {
    TriangleListPrimitive {
        pose: Some(pose(DVec3::ZERO, DQuat::IDENTITY)),
        points,
        color: Some(color),
        colors: Vec::new(),
        indices,
    }
}

/// A rotation from a linear map's first two columns, without scale, shear and mirroring: x keeps its direction.
fn upright(map: &DMat3) -> DQuat {
    let x = map.x_axis.normalize_or(DVec3::X);
    let z = x.cross(map.y_axis).normalize_or(x.any_orthonormal_vector());
    DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z))
}

/// A message that removes an entity.
pub(crate) fn deletion(nanoseconds: u64, id: &str) -> SceneEntityDeletion {
    SceneEntityDeletion {
        timestamp: Some(timestamp(nanoseconds)),
        r#type: scene_entity_deletion::Type::MatchingId as i32,
        id: id.to_owned(),
    }
}

/// An empty entity of a scene, in the frame of the world.
pub(crate) fn entity(nanoseconds: u64, id: &str) -> SceneEntity {
    SceneEntity {
        timestamp: Some(timestamp(nanoseconds)),
        frame_id: WORLD.to_owned(),
        id: id.to_owned(),
        frame_locked: true,
        ..SceneEntity::default()
    }
}
