//! A limb to strike, for tests.

use std::sync::Arc;

use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshSource};
use clamber_surface::rig::JointId;
use glam::Vec3;

/// Vertices of each of the limb's rings.
const SIDES: u32 = 10;
/// Rings of quads in each of the limb's two parts.
const RINGS: u32 = 3;
/// Radius of the limb, metres.
const RADIUS: f32 = 0.35;
/// Length of the limb, metres.
const LENGTH: f32 = 2.4;

/// A closed tube along z with two parts, each on its own joint.
pub(crate) fn limb() -> Arc<ColliderMesh> {
    let (mut positions, mut triangles, mut influences) = (Vec::new(), Vec::new(), Vec::new());
    let rings = 2 * RINGS;
    for ring in 0..=rings {
        let z = (ring as f32 / rings as f32 - 0.5) * LENGTH;
        for side in 0..SIDES {
            let angle = f64::from(side) / f64::from(SIDES) * core::f64::consts::TAU;
            let (sin, cos) = libm::sincos(angle);
            positions.push(Vec3::new(RADIUS * cos as f32, RADIUS * sin as f32, z));
            let joint = JointId(u32::from(ring > RINGS));
            influences.push(Influence { joint, weight: 1.0 });
        }
    }
    for ring in 0..rings {
        for side in 0..SIDES {
            let at = |ring: u32, side: u32| ring * SIDES + side % SIDES;
            let (a, b) = (at(ring, side), at(ring, side + 1));
            let (c, d) = (at(ring + 1, side), at(ring + 1, side + 1));
            triangles.extend([[a, b, d], [a, d, c]]);
        }
    }
    for (ring, joint) in [(0, 0), (rings, 1)] {
        let middle = positions.len() as u32;
        positions.push(Vec3::Z * ((ring as f32 / rings as f32 - 0.5) * LENGTH));
        influences.push(Influence {
            joint: JointId(joint),
            weight: 1.0,
        });
        for side in 0..SIDES {
            let (a, b) = (ring * SIDES + side, ring * SIDES + (side + 1) % SIDES);
            triangles.push(if ring == 0 {
                [middle, b, a]
            } else {
                [middle, a, b]
            });
        }
    }
    let source = MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        joint_count: 2,
        ..MeshSource::default()
    };
    Arc::new(
        ColliderMesh::build(&source, &ColliderBuildOptions::default())
            .unwrap()
            .0,
    )
}
