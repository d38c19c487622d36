use clamber_world::ObstacleId;

use super::*;
use crate::{ClimberConfig, ClimberInput, ClimberMode, ClimberState};

/// Length of a tick, seconds.
const DT: f64 = 1.0 / 60.0;

fn capsule(rng: &mut fastrand::Rng) -> WorldCapsule {
    let mut point = || DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 4.0 - 2.0;
    let (a, b) = (point(), point());
    let is_ball = rng.u32(0..3) == 0;
    WorldCapsule {
        ends: if is_ball { [a, a] } else { [a, b] },
        radius: 0.05 + 0.5 * rng.f64(),
    }
}

fn solid(now: WorldCapsule, way: DVec3) -> ClimberObstacle {
    ClimberObstacle {
        now,
        way,
        placed: way == DVec3::ZERO,
        before: now.moved(-way),
        up: DVec3::Y,
        base: DVec3::ZERO,
        own: DVec3::ZERO,
        mass: 80.0,
        walk: DVec3::ZERO,
        carried_by: None,
        others: Others::Block,
    }
}

/// Distance of two axes by a numeric search: repeatedly halves the range around the best of sampled points.
fn distance_by_search(a: &WorldCapsule, b: &WorldCapsule) -> f64 {
    let at = |c: &WorldCapsule, s: f64| c.ends[0].lerp(c.ends[1], s);
    let (mut s, mut width) = (0.5, 0.5);
    for _ in 0..60 {
        let shares = (-10..=10).map(|k| (s + width * f64::from(k) / 10.0).clamp(0.0, 1.0));
        let far = |s: f64| b.nearest_on_axis(at(a, s)).distance(at(a, s));
        s = shares.min_by(|x, y| far(*x).total_cmp(&far(*y))).unwrap();
        width *= 0.5;
    }
    b.nearest_on_axis(at(a, s)).distance(at(a, s))
}

#[test]
fn axis_distances_match_a_numeric_search() {
    let mut rng = fastrand::Rng::with_seed(1);
    for _ in 0..2_000 {
        let (a, mut b) = (capsule(&mut rng), capsule(&mut rng));
        if rng.u32(0..4) == 0 {
            // Parallel.
            b.ends[1] = b.ends[0] + (a.ends[1] - a.ends[0]) * rng.f64();
        }
        let apart = between(&a, &b);
        let found = distance_by_search(&a, &b);
        assert!(
            (apart.distance - found).abs() < 1e-6,
            "{a:?} {b:?}: {found}"
        );
        assert!((apart.away.length() - 1.0).abs() < 1e-9, "{a:?} {b:?}");
    }
}

#[test]
fn sweeps_agree_with_small_steps() {
    let mut rng = fastrand::Rng::with_seed(2);
    let (mut met, mut early) = (0, 0);
    for case in 0..3_000 {
        let (now, mut other) = (capsule(&mut rng), capsule(&mut rng));
        let near = libm::exp(-12.0 * rng.f64());
        let mut random = || DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 8.0 - 4.0;
        let (way, mut displacements) = (random(), [random(); 2]);
        if case % 2 == 1 {
            displacements[1] = random();
        }
        if case % 3 == 0 {
            // Nearly touching when the tick begins.
            let apart = between(&now.moved(-way), &other);
            let gap = apart.distance - now.radius - other.radius;
            other = other.moved(-apart.away * (gap - 0.01 * near));
        }
        let displacement = |time: f64| displacements.map(|end| end * time);
        let body = solid(now, way);
        let gap = |time: f64| {
            let here = now.moved(way * (time - 1.0));
            let there = other.with_ends_moved(displacement(time));
            between(&here, &there).distance - now.radius - other.radius
        };
        let touch = (0..=20_000)
            .map(|k| f64::from(k) / 20_000.0)
            .find(|time| gap(*time) <= 0.0);
        let hit = body.cast_capsule(&other, displacements, TargetMotion::Moving);
        let told = || format!("{body:?} {other:?} by {displacements:?}: {hit:?}, {touch:?}");
        if let Some(touch) = touch {
            let hit = hit.unwrap();
            assert!(hit.fraction <= touch, "{}", told());
            let is_near = gap(hit.fraction) <= other.sweep_tolerance() + 1e-9;
            assert!(is_near || case % 2 == 1, "{}", told());
            early += u32::from(!is_near);
            let away = other
                .with_ends_moved(displacement(hit.fraction))
                .nearest_on_axis(hit.contact.point);
            let distance = away.distance(hit.contact.point);
            let is_on = (distance - other.radius).abs() < 2e-4;
            assert!(is_on || hit.started_inside, "{}", told());
            met += 1;
        } else if let Some(hit) = hit {
            let is_near = gap(hit.fraction) <= other.sweep_tolerance() + 1e-9;
            assert!(is_near || case % 2 == 1, "{}", told());
            early += u32::from(!is_near);
        }
    }
    // A capsule that turns beside the other, nearly touching, may be reported as touching when the steps run out.
    assert!(met > 800 && early < met / 100, "{met} {early}");
}

/// Weightless climbers that fly at each other, stepped in a given order.
fn crowd(order: &[usize], ticks: u32) -> Vec<ClimberState> {
    let mut config = ClimberConfig::walker();
    config.gravity = DVec3::ZERO;
    config.body.height = 0.9;
    let mut climbers: Vec<Climber> = (0..4)
        .map(|index| {
            let side = [DVec3::X, -DVec3::X, DVec3::Z, -DVec3::Z][index];
            let mut climber = Climber::new(config, side * 4.0).unwrap();
            let state = ClimberState {
                velocity: -side * (3.0 + index as f64),
                ..*climber.state()
            };
            climber.restore(state).unwrap();
            climber
        })
        .collect();
    for _ in 0..ticks {
        let bodies: Vec<_> = climbers
            .iter()
            .map(|c| ClimberObstacle::new(c, &[], DT))
            .collect();
        for &index in order {
            let others = (0..4).filter(|other| *other != index);
            let obstacles: Vec<(ObstacleId, &dyn Obstacle)> = others
                .map(|other| (ObstacleId(other as u64), &bodies[other] as &dyn Obstacle))
                .collect();
            let report = climbers[index].step(&ClimberInput::default(), &obstacles, DT);
            assert!(report.unwrap().events.is_empty());
        }
    }
    climbers.iter().map(|climber| *climber.state()).collect()
}

#[test]
fn climbers_of_a_crowd_stop_each_other_in_any_step_order() {
    let states = crowd(&[0, 1, 2, 3], 200);
    for (index, state) in states.iter().enumerate() {
        assert_eq!(state.mode, ClimberMode::Falling);
        for other in &states[..index] {
            let apart = state.position.distance(other.position);
            assert!(apart > 0.8 - 0.02, "{apart}");
        }
        assert!(state.position.length() < 3.0, "{state:?}");
    }
    let other = crowd(&[2, 0, 3, 1], 200);
    let prints = |states: &[ClimberState]| states.iter().map(ClimberState::fingerprint).collect();
    let (a, b): (Vec<u64>, Vec<u64>) = (prints(&states), prints(&other));
    assert_eq!(a, b);
}

#[test]
fn invalid_queries_find_nothing() {
    let body = solid(WorldCapsule::ball(DVec3::ZERO, 0.5), DVec3::ZERO);
    let cast = |ball: &WorldCapsule, way, target| body.cast_capsule(ball, [way; 2], target);
    let (still, moving) = (TargetMotion::Still, TargetMotion::Moving);
    let mut contacts = Vec::new();
    for bad in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        let ray = body.cast_ray(DVec3::X * 2.0, -DVec3::X, bad);
        assert_eq!((bad.to_bits(), ray), (bad.to_bits(), None));
        // Looks behind the ray's origin, where a negative length would lead.
        assert_eq!(body.cast_ray(DVec3::X * 2.0, DVec3::X, bad), None);
        assert_eq!(body.closest_point(DVec3::ZERO, bad), None);
        let ball = WorldCapsule::ball(DVec3::ZERO, bad);
        body.overlap_capsule(&ball, &mut contacts);
        assert_eq!(cast(&ball, DVec3::X, still), None);
        assert_eq!(cast(&ball, DVec3::X, moving), None);
    }
    for bad in [DVec3::NAN, DVec3::INFINITY] {
        let ball = WorldCapsule::ball(bad, 0.1);
        body.overlap_capsule(&ball, &mut contacts);
        assert_eq!(body.cast_ray(bad, DVec3::X, 9.0), None);
        assert_eq!(body.cast_ray(DVec3::X, bad, 9.0), None);
        assert_eq!(body.closest_point(bad, 9.0), None);
        assert_eq!(cast(&ball, DVec3::X, still), None);
        let ball = WorldCapsule::ball(DVec3::X, 0.1);
        assert_eq!(cast(&ball, bad, moving), None);
    }
    assert!(contacts.is_empty(), "{contacts:?}");
    let ray = body
        .cast_ray(DVec3::X * 2.0, -DVec3::X, f64::INFINITY)
        .unwrap();
    assert!((ray.distance - 1.5).abs() <= 1e-6, "{ray:?}");
}

#[test]
fn grazing_contacts_are_never_reported_late() {
    let now = WorldCapsule {
        ends: [DVec3::ZERO, DVec3::Y],
        radius: 0.4,
    };
    let body = solid(now, DVec3::ZERO);
    // The ball passes a round end, with ever smaller depth.
    for exponent in 0..40 {
        let deep = libm::exp2(-f64::from(exponent)) * 0.1;
        let ball = WorldCapsule::ball(DVec3::new(-30.0, 1.0 + 0.8 - deep, 0.0), 0.4);
        let hit = body
            .cast_capsule(&ball, [DVec3::X * 60.0; 2], TargetMotion::Still)
            .unwrap();
        let height = 0.8 - deep;
        let touch = (30.0 - (0.64 - height * height).sqrt()) / 60.0;
        assert!(hit.fraction <= touch + 1e-12, "{deep}: {hit:?}, {touch}");
    }
}
