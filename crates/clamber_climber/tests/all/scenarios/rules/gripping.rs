//! Holds that are refused, and friends as holds.

use std::cell::Cell;
use std::rc::Rc;

use clamber_climber::ClimberMode::{Falling, Holding, LedgeHanging};
use clamber_climber::{ContactQuery, ContactRule};
use glam::DVec3;

use super::scene::{Case, ODD, at_every_rate, at_wall, person, wall};
use crate::events::is_lost_footing;
use crate::input::{HOLD, grip_climb, grip_walk};
use crate::stage::{Run, Shape};

pub(crate) fn armour_stops_hands() {
    let up = grip_climb(DVec3::Y);
    at_every_rate(|case| {
        let stage = case
            .stage()
            .numbered(ODD)
            .with_still(&wall(0.0, 3.0))
            .numbered(2)
            .with_still(&wall(3.0, 6.0));
        let mut run = at_wall(stage, 1.5);
        run.set_rule(|query| query.usual().with_grip(query.tag().user == ODD));
        for _ in 0..case.ticks(4.0) {
            run.step(&up);
            assert_eq!(run.mode(), Holding, "{case} at {}", run.position());
            let on = run.state().support.unwrap().tag.user;
            assert_eq!(on, ODD, "{case} at {}", run.position());
        }
        let height = run.position().y;
        assert!((2.6..3.6).contains(&height), "{case}: climbed to {height}");
        run.sound()
    });
}

pub(crate) fn a_hold_that_is_refused_lets_go() {
    at_every_rate(|case| {
        let stage = case.stage().numbered(ODD).with_still(&wall(-9.0, 6.0));
        let mut run = at_wall(stage, 1.5);
        let closed = Rc::new(Cell::new(false));
        let is_closed = Rc::clone(&closed);
        run.set_rule(move |query| query.usual().with_grip(!is_closed.get()));
        run.steps(case.ticks(0.5), &HOLD);
        assert_eq!(run.mode(), Holding, "{case}");
        closed.set(true);
        let report = run.step(&HOLD);
        assert_eq!(run.mode(), Falling, "{case}");
        let lost = report.events.iter().any(is_lost_footing);
        assert!(lost, "{case}: {:?}", report.events);
        run.steps(case.ticks(0.3), &HOLD);
        assert_eq!(run.mode(), Falling, "{case}");
        run.sound()
    });
}

/// Falls past a friend's shoulders with the grip held, facing it. `rule` is the rule for the friend.
fn past_a_friend(case: Case, rule: Option<fn(&ContactQuery<'_>) -> ContactRule>) -> Run {
    let mut config = person();
    config.body.height = 1.0;
    let stage = case.stage().with_still(&Shape::floor(9.0));
    let mut run = Run::new(stage, config, DVec3::new(0.0, 1.2, 0.9));
    run.meet_friend(DVec3::ZERO);
    if let Some(rule) = rule {
        run.set_rule(move |query| {
            if query.is_character() {
                rule(query)
            } else {
                query.usual()
            }
        });
    }
    let towards = grip_walk(DVec3::NEG_Z);
    run.steps(case.ticks(1.0), &towards);
    run
}

pub(crate) fn a_friend_is_neither_hung_from_nor_gripped_unless_the_rule_says_so() {
    at_every_rate(|case| {
        let holds = |run: &Run| run.trace.modes.iter().any(|mode| mode.is_holding());
        let run = past_a_friend(case, None);
        assert!(!holds(&run), "{case}: holds a friend");
        let ledge = past_a_friend(case, Some(|query| query.usual().with_hang(true)));
        assert!(
            ledge.trace.modes.contains(&LedgeHanging),
            "{case}: {:?}",
            ledge.mode()
        );
        let gripped = past_a_friend(case, Some(|_| ContactRule::GRIP));
        let mode = gripped.mode();
        assert!(gripped.trace.modes.contains(&Holding), "{case}: {mode:?}");
        run.sound()
    });
}
