use clamber_surface::geometry::rotation_from_axis_angle;
use glam::DVec3;
use rapier3d::geometry::TriMesh;
use rapier3d::parry::query::{DefaultQueryDispatcher, PersistentQueryDispatcher};
use rapier3d::parry::shape::{Ball, Cuboid, TriMeshFlags};

use super::*;

type Manifold = rapier3d::parry::query::ContactManifold<(), ()>;

/// A rough sheet of `side` by `side` squares, with a fin on one of its edges and a triangle without area.
struct Sheet {
    side: u32,
    triangles: Vec<[u32; 3]>,
    /// For each vertex, its place in the grid. Vertices are in the order in which triangles use them, because a mesh of
    /// parry's with normals sorts them in this order.
    places: Vec<u32>,
}

impl Sheet {
    fn new(side: u32, rng: &mut fastrand::Rng) -> Self {
        let row = side + 1;
        let mut triangles = Vec::new();
        for first in (0..side * row).filter(|first| first % row < side) {
            let [b, c, d] = [first + 1, first + row, first + row + 1];
            triangles.extend([[first, b, c], [b, d, c]]);
        }
        let fin = row * row;
        triangles.extend([[0, 1, fin], [1, row, fin], [2, 2 + row, 2]]);
        rng.shuffle(&mut triangles);
        let mut places = Vec::new();
        for corner in triangles.as_flattened_mut() {
            let known = places.iter().position(|place| place == corner);
            let index = known.unwrap_or(places.len());
            if known.is_none() {
                places.push(*corner);
            }
            *corner = index as u32;
        }
        Self {
            side,
            triangles,
            places,
        }
    }

    /// New positions of the sheet's vertices, with other heights each time.
    fn heave(&self, rng: &mut fastrand::Rng) -> Vec<Vector> {
        let row = self.side + 1;
        let place = |place: &u32| {
            let height = rng.f32() * 0.3;
            if *place == row * row {
                return Vector::new(0.5, 1.0 + height, 0.5);
            }
            Vector::new((place % row) as f32, height, (place / row) as f32)
        };
        self.places.iter().map(place).collect()
    }

    fn shape(&self, vertices: &[Vector]) -> PatchShape {
        PatchShape::new(&self.triangles, vertices.iter().copied())
    }
}

/// Parry's mesh that the shape replaces.
fn mesh(sheet: &Sheet, vertices: &[Vector]) -> TriMesh {
    let flags = TriMeshFlags::FIX_INTERNAL_EDGES_TWO_SIDED;
    let mesh = TriMesh::with_flags(vertices.to_vec(), sheet.triangles.clone(), flags).unwrap();
    assert_eq!(mesh.indices(), sheet.triangles);
    mesh
}

/// The bits of the directions that contact normals are kept to.
fn bits(normals: Option<TrianglePseudoNormals>) -> Option<(Vec<u32>, bool)> {
    normals.map(|normals| {
        let all = [normals.face].into_iter().chain(normals.edges);
        let bits = all.flat_map(|v| v.to_array().map(f32::to_bits));
        (bits.collect(), normals.two_sided)
    })
}

#[test]
fn normals_have_the_bits_of_a_trimesh_whenever_the_vertices_move() {
    let mut rng = fastrand::Rng::with_seed(11);
    for side in [2, 5, 9] {
        let sheet = Sheet::new(side, &mut rng);
        let mut shape = sheet.shape(&sheet.heave(&mut rng));
        let mut none = 0;
        for _ in 0..20 {
            let vertices = sheet.heave(&mut rng);
            shape.place(vertices.iter().copied());
            let mesh = mesh(&sheet, &vertices);
            for index in 0..sheet.triangles.len() {
                let own = bits(shape.normal_constraints(index));
                none += u32::from(own.is_none());
                let other = bits(mesh.triangle_normal_constraints(index as u32));
                assert_eq!(own, other, "triangle {index} of {side}");
            }
        }
        assert!(none > 0, "no triangle without area");
    }
}

#[test]
fn rays_and_points_find_the_same_triangles_as_in_a_trimesh() {
    let mut rng = fastrand::Rng::with_seed(12);
    let sheet = Sheet::new(8, &mut rng);
    let mut vertices = sheet.heave(&mut rng);
    let mut shape = sheet.shape(&vertices);
    let mut hits = 0;
    for round in 0..2000 {
        if round % 200 == 0 {
            vertices = sheet.heave(&mut rng);
            shape.place(vertices.iter().copied());
        }
        // Without flags, because a mesh with normals counts points behind it as inside.
        let mesh = TriMesh::new(vertices.clone(), sheet.triangles.clone()).unwrap();
        let point = Vector::new(rng.f32(), rng.f32() * 0.5, rng.f32()) * 10.0 - Vector::ONE;
        let toward = Vector::new(rng.f32(), rng.f32(), rng.f32()) - 0.5;
        let ray = Ray::new(point, toward);
        let cast = |shape: &dyn Shape| {
            let hit = shape.cast_local_ray_and_get_normal(&ray, 20.0, false);
            hit.map(|hit| (hit.time_of_impact, hit.subshape))
        };
        assert_eq!(cast(&shape).map(|hit| hit.0), cast(&mesh).map(|hit| hit.0));
        hits += u32::from(cast(&shape).is_some());
        let distance = |shape: &dyn Shape| {
            let near = shape.project_local_point(point, false);
            (near.point - point).length()
        };
        assert!((distance(&shape) - distance(&mesh)).abs() < 1e-5);
    }
    assert!((300..1700).contains(&hits), "{hits} rays hit");
}

/// Contacts of a shape with a body at a pose: part, normal, depth; sorted.
fn contacts(
    skin: &dyn Shape,
    body: &dyn Shape,
    at: &Pose,
    kept: &mut (
        Vec<Manifold>,
        Option<rapier3d::parry::query::ContactManifoldsWorkspace>,
    ),
) -> Vec<(u32, [i32; 3], i32)> {
    let (manifolds, workspace) = kept;
    DefaultQueryDispatcher
        .contact_manifolds(at, skin, body, 0.02, manifolds, workspace)
        .unwrap();
    let rounded = |x: f32| (x * 1e4).round() as i32;
    let mut all = Vec::new();
    for manifold in manifolds.iter() {
        let normal = manifold.local_n1.to_array().map(rounded);
        let points = manifold.points.iter();
        all.extend(points.map(|point| (manifold.subshape1, normal, rounded(point.dist))));
    }
    all.sort_unstable();
    all
}

/// A body stands still for some ticks while the sheet heaves, then is elsewhere. A new mesh without any memory gives
/// the same contacts.
#[test]
fn contacts_are_those_of_a_trimesh_that_is_made_anew() {
    let mut rng = fastrand::Rng::with_seed(13);
    let bodies: [&dyn Shape; 2] = [&Cuboid::new(Vector::new(0.7, 0.5, 0.6)), &Ball::new(0.6)];
    let mut met = 0;
    for body in bodies {
        let sheet = Sheet::new(6, &mut rng);
        let mut shape = sheet.shape(&sheet.heave(&mut rng));
        let mut kept = (Vec::new(), None);
        let mut at = Pose::IDENTITY;
        for round in 0..300 {
            let vertices = sheet.heave(&mut rng);
            shape.place(vertices.iter().copied());
            if round % 5 == 0 {
                let place = Vector::new(1.5 + 3.0 * rng.f32(), 0.5 + 0.3 * rng.f32(), 3.0);
                let turn = rotation_from_axis_angle(DVec3::Y, rng.f64()).as_quat();
                at = Pose::from_parts(place, turn);
            }
            let own = contacts(&shape, body, &at, &mut kept);
            let mesh = mesh(&sheet, &vertices);
            let other = contacts(&mesh, body, &at, &mut Default::default());
            assert_eq!(own, other);
            met += own.len();
        }
    }
    assert!(met > 2000, "{met} contacts");
}

#[test]
fn its_box_is_around_its_vertices_and_scaling_moves_them() {
    let mut rng = fastrand::Rng::with_seed(14);
    let sheet = Sheet::new(3, &mut rng);
    let vertices = sheet.heave(&mut rng);
    let shape = sheet.shape(&vertices);
    let bounds = Aabb::from_points(vertices.iter().copied());
    assert_eq!(shape.compute_local_aabb(), bounds);
    let scale = Vector::new(2.0, 3.0, 0.5);
    let scaled = shape.scale_dyn(scale, 0).unwrap();
    let wanted = Aabb::new(bounds.mins * scale, bounds.maxs * scale);
    assert_eq!(scaled.compute_local_aabb(), wanted);
}
