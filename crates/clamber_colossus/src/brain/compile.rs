//! Compiles a brain file into a brain: names become indices, seconds become ticks, and everything is checked.

use std::collections::{BTreeMap, BTreeSet};

use super::condition::Condition;
use super::locate::{Lines, state_on};
use super::{
    After, Brain, BrainError, BrainFile, BrainProblem, DEFAULT_FADE, Gaze, MOST_DEPTH, MOST_MOODS,
    MOST_REGIONS, MOST_STATES, MOST_TRANSITIONS, MOST_WEIGHT, Mood, State, StateFile, StateId,
    Transition, TransitionFile,
};
use crate::senses::Sense;

impl Brain {
    /// Reads a brain from its JSON file, for ticks of `tick` seconds.
    ///
    /// # Errors
    /// [`BrainError`], with the line and the state if they are known.
    pub fn from_json(text: &str, tick: f64) -> Result<Self, BrainError> {
        let file: BrainFile = serde_json::from_str(text).map_err(|error| {
            let line = error.line();
            BrainError {
                line: (line > 0).then_some(line),
                state: state_on(text, line),
                problem: Box::new(BrainProblem::Text(without_place(&error.to_string()))),
            }
        })?;
        Compiler::new(&file, tick, Lines::of(text)).compile()
    }

    /// Builds a brain from a [`BrainFile`] that was made in code, for ticks of `tick` seconds.
    ///
    /// # Errors
    /// [`BrainError`], without a line.
    pub fn new(file: BrainFile, tick: f64) -> Result<Self, BrainError> {
        Compiler::new(&file, tick, Lines::default()).compile()
    }
}

struct Compiler<'a> {
    file: &'a BrainFile,
    tick: f64,
    lines: Lines,
    states: Vec<State>,
    files: Vec<&'a StateFile>,
    ids: BTreeMap<&'a str, StateId>,
}

impl<'a> Compiler<'a> {
    fn new(file: &'a BrainFile, tick: f64, lines: Lines) -> Self {
        Self {
            file,
            tick,
            lines,
            states: Vec::new(),
            files: Vec::new(),
            ids: BTreeMap::new(),
        }
    }

    fn compile(mut self) -> Result<Brain, BrainError> {
        let tick = self.tick;
        if !(tick > 0.0 && tick.is_finite()) {
            return Err(self.whole(out_of_range("tick", "finite and more than 0", tick)));
        }
        for (what, found, most) in [
            ("states", count(&self.file.states), MOST_STATES),
            ("moods", self.file.moods.len(), MOST_MOODS),
            ("regions", self.file.regions.len(), MOST_REGIONS),
        ] {
            if found > most {
                return Err(self.whole(too_many(what, found, most)));
            }
        }
        self.check_names()?;
        self.gather(&self.file.states, None)?;
        let moods = self.moods()?;
        for index in 0..self.states.len() {
            self.start_of(index)?;
        }
        let start = self.find(&self.file.start);
        let start = start.map_err(|problem| self.at(self.lines.start(), problem))?;
        let transitions = self.transitions()?;
        let mut brain = Brain {
            file: self.file.clone(),
            tick,
            states: std::mem::take(&mut self.states),
            transitions,
            moods,
            start,
            mark: 0,
        };
        brain.mark = brain.own_mark();
        brain.start = brain.innermost(start);
        self.check_instants(&brain)?;
        Ok(brain)
    }

    /// Appends all states: each outer state before its inner states.
    fn gather(
        &mut self,
        states: &'a BTreeMap<String, StateFile>,
        parent: Option<StateId>,
    ) -> Result<(), BrainError> {
        for (name, file) in states {
            let outer = parent.map(|parent| &self.states[parent.index()]);
            let (path, depth) = outer.map_or((name.clone(), 0), |outer| {
                (format!("{}/{name}", outer.path), outer.depth + 1)
            });
            let line = self.lines.state(&path);
            let here = |problem| BrainError {
                line: (line > 0).then_some(line),
                state: Some(path.clone()),
                problem: Box::new(problem),
            };
            if name.is_empty() || name.contains('/') {
                let problem = "a state's name is empty or has a slash in it";
                return Err(here(BrainProblem::Text(problem.into())));
            }
            if self.ids.contains_key(name.as_str()) {
                let (what, name) = ("states", name.clone());
                return Err(here(BrainProblem::Twice { what, name }));
            }
            if depth >= MOST_DEPTH {
                let what = "states around each other";
                return Err(here(too_many(what, depth + 1, MOST_DEPTH)));
            }
            let is_outer = !file.states.is_empty();
            if file.is_final && (is_outer || !file.transitions.is_empty()) {
                return Err(here(BrainProblem::FinalState));
            }
            if is_outer && (file.start.is_none() || file.act.is_some()) {
                return Err(here(BrainProblem::Composite));
            }
            if !is_outer && file.start.is_some() {
                return Err(here(BrainProblem::Leaf));
            }
            let fade = file.fade.unwrap_or(DEFAULT_FADE);
            let cooldown = file.cooldown.unwrap_or(0.0);
            for (what, found) in [("fade", fade), ("cooldown", cooldown)] {
                check_seconds(what, found).map_err(here)?;
            }
            check_act(file).map_err(here)?;
            let gaze = outer.map_or(Gaze::Clip, |outer| outer.gaze);
            let mut exposes = outer.map_or(Vec::new(), |outer| outer.exposes.clone());
            exposes.extend(file.exposes.iter().cloned());
            let id = StateId(self.states.len().min(usize::from(u16::MAX)) as u16);
            self.states.push(State {
                name: name.clone(),
                path,
                parent,
                depth,
                start: None,
                act: file.act.clone(),
                gaze: file.gaze.unwrap_or(gaze),
                fade,
                exposes,
                cooldown: Brain::ticks(cooldown, self.tick),
                is_final: file.is_final,
                transitions: 0..0,
                line,
            });
            self.files.push(file);
            self.ids.insert(name, id);
            self.gather(&file.states, Some(id))?;
        }
        Ok(())
    }

    fn moods(&self) -> Result<Vec<Mood>, BrainError> {
        let mut moods = Vec::new();
        for (name, file) in &self.file.moods {
            let here = |problem| self.at(self.lines.mood(name), problem);
            check_seconds("fades", file.fades).map_err(here)?;
            let fades = Brain::ticks(file.fades, self.tick).max(1);
            let mut raised = Vec::new();
            for raise in &file.raised {
                if !(0.0..=1.0).contains(&raise.to) {
                    return Err(here(out_of_range("to", "from 0 to 1", raise.to)));
                }
                let when = self.conditions(&raise.when).map_err(here)?;
                let to = (raise.to * f64::from(fades)).round() as u32;
                raised.push((when, to));
            }
            moods.push(Mood { fades, raised });
        }
        Ok(moods)
    }

    fn start_of(&mut self, index: usize) -> Result<(), BrainError> {
        let Some(name) = &self.files[index].start else {
            return Ok(());
        };
        let start = self.find(name);
        let start = start.map_err(|problem| self.in_state(index, problem))?;
        if self.states[start.index()].parent != Some(StateId(index as u16)) {
            let known = list(self.files[index].states.keys());
            let (what, name) = ("state inside it called", name.clone());
            return Err(self.in_state(index, BrainProblem::Unknown { what, name, known }));
        }
        self.states[index].start = Some(start);
        Ok(())
    }

    fn transitions(&mut self) -> Result<Vec<Transition>, BrainError> {
        let mut all = Vec::new();
        for index in 0..self.states.len() {
            let first = all.len();
            for (number, file) in self.files[index].transitions.iter().enumerate() {
                let path = self.states[index].path.clone();
                let line = self.lines.transition(&path, number);
                let transition = self.transition(StateId(index as u16), file, line);
                let transition = transition.map_err(|problem| BrainError {
                    line: (line > 0).then_some(line),
                    state: Some(path),
                    problem: Box::new(problem),
                })?;
                let number = all.len() as u64;
                all.push(Transition {
                    number,
                    ..transition
                });
            }
            self.states[index].transitions = first..all.len();
        }
        Ok(all)
    }

    fn transition(
        &self,
        from: StateId,
        file: &TransitionFile,
        line: usize,
    ) -> Result<Transition, BrainProblem> {
        let weight = file.weight.unwrap_or(1.0);
        if !(weight > 0.0 && weight <= MOST_WEIGHT) {
            return Err(out_of_range(
                "weight",
                "more than 0 and at most 1e9",
                weight,
            ));
        }
        let after = match file.after {
            None => [0.0; 2],
            Some(After::Fixed(seconds)) => [seconds; 2],
            Some(After::Between(seconds)) => seconds,
        };
        for seconds in after {
            check_seconds("after", seconds)?;
        }
        if after[0] > after[1] {
            return Err(out_of_range("after", "in ascending order", after[0]));
        }
        Ok(Transition {
            number: 0,
            from,
            to: self.find(&file.to)?,
            when: self.conditions(&file.when)?,
            any: self.conditions(&file.any)?,
            on: file.on.clone(),
            after: after.map(|seconds| Brain::ticks(seconds, self.tick)),
            priority: file.priority,
            weight,
            interrupts: file.interrupts,
            line,
        })
    }

    fn conditions(&self, texts: &[String]) -> Result<Vec<Condition>, BrainProblem> {
        let read = |text: &String| {
            Condition::parse(text, self.file).map_err(|fault| BrainProblem::Condition {
                text: text.clone(),
                fault: fault.to_string(),
            })
        };
        texts.iter().map(read).collect()
    }

    fn find(&self, name: &str) -> Result<StateId, BrainProblem> {
        let found = self.ids.get(name).copied();
        found.ok_or_else(|| BrainProblem::Unknown {
            what: "state",
            name: name.to_owned(),
            known: list(self.ids.keys()),
        })
    }

    /// Refuses transitions without conditions that form a cycle, or a chain longer than [`MOST_TRANSITIONS`].
    fn check_instants(&self, brain: &Brain) -> Result<(), BrainError> {
        for first in brain.states() {
            let mut way = vec![brain.innermost(first)];
            while let Some(next) = brain.instant_from(way[way.len() - 1]) {
                let next = brain.innermost(next);
                let here = |problem| BrainError {
                    line: brain.line(first),
                    state: Some(brain.path(first).to_owned()),
                    problem: Box::new(problem),
                };
                if way.contains(&next) {
                    way.push(next);
                    let way: Vec<&str> = way.iter().map(|state| brain.path(*state)).collect();
                    return Err(here(BrainProblem::Circle(way.join(" -> "))));
                }
                way.push(next);
                if way.len() > MOST_TRANSITIONS {
                    return Err(here(BrainProblem::Chain(way.len() - 1)));
                }
            }
        }
        Ok(())
    }

    fn whole(&self, problem: BrainProblem) -> BrainError {
        BrainError {
            line: None,
            state: None,
            problem: Box::new(problem),
        }
    }

    fn in_state(&self, index: usize, problem: BrainProblem) -> BrainError {
        let state = &self.states[index];
        BrainError {
            line: (state.line > 0).then_some(state.line),
            state: Some(state.path.clone()),
            problem: Box::new(problem),
        }
    }

    /// An error on a line outside of all states.
    fn at(&self, line: usize, problem: BrainProblem) -> BrainError {
        BrainError {
            line: (line > 0).then_some(line),
            state: None,
            problem: Box::new(problem),
        }
    }

    /// Refuses a mood, or one of the game's own senses, whose name is already taken: no condition could read it.
    fn check_names(&self) -> Result<(), BrainError> {
        let mut known: BTreeSet<&str> = Sense::all().map(Sense::name).collect();
        for name in self.file.moods.keys().chain(&self.file.senses) {
            if !known.insert(name) {
                let (what, name) = ("senses or moods", name.clone());
                return Err(self.whole(BrainProblem::Twice { what, name }));
            }
        }
        Ok(())
    }
}

impl Brain {
    /// The target of the transition without conditions that leaves this state at once; `None` without such a
    /// transition, or if the state's act has to end first.
    fn instant_from(&self, state: StateId) -> Option<StateId> {
        let around = self.around(state).flat_map(|outer| {
            let range = self
                .state(outer)
                .map_or(0..0, |state| state.transitions.clone());
            self.transitions[range].iter()
        });
        let instant = around.filter(|transition| transition.is_instant());
        if self.is_final(state) || self.act(state).is_some_and(super::StateAction::is_whole) {
            return None;
        }
        // The first transition of the highest priority.
        let best = instant.reduce(|best, next| {
            if next.priority > best.priority {
                next
            } else {
                best
            }
        });
        best.map(|transition| transition.to)
    }
}

/// Number of states, inner states included.
fn count(states: &BTreeMap<String, StateFile>) -> usize {
    let inside = states.values().map(|state| count(&state.states));
    states.len() + inside.sum::<usize>()
}

fn check_act(file: &StateFile) -> Result<(), BrainProblem> {
    use super::StateAction;
    match &file.act {
        Some(StateAction::Attack(attack)) => attack.check(),
        Some(StateAction::Walk(walk)) => check_seconds("within", walk.within),
        Some(StateAction::Turn(turn)) => check_seconds("within_deg", turn.within_deg),
        Some(StateAction::Play(_) | StateAction::Once(_) | StateAction::Sleep) | None => Ok(()),
    }
}

/// Refuses times and lengths that are not finite, negative, or more than 1,000,000.
pub(super) fn check_seconds(what: &'static str, found: f64) -> Result<(), BrainProblem> {
    if (0.0..=1e6).contains(&found) {
        Ok(())
    } else {
        Err(out_of_range(what, "from 0 to 1,000,000", found))
    }
}

pub(super) fn out_of_range(what: &'static str, range: &'static str, found: f64) -> BrainProblem {
    BrainProblem::OutOfRange { what, range, found }
}

fn too_many(what: &'static str, found: usize, most: usize) -> BrainProblem {
    BrainProblem::TooMany { what, found, most }
}

/// A comma-separated list of names, for error messages.
pub(crate) fn list<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let names: Vec<String> = names
        .into_iter()
        .map(|name| format!("`{}`", name.as_ref()))
        .collect();
    if names.is_empty() {
        "none".into()
    } else {
        names.join(", ")
    }
}

impl Brain {
    /// An error in a state, with the state's line.
    pub(crate) fn error_in(&self, state: StateId, problem: BrainProblem) -> BrainError {
        BrainError {
            line: self.line(state),
            state: Some(self.path(state).to_owned()),
            problem: Box::new(problem),
        }
    }
}

/// An error's text without the line and column at its end; [`BrainError::line`] has the line.
fn without_place(error: &str) -> String {
    let end = error.rfind(" at line ").unwrap_or(error.len());
    error[..end].to_owned()
}
