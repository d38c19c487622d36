//! Compiles a brain file into a brain: names become indices, seconds become ticks, and everything is checked.

use std::collections::{BTreeMap, BTreeSet};

use super::condition::Condition;
use super::error::whole;
use super::locate::{Lines, state_on};
use super::{
    After, Brain, BrainError, BrainFile, BrainProblem, DEFAULT_FADE, Gaze, MOST_DEPTH, MOST_MOODS,
    MOST_REGIONS, MOST_STATES, MOST_TRANSITIONS, MOST_WEIGHT, Mood, State, StateFile, StateId,
    Transition, TransitionFile,
};
use crate::senses::Sense;

impl Brain {
    /// Reads a brain from the text of its JSON file ([the brain's documentation](crate::brain) gives its form), for
    /// ticks of `tick` seconds: a finite number above 0.
    ///
    /// # Errors
    /// [`BrainError`] for a text that is no brain file, an unknown name or a number out of its range, with the line and
    /// the state if they are known.
    pub fn from_json(text: &str, tick: f64) -> Result<Self, BrainError> {
        let file: BrainFile = serde_json::from_str(text).map_err(|error| {
            let problem = BrainProblem::Text(without_place(&error.to_string()));
            BrainError::new(error.line(), state_on(text, error.line()), problem)
        })?;
        Compiler::new(&file, tick, Lines::of(text)).compile()
    }

    /// Builds a brain from a [`BrainFile`] that was made in code, for ticks of `tick` seconds: a finite number above 0.
    ///
    /// # Errors
    /// [`BrainError`] for an unknown name or a number out of its range, without a line.
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
        let has_tick = tick > 0.0 && tick.is_finite();
        check(has_tick, "tick", "finite and more than 0", tick).map_err(whole)?;
        for (what, found, most) in [
            ("states", count(&self.file.states), MOST_STATES),
            ("moods", self.file.moods.len(), MOST_MOODS),
            ("regions", self.file.regions.len(), MOST_REGIONS),
        ] {
            if found > most {
                return Err(whole(too_many(what, found, most)));
            }
        }
        self.check_names()?;
        self.gather(&self.file.states, None)?;
        let moods = self.moods()?;
        for index in 0..self.states.len() {
            self.start_of(index)?;
        }
        let start = self.find(&self.file.start);
        let start = start.map_err(|problem| BrainError::new(self.lines.start(), None, problem))?;
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
            let here = |problem| BrainError::new(line, Some(path.clone()), problem);
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
            let here = |problem| BrainError::new(self.lines.mood(name), None, problem);
            check_seconds("fades", file.fades).map_err(here)?;
            let fades = Brain::ticks(file.fades, self.tick).max(1);
            let mut raised = Vec::new();
            for raise in &file.raised {
                let is_share = (0.0..=1.0).contains(&raise.to);
                check(is_share, "to", "from 0 to 1", raise.to).map_err(here)?;
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
            let known = self.files[index].states.keys();
            let problem = BrainProblem::unknown("state inside it called", name, known);
            return Err(self.in_state(index, problem));
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
                let mut transition =
                    transition.map_err(|problem| BrainError::new(line, Some(path), problem))?;
                transition.number = all.len() as u64;
                all.push(transition);
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
        check_above("weight", weight, MOST_WEIGHT, "more than 0 and at most 1e9")?;
        let after = match file.after {
            None => [0.0; 2],
            Some(After::Fixed(seconds)) => [seconds; 2],
            Some(After::Between(seconds)) => seconds,
        };
        for seconds in after {
            check_seconds("after", seconds)?;
        }
        let is_ascending = after[0] <= after[1];
        check(is_ascending, "after", "in ascending order", after[0])?;
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
        found.ok_or_else(|| BrainProblem::unknown("state", name, self.ids.keys()))
    }

    /// Refuses transitions without conditions that form a cycle, or a chain longer than [`MOST_TRANSITIONS`].
    fn check_instants(&self, brain: &Brain) -> Result<(), BrainError> {
        for first in brain.states() {
            let mut way = vec![brain.innermost(first)];
            while let Some(next) = brain.instant_from(way[way.len() - 1]) {
                let next = brain.innermost(next);
                if way.contains(&next) {
                    way.push(next);
                    let way: Vec<&str> = way.iter().map(|state| brain.path(*state)).collect();
                    return Err(brain.error_in(first, BrainProblem::Circle(way.join(" -> "))));
                }
                way.push(next);
                if way.len() > MOST_TRANSITIONS {
                    return Err(brain.error_in(first, BrainProblem::Chain(way.len() - 1)));
                }
            }
        }
        Ok(())
    }

    fn in_state(&self, index: usize, problem: BrainProblem) -> BrainError {
        let state = &self.states[index];
        BrainError::new(state.line, Some(state.path.clone()), problem)
    }

    /// Refuses a mood, or one of the game's own senses, whose name is already taken: no condition could read it.
    fn check_names(&self) -> Result<(), BrainError> {
        let mut known: BTreeSet<&str> = Sense::all().map(Sense::name).collect();
        for name in self.file.moods.keys().chain(&self.file.senses) {
            if !known.insert(name) {
                let (what, name) = ("senses or moods", name.clone());
                return Err(whole(BrainProblem::Twice { what, name }));
            }
        }
        Ok(())
    }
}

impl Brain {
    /// The target of the transition without conditions that leaves this state at once; `None` without such a
    /// transition, or if the state's act has to end first.
    fn instant_from(&self, state: StateId) -> Option<StateId> {
        if self.is_final(state) || self.act(state).is_some_and(super::StateAction::is_whole) {
            return None;
        }
        // The first transition of the highest priority.
        let leaving = self.leaving(state);
        let instant = leaving.filter(|transition| transition.is_instant());
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
    let is_within = (0.0..=1e6).contains(&found);
    check(is_within, what, "from 0 to 1,000,000", found)
}

/// Refuses numbers that are 0, negative, or more than `most`.
pub(super) fn check_above(
    what: &'static str,
    found: f64,
    most: f64,
    range: &'static str,
) -> Result<(), BrainProblem> {
    check(found > 0.0 && found <= most, what, range, found)
}

/// Refuses a number that is not within its range.
pub(crate) fn check(
    is_within: bool,
    what: &'static str,
    range: &'static str,
    found: f64,
) -> Result<(), BrainProblem> {
    if is_within {
        return Ok(());
    }
    Err(BrainProblem::OutOfRange { what, range, found })
}

fn too_many(what: &'static str, found: usize, most: usize) -> BrainProblem {
    BrainProblem::TooMany { what, found, most }
}

impl BrainProblem {
    /// A name that is not among the known names.
    pub(crate) fn unknown<S: AsRef<str>>(
        what: &'static str,
        name: &str,
        known: impl IntoIterator<Item = S>,
    ) -> Self {
        let (name, known) = (name.to_owned(), list(known));
        Self::Unknown { what, name, known }
    }
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
        let line = self.line(state).unwrap_or(0);
        BrainError::new(line, Some(self.path(state).to_owned()), problem)
    }
}

/// An error's text without the line and column at its end; [`BrainError::line`] has the line.
fn without_place(error: &str) -> String {
    let end = error.rfind(" at line ").unwrap_or(error.len());
    error[..end].to_owned()
}
