//! Bodies of known area: how much of it is reached.

use std::ops::ControlFlow;

use crate::support::{Body, ball, climber};
use clamber_navigation::{ClimbReport, GraphConfig};
use clamber_surface::mesh::SurfaceKind::{Fur, Skin, Stone};
use clamber_surface::mesh::TriangleId;
use clamber_surface::rig::{JointId, WeakPoint};
use glam::Vec3;

/// A box from `low` to `high`. `kinds` are the materials of its sides in the order -x, +x, -y, +y, -z, +z.
fn cube(low: Vec3, high: Vec3, kinds: [clamber_surface::mesh::SurfaceKind; 6]) -> Body {
    let size = high - low;
    let mut body = Body::default();
    for axis in 0..3 {
        for end in 0..2 {
            let (mut u, mut v) = (Vec3::ZERO, Vec3::ZERO);
            u[(axis + 1) % 3] = size[(axis + 1) % 3];
            v[(axis + 2) % 3] = size[(axis + 2) % 3];
            let (from, u, v) = if end == 1 {
                let mut from = low;
                from[axis] = high[axis];
                (from, u, v)
            } else {
                (low, v, u)
            };
            let side = Body::grid(
                [4, 4],
                |s, t| from + u * s + v * t,
                |_, _| kinds[2 * axis + end],
            );
            body = body.and(&side);
        }
    }
    body
}

fn close(found: f64, wanted: f64) {
    let off = found / wanted - 1.0;
    assert!(off.abs() < 0.02, "{found} for {wanted}: {off:.4}");
}

#[test]
fn all_of_a_cube_of_fur_that_hangs_low_is_reached() {
    let low = Vec3::new(-3.0, 1.2, -3.0);
    let (_, report) = cube(low, low + Vec3::splat(6.0), [Fur; 6]).report(&climber());
    close(report.area, 216.0);
    close(report.reachable_area, 216.0);
    // A climber can stand on its top.
    close(report.stand_area, 36.0);
}

#[test]
fn sides_of_stone_are_not_reached_and_what_is_above_neither() {
    // -x, +x, -y, +y, -z, +z: only one side is fur.
    let low = Vec3::new(-3.0, 0.0, -3.0);
    let kinds = [Fur, Stone, Stone, Stone, Stone, Stone];
    let (_, report) = cube(low, low + Vec3::splat(6.0), kinds).report(&climber());
    // The fur side and the top are reached. The other sides are reached only at their edges, within an arm's length of
    // the fur.
    let arms = report.reachable_area - 72.0;
    assert!((0.0..20.0).contains(&arms), "{report:?}");
    let high = low + Vec3::Y * 6.0;
    let (_, report) = cube(high, high + Vec3::splat(6.0), [Fur; 6]).report(&climber());
    assert_eq!((report.ways_on.len(), report.reachable_area), (0, 0.0));
}

#[test]
fn a_ball_is_reached_wholly_and_by_a_climber_that_cannot_climb_overhangs_up_to_its_limit() {
    let fur = ball(Vec3::Y * 6.2, 5.0, |_, _| Fur);
    let whole = 4.0 * std::f64::consts::PI * 25.0;
    let (_, report) = fur.report(&climber());
    close(report.reachable_area, whole);
    let mut careful = climber();
    careful.climber.grip.as_mut().unwrap().max_overhang = 120f64.to_radians();
    // The entries are at its bottom, which this climber cannot climb. The lower ball gives it entries on walls.
    let (_, report) = fur.report(&careful);
    assert_eq!(report.reachable_area, 0.0);
    let low = ball(Vec3::Y * 1.0, 5.0, |_, _| Fur);
    let (_, report) = low.report(&careful);
    // The part that is above the ground by a ball's middle, and not steeper than the limit.
    let from = 5.0 * (0.4 - 1.0) / 5.4;
    close(
        report.reachable_area,
        std::f64::consts::TAU * 5.0 * (5.0 - from),
    );
}

#[test]
fn a_torus_is_reached_where_its_hole_has_room() {
    let torus = |ring: f32, tube: f32| {
        let place = move |u: f32, v: f32| {
            let (a, b) = (u * std::f32::consts::TAU, v * std::f32::consts::TAU);
            let out = ring + tube * libm::cosf(b);
            Vec3::new(
                out * libm::cosf(a),
                2.5 + tube * libm::sinf(b),
                -out * libm::sinf(a),
            )
        };
        Body::grid([96, 32], place, |_, _| Fur)
    };
    let area =
        |ring: f64, tube: f64| 4.0 * std::f64::consts::PI * std::f64::consts::PI * ring * tube;
    let (_, report) = torus(4.0, 1.5).report(&climber());
    close(report.reachable_area, area(4.0, 1.5));
    // A hole of 0.1 m radius: from above, a ball of 0.4 m touches both sides of it, and never reaches the skin below.
    let (ring, tube) = (1.6, 1.5);
    let (_, report) = torus(ring as f32, tube as f32).report(&climber());
    let least = libm::acos(ring / (tube + 0.4));
    let hidden = 2.0 * std::f64::consts::TAU * tube * (ring * (least) - tube * libm::sin(least));
    close(report.reachable_area, area(ring, tube) - hidden);
}

#[test]
fn the_order_of_triangles_does_not_matter() {
    let body = ball(Vec3::Y * 5.4, 5.0, |u, v| {
        if ((8.0 * u) as u32).is_multiple_of(3) && v > 0.4 {
            Skin
        } else {
            Fur
        }
    });
    let (graph, report) = body.report(&climber());
    for seed in 0..3 {
        let (other, again) = body.shuffled(seed).report(&climber());
        assert_eq!(report, again);
        let seats = |graph: &clamber_navigation::ClimbGraph| -> Vec<_> {
            graph
                .patches()
                .iter()
                .map(|patch| (patch.point, patch.seat, patch.area))
                .collect()
        };
        let (ours, theirs) = (seats(&graph), seats(&other));
        assert_eq!(ours.len(), theirs.len());
        let differ = ours.iter().zip(&theirs).find(|(a, b)| a != b);
        assert_eq!(differ, None);
    }
}

/// B61: a pillar with fur below and above a belt of stone.
#[test]
fn a_belt_of_stone_is_missed_by_as_much_as_longer_arms_need() {
    for width in [1.5f64, 1.8, 2.4] {
        // A pillar of 3 m radius and 10 m height.
        let ring = |from: f32, to: f32, kind| {
            let rows = ((to - from) / 0.4).ceil() as u32;
            let place = move |u: f32, v: f32| {
                let around = u * std::f32::consts::TAU;
                let height = from + (to - from) * v;
                Vec3::new(3.0 * libm::cosf(around), height, -3.0 * libm::sinf(around))
            };
            Body::grid([48, rows], place, move |_, _| kind)
        };
        let half = 0.5 * width as f32;
        let mut body = ring(0.0, 5.0 - half, Fur)
            .and(&ring(5.0 - half, 5.0 + half, Stone))
            .and(&ring(5.0 + half, 10.0, Fur));
        let mut point = WeakPoint::new("top", JointId(0), Vec3::new(3.0, 9.0, 0.0));
        point.radius = 0.5;
        body.weak_points = vec![point];
        let (_, report) = body.report(&climber());
        let [found] = &*report.weak_points else {
            panic!("{report:?}")
        };
        let needed = (0.25 * width * width + 0.16).sqrt() - 0.4;
        match found.missing {
            Some(clamber_navigation::Missing::Reach(by)) => {
                let off = by - (needed - 0.35);
                assert!(off.abs() <= 0.01, "{width}: {by} for {}", needed - 0.35);
                let mut longer = climber();
                let reach = &mut longer.climber.grip.as_mut().unwrap().reach;
                *reach += by + 0.01;
                let (_, report) = body.report(&longer);
                assert!(report.weak_points[0].reachable, "{width}");
            }
            other => panic!("{width}: {other:?}"),
        }
    }
}

/// A climber that stands on stone has no grip. The missing reach is measured from there, too.
#[test]
fn fur_above_a_step_of_stone_is_missed_by_as_much_as_longer_arms_need() {
    let step = Body::grid(
        [12, 6],
        |u, v| Vec3::new(6.0 * (u - 0.5), 0.01, 2.0 - 2.0 * v),
        |_, _| Stone,
    );
    let wall = |from: f32, to: f32, kind| {
        let rows = ((to - from) / 0.3).ceil() as u32;
        let place = move |u: f32, v: f32| Vec3::new(6.0 * (u - 0.5), from + (to - from) * v, 0.0);
        Body::grid([20, rows], place, move |_, _| kind)
    };
    let mut body = step.and(&wall(0.01, 1.9, Stone)).and(&wall(1.9, 9.0, Fur));
    let mut point = WeakPoint::new("top", JointId(0), Vec3::new(0.0, 8.0, 0.0));
    point.radius = 0.5;
    body.weak_points = vec![point];
    // A climber that hardly jumps.
    let mut config = climber();
    config.climber.ground.jump_speed = 0.5;
    let (_, report) = body.report(&config);
    let Some(clamber_navigation::Missing::Reach(by)) = report.weak_points[0].missing else {
        panic!("{:?}", report.weak_points)
    };
    // The ball stands at the foot of the wall, and the fur begins 1.9 m above the ground.
    let radius = config.climber.body.radius;
    let needed = libm::hypot(1.9 - 0.01 - radius, radius) - radius - 0.35;
    assert!((by - needed).abs() < 0.03, "{by} for {needed}");
    config.climber.grip.as_mut().unwrap().reach += by + 0.01;
    let (_, report) = body.report(&config);
    assert!(report.weak_points[0].reachable, "{by}");
}

/// A weak point below a plate is reachable only if the skin below the plate is, even if the plate can be reached.
#[test]
fn who_is_on_a_plate_is_not_at_what_it_covers() {
    let wall = |depth: f32, kind| {
        let place = move |u: f32, v: f32| Vec3::new(6.0 * (u - 0.5), 6.0 * v, depth);
        Body::grid([20, 20], place, move |_, _| kind)
    };
    for (kind, reaches) in [(Fur, true), (Stone, false)] {
        // Skin that is covered by fur wholly.
        let skin = wall(0.0, kind);
        let plate = skin.triangles.len() as u32;
        let mut body = skin.and(&wall(0.15, Fur));
        let mut point = WeakPoint::new("covered", JointId(0), Vec3::new(0.0, 5.0, 0.0));
        point.radius = 0.5;
        body.weak_points = vec![point];
        let plate: Vec<TriangleId> = (plate..body.triangles.len() as u32)
            .map(TriangleId)
            .collect();
        let go_on = |_| ControlFlow::Continue(());
        let config = GraphConfig {
            plates: vec![plate],
            ..climber()
        };
        let (report, _) = ClimbReport::new(&body.rig(), &config, go_on).unwrap();
        let [found] = &*report.weak_points else {
            panic!("{report:?}")
        };
        assert_eq!(found.reachable, reaches, "{kind:?}: {found:?}");
    }
}
