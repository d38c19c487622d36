//! Corrections of position (step-ups, snaps down, mantles and push-outs) do not become velocity.

use clamber_climber::{
    ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberObstacle, Knockback,
};
use clamber_world::Obstacle;
use glam::{DVec3, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::v;
use crate::input::{IDLE, blow, grip_walk, walk};
use crate::scene::{STONE, climber, cuboid, cuboid_at, list, moved, walker};
use crate::stage::{Played, Run, Shape, Stage, shifted};

/// Tick rates, hertz.
const RATES: [f64; 4] = [30.0, 60.0, 120.0, 240.0];

fn configs() -> [(&'static str, ClimberConfig); 2] {
    [
        ("walker", ClimberConfig::walker()),
        ("colossus climber", ClimberConfig::colossus_climber()),
    ]
}

/// A climber before a step of 0.28 m. The step and the floor below it move at `frame`.
fn one_step(hz: f64, config: ClimberConfig, frame: DVec3) -> Run {
    let shape = Shape::stairs(1, 0.28, 1.0, 4.0);
    let stage = Stage::at_rate(Played::Root, hz).with(&shape, move |t| shifted(frame * t));
    Run::new(stage, config, v(0.1, 0.0, -1.0)).settle()
}

/// A run up to the tick in which the climber has just stepped up.
fn stepped_up(hz: f64, config: ClimberConfig) -> Run {
    let mut run = one_step(hz, config, DVec3::ZERO);
    let mut was = run.position();
    for _ in 0..2000 {
        run.step(&walk(DVec3::Z));
        if run.position().y - was.y > 0.05 {
            return run;
        }
        was = run.position();
    }
    panic!("at {hz} Hz it never stepped up");
}

/// Walks along Z for a tick. Asserts that the reported velocity is the support's velocity plus the walk along the last
/// ground or the current one.
fn assert_walks(run: &mut Run, told: &str) {
    let speed = run.config().ground.walk_speed;
    let before = *run.state();
    run.step(&walk(DVec3::Z));
    let state = run.state();
    let own = state.velocity - state.base_velocity;
    let is_off = [before, *state].iter().any(|state| state.support.is_none());
    if is_off {
        // At an edge the climber may leave the ground for a moment, at its walking speed.
        let most = 1.01 * speed + 9.81 * run.stage.dt;
        assert!(own.length() <= most, "{told}: {own} of its own, {state:?}");
        return;
    }
    let grounds = [before, *state].map(|state| {
        let support = state
            .support
            .unwrap_or_else(|| panic!("{told}: {:?}", state.mode));
        support.normal_in_world()
    });
    let off = grounds.map(|normal| {
        let along = (DVec3::Z - DVec3::Y * (normal.z / normal.y)).normalize() * speed;
        // The climber's own velocity if it landed on the current ground.
        let stopped = along - grounds[1] * along.dot(grounds[1]).min(0.0);
        // The climber's own velocity if it stepped up, which leads onto level ground.
        let level = DVec3::Z * speed;
        [along, stopped, level].map(|velocity| own.distance(velocity))
    });
    let off = off.into_iter().flatten().fold(f64::INFINITY, f64::min);
    assert!(
        off <= 0.01 * speed,
        "{told}: {own} of its own, off by {off}, {state:?}"
    );
}

#[test]
fn steps_up_do_not_become_velocity() {
    let frames = [DVec3::ZERO, v(2.0, 1.0, 0.0), v(0.0, -3.0, 5.0)];
    for (hz, (name, config), frame) in triples(RATES, configs(), frames) {
        // The frame starts to move in one tick, which must not throw or knock down the climber.
        let mut config = config;
        config.tumble = None;
        config.ground.throw_acceleration = f64::INFINITY;
        let mut run = one_step(hz, config, frame);
        let mut highest = 0.0f64;
        for k in 0..(1.0 * hz) as u32 {
            let was = run.position();
            let told = format!("{name} at {hz} Hz in a frame of {frame}, tick {k}");
            assert_walks(&mut run, &told);
            highest = highest.max((run.position() - was - frame / hz).y);
            let base = run.state().base_velocity;
            assert!((base - frame).length() < 0.03, "{told}: support {base}");
        }
        assert!(highest > 0.05, "{name} at {hz} Hz: never stepped up");
    }
}

#[test]
fn steps_down_do_not_become_velocity() {
    for hz in RATES {
        let stage = Stage::at_rate(Played::Root, hz)
            .with_still(&Shape::boxed(v(-4.0, -1.0, -4.0), v(4.0, 0.18, 0.0)))
            .with_still(&Shape::boxed(v(-4.0, -1.0, 0.0), v(4.0, 0.0, 8.0)));
        let config = ClimberConfig::colossus_climber();
        let mut run = Run::new(stage, config, v(0.1, 0.18, -1.0)).settle();
        for k in 0..(1.5 * hz) as u32 {
            assert_walks(&mut run, &format!("{hz} Hz, tick {k}"));
        }
        assert!(run.feet().y < 0.01, "{hz} Hz: {}", run.feet());
    }
}

#[test]
fn stairs_do_not_become_velocity() {
    for hz in RATES {
        let stage = Stage::at_rate(Played::Root, hz).with_still(&Shape::stairs(12, 0.2, 0.3, 4.0));
        let config = ClimberConfig::colossus_climber();
        let mut run = Run::new(stage, config, v(0.1, 0.0, -1.0)).settle();
        for k in 0..3000 {
            let told = format!("{hz} Hz, tick {k} at {}", run.position());
            assert_walks(&mut run, &told);
            if run.position().z > 3.6 {
                break;
            }
        }
        assert!(run.position().z > 3.6, "{hz} Hz: {}", run.position());
    }
}

/// The greatest height within a second, with an input and a blow in the first tick: above the ground, or above the
/// start without ground.
fn rises(
    run: &mut Run,
    first: &ClimberInput,
    knockback: Option<Knockback>,
    keeps_ground: bool,
) -> f64 {
    run.knockback = knockback;
    let from = run.position().y;
    let mut highest = 0.0f64;
    let ticks = (1.0 / run.stage.dt) as u32;
    for k in 0..ticks {
        let input = if k == 0 { first } else { &IDLE };
        if keeps_ground {
            run.step(input);
            let place = run.position();
            let near = run.stage.obstacles(|obstacles| {
                let all = obstacles.iter();
                let all = all.filter_map(|(_, obstacle)| obstacle.closest_point(place, 9.0));
                all.map(|contact| contact.distance)
                    .fold(f64::INFINITY, f64::min)
            });
            highest = highest.max(near - run.config().body.radius);
        } else {
            let dt = run.stage.dt;
            run.climber.step(input, &[], dt).unwrap();
            highest = highest.max(run.climber.state().position.y - from);
        }
    }
    highest
}

#[test]
fn a_climber_is_not_thrown_up_right_after_a_step_up() {
    let (mut worst, mut all) = (0.0f64, String::new());
    for (hz, (name, config)) in pairs(RATES, configs()) {
        for (what, first, knockback, keeps_ground) in [
            ("nothing", IDLE, None, true),
            ("lost ground", IDLE, None, false),
            ("lost ground while it walks", walk(DVec3::Z), None, false),
            ("a blow", IDLE, blow(v(2.9, 0.0, 0.0)), true),
            ("a harder blow", IDLE, blow(v(3.1, 0.0, 0.0)), true),
        ] {
            let mut run = stepped_up(hz, config);
            let risen = rises(&mut run, &first, knockback, keeps_ground);
            all += &format!("\n{name} at {hz} Hz, {what}: thrown up by {risen} m");
            worst = worst.max(risen);
        }
    }
    assert!(worst <= 0.05, "{worst}: {all}");
}

#[test]
fn a_level_blow_right_after_a_step_of_stairs_does_not_throw_the_climber_up() {
    let (mut worst, mut all) = (0.0f64, String::new());
    for hz in RATES {
        let stairs = || {
            let shape = Shape::stairs(6, 0.2, 0.3, 4.0);
            let stage = Stage::at_rate(Played::Root, hz).with_still(&shape);
            Run::new(stage, ClimberConfig::colossus_climber(), v(0.1, 0.0, -0.4)).settle()
        };
        let mut run = stairs();
        let mut state = *run.state();
        let (mut has_stepped, mut steps) = (false, 0);
        for k in 0..3000 {
            if has_stepped {
                steps += 1;
                let mut other = stairs();
                other.put(state);
                let risen = rises(&mut other, &IDLE, blow(v(3.1, 0.0, 0.0)), true);
                if risen > 0.05 {
                    all += &format!("\n{hz} Hz, tick {k} at {}: {risen} m", state.position);
                }
                worst = worst.max(risen);
            }
            run.step(&walk(DVec3::Z));
            // A step-up rises faster than rolling over an edge.
            let rolls = state.velocity.y.max(run.state().velocity.y) / hz;
            has_stepped = run.position().y - state.position.y > rolls + 0.02;
            state = *run.state();
            if state.position.z > 1.8 {
                break;
            }
        }
        assert!(state.position.z > 1.8, "{hz} Hz: {}", state.position);
        assert!(steps > 0, "{hz} Hz: no step-up");
    }
    assert!(worst <= 0.05, "{worst}: {all}");
}

#[test]
fn a_mantle_and_a_push_out_do_not_become_velocity() {
    for hz in RATES {
        let dt = 1.0 / hz;
        let mut block = cuboid(Vec3::new(4.0, 3.0, 3.0), STONE);
        let frame = v(1.0, 0.5, 0.0);
        let mut climber = climber(v(0.3, 2.75, 3.5));
        let mut mantled = None;
        for k in 0..(3.0 * hz) as u32 {
            moved(&mut block, frame * (f64::from(k) * dt));
            let toward = if k < (0.5 * hz) as u32 { -0.1 } else { -1.0 };
            let input = grip_walk(DVec3::Z * toward);
            let report = climber.step(&input, &list(&[&block]), dt).unwrap();
            if report.events.contains(&ClimberEvent::Mantled) {
                mantled = Some(*climber.state());
                break;
            }
        }
        let state = mantled.unwrap_or_else(|| panic!("{hz} Hz: {:?}", climber.state()));
        let off = (state.velocity - frame).length();
        assert!(off <= 0.03, "{hz} Hz: {off} m/s after a mantle, {state:?}");

        // A wall is placed in a standing climber, which is pushed out of it.
        for deep in [0.05, 0.2, 0.35] {
            let floor = cuboid_at(Vec3::new(6.0, 1.0, 6.0), STONE, v(0.0, -1.0, 0.0));
            let wall = cuboid_at(Vec3::new(0.5, 2.0, 3.0), STONE, v(-0.9 + deep, 2.05, 0.0));
            let mut climber = walker(v(0.0, 0.4, 0.0));
            for _ in 0..4 {
                climber.step(&IDLE, &list(&[&floor]), dt).unwrap();
            }
            for k in 0..4 {
                climber.step(&IDLE, &list(&[&floor, &wall]), dt).unwrap();
                let state = climber.state();
                let told = format!("{hz} Hz, wall {deep} m in it, tick {k}: {state:?}");
                assert!(state.velocity.length() <= 0.03, "{told}");
                assert!(state.position.x > deep - 0.02, "{told}");
                assert_eq!(state.mode, ClimberMode::Standing, "{told}");
            }
        }
    }
}

/// Steps up and snaps to the ground are included, so that a climber on top of another is carried by all of its
/// movements.
#[test]
fn a_climber_obstacle_goes_where_the_climber_has_gone() {
    for (hz, (name, config)) in pairs(RATES, configs()) {
        let mut run = one_step(hz, config, DVec3::ZERO);
        run.step(&walk(DVec3::Z));
        let mut last: Option<DVec3> = None;
        for k in 0..(1.5 * hz) as u32 {
            run.stage.advance();
            let (climber, dt) = (&run.climber, 1.0 / hz);
            let obstacle = run
                .stage
                .in_world(|obstacles| ClimberObstacle::new(climber, obstacles, dt));
            let above = climber.state().position + DVec3::Y * 5.0;
            let head = obstacle.closest_point(above, 9.0).unwrap();
            let motion = obstacle.motion(&head.material, dt).unwrap();
            let told = format!("{name} at {hz} Hz, tick {k}: {motion:?}");
            // The climber's ground is at rest.
            let height = motion.position - climber.state().position;
            assert!((height - DVec3::Y * 0.4).length() < 1e-9, "{told}");
            if let Some(last) = last {
                let off = motion.previous_position.distance(last);
                assert!(off < 1e-9, "{told}: it was at {last}");
            }
            last = Some(motion.position);
            run.step(&walk(DVec3::Z));
        }
    }
}
