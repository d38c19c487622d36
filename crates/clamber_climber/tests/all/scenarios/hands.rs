//! Ledges, fur, and being knocked down.

use clamber_climber::ClimberMode::{Hanging, Holding, LedgeHanging, Standing, Tumbling};
use clamber_climber::{ClimberConfig, ClimberEvent};
use clamber_world::SurfaceKind;
use glam::{DAffine3, DVec3};

use crate::events::{count, is_turned_corner};
use crate::input::{HOLD, IDLE, blow, grip_climb, grip_walk};
use crate::stage::{Run, Shape, Skin, Stage, every, shifted, within};

/// A block of 8 by 6 by 6 m around the origin.
fn block() -> Shape {
    Shape::boxed(DVec3::new(-4.0, -3.0, -3.0), DVec3::new(4.0, 3.0, 3.0))
}

/// The block with fur, which moves along Z.
fn furry(moved: impl Fn(f64) -> f64 + 'static) -> Skin {
    let pose = move |time: f64| {
        let root = shifted(DVec3::Z * moved(time));
        (vec![DAffine3::IDENTITY], root)
    };
    Skin::of(&block(), SurfaceKind::Fur, &|_| vec![1.0], Box::new(pose))
}

/// A run whose climber starts with the centre of its ball at `center`.
fn at(stage: Stage, center: DVec3) -> Run {
    let config = ClimberConfig::colossus_climber();
    Run::new(stage, config, center - DVec3::Y * config.body.radius)
}

pub(crate) fn a_ledge_is_caught_hung_from_and_climbed_over() {
    every(0.0, |played| {
        let stage = Stage::new(played).with_still(&block());
        let mut run = at(stage, DVec3::new(0.3, 2.75, 3.5));
        let towards = |share: f64| grip_walk(-DVec3::Z * share);
        run.steps(3, &towards(0.1));
        assert_eq!(run.mode(), LedgeHanging, "{played:?}: {}", run.position());
        run.steps(60, &HOLD);
        let hangs = run.position().distance(DVec3::new(0.3, 2.4, 3.4));
        within!(hangs, 1e-3, "{played:?}: hangs at {}", run.position());
        run.steps(60, &grip_walk(DVec3::X));
        let aside = run.position().distance(DVec3::new(-0.7, 2.4, 3.4));
        let other = run.position().distance(DVec3::new(1.3, 2.4, 3.4));
        let place = run.position();
        within!(aside.min(other), 1e-3, "{played:?}: along to {place}");
        run.steps(60, &towards(1.0));
        let is_over = run.trace.events.contains(&ClimberEvent::Mantled);
        assert!(is_over, "{played:?}: {}", run.position());
        run.steps(30, &HOLD);
        assert_eq!(run.mode(), Standing);
        let feet = run.feet();
        within!((feet.y - 3.0).abs(), 1e-4, "{played:?}: {feet}");
        run.sound()
    });
}

pub(crate) fn fur_is_climbed_and_its_corner_turned() {
    every(0.0, |played| {
        let stage = Stage::new(played).with_skin(furry(|_| 0.0));
        let mut run = at(stage, DVec3::new(0.3, 0.0, 3.6));
        run.steps(20, &HOLD);
        assert_eq!(run.mode(), Holding, "{played:?}: {}", run.position());
        let gap = run.position().z - 3.4;
        within!(gap.abs(), 1e-3, "{played:?}: drawn to {gap}");
        let before = run.position();
        run.steps(60, &grip_climb(DVec3::Y));
        let off = run.position().distance(before + DVec3::Y * 1.5);
        within!(off, 1e-3, "{played:?}: climbs to {}", run.position());
        run.steps(240, &grip_climb(DVec3::X));
        let corners = count(&run.trace.events, is_turned_corner);
        assert_eq!(corners, 1, "{played:?}: {}", run.position());
        let gap = run.position().x - 4.4;
        within!(gap.abs(), 1e-3, "{played:?}: at {}", run.position());
        run.sound()
    });
}

/// Shakes for two seconds at 4 Hz, then keeps still.
fn shake(time: f64) -> f64 {
    let waves = core::f64::consts::TAU * 4.0 * time.min(2.0);
    0.08 * libm::sin(waves)
}

pub(crate) fn a_hold_that_shakes_is_hung_from_until_it_is_calm() {
    every(0.0, |played| {
        let stage = Stage::new(played).with_skin(furry(shake));
        let mut run = at(stage, DVec3::new(0.3, 0.0, 3.4));
        run.step_held(&HOLD);
        run.steps(60, &HOLD);
        assert_eq!(run.mode(), Hanging, "{played:?}: {}", run.position());
        run.steps(240, &HOLD);
        assert_eq!(run.mode(), Holding, "{played:?}: {}", run.position());
        run.sound()
    });
}

pub(crate) fn a_knocked_down_climber_bounces_slides_and_gets_up() {
    every(0.0, |played| {
        let stage = Stage::new(played).with_still(&Shape::floor(60.0));
        let mut run = at(stage, DVec3::Y * 3.0);
        run.knockback = blow(DVec3::new(6.0, 1.0, 0.0));
        run.step(&IDLE);
        assert_eq!(run.mode(), Tumbling);
        run.steps(300, &IDLE);
        assert_eq!(run.mode(), Standing, "{played:?}: {}", run.position());
        assert!(run.feet().x > 4.0, "{played:?}: {}", run.feet());
        run.sound()
    });
}
