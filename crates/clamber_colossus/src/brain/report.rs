use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use super::condition::Condition;
use super::{After, Brain, StateId, Transition};

/// A brain as text: its states and transitions, and those that can never happen.
#[derive(Clone, Debug, PartialEq)]
pub struct BrainReport {
    states: Vec<String>,
    /// States and transitions that can never happen, and states without a way out or, if the brain has final states,
    /// without a way to one; by ascending line of the file.
    pub never: Vec<Never>,
}

/// A finding about a brain: a state or a transition that can never happen, a state that is not final
/// ([`StateFile::is_final`](crate::brain::StateFile::is_final)) and has no way out, or, in a brain with final states, a
/// state from which none of them can be reached. The brain works nevertheless.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Never {
    /// The line of the file, from 1; `None` if the brain was not read from a file.
    pub line: Option<usize>,
    /// The state's path, such as `calm/idle`.
    pub state: String,
    /// The fault, such as `nothing leads here`.
    pub what: String,
}

impl fmt::Display for Never {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        write!(f, "`{}`: {}", self.state, self.what)
    }
}

impl fmt::Display for BrainReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for state in &self.states {
            writeln!(f, "{state}")?;
        }
        if self.never.is_empty() {
            return writeln!(f, "\nall of it can happen");
        }
        writeln!(f, "\nnever, or without an end:")?;
        for never in &self.never {
            writeln!(f, "  {never}")?;
        }
        Ok(())
    }
}

impl Brain {
    /// The states and transitions as text, and those that can never happen, as far as this is known without a creature.
    /// [`CreatureKind::report`](crate::CreatureKind::report) also checks the markers that transitions wait for.
    pub fn report(&self) -> BrainReport {
        self.report_with(&|_, _| true)
    }

    /// The report, where `has(clip, marker)` tells whether a clip has a marker.
    pub(crate) fn report_with(&self, has: &dyn Fn(&str, &str) -> bool) -> BrainReport {
        BrainReport {
            states: self
                .states()
                .flat_map(|state| self.lines_of(state))
                .collect(),
            never: self.never(has),
        }
    }

    fn lines_of(&self, id: StateId) -> Vec<String> {
        let state = &self.states[id.index()];
        let indent = "  ".repeat(state.depth);
        let mut head = format!("{indent}{}", state.name);
        if let Some(act) = &state.act {
            let act = serde_json::to_string(act).unwrap_or_default();
            head.push_str(&format!("  {act}"));
        }
        if id == self.start {
            head.push_str("  (start)");
        }
        if state.is_final {
            head.push_str("  (final)");
        }
        let mut lines = vec![head];
        for transition in &self.transitions[state.transitions.clone()] {
            lines.push(format!("{indent}    {}", self.text_of(transition)));
        }
        lines
    }

    fn text_of(&self, transition: &Transition) -> String {
        let outer = &self.states[transition.from.index()];
        let number = transition.number as usize - outer.transitions.start;
        let Some(file) = self
            .file_of(transition.from)
            .and_then(|file| file.transitions.get(number))
        else {
            return String::new();
        };
        let mut text = format!("-> {}", file.to);
        let mut part = |what: String| text.push_str(&what);
        if !file.when.is_empty() {
            part(format!("  when {}", file.when.join(" and ")));
        }
        if !file.any.is_empty() {
            part(format!("  if any of {}", file.any.join(" or ")));
        }
        if let Some(marker) = &file.on {
            part(format!("  on {marker}"));
        }
        match file.after {
            Some(After::Fixed(seconds)) => part(format!("  after {seconds} s")),
            Some(After::Between([from, to])) => part(format!("  after {from} to {to} s")),
            None => {}
        }
        if file.priority != 0 {
            part(format!("  priority {}", file.priority));
        }
        if let Some(weight) = file.weight {
            part(format!("  weight {weight}"));
        }
        if file.interrupts {
            part("  interrupts".into());
        }
        text
    }

    fn file_of(&self, id: StateId) -> Option<&super::StateFile> {
        let mut states = &self.file.states;
        let mut found = None;
        for name in self.states[id.index()].path.split('/') {
            let state = states.get(name)?;
            (found, states) = (Some(state), &state.states);
        }
        found
    }

    fn never(&self, has: &dyn Fn(&str, &str) -> bool) -> Vec<Never> {
        let mut never = Vec::new();
        let reached = self.reached_from(self.start);
        let innermost = |id: &StateId| self.states[id.index()].start.is_none();
        for id in self.states() {
            let state = &self.states[id.index()];
            if !reached.iter().any(|inner| self.is_within(*inner, id)) {
                never.push(self.tell(state.line, id, "nothing leads here"));
            }
        }
        for transition in &self.transitions {
            let what = if let Some(name) = self.contradiction(transition) {
                format!("its conditions on {name} cannot hold together")
            } else if let Some(marker) = self.missing_marker(transition, has) {
                format!("no clip of the state has a marker `{marker}`")
            } else if self.waits_for_no_end(transition) {
                "its act has no end, so `done` never holds".into()
            } else if self.is_hidden(transition) {
                "another transition is always taken before it".into()
            } else {
                continue;
            };
            let what = format!("to `{}`: {what}", self.path(transition.to));
            never.push(self.tell(transition.line, transition.from, &what));
        }
        let finals: Vec<StateId> = self.states().filter(|id| self.is_final(*id)).collect();
        for id in reached
            .iter()
            .filter(|id| innermost(id) && !self.is_final(**id))
        {
            let on = self.reached_from(*id);
            let line = self.states[id.index()].line;
            if on.len() == 1 && self.leaving(*id).next().is_none() {
                never.push(self.tell(line, *id, "nothing leads out of it, and it is not `final`"));
            } else if !finals.is_empty() && !finals.iter().any(|end| on.contains(end)) {
                never.push(self.tell(line, *id, "no final state can be reached from it"));
            }
        }
        never.sort_by_key(|never| never.line);
        never
    }

    fn tell(&self, line: usize, state: StateId, what: &str) -> Never {
        Never {
            line: (line > 0).then_some(line),
            state: self.path(state).to_owned(),
            what: what.to_owned(),
        }
    }

    /// The transitions out of a state and out of its outer states.
    pub(super) fn leaving(&self, state: StateId) -> impl Iterator<Item = &Transition> {
        let around = self.around(state);
        around.flat_map(|outer| {
            let range = self.states[outer.index()].transitions.clone();
            self.transitions[range].iter()
        })
    }

    /// The innermost states that can be reached from `start`, `start` included. Any condition is taken to be possible,
    /// unless it contradicts another condition of its transition.
    pub(crate) fn reached_from(&self, start: StateId) -> BTreeSet<StateId> {
        let (mut reached, mut open) = (BTreeSet::from([start]), vec![start]);
        while let Some(state) = open.pop() {
            if self.is_final(state) {
                continue;
            }
            for transition in self.leaving(state) {
                let to = self.innermost(transition.to);
                if self.contradiction(transition).is_none() && reached.insert(to) {
                    open.push(to);
                }
            }
        }
        reached
    }

    /// The first sense or mood for which the transition's conditions cannot all hold; `None` if they can.
    fn contradiction(&self, transition: &Transition) -> Option<String> {
        let mut ranges: BTreeMap<String, [f64; 2]> = BTreeMap::new();
        for condition in &transition.when {
            let name = self.name_of(condition);
            let range = ranges
                .entry(name.clone())
                .or_insert(condition.source.range());
            let [low, high] = condition.interval();
            *range = [range[0].max(low), range[1].min(high)];
            if range[0] > range[1] {
                return Some(name);
            }
        }
        None
    }

    fn name_of(&self, condition: &Condition) -> String {
        use super::condition::Source;
        let nth = |mut names: Box<dyn Iterator<Item = &str> + '_>, index: usize| {
            names.nth(index).unwrap_or_default().to_owned()
        };
        match condition.source {
            Source::Sense(sense) => sense.name().into(),
            Source::Region(sense, region) => {
                let region = nth(Box::new(self.regions().map(|(name, _)| name)), region);
                format!("{}@{region}", sense.name())
            }
            Source::Mood(mood) => nth(Box::new(self.moods()), mood),
            Source::Own(own) => nth(Box::new(self.file.senses.iter().map(String::as_str)), own),
        }
    }

    /// The marker that a transition waits for, if no clip of its states has it.
    fn missing_marker(
        &self,
        transition: &Transition,
        has: &dyn Fn(&str, &str) -> bool,
    ) -> Option<String> {
        let wanted = transition.on.as_ref()?;
        let within = |state: &StateId| self.is_within(*state, transition.from);
        let mut acts = self
            .states()
            .filter(within)
            .filter_map(|state| self.act(state));
        let found = acts.any(|act| match act {
            // Walks and turns play clips of the gait, which are not known here.
            super::StateAction::Walk(_) | super::StateAction::Turn(_) => true,
            act => act.clip().is_some_and(|clip| has(clip, wanted)),
        });
        (!found).then(|| wanted.clone())
    }

    /// True if the transition waits for `done` in a state whose own act never ends.
    fn waits_for_no_end(&self, transition: &Transition) -> bool {
        use super::condition::Source;
        let state = &self.states[transition.from.index()];
        let is_endless = matches!(
            state.act,
            Some(super::StateAction::Play(_) | super::StateAction::Sleep)
        );
        let waits = |condition: &Condition| {
            let is_done = condition.source == Source::Sense(crate::senses::Sense::Done);
            is_done && !condition.holds_for(0.0)
        };
        is_endless && transition.when.iter().any(waits)
    }

    /// True if a transition of the same state, without conditions and of a higher priority, is always taken first.
    fn is_hidden(&self, transition: &Transition) -> bool {
        let range = self.states[transition.from.index()].transitions.clone();
        let mut beside = self.transitions[range].iter();
        !transition.interrupts
            && self.states[transition.from.index()].start.is_none()
            && beside.any(|other| other.is_instant() && other.priority > transition.priority)
    }
}
