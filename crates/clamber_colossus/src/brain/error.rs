use std::fmt;

use thiserror::Error;

/// Why a brain was refused, and where in its file: the line and the state, as far as they are known.
#[derive(Clone, Debug, Error, PartialEq)]
pub struct BrainError {
    /// The line of the file, from 1; `None` for a brain that was not read from text, or if no single line is at fault.
    pub line: Option<usize>,
    /// The path of the state at fault, such as `calm/idle`; `None` if no state is at fault.
    pub state: Option<String>,
    /// The fault itself.
    pub problem: Box<BrainProblem>,
}

impl BrainError {
    /// An error on a line, or on none if `line` is 0.
    pub(crate) fn new(line: usize, state: Option<String>, problem: BrainProblem) -> Self {
        Self {
            line: (line > 0).then_some(line),
            state,
            problem: Box::new(problem),
        }
    }
}

/// An error of the whole brain, without a state and a line.
pub(crate) fn whole(problem: BrainProblem) -> BrainError {
    BrainError::new(0, None, problem)
}

impl fmt::Display for BrainError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        if let Some(state) = &self.state {
            write!(f, "state `{state}`: ")?;
        }
        write!(f, "{}", self.problem)
    }
}

/// A fault of a brain.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BrainProblem {
    /// A text that is not a valid brain file.
    #[error("{0}")]
    Text(String),
    /// A name that is unknown to the file, the creature or this library.
    #[error("there is no {what} `{name}`; there is {known}")]
    Unknown {
        /// The kind of the name: a state, a clip, a joint.
        what: &'static str,
        /// The unknown name.
        name: String,
        /// The list of known names.
        known: String,
    },
    /// A name that is used twice.
    #[error("there are two {what} `{name}`")]
    Twice {
        /// The kind of the name, in the plural.
        what: &'static str,
        /// The repeated name.
        name: String,
    },
    /// A condition that cannot be read.
    #[error("the condition {text:?} {fault}")]
    Condition {
        /// The condition's text.
        text: String,
        /// Why it cannot be read.
        fault: String,
    },
    /// A number that is out of its range.
    #[error("`{what}` is {found}, which is not {range}")]
    OutOfRange {
        /// The number's name in the file.
        what: &'static str,
        /// The allowed range.
        range: &'static str,
        /// The number found.
        found: f64,
    },
    /// A height for a creature whose skin has no height at rest.
    #[error("`{what}` is given, but at rest the skin has no height")]
    NoHeight {
        /// The number's name in the file.
        what: &'static str,
    },
    /// A cycle of transitions without conditions.
    #[error("it leads back to itself at once, by {0}")]
    Circle(String),
    /// A chain of transitions without conditions that is longer than a tick allows.
    #[error("it is left at once, and so are the next {0} states: at most {most} transitions may follow each other in a tick", most = super::MOST_TRANSITIONS)]
    Chain(usize),
    /// A final state with transitions or inner states.
    #[error("it is final, so it can have neither transitions nor states inside it")]
    FinalState,
    /// A state with inner states that has an act of its own, or no start.
    #[error("it has states inside it, so it needs a `start`, and has no `act` of its own")]
    Composite,
    /// A state without inner states that has a start.
    #[error("it has no states inside it, so it has no `start`")]
    Leaf,
    /// A brain with too many states, moods or regions, or with states that are nested too deeply.
    #[error("there are {found} {what}; a brain has at most {most}")]
    TooMany {
        /// The things that are too many, in the plural.
        what: &'static str,
        /// Their number.
        found: usize,
        /// The largest number allowed.
        most: usize,
    },
    /// Joints of a leg or of the head that inverse kinematics cannot move.
    #[error("the {limb} of {joints} cannot be moved: {fault}")]
    Limb {
        /// The limb: a leg or the head.
        limb: &'static str,
        /// The limb's joints, in the order of the file.
        joints: String,
        /// Why they cannot be moved.
        fault: String,
    },
    /// A walk's `strike` names a clip that no attack plays.
    #[error("`strike` names the clip `{clip}`, and no state attacks with that")]
    NoAttack {
        /// The clip.
        clip: String,
    },
    /// A walk or a turn of a body without a gait.
    #[error("it walks or turns, and `body` has no `gait`")]
    NoGait,
    /// The clip of an attack that lacks a marker, or whose markers are in the wrong order.
    #[error("the clip `{clip}` of an attack needs the markers `active` and, later, `recovery`")]
    Phases {
        /// The clip.
        clip: String,
    },
}
