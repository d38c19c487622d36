//! A tube on a chain of joints, a clip that bends, stretches and mirrors it, and the ground below it.

use std::f64::consts::TAU;
use std::sync::Arc;

use clamber_surface::geometry::{Affine, rotation_from_axis_angle};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshSource};
use clamber_surface::rig::{
    Channel, Clip, Interpolation, Joint, JointId, Keyframes, Skeleton, Transform,
};
use glam::{DAffine3, DVec3, Vec3};

/// Number of joints of the tube.
pub(crate) const JOINTS: u32 = 16;

/// Number of sides of the tube.
const SIDES: u32 = 20;

/// Radius of the tube, metres.
const RADIUS: f64 = 1.25;

/// Rings of vertices per joint.
const RINGS: u32 = 4;

/// Length of the clip, seconds.
pub(crate) const SECONDS: f32 = 2.0;

/// A closed tube along X, with a joint at each metre and up to four influences per vertex.
pub(crate) fn tube() -> Arc<ColliderMesh> {
    let rings = (JOINTS - 1) * RINGS + 1;
    let mut positions = Vec::new();
    let mut influences = Vec::new();
    let mut influence_ends = Vec::new();
    let mut push = |x: f64, y: f64, z: f64| {
        positions.push(DVec3::new(x, y, z).as_vec3());
        for joint in 0..JOINTS {
            let near = 2.0 - (x - f64::from(joint)).abs();
            if near > 0.0 {
                influences.push(Influence {
                    joint: JointId(joint),
                    weight: (near * near) as f32,
                });
            }
        }
        influence_ends.push(influences.len() as u32);
    };
    for ring in 0..rings {
        for side in 0..SIDES {
            let angle = f64::from(side) / f64::from(SIDES) * TAU;
            let (y, z) = (libm::cos(angle) * RADIUS, libm::sin(angle) * RADIUS);
            push(f64::from(ring) / f64::from(RINGS), y, z);
        }
    }
    push(0.0, 0.0, 0.0);
    push(f64::from(JOINTS - 1), 0.0, 0.0);
    let (first, last) = (rings * SIDES, rings * SIDES + 1);
    let mut triangles = Vec::new();
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        for ring in 0..rings - 1 {
            let (a, b) = (ring * SIDES + side, ring * SIDES + next);
            triangles.push([a, b, a + SIDES]);
            triangles.push([b, b + SIDES, a + SIDES]);
        }
        let end = (rings - 1) * SIDES;
        triangles.push([first, next, side]);
        triangles.push([last, end + side, end + next]);
    }
    build(&MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        influence_ends: &influence_ends,
        joint_count: JOINTS as usize,
        ..MeshSource::default()
    })
}

/// A square of 200 m in the XZ plane, in squares of 10 m, on one joint.
pub(crate) fn ground() -> Arc<ColliderMesh> {
    let side = 21;
    let at = |step: u32| step as f32 * 10.0 - 100.0;
    let corners = (0..side * side).map(|k| Vec3::new(at(k % side), 0.0, at(k / side)));
    let positions: Vec<Vec3> = corners.collect();
    let mut triangles = Vec::new();
    for z in 0..side - 1 {
        for x in 0..side - 1 {
            let a = z * side + x;
            triangles.push([a, a + side, a + side + 1]);
            triangles.push([a, a + side + 1, a + 1]);
        }
    }
    build(&MeshSource::rigid(&positions, &triangles))
}

fn build(source: &MeshSource<'_>) -> Arc<ColliderMesh> {
    let (mesh, _) = ColliderMesh::build(source, &ColliderBuildOptions::default()).unwrap();
    Arc::new(mesh)
}

/// The tube's joints, as a chain.
pub(crate) fn skeleton() -> Skeleton {
    let joint = |index: u32| Joint {
        name: format!("joint {index}"),
        parent: index.checked_sub(1).map(JointId),
        rest: Transform::from_translation(if index > 0 { Vec3::X } else { Vec3::ZERO }),
        inverse_bind: Affine::from_f64(&DAffine3::from_translation(DVec3::X * -f64::from(index))),
    };
    Skeleton::new((0..JOINTS).map(joint).collect()).unwrap()
}

/// Waves along the tube, with the kinds of interpolation in turn. One joint grows and shrinks, one is mirrored.
pub(crate) fn clip() -> Clip {
    let mut channels = Vec::new();
    let keys = 8;
    let times: Vec<f32> = (0..=keys)
        .map(|key| key as f32 / keys as f32 * SECONDS)
        .collect();
    for joint in 1..JOINTS {
        let turned = |key: u32| {
            let phase = TAU * (f64::from(key % keys) / f64::from(keys) + f64::from(joint) / 9.0);
            let axis = DVec3::new(0.3, libm::sin(phase), 1.0).normalize();
            rotation_from_axis_angle(axis, 0.12 * libm::sin(phase)).as_quat()
        };
        let values: Vec<_> = (0..=keys).map(turned).collect();
        let cubic = joint % 3 == 0;
        let values = if cubic {
            let still = glam::Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
            values
                .into_iter()
                .flat_map(|value| [still, value, still])
                .collect()
        } else {
            values
        };
        let interpolation = match joint % 3 {
            0 => Interpolation::CubicSpline,
            1 => Interpolation::Linear,
            _ => Interpolation::Step,
        };
        let values = Keyframes::Rotation(values);
        channels.push(Channel::new(JointId(joint), interpolation, times.clone(), values).unwrap());
    }
    let grown = |key: u32| Vec3::splat(1.0 + 0.2 * (key % keys).min(keys - key % keys) as f32);
    let mirrored = |_| Vec3::new(1.0, 1.0, -1.0);
    let scales = [
        (5, (0..=keys).map(grown).collect()),
        (JOINTS - 2, (0..=keys).map(mirrored).collect()),
    ];
    for (joint, values) in scales {
        let (joint, values) = (JointId(joint), Keyframes::Scale(values));
        let channel = Channel::new(joint, Interpolation::Linear, times.clone(), values);
        channels.push(channel.unwrap());
    }
    Clip::new("waves", channels)
}
