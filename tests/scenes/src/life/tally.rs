use std::fmt;

use clamber_colossus::Brain;
use clamber_colossus::brain::StateId;

use super::{TICK, attacks};

/// A state is seen as lasting for ever after so many seconds.
const FOR_EVER: f64 = 180.0;

/// The most gap or depth of a settled foot, as a share of its length.
const MOST_GAP: f64 = 0.01;

/// What was seen of a state.
#[derive(Clone, Debug, Default)]
pub struct StateLine {
    /// Its name, with those of the states around it.
    pub name: String,
    /// True if it attacks.
    pub attacks: bool,
    /// True if it is never left.
    pub is_final: bool,
    /// How often it was entered.
    pub entered: u32,
    /// Seconds spent in it.
    pub seconds: f64,
    /// The most seconds at once.
    pub longest: f64,
    /// People whom it struck.
    pub blows: u32,
}

/// What was seen of a life.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The states without others inside them, in the brain's order.
    pub states: Vec<StateLine>,
    /// Of each state of the brain, its index in `states`.
    lines: Vec<Option<usize>>,
    /// Ticks so far.
    pub ticks: u64,
    /// Giants that died.
    pub lives: u32,
    /// Damage to weak points.
    pub damage: f64,
    /// People who died or were lost.
    pub fallen: u32,
    /// How often riders got on.
    pub mounted: u32,
    /// How often riders got off.
    pub thrown: u32,
    /// The most gap below a settled foot, as a share of its length.
    pub gap: f64,
    /// The most depth of a settled foot in the ground, as a share of its length.
    pub depth: f64,
    /// How often feet were looked at.
    pub looks: u64,
    current: f64,
}

impl Tally {
    pub(super) fn new(brain: &Brain) -> Self {
        let mut tally = Self {
            lines: vec![None; brain.len()],
            ..Self::default()
        };
        for state in brain.states() {
            let has_inner = brain
                .states()
                .any(|other| other != state && brain.is_within(other, state));
            if has_inner {
                continue;
            }
            tally.lines[state.index()] = Some(tally.states.len());
            tally.states.push(StateLine {
                name: brain.path(state).to_owned(),
                attacks: attacks(brain, state),
                is_final: brain.is_final(state),
                ..StateLine::default()
            });
        }
        tally
    }

    fn line(&mut self, state: StateId) -> Option<&mut StateLine> {
        let index = self.lines.get(state.index()).copied().flatten()?;
        self.states.get_mut(index)
    }

    pub(super) fn enter(&mut self, state: StateId) {
        self.current = 0.0;
        if let Some(line) = self.line(state) {
            line.entered += 1;
        }
    }

    pub(super) fn born(&mut self) {
        self.current = 0.0;
    }

    pub(super) fn blow(&mut self, state: StateId) {
        if let Some(line) = self.line(state) {
            line.blows += 1;
        }
    }

    pub(super) fn tick(&mut self, state: StateId) {
        self.ticks += 1;
        self.current += TICK;
        let current = self.current;
        if let Some(line) = self.line(state) {
            line.seconds += TICK;
            line.longest = line.longest.max(current);
        }
    }

    pub(super) fn ride(&mut self, before: bool, after: bool) {
        self.mounted += u32::from(!before && after);
        self.thrown += u32::from(before && !after);
    }

    pub(super) fn foot(&mut self, clearance: f64) {
        self.looks += 1;
        self.gap = self.gap.max(clearance);
        self.depth = self.depth.max(-clearance);
    }

    /// What is wrong: states that were never seen or never left, feet that do not stand. Empty if all is well. A life
    /// of less than half an hour need not have seen everything.
    pub fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        let is_long = self.ticks as f64 * TICK >= 1_800.0;
        for line in &self.states {
            if is_long && line.entered == 0 && line.seconds == 0.0 {
                faults.push(format!("`{}` was never entered", line.name));
            }
            if line.longest > FOR_EVER && !line.is_final {
                let name = &line.name;
                faults.push(format!("`{name}` lasted for {:.0} s", line.longest));
            }
        }
        for (what, share) in [("above", self.gap), ("in", self.depth)] {
            if share > MOST_GAP {
                let share = 100.0 * share;
                faults.push(format!(
                    "a foot stood {share:.2} % of its length {what} the ground"
                ));
            }
        }
        if self.looks == 0 {
            faults.push("no foot was looked at".into());
        }
        faults
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<28} {:>7} {:>9} {:>9} {:>6}",
            "state", "entered", "seconds", "longest", "blows"
        )?;
        for line in &self.states {
            write!(
                f,
                "{:<28} {:>7} {:>9.1} {:>9.1}",
                line.name, line.entered, line.seconds, line.longest
            )?;
            if line.attacks {
                write!(f, " {:>6}", line.blows)?;
            }
            writeln!(f)?;
        }
        writeln!(
            f,
            "\n{} ticks; {} giants died; {:.1} hit points of weak points; people got on it {} times, off it {} times, and \
             {} died or were lost",
            self.ticks, self.lives, self.damage, self.mounted, self.thrown, self.fallen
        )?;
        writeln!(
            f,
            "feet that stand, of their length: at most {:.3} % above the ground and {:.3} % in it, in {} looks",
            100.0 * self.gap,
            100.0 * self.depth,
            self.looks
        )
    }
}
