use clamber_surface::Fingerprint;
use serde::{Deserialize, Serialize};

use super::{Brain, MOST_DEPTH, MOST_TRANSITIONS, StateId, Transition};
use crate::senses::Senses;

/// All that changes in a brain: the current state, its duration, moods and random numbers. It takes less than 1 KB, and
/// is all of the brain that has to be saved.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct BrainState {
    /// `Brain::mark` of its brain.
    brain: u64,
    current: StateId,
    /// Ticks since the brain began.
    now: u32,
    /// The ticks in which the current state and its outer states were entered, from the outside in.
    entered: [u32; MOST_DEPTH],
    /// Random numbers, each drawn when the state of that depth was entered.
    lots: [u64; MOST_DEPTH],
    /// Per state, the first tick in which it can be entered again.
    ready: Vec<u32>,
    /// Per mood, ticks until it has faded.
    moods: Vec<u32>,
    /// The state of the random number generator.
    random: u64,
}

/// A transition that the brain takes in a tick, from one state to another: [`Brain::step`] reports each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entered {
    /// The innermost current state before the transition.
    pub from: StateId,
    /// The innermost current state after the transition.
    pub to: StateId,
    /// The [`TransitionFile::interrupts`](crate::brain::TransitionFile::interrupts) of the transition that was taken.
    /// If true, the creature breaks off the clip of the state that it left, and begins the new act at once. If it is
    /// walking then, it stops abruptly, unless the new act is a walk as well. If false, nothing is broken off: an act
    /// that has to be played to its end was over, and any other act may end at any time. A walking creature then first
    /// comes to a stand, unless the new act is a walk.
    pub interrupts: bool,
}

impl BrainState {
    /// The start state of a brain, with a seed for its random numbers.
    pub fn new(brain: &Brain, seed: u64) -> Self {
        let mut state = Self {
            brain: brain.mark,
            current: brain.start,
            now: 0,
            entered: [0; MOST_DEPTH],
            lots: [0; MOST_DEPTH],
            ready: vec![0; brain.states.len()],
            moods: vec![0; brain.moods.len()],
            random: fastrand::Rng::with_seed(seed).u64(..),
        };
        for depth in 0..MOST_DEPTH {
            state.lots[depth] = state.draw();
        }
        state
    }

    /// The current state: the innermost one, where states are nested.
    pub fn current(&self) -> StateId {
        self.current
    }

    /// Ticks since the current state was entered.
    pub fn ticks_in_state(&self, brain: &Brain) -> u32 {
        let depth = brain.state(self.current).map_or(0, |state| state.depth);
        self.now - self.entered[depth].min(self.now)
    }

    /// A mood, 0 to 1, by its index in [`Brain::moods`]; 0 if there is no such mood.
    pub fn mood(&self, brain: &Brain, mood: usize) -> f64 {
        let (Some(left), Some(mood)) = (self.moods.get(mood), brain.moods.get(mood)) else {
            return 0.0;
        };
        f64::from(*left) / f64::from(mood.fades)
    }

    /// The next number of the brain's random number generator.
    pub(crate) fn draw(&mut self) -> u64 {
        let mut random = fastrand::Rng::with_seed(self.random);
        let lot = random.u64(..);
        self.random = random.get_seed();
        lot
    }

    /// Size in memory, bytes.
    pub fn size(&self) -> usize {
        size_of::<Self>() + size_of_val(&self.ready[..]) + size_of_val(&self.moods[..])
    }

    /// True if it belongs to this brain, or to one with the same states and moods.
    pub(crate) fn fits(&self, brain: &Brain) -> bool {
        let is_innermost = brain
            .state(self.current)
            .is_some_and(|state| state.start.is_none());
        let is_ours = self.brain == brain.mark && is_innermost;
        is_ours && (self.ready.len(), self.moods.len()) == (brain.states.len(), brain.moods.len())
    }
}

impl Brain {
    /// Advances the brain by a tick. `passed` are the markers that clips passed in the tick. `entered` is called for
    /// each transition that is taken, at most [`MOST_TRANSITIONS`] times.
    ///
    /// Does nothing if the state or the senses belong to another brain, or if a sense is NaN.
    pub fn step(
        &self,
        state: &mut BrainState,
        senses: &Senses,
        passed: &[&str],
        mut entered: impl FnMut(Entered),
    ) {
        if !state.fits(self) || !senses.fits(self.file.regions.len(), self.file.senses.len()) {
            return;
        }
        state.now = state.now.saturating_add(1);
        self.feel(state, senses);
        for round in 0..MOST_TRANSITIONS {
            let Some(chosen) = self.chosen(state, senses, passed, round > 0) else {
                return;
            };
            let interrupts = chosen.interrupts;
            let from = state.current;
            self.enter(state, chosen.to);
            let to = state.current;
            entered(Entered {
                from,
                to,
                interrupts,
            });
        }
    }

    /// Converts a state of the brain `from` into a state of this brain, for a game that reloads a brain's file while a
    /// creature lives. States are matched by path, moods by name. If this brain does not have the current state, the
    /// result begins in this brain's start. `None` if the state does not belong to `from`.
    pub fn carry_over(&self, from: &Brain, state: &BrainState) -> Option<BrainState> {
        if !state.fits(from) {
            return None;
        }
        let mut carried = BrainState {
            brain: self.mark,
            ready: vec![0; self.states.len()],
            moods: vec![0; self.moods.len()],
            ..state.clone()
        };
        let before = |path: &str| from.states.iter().position(|known| known.path == path);
        for (index, known) in self.states.iter().enumerate() {
            carried.ready[index] = before(&known.path).map_or(0, |before| state.ready[before]);
        }
        for (index, name) in self.file.moods.keys().enumerate() {
            let Some(before) = from.file.moods.keys().position(|known| known == name) else {
                continue;
            };
            let share = state.mood(from, before);
            carried.moods[index] = (share * f64::from(self.moods[index].fades)).round() as u32;
        }
        let path = &from.states[state.current.index()].path;
        let current = self.states.iter().position(|known| known.path == *path);
        match current.filter(|current| self.states[*current].start.is_none()) {
            Some(current) => carried.current = StateId(current as u16),
            None => {
                carried.current = self.start;
                carried.entered = [state.now; MOST_DEPTH];
            }
        }
        Some(carried)
    }

    /// A hash of the names of its states and moods, in their order, and of the moods' fading times.
    pub(crate) fn own_mark(&self) -> u64 {
        let mut hash = Fingerprint::default();
        hash.word(self.states.len() as u64);
        for state in &self.states {
            hash.text(&state.path);
        }
        for (name, mood) in self.file.moods.keys().zip(&self.moods) {
            hash.text(name);
            hash.word(u64::from(mood.fades));
        }
        hash.value()
    }

    /// Enters a state at once, for a scripted scene; a creature has [`Creature::enter`](crate::Creature::enter) for it.
    /// Does nothing if `state` does not fit this brain, or if `to` is not below [`Brain::len`]. An id is only an index:
    /// an id of another brain enters the state with the same index.
    pub fn go_to(&self, state: &mut BrainState, to: StateId) {
        if state.fits(self) && self.state(to).is_some() {
            self.enter(state, to);
        }
    }

    /// Fades the moods by a tick, and raises those whose conditions hold.
    fn feel(&self, state: &mut BrainState, senses: &Senses) {
        for left in &mut state.moods {
            *left = left.saturating_sub(1);
        }
        for (index, mood) in self.moods.iter().enumerate() {
            for (when, to) in &mood.raised {
                let value = |mood: usize| state.mood(self, mood);
                if when.iter().all(|condition| condition.holds(senses, value)) {
                    state.moods[index] = state.moods[index].max(*to);
                }
            }
        }
    }

    /// The transition to take now; `None` if none can be taken. With `at_once` only transitions without conditions
    /// count.
    fn chosen(
        &self,
        state: &mut BrainState,
        senses: &Senses,
        passed: &[&str],
        at_once: bool,
    ) -> Option<&Transition> {
        let current = state.current;
        if self.is_final(current) {
            return None;
        }
        let is_whole = self.act(current).is_some_and(super::StateAction::is_whole);
        let is_bound = is_whole && (at_once || senses.get(crate::Sense::Done) == 0.0);
        let can = |transition: &&Transition| {
            (!at_once || transition.is_instant())
                && (!is_bound || transition.interrupts && !at_once)
                && self.is_open(state, transition, senses, passed)
        };
        let all = || self.leaving(current);
        let priority = all()
            .filter(can)
            .map(|transition| transition.priority)
            .max()?;
        let best = |transition: &&Transition| transition.priority == priority && can(transition);
        let (count, weight) = all().filter(best).fold((0, 0.0), |(count, weight), one| {
            (count + 1, weight + one.weight)
        });
        if count == 1 {
            return all().find(best);
        }
        let chosen: Vec<&Transition> = all().filter(best).collect();
        let mut left = weight * unit(state.draw());
        for one in &chosen {
            left -= one.weight;
            if left < 0.0 {
                return Some(one);
            }
        }
        chosen.last().copied()
    }

    /// True if the transition's conditions hold and its target can be entered.
    fn is_open(
        &self,
        state: &BrainState,
        transition: &Transition,
        senses: &Senses,
        passed: &[&str],
    ) -> bool {
        let from = self.state(transition.from);
        let depth = from.map_or(0, |from| from.depth);
        let lasted = state.now - state.entered[depth].min(state.now);
        if lasted < self.wait(state, transition, depth) {
            return false;
        }
        if let Some(marker) = &transition.on
            && !passed.contains(&marker.as_str())
        {
            return false;
        }
        let value = |mood: usize| state.mood(self, mood);
        let holds = |condition: &super::Condition| condition.holds(senses, value);
        if !transition.when.iter().all(holds)
            || !transition.any.is_empty() && !transition.any.iter().any(holds)
        {
            return false;
        }
        let target = self.innermost(transition.to);
        let is_ready = |entered: StateId| {
            self.is_within(state.current, entered) || state.ready[entered.index()] <= state.now
        };
        let is_repeated = target == state.current && state.ready[target.index()] > state.now;
        self.around(target).all(is_ready) && !is_repeated
    }

    /// Ticks that the transition's state must have lasted.
    fn wait(&self, state: &BrainState, transition: &Transition, depth: usize) -> u32 {
        let [from, to] = transition.after;
        if from == to {
            return from;
        }
        // The same random number while the state lasts, for all transitions with the same range.
        let seed = state.lots[depth].wrapping_add(u64::from(from) << 32 | u64::from(to));
        let share = unit(fastrand::Rng::with_seed(seed).u64(..));
        from + (share * f64::from(to - from + 1)) as u32
    }

    fn enter(&self, state: &mut BrainState, to: StateId) {
        let from = state.current;
        let target = self.innermost(to);
        // The states that are left: those that do not contain the target, and those that are entered anew.
        for left in self.around(from) {
            let Some(outer) = self.state(left) else {
                continue;
            };
            if !self.is_within(target, left) || self.is_within(left, to) {
                state.ready[left.index()] = state.now.saturating_add(outer.cooldown);
            }
        }
        for entered in self.around(target) {
            let Some(inner) = self.state(entered) else {
                continue;
            };
            if !self.is_within(from, entered) || self.is_within(entered, to) {
                state.entered[inner.depth] = state.now;
                state.lots[inner.depth] = state.draw();
            }
        }
        state.current = target;
    }
}

/// Maps a random number to a number from 0 to less than 1.
fn unit(lot: u64) -> f64 {
    (lot >> 11) as f64 / (1u64 << 53) as f64
}
