//! The brain's step.

use super::Creature;
use super::report::CreatureEvent;

impl Creature {
    /// Steps the brain, with the markers that the clips passed in the last tick.
    pub(super) fn think(&mut self) {
        let kind = &self.kind;
        let passed = self.state.passed.names(kind);
        let events = &mut self.report.events;
        let (mut changed, mut interrupts) = (false, false);
        kind.brain().step(
            &mut self.state.brain,
            &self.state.senses,
            &passed,
            |entered| {
                changed = true;
                interrupts |= entered.interrupts;
                events.push(CreatureEvent::Entered {
                    from: entered.from,
                    to: entered.to,
                });
            },
        );
        if changed {
            self.state.acting.end();
            self.state.acting.halt(interrupts);
            self.state.senses.begin_act();
            if kind.brain().is_final(self.state.brain.current()) {
                self.drop_errand();
            }
        }
    }
}
