//! Brute-force queries in f64, over triangles that are posed from the entities' transforms alone.

#![allow(dead_code, reason = "no test uses all of it")]

use bevy_app::App;
use bevy_asset::Assets;
use bevy_ecs::prelude::*;
use bevy_mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};
use bevy_transform::components::Transform;
use glam::{DAffine3, DQuat, DVec3};

/// Corners of a triangle in world space.
pub(crate) type Corners = [DVec3; 3];

/// An entity's transform in world space, from the `Transform`s of the entity and its ancestors.
pub(crate) fn world_from(app: &App, entity: Entity) -> DAffine3 {
    let transform = app.world().get::<Transform>(entity).unwrap();
    let q = transform.rotation;
    let local = DAffine3::from_scale_rotation_translation(
        transform.scale.as_dvec3(),
        DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into()).normalize(),
        transform.translation.as_dvec3(),
    );
    match app.world().get::<ChildOf>(entity) {
        Some(child_of) => world_from(app, child_of.parent()) * local,
        None => local,
    }
}

/// The current positions of a skinned mesh's vertices, in world space.
pub(crate) fn posed(app: &App, entity: Entity) -> Vec<DVec3> {
    let world = app.world();
    let skin = world.get::<SkinnedMesh>(entity).unwrap();
    let bind = world.resource::<Assets<SkinnedMeshInverseBindposes>>();
    let bind = bind.get(&skin.inverse_bindposes).unwrap();
    let palette: Vec<DAffine3> = skin
        .joints
        .iter()
        .zip(bind.iter())
        .map(|(joint, bind)| world_from(app, *joint) * DAffine3::from_mat4(bind.as_dmat4()))
        .collect();
    let mesh = world.get::<Mesh3d>(entity).unwrap();
    let mesh = world.resource::<Assets<Mesh>>().get(mesh).unwrap();
    let (
        VertexAttributeValues::Float32x3(positions),
        VertexAttributeValues::Uint16x4(joints),
        VertexAttributeValues::Float32x4(weights),
    ) = (
        mesh.attribute(Mesh::ATTRIBUTE_POSITION).unwrap(),
        mesh.attribute(Mesh::ATTRIBUTE_JOINT_INDEX).unwrap(),
        mesh.attribute(Mesh::ATTRIBUTE_JOINT_WEIGHT).unwrap(),
    )
    else {
        panic!("formats");
    };
    let skinned = positions.iter().zip(joints).zip(weights);
    skinned
        .map(|((position, joints), weights)| {
            let rest = DVec3::from_array(position.map(f64::from));
            let images = joints.iter().zip(weights);
            // The weights add up to 1 in f32 only, which matters far from the origin.
            let sum: f64 = weights.iter().map(|weight| f64::from(*weight)).sum();
            let position: DVec3 = images
                .map(|(joint, weight)| {
                    palette[usize::from(*joint)].transform_point3(rest) * f64::from(*weight)
                })
                .sum();
            position / sum
        })
        .collect()
}

/// The triangles of a skinned mesh as posed now.
pub(crate) fn triangles(app: &App, entity: Entity) -> Vec<Corners> {
    let positions = posed(app, entity);
    let mesh = app.world().get::<Mesh3d>(entity).unwrap();
    let mesh = app.world().resource::<Assets<Mesh>>().get(mesh).unwrap();
    let indices: Vec<usize> = mesh.indices().unwrap().iter().collect();
    let corners = indices.as_chunks::<3>().0;
    corners.iter().map(|c| c.map(|i| positions[i])).collect()
}

/// Distance along a unit ray to a triangle, and the smallest barycentric coordinate of the hit, which is negative just
/// outside the triangle. Hits from either side count.
pub(crate) fn ray(origin: DVec3, along: DVec3, [a, b, c]: Corners) -> Option<(f64, f64)> {
    let (u, v) = (b - a, c - a);
    let p = along.cross(v);
    let determinant = u.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let s = origin - a;
    let second = s.dot(p) / determinant;
    let q = s.cross(u);
    let third = along.dot(q) / determinant;
    let distance = v.dot(q) / determinant;
    let border = second.min(third).min(1.0 - second - third);
    (border > -1e-3 && distance > -1e-3).then_some((distance, border))
}

fn on_segment(p: DVec3, [a, b]: [DVec3; 2]) -> DVec3 {
    let d = b - a;
    let t = (p - a).dot(d) / d.length_squared().max(f64::MIN_POSITIVE);
    a + d * t.clamp(0.0, 1.0)
}

/// Distance from a point to a triangle.
pub(crate) fn point(p: DVec3, [a, b, c]: Corners) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = |from: DVec3, to: DVec3| (to - from).cross(p - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return (p - a).dot(normal.normalize()).abs();
    }
    let edges = [[a, b], [b, c], [c, a]];
    let apart = edges.map(|edge| (on_segment(p, edge) - p).length());
    apart.into_iter().fold(f64::INFINITY, f64::min)
}

/// Distance of two segments: the least of their ends' distances, and of their lines' if both nearest points are inside.
fn segments(a: [DVec3; 2], b: [DVec3; 2]) -> f64 {
    let ends = [
        (a[0] - on_segment(a[0], b)).length(),
        (a[1] - on_segment(a[1], b)).length(),
        (b[0] - on_segment(b[0], a)).length(),
        (b[1] - on_segment(b[1], a)).length(),
    ];
    let mut best = ends.into_iter().fold(f64::INFINITY, f64::min);
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let normal = u.cross(v);
    let size = normal.length_squared();
    if size > 1e-18 {
        let s = w.cross(v).dot(normal) / size;
        let t = w.cross(u).dot(normal) / size;
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            best = best.min((a[0] + u * s - b[0] - v * t).length());
        }
    }
    best
}

/// Distance from a segment to a triangle.
pub(crate) fn segment(ends: [DVec3; 2], corners: Corners) -> f64 {
    let along = ends[1] - ends[0];
    let length = along.length();
    if length > 0.0
        && let Some((distance, border)) = ray(ends[0], along / length, corners)
        && border >= 0.0
        && (0.0..=length).contains(&distance)
    {
        return 0.0;
    }
    let [a, b, c] = corners;
    let edges = [[a, b], [b, c], [c, a]].map(|edge| segments(ends, edge));
    let ends = ends.map(|end| point(end, corners));
    edges.into_iter().chain(ends).fold(f64::INFINITY, f64::min)
}

/// The least distance over all triangles.
pub(crate) fn least(all: &[Corners], distance: impl Fn(Corners) -> f64) -> f64 {
    let each = all.iter().map(|corners| distance(*corners));
    each.fold(f64::INFINITY, f64::min)
}

/// Pseudo-random numbers from 0 to 1.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A vector in a cube with sides of `2 * half`.
    pub(crate) fn vector(&mut self, half: f64) -> DVec3 {
        let mut one = || (self.next() * 2.0 - 1.0) * half;
        DVec3::new(one(), one(), one())
    }
}
