use clamber_surface::glam::Vec3;
use clamber_world::{Obstacle, ObstacleId, TriangleTerrain};

use super::*;
use crate::MoverMemory;

/// Sizes of the body, as multiples of a ball of 0.4 m.
const SIZES: [f64; 4] = [0.02, 0.1, 1.0, 100.0];

/// A closed box, scaled and turned about the vertical.
fn boxed(low: Vec3, high: Vec3, size: f64, turn: f64) -> TriangleTerrain {
    let (sin, cos) = (libm::sin(turn) as f32, libm::cos(turn) as f32);
    let corner = |k: usize| {
        let pick = |bit: usize, axis: usize| if k & bit == 0 { low[axis] } else { high[axis] };
        let p = Vec3::new(pick(1, 0), pick(2, 1), pick(4, 2)) * size as f32;
        Vec3::new(p.x * cos + p.z * sin, p.y, p.z * cos - p.x * sin)
    };
    let positions: Vec<Vec3> = (0..8).map(corner).collect();
    let faces = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = faces.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    TriangleTerrain::new(&positions, triangles.as_flattened(), &[], DVec3::ZERO).unwrap()
}

/// Turns a vector about the vertical, as the scene is turned.
fn turned(v: DVec3, turn: f64) -> DVec3 {
    let (sin, cos) = (libm::sin(turn), libm::cos(turn));
    DVec3::new(v.x * cos + v.z * sin, v.y, v.z * cos - v.x * sin)
}

/// Runs a ledge query among boxes, for a ball of 0.4 m that hangs at `x`, 0.6 m below an edge at y 0 and z 0.
fn asked<T>(
    boxes: &[(Vec3, Vec3)],
    (size, turn): (f64, f64),
    x: f64,
    ask: impl FnOnce(&mut Mover<'_>, &LedgeHold, DVec3) -> T,
) -> T {
    let terrain: Vec<TriangleTerrain> = boxes
        .iter()
        .map(|(low, high)| boxed(*low, *high, size, turn))
        .collect();
    let obstacles: Vec<(ObstacleId, &dyn Obstacle)> = (0..)
        .map(ObstacleId)
        .zip(terrain.iter().map(|one| one as &dyn Obstacle))
        .collect();
    let mut memory = MoverMemory::default();
    let mut mover = Mover::new(&obstacles, 1.0 / 60.0, &mut memory).unwrap();
    let hold = LedgeHold {
        body: MoverBody::ball(0.4 * size, 0.01 * size),
        up: DVec3::Y,
        facing: turned(DVec3::NEG_Z, turn),
        held: turned(DVec3::new(x, 0.0, -0.16), turn) * size,
        max_slope: 0.87,
    };
    let position = turned(DVec3::new(x, -0.6, 0.4), turn) * size;
    ask(&mut mover, &hold, position)
}

/// The ledge ahead of a body that hangs at x 0.3.
fn ahead(boxes: &[(Vec3, Vec3)], scene: (f64, f64)) -> Option<Ledge> {
    asked(boxes, scene, 0.3, |mover, hold, at| {
        mover.ledge_ahead(hold, at)
    })
}

/// A wall with its edge at y 0 and z 0, from one x to another.
fn wall(from: f32, to: f32) -> (Vec3, Vec3) {
    stands(from, to, 0.0, 0.0)
}

/// A wall whose edge is higher by `up` and ahead by `back`.
fn stands(from: f32, to: f32, up: f32, back: f32) -> (Vec3, Vec3) {
    (Vec3::new(from, -4.0, -4.0), Vec3::new(to, up, -back))
}

fn each(check: impl Fn((f64, f64), &str)) {
    for size in SIZES {
        for turn in [0.0, 0.7, 2.5] {
            check((size, turn), &format!("size {size}, turned by {turn}"));
        }
    }
}

/// Asserts where a ledge was found: hands at a point and the wall in a direction, both before turning and scaling.
fn assert_found(
    ledge: Option<Ledge>,
    (point, facing): (DVec3, DVec3),
    (size, turn): (f64, f64),
    told: &str,
) {
    let ledge = ledge.unwrap_or_else(|| panic!("{told}: no ledge"));
    let hands = ledge.touch.contact.point;
    let off = hands.distance(turned(point, turn) * size);
    assert!(off < 2e-3 * size, "{told}: {off} from {point}: {ledge:?}");
    let off = ledge.facing.distance(turned(facing, turn));
    assert!(off < 1e-3, "{told}: {off} from {facing}: {ledge:?}");
}

#[test]
fn a_ledge_goes_on_ahead_up_to_half_a_radius_higher_lower_nearer_and_farther() {
    each(|scene, told| {
        for (up, back) in [
            (0.0, 0.0),
            (0.2, 0.0),
            (-0.2, 0.0),
            (0.0, 0.2),
            (0.0, -0.2),
            (0.1, 0.1),
        ] {
            let told = format!("{told}, {up} higher, {back} ahead");
            let ledge = ahead(&[stands(-4.0, 4.0, up, back)], scene);
            let point = DVec3::new(0.3, f64::from(up), -0.16 - f64::from(back));
            assert_found(ledge, (point, DVec3::NEG_Z), scene, &told);
        }
        for (up, back) in [(0.24, 0.0), (-0.24, 0.0), (0.0, 0.24), (0.0, -0.24)] {
            let ledge = ahead(&[stands(-4.0, 4.0, up, back)], scene);
            assert_eq!(ledge, None, "{told}, {up} higher, {back} ahead");
        }
    });
}

#[test]
fn a_hand_has_room_below_a_low_ceiling_and_none_below_a_lower_one() {
    each(|scene, told| {
        for (gap, fits) in [(0.17, true), (0.1, false)] {
            let ceiling = (Vec3::new(-4.0, gap, -4.0), Vec3::new(4.0, 4.0, 0.0));
            let ledge = ahead(&[wall(-4.0, 4.0), ceiling], scene);
            assert_eq!(ledge.is_some(), fits, "{told}, a ceiling at {gap}");
        }
    });
}

#[test]
fn hands_reach_across_a_gap_and_not_through_a_pillar() {
    each(|scene, told| {
        let (size, turn) = scene;
        let way = turned(DVec3::X, turn) * (0.35 * size);
        let beside = |boxes: &[(Vec3, Vec3)], x: f64| {
            asked(boxes, scene, x, |mover, hold, at| {
                assert_eq!(mover.ledge_ahead(hold, at), None, "{told}");
                mover.ledge_beside(hold, at, way, |_| true)
            })
        };
        let ledge = beside(&[wall(-4.0, 1.0), wall(1.3, 4.0)], 1.01);
        let found = ledge.map(|ledge| turned(ledge.touch.contact.point, -turn).x / size);
        let is_beyond = found.is_some_and(|x| (1.3..1.345).contains(&x));
        assert!(is_beyond, "{told}: {found:?}");
        let ledge = beside(&[wall(-4.0, 1.0), wall(1.4, 4.0)], 1.01);
        assert_eq!(ledge, None, "{told}: too wide");
        let pillar = stands(1.1, 1.2, 0.5, -0.3);
        let ledge = beside(&[wall(-4.0, 1.0), wall(1.3, 4.0), pillar], 1.01);
        assert_eq!(ledge, None, "{told}: through a pillar");
    });
}

#[test]
fn a_body_goes_around_an_outer_corner_on_a_circle() {
    each(|scene, told| {
        let (size, turn) = scene;
        for degrees in [5.0f64, 30.0, 45.0, 60.0, 85.0] {
            let angle = degrees.to_radians();
            let out = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
            let told = format!("{told}, at {degrees} degrees");
            let ledge = asked(&[wall(-4.0, 1.0)], scene, 1.0, |mover, hold, _| {
                let corner = DVec3::new(1.0, -0.6, 0.0);
                let position = turned(corner + out * 0.4, turn) * size;
                // The body still faces the corner from a slightly earlier position.
                let before = DVec3::new(libm::sin(angle - 0.05), 0.0, libm::cos(angle - 0.05));
                let hold = LedgeHold {
                    facing: -turned(before, turn),
                    ..*hold
                };
                mover.ledge_around(&hold, position, 0.45 * size)
            });
            let point = DVec3::new(1.0, 0.0, 0.0) - out * 0.16;
            assert_found(ledge, (point, -out), scene, &told);
        }
    });
}

#[test]
fn a_body_finds_the_other_wall_of_an_inner_corner() {
    each(|scene, told| {
        let (size, turn) = scene;
        let other = (Vec3::new(1.0, -4.0, -4.0), Vec3::new(2.0, 0.1, 4.0));
        let ledge = asked(&[wall(-4.0, 1.0), other], scene, 0.6, |mover, hold, at| {
            mover.ledge_in_corner(hold, at, turned(DVec3::X, turn))
        });
        let found = (DVec3::new(1.16, 0.1, 0.4), DVec3::X);
        assert_found(ledge, found, scene, told);
        let alone = asked(&[wall(-4.0, 1.0)], (size, turn), 0.6, |mover, hold, at| {
            mover.ledge_in_corner(hold, at, turned(DVec3::X, turn))
        });
        assert_eq!(alone, None, "{told}");
        // A gap before the other wall.
        let gap = asked(&[wall(-4.0, 0.5), other], scene, 0.49, |mover, hold, at| {
            let nearer = at + turned(DVec3::X, turn) * (0.11 * size);
            mover.ledge_in_corner(hold, nearer, turned(DVec3::X, turn))
        });
        assert_eq!(gap, None, "{told}: a gap");
    });
}
