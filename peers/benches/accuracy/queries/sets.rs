//! Seeded sets of ordinary and difficult queries.

use std::error::Error;
use std::sync::Arc;

use clamber_peers::ball;
use clamber_scenes::giant::giant;
use clamber_surface::geometry::{Affine, Ray, Sphere, rotation_from_axis_angle};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::skin::skin_into;
use clamber_verify::brute_force::{Corners, Triangles};
use glam::{DVec3, Vec3};

/// Place of the creature in the set far from the origin, metres.
const FAR: DVec3 = DVec3::new(1_000.0, 0.0, -1_000.0);

/// A posed and placed skin, with its true positions and its queries.
pub(crate) struct Set {
    pub(crate) name: &'static str,
    pub(crate) mesh: Arc<ColliderMesh>,
    pub(crate) palette: Palette,
    pub(crate) place: DVec3,
    pub(crate) truth: Triangles,
    pub(crate) queries: Vec<Query>,
}

/// A ray that hits the skin, and the sphere, point and motion for the other queries.
pub(crate) struct Query {
    pub(crate) ray: Ray,
    pub(crate) reach: f32,
    pub(crate) sphere: Sphere,
    pub(crate) motion: Vec3,
}

/// The target of rays.
#[derive(Clone, Copy, PartialEq)]
enum Aim {
    /// At points inside triangles, from the front.
    Inside,
    /// At points inside triangles, at an angle of about a thousandth of a radian to the skin.
    Grazing,
    /// At points of edges.
    Edges,
    /// At vertices.
    Vertices,
}

pub(crate) fn sets(queries: usize) -> Result<Vec<Set>, Box<dyn Error>> {
    let giant = giant()?;
    let palette = giant.palette("walk", 0.4)?;
    let needles = Arc::new(needles()?);
    let still = Palette::from_matrices([Affine::IDENTITY]);
    let set = |name, mesh: &Arc<ColliderMesh>, palette: &Palette, place, aim| {
        Set::new(name, mesh, palette, place, aim, queries)
    };
    let (skin, origin) = (&giant.rig.collider, DVec3::ZERO);
    Ok(vec![
        set("ordinary", skin, &palette, origin, Aim::Inside)?,
        set("grazing", skin, &palette, origin, Aim::Grazing)?,
        set("slivers", &needles, &still, origin, Aim::Inside)?,
        set("1.4 km out", skin, &palette, FAR, Aim::Inside)?,
        set("aimed at edges", skin, &palette, origin, Aim::Edges)?,
        set("aimed at vertices", skin, &palette, origin, Aim::Vertices)?,
    ])
}

impl Set {
    fn new(
        name: &'static str,
        mesh: &Arc<ColliderMesh>,
        palette: &Palette,
        place: DVec3,
        aim: Aim,
        count: usize,
    ) -> Result<Self, Box<dyn Error>> {
        let mut positions = Vec::new();
        skin_into(mesh, palette.matrices(), &mut positions)?;
        let corners = mesh.triangles().iter();
        let truth = corners.map(|t| t.map(|v| positions[v.index()].as_dvec3() + place));
        let truth = Triangles(truth.collect());
        let mut rng = fastrand::Rng::with_seed(11);
        let mut queries = Vec::with_capacity(count);
        let around = around(mesh);
        while queries.len() < count {
            let triangle = rng.usize(0..truth.0.len());
            let Some(query) = query(&truth.0[triangle], aim, &mut rng) else {
                continue;
            };
            // At the edge of a triangle that faces away, a ray may pass by the skin, so a hit and a miss are both
            // right. Such queries are left out.
            let corners = mesh.triangles()[triangle];
            let at = |v: usize| around[corners[v].index()].iter().copied();
            let along = query.ray.direction().as_dvec3();
            let faces = |triangle: usize| faces(&truth.0[triangle], along);
            let passes = match aim {
                Aim::Inside | Aim::Grazing => false,
                Aim::Edges => !at(0).filter(|t| at(1).any(|other| other == *t)).all(faces),
                Aim::Vertices => !at(0).all(faces),
            };
            if !passes {
                queries.push(query);
            }
        }
        Ok(Self {
            name,
            mesh: Arc::clone(mesh),
            palette: palette.clone(),
            place,
            truth,
            queries,
        })
    }
}

/// The triangles around each vertex.
fn around(mesh: &ColliderMesh) -> Vec<Vec<usize>> {
    let mut around = vec![Vec::new(); mesh.positions().len()];
    for (index, corners) in mesh.triangles().iter().enumerate() {
        for vertex in corners {
            around[vertex.index()].push(index);
        }
    }
    around
}

/// True if a triangle clearly faces a ray with this direction.
fn faces(&[a, b, c]: &Corners, along: DVec3) -> bool {
    (b - a).cross(c - a).normalize_or_zero().dot(along) < -0.05
}

/// A query that is aimed at a triangle from at most a few metres away; `None` if the triangle has no area.
fn query(&[a, b, c]: &Corners, aim: Aim, rng: &mut fastrand::Rng) -> Option<Query> {
    let normal = (b - a).cross(c - a).try_normalize()?;
    let target = match aim {
        Aim::Inside | Aim::Grazing => {
            let (u, v) = (rng.f64(), rng.f64());
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            a + (b - a) * (0.02 + 0.94 * u) + (c - a) * (0.02 + 0.94 * v)
        }
        Aim::Edges => a.lerp(b, rng.f64()),
        Aim::Vertices => a,
    };
    let (mut sideways, _) = normal.any_orthonormal_pair();
    sideways = rotation_from_axis_angle(normal, rng.f64() * core::f64::consts::TAU) * sideways;
    let steep = match aim {
        Aim::Grazing => 1e-3,
        _ => 0.3 + rng.f64(),
    };
    let back = (normal * steep + sideways).normalize();
    let length = 0.2 + 2.0 * rng.f64();
    // The origin is rounded to f32 first, and the direction is aimed from there.
    let origin = (target + back * length).as_vec3();
    let direction = (target - origin.as_dvec3()).normalize().as_vec3();
    let radius = 0.05 + 0.4 * rng.f32();
    Some(Query {
        ray: Ray::new(origin, direction)?,
        reach: 2.0 * length as f32 + 1.0,
        sphere: Sphere {
            center: origin,
            radius,
        },
        motion: direction * (length as f32 + radius),
    })
}

/// A closed ball of 6 rings and 2,048 segments, 10 m across. Its triangles are hundreds of times as long as wide.
fn needles() -> Result<ColliderMesh, Box<dyn Error>> {
    let (positions, triangles) = ball(6, 2_048, |_, _| 5.0);
    let source = MeshSource::rigid(&positions, &triangles);
    Ok(ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0)
}
