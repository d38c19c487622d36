//! Ledges that are refused.

use std::cell::Cell;
use std::rc::Rc;

use clamber_climber::ClimberMode::{Falling, LedgeHanging};
use glam::DVec3;

use super::scene::{ODD, RADIUS, at_every_rate, but, person, wall};
use crate::input::grip_walk;
use crate::stage::{Run, Shape};

/// The climber falls off a ledge that the rule refuses, and does not pull itself up onto a top that the rule does not
/// let it stand on.
pub(crate) fn a_ledge_that_is_refused_is_let_go_and_one_without_footing_is_only_hung_from() {
    let up = grip_walk(DVec3::NEG_Z);
    at_every_rate(|case| {
        let stage = case.stage().numbered(ODD).with_still(&wall(-9.0, 1.0));
        let mut config = person();
        config.grip = None;
        let mut run = Run::new(stage, config, DVec3::new(0.0, 0.2, RADIUS));
        let holds = Rc::new(Cell::new(true));
        let may_hang = Rc::clone(&holds);
        run.set_rule(but(move |query| {
            query.usual().with_stand(false).with_hang(may_hang.get())
        }));
        run.steps(case.ticks(2.0), &up);
        assert_eq!(run.mode(), LedgeHanging, "{case}");
        holds.set(false);
        run.steps(case.ticks(0.2), &up);
        assert_eq!(run.mode(), Falling, "{case}");
        run.sound()
    });
}

/// Hands go along a ledge, up to the part that they may not hold.
pub(crate) fn hands_stop_where_a_ledge_may_not_be_held() {
    let aside = grip_walk(DVec3::X);
    at_every_rate(|case| {
        let part = |from: f64, to: f64| {
            Shape::boxed(DVec3::new(from, -9.0, -1.0), DVec3::new(to, 1.0, 0.0))
        };
        let stage = case
            .stage()
            .with_still(&part(-3.0, 0.8))
            .numbered(ODD)
            .with_still(&part(0.8, 3.0));
        let mut config = person();
        config.grip = None;
        let mut run = Run::new(stage, config, DVec3::new(0.0, 0.2, RADIUS));
        run.set_rule(but(|query| query.usual().with_hang(false)));
        let face = grip_walk(DVec3::NEG_Z * 0.1);
        run.steps(case.ticks(0.5), &face);
        assert_eq!(run.mode(), LedgeHanging, "{case}");
        for _ in 0..case.ticks(3.0) {
            run.step(&aside);
            assert_eq!(run.mode(), LedgeHanging, "{case}");
            let on = run.state().support.unwrap().tag.user;
            assert_eq!(on, 0, "{case} at {}", run.position());
        }
        let x = run.position().x;
        assert!((0.5..1.3).contains(&x), "{case}: at {x}");
        run.sound()
    });
}
