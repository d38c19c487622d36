//! The fuzz target of queries: any query of any surface, with any edits, gives brute force's answer bit for bit.
//! A length that is NaN or negative finds nothing.

use std::sync::Arc;

use clamber_surface::SimdLevel;
use clamber_surface::geometry::{Capsule, Ray};
use clamber_surface::measure::BruteForce;
use clamber_surface::mesh::{ColliderMesh, Influence, PartId, TriangleId, VertexId};
use clamber_surface::rig::JointId;
use clamber_surface::surface::{ModelSpace, SkinnedSurface, SurfaceEdit, SurfaceError, SurfaceHit};
use glam::Vec3;

use crate::bytes::Bytes;
use crate::mesh::{built, tag};
use crate::poses::{palette, similarity};
use crate::same::{bits, same_hits};
use crate::sweeps::{self, Moves};

/// Counts of what was checked.
#[derive(Clone, Copy, Debug, Default)]
pub struct Queries {
    /// Hits, which brute force found as well.
    pub hits: usize,
    /// Queries with valid arguments, with or without hits.
    pub answered: usize,
    /// Queries with invalid lengths, points or shapes, which found nothing.
    pub refused: usize,
    /// Edits that were accepted.
    pub edits: usize,
}

/// Runs queries that are made from any bytes on a surface made from them, and compares with brute force.
///
/// # Panics
/// If a check fails.
pub fn queries(data: &[u8]) -> Queries {
    let mut bytes = Bytes::new(data);
    let mut seen = Queries::default();
    let Some(mesh) = built(&mut bytes) else {
        return seen;
    };
    let level = bytes.pick(&SimdLevel::available());
    let mut surface = SkinnedSurface::with_simd_level(Arc::new(mesh), level);
    for _ in 0..3 {
        let mesh = surface.mesh();
        let faults = bytes.one_in(8);
        let palette = palette(&mut bytes, mesh.joint_count(), mesh.radius(), faults);
        // If the pose is rejected, the surface is queried in its old one.
        let _ = surface.advance(&palette, similarity(&mut bytes, faults));
        for _ in 0..bytes.below(4) {
            seen.edits += usize::from(edit(&mut surface, &mut bytes));
        }
        if bytes.one_in(8) {
            surface.skin_ahead();
        }
        compare(&surface, &mut bytes, &mut seen);
    }
    seen
}

/// Makes an edit; returns false if it was rejected, and checks that nothing has changed then.
fn edit(surface: &mut SkinnedSurface, bytes: &mut Bytes<'_>) -> bool {
    let mesh = surface.mesh().clone();
    // An id may be one past the end.
    let triangle = TriangleId(bytes.below(mesh.triangles().len() + 1) as u32);
    let part = PartId(bytes.below(mesh.parts().len() + 1) as u32);
    let mut vertex = || VertexId(bytes.below(mesh.positions().len() + 1) as u32);
    let corners = [vertex(), vertex(), vertex()];
    let before = shown(surface);
    let kind = bytes.byte();
    let result = match kind % 8 {
        0 => surface.enable_part(part),
        1 => surface.disable_part(part),
        2 => surface.enable_triangle(triangle),
        3 | 4 => surface.disable_triangle(triangle),
        5 => surface.edit(|edit| edit.remove_triangle(triangle)),
        _ => surface.edit(|edit| match kind / 32 {
            0 => edit.remove_vertex(corners[0]),
            1 => edit.set_tag(triangle, tag(bytes)),
            2 | 3 => add_vertex(edit, &mesh, corners, bytes),
            _ => add_triangle(edit, &mesh, corners, bytes),
        }),
    };
    if let Err(error) = &result {
        assert!(!error.to_string().is_empty());
        assert_eq!(shown(surface), before, "{error}");
        assert_eq!(*surface.mesh(), mesh, "{error}");
    }
    result.is_ok()
}

fn add_triangle(
    edit: &mut SurfaceEdit<'_>,
    mesh: &ColliderMesh,
    corners: [VertexId; 3],
    bytes: &mut Bytes<'_>,
) -> Result<(), SurfaceError> {
    let added = edit.add_triangle(corners, tag(bytes))?;
    assert_eq!(added.index(), mesh.triangles().len());
    Ok(())
}

/// Adds a vertex, and if it has area, a triangle with the vertex in place of the first corner.
fn add_vertex(
    edit: &mut SurfaceEdit<'_>,
    mesh: &ColliderMesh,
    [_, b, c]: [VertexId; 3],
    bytes: &mut Bytes<'_>,
) -> Result<(), SurfaceError> {
    let (position, influences) = vertex_of(bytes, mesh);
    let added = edit.add_vertex(position, &influences)?;
    assert_eq!(added.index(), mesh.positions().len());
    // If the triangle is rejected, the vertex stays.
    let _ = add_triangle(edit, mesh, [added, b, c], bytes);
    Ok(())
}

/// A vertex between two vertices of the mesh, or anywhere; sometimes one that is rejected.
fn vertex_of(bytes: &mut Bytes<'_>, mesh: &ColliderMesh) -> (Vec3, Vec<Influence>) {
    let mut known = || mesh.positions()[bytes.below(mesh.positions().len())] * 0.5;
    let between = known() + known();
    let position = match bytes.below(8) {
        0 => bytes.hostile_point(),
        1 => between + bytes.point() * mesh.radius(),
        _ => between,
    };
    let beyond = usize::from(bytes.one_in(16));
    let influences = (0..1 + bytes.below(4)).map(|_| Influence {
        joint: JointId(bytes.below(mesh.joint_count() + beyond) as u32),
        weight: if bytes.one_in(16) {
            bytes.hostile()
        } else {
            bytes.share()
        },
    });
    (position, influences.collect())
}

/// For each triangle, whether it is enabled.
fn shown(surface: &SkinnedSurface) -> Vec<bool> {
    let ids = 0..surface.mesh().triangles().len() as u32;
    ids.map(|id| surface.is_enabled(TriangleId(id))).collect()
}

/// A posed surface, and brute force to compare it with.
pub(crate) struct Both<'a> {
    pub(crate) space: ModelSpace<'a>,
    pub(crate) brute_force: BruteForce<'a>,
}

fn compare(surface: &SkinnedSurface, bytes: &mut Bytes<'_>, seen: &mut Queries) {
    let space = surface.in_model();
    let brute_force = BruteForce::new(space);
    let both = Both { space, brute_force };
    let positions = both.brute_force.positions();
    for (v, p) in (0..).map(VertexId).zip(positions) {
        let wanted = surface.mesh().has_vertex(v).then(|| bits(*p));
        assert_eq!(space.position(v).map(bits), wanted, "vertex {v}");
    }
    let largest = |p: &Vec3| p.abs().max_element();
    let size = positions.iter().map(largest).fold(0.0, f32::max);
    for _ in 0..4 {
        let origin = place(bytes, positions, size);
        let to = place(bytes, positions, size);
        let reach = length(bytes, size);
        let aim = if bytes.one_in(4) {
            bytes.hostile_point()
        } else {
            to - origin
        };
        if let Some(ray) = ray(origin, aim) {
            seen.ask_along(&both, &ray, reach);
        }
        seen.ask_nearest(&both, origin, reach);
        // A shape's radius must be finite.
        let radius = if reach == f32::INFINITY {
            f32::MAX
        } else {
            reach
        };
        let moves = Moves::any(bytes, to - origin, radius);
        for (end, ways) in [(origin, moves.of_ball()), (to, moves.of_capsule())] {
            let Some(capsule) = capsule(origin, end, radius) else {
                seen.refused += 1;
                continue;
            };
            seen.ask_about(&both, &capsule, reach);
            let swept = sweeps::compare(&both, &capsule, ways, moves.tolerance);
            seen.answered += swept.answered;
            seen.refused += swept.refused;
            seen.hits += swept.hits;
        }
    }
}

/// A capsule, or `None`; checks that it is `None` exactly for invalid arguments.
fn capsule(a: Vec3, b: Vec3, radius: f32) -> Option<Capsule> {
    let capsule = Capsule::new(a, b, radius);
    let usable = a.is_finite() && b.is_finite() && radius >= 0.0 && radius.is_finite();
    assert_eq!(capsule.is_some(), usable, "{a}, {b}, {radius}");
    capsule
}

/// A ray, or `None`; checks that it is `None` exactly for invalid arguments.
fn ray(origin: Vec3, aim: Vec3) -> Option<Ray> {
    let ray = Ray::new(origin, aim);
    let usable = origin.is_finite() && aim.is_finite() && aim != Vec3::ZERO;
    assert_eq!(ray.is_some(), usable, "{origin}, {aim}");
    if let Some(ray) = ray {
        let length = ray.direction().as_dvec3().length();
        assert!((length - 1.0).abs() < 1e-6, "{ray:?}");
    }
    ray
}

/// A point on the surface, near it, or anywhere.
fn place(bytes: &mut Bytes<'_>, positions: &[Vec3], size: f32) -> Vec3 {
    let vertex = positions[bytes.below(positions.len())];
    let other = positions[bytes.below(positions.len())];
    match bytes.byte() % 8 {
        0 => vertex,
        1 => vertex * 0.5 + other * 0.5,
        2 if bytes.one_in(2) => bytes.hostile_point(),
        3 => bytes.point(),
        4 => vertex + bytes.point() * size,
        _ => vertex + bytes.point() * size * 0.03,
    }
}

fn length(bytes: &mut Bytes<'_>, size: f32) -> f32 {
    match bytes.byte() % 8 {
        0 => 0.0,
        1 => f32::INFINITY,
        2 if bytes.one_in(3) => bytes.hostile(),
        3 => bytes.number().abs(),
        4 => size,
        _ => size * bytes.share(),
    }
}

impl Queries {
    fn ask_along(&mut self, both: &Both<'_>, ray: &Ray, reach: f32) {
        let Both { space, brute_force } = both;
        let may_find = reach >= 0.0;
        let one = space.cast_ray(ray, reach);
        let wanted = brute_force.cast_ray(ray, reach);
        let met = space.intersects_ray(ray, reach);
        assert_eq!(met, wanted.is_some(), "{ray:?}, {reach}");
        let question = || format!("cast {ray:?}, {reach}");
        self.same(may_find, one.as_slice(), wanted.as_slice(), question);
        let (mut all, mut wanted) = (Vec::new(), Vec::new());
        space.cast_ray_all(ray, reach, &mut all);
        brute_force.cast_ray_all(ray, reach, &mut wanted);
        let question = || format!("all along {ray:?}, {reach}");
        self.same(may_find, &all, &wanted, question);
    }

    fn ask_nearest(&mut self, both: &Both<'_>, point: Vec3, reach: f32) {
        let may_find = point.is_finite() && reach >= 0.0;
        let one = both.space.closest_point(point, reach);
        let wanted = both.brute_force.closest_point(point, reach);
        let question = || format!("closest to {point}, {reach}");
        self.same(may_find, one.as_slice(), wanted.as_slice(), question);
    }

    fn ask_about(&mut self, both: &Both<'_>, capsule: &Capsule, reach: f32) {
        let Both { space, brute_force } = both;
        let (mut all, mut wanted) = (Vec::new(), Vec::new());
        space.overlap_capsule(capsule, &mut all);
        brute_force.overlap_capsule(capsule, &mut wanted);
        self.same(true, &all, &wanted, || format!("{capsule:?}"));
        let one = space.closest_to_capsule(capsule, reach);
        let wanted = brute_force.closest_to_capsule(capsule, reach);
        let (one, wanted) = (one.map(|hit| hit.surface), wanted.map(|hit| hit.surface));
        let question = || format!("closest to {capsule:?}, {reach}");
        self.same(reach >= 0.0, one.as_slice(), wanted.as_slice(), question);
    }

    /// Checks that two answers to one question are equal and valid, and empty unless the question `may_find` something.
    fn same(
        &mut self,
        may_find: bool,
        found: &[SurfaceHit],
        wanted: &[SurfaceHit],
        question: impl Fn() -> String,
    ) {
        let same = same_hits(found, wanted);
        assert!(same, "{}:\n{found:?}\n{wanted:?}", question());
        for hit in found {
            check(hit, &question);
        }
        if may_find {
            self.answered += 1;
        } else {
            assert!(found.is_empty(), "{}: {found:?}", question());
            self.refused += 1;
        }
        self.hits += found.len();
    }
}

fn check(hit: &SurfaceHit, question: &impl Fn() -> String) {
    let say = || format!("{}: {hit:?}", question());
    let [u, v, w] = hit.barycentric;
    assert!(u >= 0.0 && v >= 0.0 && w >= 0.0, "{}", say());
    assert!((u + v + w - 1.0).abs() < 1e-6, "{}", say());
    assert!(hit.point.is_finite(), "{}", say());
    let normal = hit.normal.as_dvec3().length();
    assert!((normal - 1.0).abs() < 1e-6, "{}", say());
    assert!(hit.distance >= 0.0 && hit.distance.is_finite(), "{}", say());
}
