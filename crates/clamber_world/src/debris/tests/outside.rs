//! When a body is outside a creature again, checked against the winding number.

use clamber_surface::geometry::Similarity;
use clamber_surface::measure::winding_number;
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use super::scene::at;
use crate::debris::hull::Hull;
use crate::debris::inner_capsule::InnerCapsule;
use crate::debris::let_through::is_outside;
use crate::testing::{rest, rigid};

/// One creature on one joint, made of closed boxes, each given by its low and high corner. The boxes may overlap.
fn boxes(corners: &[[Vec3; 2]]) -> SkinnedSurface {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for [low, high] in corners {
        let first = positions.len() as u32;
        for corner in 0..8 {
            let side = |axis: usize| [low, high][corner >> axis & 1][axis];
            positions.push(Vec3::new(side(0), side(1), side(2)));
        }
        let faces = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        for [a, b, c, d] in faces.map(|face| face.map(|corner| first + corner)) {
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    rigid(&positions, &triangles)
}

fn ball(radius: f32) -> (InnerCapsule, Hull) {
    let mut world = PhysicsWorld::default();
    let (body, _) = world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::ball(radius));
    let (body, colliders) = (&world.bodies[body], &world.colliders);
    let core = InnerCapsule::of(body, colliders).unwrap();
    (core, Hull::of(body, colliders).unwrap())
}

#[test]
fn a_body_is_outside_if_its_winding_number_is_0_and_it_touches_nothing() {
    // Where the boxes overlap, skin of one box is inside another.
    let mut surface = boxes(&[
        [Vec3::new(-2.0, -1.0, -1.0), Vec3::new(2.0, 1.0, 1.0)],
        [Vec3::new(-0.5, 0.2, -0.6), Vec3::new(0.5, 3.0, 0.6)],
        [Vec3::new(1.0, -0.4, -3.0), Vec3::new(1.6, 0.5, 3.0)],
    ]);
    let origin = DVec3::new(3e4, 0.0, -1e4);
    let turned = at(origin + DVec3::Y, DVec3::Z, 0.4);
    surface.teleport(&rest(), turned).unwrap();
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    let mut rng = fastrand::Rng::with_seed(4);
    let (mut counts, ball) = ([0; 3], ball(0.05));
    for _ in 0..20_000 {
        let mut coordinate = |size: f32| (rng.f32() * 2.0 - 1.0) * size;
        let in_model = Vec3::new(coordinate(2.5), coordinate(3.5), coordinate(3.5));
        let place = turned.transform_point_f32(in_model) - origin;
        let (core, hull) = &ball;
        let pose = Pose::from_translation(place.as_vec3());
        let exact = pose.translation.as_dvec3() + origin;
        let middle = surface
            .world_from_model()
            .inverse_transform_point_f32(exact);
        let touches = surface.in_model().closest_point(middle, 0.05).is_some();
        let winding = winding_number(&positions, surface.mesh(), middle.as_dvec3());
        let found =
            is_outside(&surface, (core, hull), [&pose; 2], origin, &mut Vec::new()).unwrap();
        assert_eq!(
            found,
            !touches && winding < 0.5,
            "{in_model}: winds {winding}, touches {touches}"
        );
        counts[if touches { 2 } else { usize::from(found) }] += 1;
    }
    assert!(counts.iter().all(|count| *count > 500), "{counts:?}");
}

#[test]
fn a_body_under_an_open_roof_is_outside() {
    // One-sided, as ears and wings often are.
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]];
    let positions = corners.map(|[x, z]| Vec3::new(x, 2.0, z));
    for [a, b, c, d] in [[0, 3, 2, 1], [0, 1, 2, 3]] {
        let mut roof = rigid(&positions, &[[a, b, c], [a, c, d]]);
        roof.teleport(&rest(), Similarity::IDENTITY).unwrap();
        for height in [0.0, 1.0, 3.0] {
            let pose = Pose::from_translation(Vec3::new(0.3, height, 0.2));
            let (core, hull) = &ball(0.3);
            let origin = DVec3::ZERO;
            let found =
                is_outside(&roof, (core, hull), [&pose; 2], origin, &mut Vec::new()).unwrap();
            assert!(found, "{height} m");
        }
    }
}

#[test]
fn a_body_behind_a_large_open_sheet_is_outside_whatever_way_the_sheet_faces() {
    let corners = [[-90.0, -90.0], [90.0, -90.0], [90.0, 90.0], [-90.0, 90.0]];
    let (core, hull) = &ball(0.3);
    let (mut rng, mut by_three_rays) = (fastrand::Rng::with_seed(5), 0);
    for round in 0..300 {
        let mut coordinate = || rng.f64() * 2.0 - 1.0;
        let axis = DVec3::new(coordinate(), coordinate(), coordinate()).normalize();
        let turned = at(DVec3::ZERO, axis, 3.0 * coordinate());
        let place = |p: DVec3| turned.transform_point(p).as_vec3();
        let positions = corners.map(|[x, z]| place(DVec3::new(x, 0.0, z)));
        let sheet = rigid(&positions, &[[0, 2, 1], [0, 3, 2]]);
        for distance in [-5.0, -1.0, -0.4, 0.4, 1.0, 5.0] {
            let place = place(DVec3::new(0.3, distance, -0.2));
            let pose = Pose::from_translation(place);
            let (poses, origin) = ([&pose; 2], DVec3::ZERO);
            let found = is_outside(&sheet, (core, hull), poses, origin, &mut Vec::new());
            assert_eq!(found, Some(true), "{round}: {distance} m from {turned:?}");
            by_three_rays += u32::from(sheet.in_model().is_inside(place));
        }
    }
    // In many of these cases, a test with three rays would fail.
    assert!(by_three_rays > 100, "{by_three_rays}");
}
