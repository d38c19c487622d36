//! Custom modes of a game end their tick, for every result of their handlers.

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberMode, CustomMode, ModeContext, NextMode, StepRules,
};
use glam::DVec3;

use crate::input::IDLE;
use crate::scene::DT;

/// A charge that asks to begin anew in every tick.
struct Charge;

impl CustomMode for Charge {
    fn id(&self) -> u16 {
        1
    }

    fn begins(&self, _: &mut ModeContext<'_, '_>) -> bool {
        true
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        context.custom_slots()[0] += 1.0;
        NextMode::Change(ClimberMode::Custom(self.id()))
    }
}

/// A mode of a pair that hand over to each other.
struct PingPong(u16);

impl CustomMode for PingPong {
    fn id(&self) -> u16 {
        self.0
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        !context.state().mode.is_custom()
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        context.custom_slots()[0] += 1.0;
        NextMode::Change(ClimberMode::Custom(5 - self.0))
    }
}

#[test]
fn a_mode_that_changes_to_itself_stays() {
    let mut climber = Climber::new(ClimberConfig::walker(), DVec3::ZERO).unwrap();
    let rules = StepRules::with_modes(&[&Charge]);
    for tick in 1..=3 {
        let report = climber.step_with(&IDLE, &[], &rules, DT);
        let report = report.unwrap();
        let mode = ClimberMode::Custom(1);
        assert_eq!(climber.state().mode, mode);
        // The mode's handler ran once.
        assert_eq!(climber.state().custom_slots[0], f64::from(tick));
        let told = ClimberEvent::AlreadyInMode { mode };
        assert!(report.events.contains(&told), "{report:?}");
        assert!(!report.changes_left, "{report:?}");
    }
}

#[test]
fn modes_that_hand_over_to_each_other_end_their_tick() {
    let mut climber = Climber::new(ClimberConfig::walker(), DVec3::ZERO).unwrap();
    let rules = StepRules::with_modes(&[&PingPong(2), &PingPong(3)]);
    for tick in 1..=3 {
        let report = climber.step_with(&IDLE, &[], &rules, DT);
        let report = report.unwrap();
        assert!(report.changes_left, "{report:?}");
        let ran = climber.state().custom_slots[0];
        assert!(
            ran <= 4.0 * f64::from(tick),
            "{ran} handlers in {tick} ticks"
        );
    }
}
