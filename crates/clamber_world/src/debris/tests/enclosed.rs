//! The test for enclosed points, checked against the winding number.

use clamber_surface::measure::winding_number;
use clamber_surface::mesh::{Influence, SurfaceTag, TriangleId, VertexId};
use clamber_surface::rig::JointId;
use clamber_surface::surface::SkinnedSurface;
use glam::{Vec2, Vec3, Vec3Swizzles};

use super::scene::slab;
use crate::debris::enclosed::{is_enclosed, is_within};
use crate::testing::rigid;

/// Half the size of the slab, metres.
const HALF: Vec3 = Vec3::new(3.0, 1.5, 2.0);

/// Random points in a box of twice the size of a slab.
fn points(seed: u64) -> impl Iterator<Item = Vec3> {
    let mut rng = fastrand::Rng::with_seed(seed);
    std::iter::repeat_with(move || {
        let mut along = |half: f32| (rng.f32() * 4.0 - 2.0) * half;
        Vec3::new(along(HALF.x), along(HALF.y), along(HALF.z))
    })
}

fn winding(surface: &SkinnedSurface, point: Vec3) -> f64 {
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    winding_number(&positions, surface.mesh(), point.as_dvec3())
}

#[test]
fn closed_skin_encloses_what_it_winds_around() {
    let surface = slab(HALF, 0.7, 1);
    let (mut hits, mut inside) = (Vec::new(), 0);
    for point in points(1).take(3_000) {
        let wanted = winding(&surface, point) > 0.5;
        let space = surface.in_model();
        assert_eq!(is_enclosed(space, point, &mut hits), wanted, "{point}");
        assert_eq!(is_within(space, point, &mut hits), wanted, "{point}");
        inside += u32::from(wanted);
    }
    assert!(inside > 200, "{inside}");
}

#[test]
fn a_hole_that_covers_little_of_the_view_does_not_matter() {
    let mut surface = slab(HALF, 0.7, 1);
    let middle = |surface: &SkinnedSurface, triangle: TriangleId| {
        let corners = surface.mesh().triangles()[triangle.index()];
        let corners = corners.map(|v| surface.mesh().positions()[v.index()]);
        (corners[0] + corners[1] + corners[2]) / 3.0
    };
    // A round hole in the top.
    for triangle in (0..surface.mesh().triangles().len() as u32).map(TriangleId) {
        let place = middle(&surface, triangle);
        if place.y > HALF.y * 0.99 && place.xz().length() < 0.8 {
            surface.disable_triangle(triangle).unwrap();
        }
    }
    let mut hits = Vec::new();
    for point in points(2).take(3_000) {
        let space = surface.in_model();
        let [enclosed, within] = [is_enclosed, is_within].map(|asks| asks(space, point, &mut hits));
        let inside = point.abs().cmplt(HALF).all();
        let near = (point - Vec3::Y * HALF.y).length();
        assert!(inside || !enclosed && !within, "{point}");
        assert!(!inside || near < 1.6 || enclosed, "{point}");
        assert!(!inside || near < 0.9 || within, "{point}");
        assert!(!enclosed || within, "{point}");
    }
}

/// A sheet over a disc of radius 1, lifted by a function of the distance from its middle; its back is below.
fn disc(lift: impl Fn(f32) -> f32) -> SkinnedSurface {
    /// Number of rings of vertices around the middle.
    const RINGS: u32 = 16;
    /// Number of vertices in a ring.
    const SIDES: u32 = 32;
    let mut positions = vec![Vec3::Y * lift(0.0)];
    let mut triangles = Vec::new();
    for ring in 1..=RINGS {
        let radius = ring as f32 / RINGS as f32;
        for side in 0..SIDES {
            let angle = std::f64::consts::TAU * f64::from(side) / f64::from(SIDES);
            let around = Vec2::new(libm::cos(angle) as f32, libm::sin(angle) as f32) * radius;
            positions.push(Vec3::new(around.x, lift(radius), around.y));
            let next = (side + 1) % SIDES;
            let outer = 1 + (ring - 1) * SIDES;
            if ring == 1 {
                triangles.push([0, outer + next, outer + side]);
            } else {
                let inner = outer - SIDES;
                triangles.push([inner + side, outer + next, outer + side]);
                triangles.push([inner + side, inner + next, outer + next]);
            }
        }
    }
    rigid(&positions, &triangles)
}

#[test]
fn open_skin_encloses_nothing_that_is_not_deep_in_it() {
    let mut hits = Vec::new();
    // Flat, domes, and a half ball, which may enclose points near its wall.
    for height in [0.0, 0.2, 0.4, 0.6, 1.0f32] {
        let dome = disc(|radius| height * (1.0 - radius * radius).max(0.0).sqrt());
        for point in points(3).take(4_000) {
            let point = point * 0.3;
            let above = point.xz().length() < 1.0
                && point.y > height * (1.0 - point.xz().length_squared()).max(0.0).sqrt();
            let space = dome.in_model();
            if above || point.y < 0.0 {
                assert!(!is_within(space, point, &mut hits), "{height}: {point}");
            }
            assert!(
                height == 1.0 || !is_enclosed(space, point, &mut hits),
                "{height}: {point}"
            );
        }
    }
}

/// Adds the sides and the top of a box to a surface, seen from outside, or all of it seen from inside.
fn add_box(surface: &mut SkinnedSurface, middle: Vec3, half: Vec3, outside: bool) {
    let one = Influence {
        joint: JointId(0),
        weight: 1.0,
    };
    surface.edit(|edit| {
        let corners: [VertexId; 8] = std::array::from_fn(|corner| {
            let side = |axis: usize| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
            let place = middle + half * Vec3::new(side(0), side(1), side(2));
            edit.add_vertex(place, &[one]).unwrap()
        });
        let quads = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
        ];
        for quad in quads.iter().take(if outside { 5 } else { 6 }) {
            let [a, b, c, d] = quad.map(|corner: usize| corners[corner]);
            for [p, q, r] in [[a, b, c], [a, c, d]] {
                let corners = if outside { [p, q, r] } else { [p, r, q] };
                edit.add_triangle(corners, SurfaceTag::default()).unwrap();
            }
        }
    });
}

#[test]
fn a_hollow_below_added_skin_is_enclosed_and_a_mouth_is_not() {
    let (middle, half) = (Vec3::new(0.3, HALF.y + 0.6, -0.2), Vec3::new(1.5, 0.6, 1.2));
    let mut scab = slab(HALF, 0.7, 1);
    add_box(&mut scab, middle, half, true);
    // A closed room inside a larger creature.
    let mut mouth = slab(HALF * 3.0, 2.1, 1);
    add_box(&mut mouth, middle, half, false);
    let (mut hits, mut inside) = (Vec::new(), 0);
    for point in points(4).take(6_000) {
        let away = (point - middle).abs() - half;
        let (in_box, near) = (away.max_element() < 0.0, away.abs().min_element() < 0.02);
        if near || in_box && away.max_element() > -0.05 {
            continue;
        }
        let [found, within] =
            [is_enclosed, is_within].map(|asks| asks(scab.in_model(), point, &mut hits));
        let wanted = in_box || point.abs().cmplt(HALF).all();
        // Points just above the skin beside the scab are in the open, too.
        assert_eq!((found, within), (wanted, wanted), "scab: {point}");
        let found = is_enclosed(mouth.in_model(), point, &mut hits);
        assert_eq!(found, !in_box, "mouth: {point}");
        inside += u32::from(in_box);
    }
    assert!(inside > 60, "{inside}");
}

#[test]
fn points_that_are_not_finite_are_not_enclosed() {
    let surface = slab(HALF, 0.7, 1);
    for point in [Vec3::NAN, Vec3::splat(f32::INFINITY)] {
        assert!(!is_enclosed(surface.in_model(), point, &mut Vec::new()));
        assert!(!is_within(surface.in_model(), point, &mut Vec::new()));
    }
}
