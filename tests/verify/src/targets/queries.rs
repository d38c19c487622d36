//! The fuzz target of queries: the answer to any query of any surface, after any edits, equals the answer of brute
//! force bit for bit. A query with a length that is NaN or negative finds nothing.

use std::sync::Arc;

use crate::agreement::{Among, Answers, Cast, Comparison, Found, Line, Question, Shape};
use clamber_surface::SimdLevel;
use clamber_surface::geometry::{Capsule, Ray};
use clamber_surface::measure::BruteForce;
use clamber_surface::mesh::{ColliderMesh, Influence, PartId, TriangleId, VertexId};
use clamber_surface::rig::JointId;
use clamber_surface::surface::{ModelSpace, SkinnedSurface, SurfaceEdit, SurfaceError};
use glam::Vec3;

use super::bits::bits;
use super::bytes::Bytes;
use super::mesh::{built, tag};
use super::poses::{palette, similarity};

/// Numbers of checked queries and edits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Queries {
    /// Hits. Brute force found the same ones.
    pub hits: usize,
    /// Queries with valid arguments, with or without hits.
    pub answered: usize,
    /// Queries with invalid lengths, points or shapes, which found nothing.
    pub refused: usize,
    /// Edits that were accepted.
    pub edits: usize,
}

/// Runs random queries on a random surface, both made from the bytes, and compares the answers with brute force.
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
        // If the pose is rejected, the queries use the surface's old pose.
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

/// Makes a random edit; returns true if it was accepted. If it was rejected, checks that the surface has not changed.
fn edit(surface: &mut SkinnedSurface, bytes: &mut Bytes<'_>) -> bool {
    let mesh = surface.mesh().clone();
    // An id may be one past the end.
    let triangle = TriangleId(bytes.below(mesh.triangles().len() + 1) as u32);
    let part = PartId(bytes.below(mesh.part_count() + 1) as u32);
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

/// Adds a vertex, and a triangle with this vertex in place of the first corner. If the triangle is rejected, only the
/// vertex is added.
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

/// Asks questions from four places, and compares the answers with brute force.
fn compare(surface: &SkinnedSurface, bytes: &mut Bytes<'_>, seen: &mut Queries) {
    let space = surface.in_model();
    let brute_force = BruteForce::new(space);
    let positions = brute_force.positions();
    for (v, p) in (0..).map(VertexId).zip(positions) {
        let wanted = surface.mesh().has_vertex(v).then(|| bits(*p));
        assert_eq!(space.position(v).map(bits), wanted, "vertex {v}");
    }
    let largest = |p: &Vec3| p.abs().max_element();
    let size = positions.iter().map(largest).fold(0.0, f32::max);
    let mut asked = Vec::new();
    for _ in 0..4 {
        questions(bytes, positions, size, &mut asked);
        for question in &asked {
            seen.ask(&brute_force, &space, question);
        }
    }
}

/// Questions of every kind from one place, with valid arguments and with others.
fn questions(bytes: &mut Bytes<'_>, positions: &[Vec3], size: f32, all: &mut Vec<Question>) {
    let origin = place(bytes, positions, size);
    let to = place(bytes, positions, size);
    let max_distance = length(bytes, size);
    let direction = if bytes.one_in(4) {
        bytes.hostile_point()
    } else {
        to - origin
    };
    check_ray(origin, direction);
    *all = Question::along_ray(origin, direction, max_distance).to_vec();
    all.push(Question::ClosestPoint {
        point: origin,
        max_distance,
    });
    all.push(Question::VisitBox {
        low: origin.min(to),
        high: to,
    });
    // A shape's radius must be finite.
    let radius = if max_distance == f32::INFINITY {
        f32::MAX
    } else {
        max_distance
    };
    let motion = motion(bytes, to - origin);
    let tolerance = Some(f64::from(tolerance(bytes, radius)));
    let other = if bytes.one_in(2) { motion } else { to - origin };
    for (end, displacements) in [(origin, [motion; 2]), (to, [motion, other])] {
        let shape = Shape {
            ends: [origin, end],
            radius,
        };
        let capsule = Capsule::new(origin, end, radius);
        assert_eq!(capsule.is_some(), is_capsule(shape), "{shape:?}");
        all.push(Question::OverlapCapsule { shape });
        all.push(Question::ClosestToCapsule {
            shape,
            max_distance,
        });
        for moving in [true, false] {
            let cast = Cast {
                shape,
                displacements,
                moving,
                tolerance,
            };
            let some = bytes.pick(&[Among::OutsideAtStart, Among::EveryThirdTriangle]);
            for among in [Among::All, some] {
                all.push(Question::CastCapsule { cast, among });
            }
            all.push(Question::CastCapsuleAll { cast });
        }
    }
}

/// A displacement for a shape whose target is at `way` from it.
fn motion(bytes: &mut Bytes<'_>, way: Vec3) -> Vec3 {
    match bytes.byte() % 4 {
        0 => Vec3::ZERO,
        1 => way,
        2 => way * bytes.share() * 3.0,
        _ if bytes.one_in(6) => bytes.hostile_point(),
        _ => bytes.point() * way.length(),
    }
}

fn tolerance(bytes: &mut Bytes<'_>, radius: f32) -> f32 {
    match bytes.byte() % 4 {
        0 => 0.0,
        1 => radius * 0.01,
        2 if bytes.one_in(4) => bytes.hostile(),
        _ => 1e-4,
    }
}

/// Checks that [`Ray::new`] succeeds if and only if its arguments are valid.
fn check_ray(origin: Vec3, aim: Vec3) {
    let ray = Ray::new(origin, aim);
    assert_eq!(ray.is_some(), is_ray(origin, aim), "{origin}, {aim}");
    if let Some(ray) = ray {
        let length = ray.direction().as_dvec3().length();
        assert!((length - 1.0).abs() < 1e-6, "{ray:?}");
    }
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
    /// Compares one answer with brute force's, and checks that a question with invalid arguments finds nothing.
    ///
    /// If coordinates differ in size by about 2^50, bounds may rule out contacts that the exact test cannot decide. So
    /// if brute force leaves a contact undecided, the answers are compared only for a first contact, and only if both
    /// answers are decided.
    fn ask(&mut self, brute_force: &BruteForce<'_>, space: &ModelSpace<'_>, question: &Question) {
        let mut comparison = Comparison::default();
        comparison.ask(brute_force, question);
        let result = comparison.hold(space).map(<[Found]>::len);
        let found = match result {
            Ok(found) => found,
            Err(_) if is_undecided(brute_force, &comparison, question) => 0,
            Err(disagreement) => panic!("{disagreement}"),
        };
        if is_sound(question) {
            self.answered += 1;
        } else {
            assert!(
                comparison.found().is_empty(),
                "{question:?} finds something"
            );
            self.refused += 1;
        }
        self.hits += found;
    }
}

/// True if the answers may differ because brute force could not decide a contact: see [`Queries::ask`].
fn is_undecided(brute_force: &BruteForce<'_>, asked: &Comparison, question: &Question) -> bool {
    let any = |rows: &[Found]| rows.iter().any(Found::is_undecided);
    let Question::CastCapsule { cast, .. } = *question else {
        return any(asked.wanted());
    };
    let mut all = Vec::new();
    brute_force.answer(&Question::CastCapsuleAll { cast }, &mut all);
    any(&all) && (any(asked.wanted()) || any(asked.found()))
}

/// True if a ray's arguments are valid.
fn is_ray(origin: Vec3, direction: Vec3) -> bool {
    origin.is_finite() && direction.is_finite() && direction != Vec3::ZERO
}

/// True if a capsule's arguments are valid.
fn is_capsule(shape: Shape) -> bool {
    let finite = shape.ends.iter().all(|end| end.is_finite());
    finite && shape.radius >= 0.0 && shape.radius.is_finite()
}

/// True if a question's arguments are valid.
fn is_sound(question: &Question) -> bool {
    let line = |line: Line| is_ray(line.origin, line.direction) && line.max_distance >= 0.0;
    let cast = |cast: Cast| {
        let tolerance = cast.tolerance.unwrap_or_default();
        let finite = cast.displacements.iter().all(|way| way.is_finite());
        is_capsule(cast.shape) && finite && tolerance >= 0.0 && tolerance.is_finite()
    };
    match *question {
        Question::CastRay(of) | Question::IntersectsRay(of) | Question::CastRayAll(of) => line(of),
        Question::ClosestPoint {
            point,
            max_distance,
        } => point.is_finite() && max_distance >= 0.0,
        Question::ClosestToCapsule {
            shape,
            max_distance,
        } => is_capsule(shape) && max_distance >= 0.0,
        Question::OverlapCapsule { shape } => is_capsule(shape),
        Question::CastCapsule { cast: of, .. } | Question::CastCapsuleAll { cast: of } => cast(of),
        Question::VisitBox { low, high } => {
            low.is_finite() && high.is_finite() && low.cmple(high).all()
        }
    }
}
