//! A quadruped built in code: 38 joints, one closed mesh with smooth weights, three clips.
//!
//! Its body is the zero set of a smooth union of cones around its bones, turned into triangles by
//! surface nets. Its weights fall off with the distance from the bones. It is about 21 m tall and 36 m
//! long, and faces +Z.

mod body;
mod clips;
mod field;
mod nets;
mod weights;

use std::sync::Arc;

use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{
    BuildOptions, ColliderMesh, Influence, MeshError, MeshSource, SurfaceKind, SurfaceTag,
};
use clamber_surface::rig::{Joint, JointId, RigError, Skeleton, Transform};
use glam::{DVec3, Vec3};

use crate::Creature;
use body::Bone;
use field::Field;

/// Surface area of the beast, square metres. Divided by the number of vertices, it gives the area of a cell.
const SURFACE: f64 = 1560.0;

/// A beast with 0.8 to 1.25 times as many vertices as asked for; a number below 500 counts as 500.
pub fn beast(vertices: usize) -> Creature {
    // The tables are constants, so this cannot fail for any number of vertices; a test tries several.
    match build(vertices) {
        Ok(creature) => creature,
        Err(error) => unreachable!("the beast's own tables are consistent: {error}"),
    }
}

#[derive(Debug, thiserror::Error)]
enum BeastError {
    #[error(transparent)]
    Rig(#[from] RigError),
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

fn build(vertices: usize) -> Result<Creature, BeastError> {
    let bones = body::bones();
    let skeleton = skeleton(&bones)?;
    let field = Field::new(&bones);
    let cell = (SURFACE / vertices.max(500) as f64).sqrt();
    let surface = nets::polygonise(&field, cell);
    let influences = surface
        .positions
        .iter()
        .flat_map(|p| weights::weights(&bones, *p))
        .map(|(joint, weight)| Influence {
            joint: JointId(joint),
            weight: weight as f32,
        })
        .collect::<Vec<_>>();
    let positions: Vec<Vec3> = surface.positions.iter().map(|p| p.as_vec3()).collect();
    let tags: Vec<SurfaceTag> = surface
        .triangles
        .iter()
        .map(|corners| tag(corners.map(|v| surface.positions[v as usize])))
        .collect();
    let source = MeshSource {
        positions: &positions,
        triangles: &surface.triangles,
        influences: &influences,
        tags: &tags,
        joint_count: bones.len(),
        ..MeshSource::default()
    };
    let (mesh, _) = ColliderMesh::build(&source, &BuildOptions::default())?;
    let clips = clips::clips(&bones)?;
    Ok(Creature {
        walk_speed: Some(clips::WALK_SPEED),
        ..Creature::new("beast", skeleton, clips, Arc::new(mesh))
    })
}

fn skeleton(bones: &[Bone]) -> Result<Skeleton, RigError> {
    let joints = bones.iter().map(|bone| {
        let parent_at = bone.parent.map_or(DVec3::ZERO, |parent| bones[parent].at);
        let bind = glam::DAffine3::from_translation(-bone.at);
        Joint {
            name: bone.name.clone(),
            parent: bone.parent.map(|parent| JointId(parent as u32)),
            rest: Transform::from_translation((bone.at - parent_at).as_vec3()),
            inverse_bind: Affine::from_f64(&bind),
        }
    });
    Skeleton::new(joints.collect())
}

/// The tag of a triangle: fur from the elbows up, a stone belt with ledges behind the shoulders, stone feet,
/// and skin elsewhere.
fn tag(corners: [DVec3; 3]) -> SurfaceTag {
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let belt = middle.z > 1.4 && middle.z < 2.6 && middle.y > 9.0;
    let kind = if belt || middle.y < 3.0 {
        SurfaceKind::Stone
    } else if middle.y > 8.0 {
        SurfaceKind::Fur
    } else {
        SurfaceKind::Skin
    };
    SurfaceTag {
        ledge: belt,
        ..SurfaceTag::new(kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn is_one_closed_orientable_mesh_of_about_the_size_asked_for() {
        for wanted in [1_000, 6_000, 20_000] {
            let creature = beast(wanted);
            let mesh = &creature.collider;
            let found = mesh.positions().len();
            let share = found as f64 / wanted as f64;
            assert!((0.8..1.25).contains(&share), "{wanted}: {found} vertices");
            let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
            for corners in mesh.triangles() {
                for k in 0..3 {
                    let (a, b) = (corners[k].0, corners[(k + 1) % 3].0);
                    *edges.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
                }
            }
            let open = edges.values().filter(|balance| **balance != 0).count();
            assert_eq!(open, 0, "{wanted}: {open} edges are not closed");
        }
    }

    #[test]
    fn follows_its_joints_smoothly() {
        let creature = beast(6_000);
        assert!(creature.skeleton.joints().len() >= 30);
        let mesh = &creature.collider;
        assert!(mesh.max_influences() >= 3);
        let mut steepest = 0.0f64;
        for corners in mesh.triangles() {
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let of = |v| mesh.influences(v).collect::<BTreeMap<_, _>>();
                let (wa, wb) = (of(a), of(b));
                let joints = wa.keys().chain(wb.keys());
                let change = joints
                    .map(|j| (wa.get(j).unwrap_or(&0.0) - wb.get(j).unwrap_or(&0.0)).abs())
                    .fold(0.0, f32::max);
                steepest = steepest.max(f64::from(change));
            }
        }
        assert!(
            steepest < 0.5,
            "a weight changes by {steepest} along one edge"
        );
    }

    #[test]
    fn the_trunk_is_inside_and_the_gap_between_the_legs_outside() {
        let creature = beast(2_000);
        let mesh = &creature.collider;
        let inside = |p| crate::solid_angle::is_inside(mesh.positions(), mesh, p);
        assert!(inside(DVec3::new(0.0, 14.0, 0.0)));
        assert!(!inside(DVec3::new(0.0, 25.0, 0.0)));
        assert!(!inside(DVec3::new(0.0, 5.0, 0.0)), "between the legs");
    }
}
