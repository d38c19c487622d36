//! Corrections of position: step-ups, snaps down, mantles and push-outs are no motion.

use clamber_climber::{
    Blow, Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberObstacle,
};
use clamber_world::Obstacle;
use glam::{DQuat, DVec3, Vec3};

use crate::common::{at, list, v};
use crate::scene::{HOLD, STONE, cuboid, moved};
use crate::stage::{IDLE, Played, Run, Shape, Stage, shifted, walk};

const RATES: [f64; 4] = [30.0, 60.0, 120.0, 240.0];

fn configs() -> [(&'static str, ClimberConfig); 2] {
    [
        ("walker", ClimberConfig::walker()),
        ("colossus climber", ClimberConfig::colossus_climber()),
    ]
}

/// One step of 0.28 m, and below it a floor, that both move.
fn one_step(hz: f64, config: ClimberConfig, frame: DVec3) -> Run {
    let shape = Shape::stairs(1, 0.28, 1.0, 4.0);
    let stage =
        Stage::at(Played::Root, 1.0 / hz, DVec3::ZERO).with(&shape, move |t| shifted(frame * t));
    Run::new(stage, config, v(0.1, 0.0, -1.0)).settle()
}

/// Until it has just stepped up.
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

/// What a standing climber reports is its support's velocity and, along the ground, its walk.
fn assert_walks(run: &Run, told: &str) {
    let state = run.state();
    let Some(support) = state.support else {
        panic!("{told}: {:?}", state.mode);
    };
    let speed = run.config().ground.walk_speed;
    let own = state.velocity - state.base_velocity;
    let off = own.dot(support.normal_in_world());
    assert!(off.abs() <= 0.01 * speed, "{told}: {off} m/s off the ground, {state:?}");
    assert!(own.length() <= 1.01 * speed, "{told}: {own} of its own, {state:?}");
    assert!(own.x.abs() <= 0.01 * speed, "{told}: {own} aside, {state:?}");
}

#[test]
fn steps_up_do_not_become_velocity() {
    for hz in RATES {
        for (name, config) in configs() {
            for frame in [DVec3::ZERO, v(2.0, 1.0, 0.0), v(0.0, -3.0, 5.0)] {
                let mut run = one_step(hz, config, frame);
                let mut highest = 0.0f64;
                for k in 0..(1.0 * hz) as u32 {
                    let was = run.position();
                    run.step(&walk(DVec3::Z));
                    let told = format!("{name} at {hz} Hz in a frame of {frame}, tick {k}");
                    assert_walks(&run, &told);
                    highest = highest.max((run.position() - was - frame / hz).y);
                    let base = run.state().base_velocity;
                    assert!((base - frame).length() < 0.03, "{told}: support {base}");
                }
                assert!(highest > 0.05, "{name} at {hz} Hz: never stepped up");
            }
        }
    }
}

#[test]
fn steps_down_do_not_become_velocity() {
    for hz in RATES {
        let stage = Stage::at(Played::Root, 1.0 / hz, DVec3::ZERO)
            .with_still(&Shape::boxed(v(-4.0, -1.0, -4.0), v(4.0, 0.18, 0.0)))
            .with_still(&Shape::boxed(v(-4.0, -1.0, 0.0), v(4.0, 0.0, 8.0)));
        let config = ClimberConfig::colossus_climber();
        let mut run = Run::new(stage, config, v(0.1, 0.18, -1.0)).settle();
        for k in 0..(1.5 * hz) as u32 {
            run.step(&walk(DVec3::Z));
            assert_walks(&run, &format!("{hz} Hz, tick {k}"));
        }
        assert!(run.feet().y < 0.01, "{hz} Hz: {}", run.feet());
    }
}

#[test]
fn stairs_do_not_become_velocity() {
    for hz in RATES {
        let stage = Stage::at(Played::Root, 1.0 / hz, DVec3::ZERO)
            .with_still(&Shape::stairs(12, 0.2, 0.3, 4.0));
        let config = ClimberConfig::colossus_climber();
        let mut run = Run::new(stage, config, v(0.1, 0.0, -1.0)).settle();
        for k in 0..3000 {
            run.step(&walk(DVec3::Z));
            assert_walks(&run, &format!("{hz} Hz, tick {k} at {}", run.position()));
            if run.position().z > 3.6 {
                break;
            }
        }
        assert!(run.position().z > 3.6, "{hz} Hz: {}", run.position());
    }
}

/// How high it flies from where it is, with an input in the first tick.
fn rises(run: &mut Run, first: &ClimberInput, keeps_ground: bool) -> f64 {
    let from = run.position().y;
    let mut top = from;
    let ticks = (1.0 / run.stage.dt) as u32;
    for k in 0..ticks {
        let input = if k == 0 { first } else { &IDLE };
        if keeps_ground {
            run.step(input);
            top = top.max(run.position().y);
        } else {
            let dt = run.stage.dt;
            run.climber.step(input, &[], dt).unwrap();
            top = top.max(run.climber.state().position.y);
        }
    }
    top - from
}

fn level_blow(tumbles: bool) -> ClimberInput {
    let speed = if tumbles { 3.1 } else { 2.9 };
    ClimberInput {
        blow: Some(Blow {
            velocity: v(speed, 0.0, 0.0),
            damage: 0.0,
            by: None,
        }),
        ..IDLE
    }
}

#[test]
fn nothing_is_thrown_up_right_after_a_step_up() {
    for hz in RATES {
        for (name, config) in configs() {
            for (what, first, keeps_ground) in [
                ("nothing", IDLE, true),
                ("lost ground", IDLE, false),
                ("lost ground while it walks", walk(DVec3::Z), false),
                ("a blow", level_blow(false), true),
                ("a harder blow", level_blow(true), true),
            ] {
                let mut run = stepped_up(hz, config);
                let risen = rises(&mut run, &first, keeps_ground);
                assert!(risen <= 0.05, "{name} at {hz} Hz, {what}: thrown up by {risen} m");
            }
        }
    }
}

#[test]
fn a_level_blow_anywhere_on_stairs_throws_nothing_up() {
    for hz in RATES {
        let stairs = || {
            let shape = Shape::stairs(6, 0.2, 0.3, 4.0);
            let stage = Stage::at(Played::Root, 1.0 / hz, DVec3::ZERO).with_still(&shape);
            Run::new(stage, ClimberConfig::colossus_climber(), v(0.1, 0.0, -0.4)).settle()
        };
        let mut run = stairs();
        let mut state = *run.state();
        for k in 0..3000 {
            let mut other = stairs();
            other.put(state);
            let risen = rises(&mut other, &level_blow(true), true);
            assert!(risen <= 0.05, "{hz} Hz, tick {k} at {}: {risen} m", state.position);
            for _ in 0..(hz / 30.0) as u32 {
                run.step(&walk(DVec3::Z));
            }
            state = *run.state();
            if state.position.z > 1.8 {
                break;
            }
        }
        assert!(state.position.z > 1.8, "{hz} Hz: {}", state.position);
    }
}

#[test]
fn a_mantle_and_a_push_out_do_not_become_velocity() {
    for hz in RATES {
        let dt = 1.0 / hz;
        let mut block = cuboid(Vec3::new(4.0, 3.0, 3.0), STONE);
        let frame = v(1.0, 0.5, 0.0);
        let mut climber =
            Climber::new(ClimberConfig::colossus_climber(), v(0.3, 2.75, 3.5)).unwrap();
        let mut mantled = None;
        for k in 0..(3.0 * hz) as u32 {
            moved(&mut block, frame * (f64::from(k) * dt), DQuat::IDENTITY);
            let toward = if k < (0.5 * hz) as u32 { -0.1 } else { -1.0 };
            let input = ClimberInput {
                walk: DVec3::Z * toward,
                ..HOLD
            };
            let report = climber.step(&input, &list(&[&block]), dt).unwrap();
            if report.events.contains(&ClimberEvent::Mantled) {
                mantled = Some(*climber.state());
                break;
            }
        }
        let state = mantled.unwrap_or_else(|| panic!("{hz} Hz: {:?}", climber.state()));
        let off = (state.velocity - frame).length();
        assert!(off <= 0.03, "{hz} Hz: {off} m/s after a mantle, {state:?}");

        // A wall is put into a standing climber, which is pushed out of it.
        for deep in [0.05, 0.2, 0.35] {
            let floor = at(cuboid(Vec3::new(6.0, 1.0, 6.0), STONE), v(0.0, -1.0, 0.0));
            let wall = at(
                cuboid(Vec3::new(0.5, 2.0, 3.0), STONE),
                v(-0.9 + deep, 2.05, 0.0),
            );
            let mut climber = Climber::new(ClimberConfig::walker(), v(0.0, 0.4, 0.0)).unwrap();
            let only: [&dyn Obstacle; 1] = [&floor];
            for _ in 0..4 {
                climber.step(&IDLE, &list(&only), dt).unwrap();
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

#[test]
fn a_climber_as_an_obstacle_is_where_it_is_expected() {
    for hz in RATES {
        for (name, config) in configs() {
            let mut run = one_step(hz, config, DVec3::ZERO);
            for k in 0..(1.5 * hz) as u32 {
                let obstacle = ClimberObstacle::new(&run.climber, 1.0 / hz);
                let (expected, _) = obstacle.bounds().unwrap();
                let way = run.state().velocity / hz;
                let expected = expected + way * 0.5;
                run.step(&walk(DVec3::Z));
                let off = expected.distance(run.position());
                assert!(off <= 0.02 + 0.28, "{name} at {hz} Hz, tick {k}: off by {off}");
            }
        }
    }
}
