//! Ground that may not be stood on, and steps that may not be stepped onto.

use clamber_climber::ClimberMode::{Sliding, Standing};
use clamber_climber::{ClimberConfig, ClimberEvent, ClimberInput};
use clamber_surface::geometry::Similarity;
use glam::DVec3;

use super::scene::{G, ODD, RADIUS, at_every_rate, but};
use crate::input::{IDLE, walk};
use crate::stage::{Run, Shape, radians, within};

pub(crate) fn ground_that_may_not_be_stood_on_is_slid_off() {
    let angle = radians(20.0);
    let floor = Shape::floor(30.0).turned(DVec3::Z, angle);
    at_every_rate(|case| {
        let stage = case.stage().numbered(ODD).with_still(&floor);
        let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::ZERO).settle();
        run.set_rule(but(|query| query.usual().with_stand(false)));
        let start = run.position();
        let report = run.step(&IDLE);
        assert!(report.events.contains(&ClimberEvent::Slipped), "{case}");
        run.steps(case.ticks(1.0) - 1, &IDLE);
        assert!(run.trace.always(Sliding), "{case}: {:?}", run.mode());
        let went = run.position().distance(start);
        let slid = G * libm::sin(angle) / 2.0;
        within!((went - slid).abs(), 5e-3, "{case}: slid {went} m");
        run.sound()
    });
}

pub(crate) fn a_curb_that_may_not_be_stepped_onto_blocks() {
    for height in [0.05, 0.1, 0.2] {
        at_every_rate(|at| {
            let case = format!("{at}, {height} m");
            let low = DVec3::new(1.0, -0.5, -9.0);
            let curb = Shape::boxed(low, DVec3::new(9.0, height, 9.0));
            let stage = at
                .stage()
                .with_still(&Shape::floor(9.0))
                .numbered(ODD)
                .with(&curb, |_| Similarity::IDENTITY);
            let mut run = Run::new(stage, ClimberConfig::walker(), DVec3::ZERO).settle();
            run.set_rule(but(|query| query.usual().with_step(false)));
            run.steps(at.ticks(1.0), &walk(DVec3::X));
            assert!(run.trace.always(Standing), "{case}");
            let before = libm::sqrt(RADIUS * RADIUS - (RADIUS - height) * (RADIUS - height));
            let x = run.position().x;
            // A body that is pressed onto its ground meets the edge up to one and a half margins early.
            let place = run.position();
            within!((x - 1.0 + before).abs(), 0.015, "{case}: stops at {place}");
            within!(run.feet().y.abs(), 1e-3, "{case}: stands at {}", run.feet());
            // Once the climber has jumped onto the step, it walks there.
            run.step(&ClimberInput {
                jump: true,
                jump_held: true,
                ..walk(DVec3::X)
            });
            run.steps(at.ticks(1.5), &walk(DVec3::X));
            let there = run.feet();
            within!((there.y - height).abs(), 1e-3, "{case}: jumped to {there}");
            run.sound()
        });
    }
}
