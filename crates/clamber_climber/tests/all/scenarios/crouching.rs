//! Crouching under ceilings, and bodies that grow and shrink.

use clamber_climber::ClimberMode::Standing;
use clamber_climber::{ClimberConfig, ClimberError, ClimberInput};
use glam::DVec3;

use crate::input::{IDLE, walk};
use crate::stage::{Played, Run, Shape, Stage, every, within};

/// Height of the second ball above the first, metres: the body is 1.6 m tall.
const HEIGHT: f64 = 0.8;

/// Radius of the body, metres.
const RADIUS: f64 = 0.4;

/// Tick rates, hertz.
const RATES: [f64; 3] = [60.0, 30.0, 240.0];

/// A floor, and a ceiling over z 2 to 6 with its lower side at a height.
fn room(played: Played, rate: f64, ceiling: f64) -> Stage {
    let slab = Shape::boxed(
        DVec3::new(-3.0, ceiling, 2.0),
        DVec3::new(3.0, ceiling + 0.5, 6.0),
    );
    Stage::at_rate(played, rate)
        .with_still(&Shape::boxed(
            DVec3::new(-9.0, -1.0, -9.0),
            DVec3::new(9.0, 0.0, 19.0),
        ))
        .with_still(&slab)
}

fn tall() -> ClimberConfig {
    let mut config = ClimberConfig::walker();
    config.body.height = HEIGHT;
    config
}

fn crouch(input: ClimberInput) -> ClimberInput {
    ClimberInput {
        crouch: true,
        ..input
    }
}

pub(crate) fn a_climber_crouches_under_a_ceiling() {
    for rate in RATES {
        every(0.0, |played| {
            let told = format!("{played:?}, {rate} Hz");
            let mut run = Run::new(room(played, rate, 1.0), tall(), DVec3::ZERO).settle();
            let ahead = walk(DVec3::Z);
            // Upright, the climber stops at the ceiling's edge.
            run.steps((2.0 * rate) as u32, &ahead);
            assert!(run.position().z < 2.0, "{told}: {}", run.position());
            assert!(!run.state().crouched, "{told}");
            for _ in 0..(rate * 0.8) as u32 {
                run.step(&crouch(ahead));
                assert_eq!(run.mode(), Standing, "{told}");
                within!((run.position().y - RADIUS).abs(), 2e-2, "{told}");
            }
            let inside = run.position();
            assert!(inside.z > 2.5 && inside.z < 5.6, "{told}: {inside}");
            // Without room the climber stays crouched, and goes on.
            for _ in 0..(rate * 0.25) as u32 {
                run.step(&IDLE);
                assert!(run.state().crouched, "{told}: {}", run.position());
            }
            run.steps((2.0 * rate) as u32, &ahead);
            assert!(run.position().z > 6.4, "{told}: {}", run.position());
            assert!(!run.state().crouched, "{told}: upright again");
            run.sound()
        });
    }
}

pub(crate) fn who_has_no_room_does_not_stand_up() {
    // The ceiling is just too low for 1.6 m, or just high enough.
    for (ceiling, stands) in [(1.57, false), (1.63, true)] {
        every(0.0, |played| {
            let told = format!("{played:?}, ceiling at {ceiling} m");
            let stage = room(played, 60.0, ceiling);
            let mut run = Run::new(stage, tall(), DVec3::ZERO).settle();
            run.steps(80, &crouch(walk(DVec3::Z)));
            let inside = run.position();
            assert!(inside.z > 2.6 && inside.z < 5.4, "{told}: {inside}");
            run.steps(20, &crouch(IDLE));
            assert!(run.state().crouched, "{told}");
            run.steps(20, &IDLE);
            assert_eq!(run.state().crouched, !stands, "{told}");
            within!((run.position().y - RADIUS).abs(), 2e-2, "{told}");
            run.sound()
        });
    }
}

pub(crate) fn a_body_grows_only_where_it_has_room() {
    every(0.0, |played| {
        let told = format!("{played:?}");
        let stage = room(played, 60.0, 1.0);
        let small = ClimberConfig::walker();
        let mut run = Run::new(stage, small, DVec3::Z * 4.0).settle();
        let mut wide = small;
        wide.body.radius = 0.6;
        wide.body.margin = 0.015;
        for config in [tall(), wide] {
            let (state, place) = (*run.state(), run.position());
            let refused = run.resize(config);
            let is_refusal = matches!(refused, Err(ClimberError::NoRoom { lacks }) if lacks > 0.0);
            assert!(is_refusal, "{told}: {refused:?}");
            assert_eq!((*run.state(), run.position()), (state, place), "{told}");
            run.steps(5, &IDLE);
            within!(run.position().distance(place), 1e-3, "{told}: moved");
        }
        // In the open, both sizes have room, and keep their feet on the ground.
        run.steps(120, &walk(DVec3::Z));
        run.steps(30, &IDLE);
        for config in [tall(), wide, small, wide] {
            run.resize(config).unwrap();
            within!(run.feet().y.abs(), 1e-2, "{told}: {}", run.feet());
            run.steps(10, &IDLE);
            assert_eq!(run.mode(), Standing, "{told}");
            within!(run.feet().y.abs(), 1e-2, "{told}: {}", run.feet());
        }
        run.sound()
    });
}
