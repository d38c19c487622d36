use std::fmt;

use thiserror::Error;

/// Why a brain was refused, and where in its file.
#[derive(Clone, Debug, Error, PartialEq)]
pub struct BrainError {
    /// The line of the file, from 1; `None` for a brain that was not read from a text, or where no line is at fault.
    pub line: Option<usize>,
    /// The state, with those around it, such as `calm/idle`; `None` if no state is at fault.
    pub state: Option<String>,
    /// What is wrong.
    pub problem: Box<BrainProblem>,
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

/// What can be wrong with a brain.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BrainProblem {
    /// The text is no brain file in JSON.
    #[error("{0}")]
    Text(String),
    /// A name that the file, the creature or this library does not know.
    #[error("there is no {what} `{name}`; there is {known}")]
    Unknown {
        /// What was looked for: a state, a clip, a joint.
        what: &'static str,
        /// The name.
        name: String,
        /// Those that there are.
        known: String,
    },
    /// A name that stands twice.
    #[error("there are two {what} `{name}`")]
    Twice {
        /// What has that name.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A condition that cannot be read.
    #[error("the condition {text:?} {fault}")]
    Condition {
        /// The condition.
        text: String,
        /// What is wrong with it.
        fault: String,
    },
    /// A number out of its range.
    #[error("`{what}` is {found}, which is not {range}")]
    OutOfRange {
        /// The number's name in the file.
        what: &'static str,
        /// The range that it must be in.
        range: &'static str,
        /// The number.
        found: f64,
    },
    /// A height cannot be given to a skin without one.
    #[error("`{what}` is given, but at rest the skin has no height")]
    NoHeight {
        /// The number's name in the file.
        what: &'static str,
    },
    /// Transitions without conditions that lead from state to state in a circle.
    #[error("it leads back to itself at once, by {0}")]
    Circle(String),
    /// More transitions without conditions one after the other than a tick takes.
    #[error("it is left at once, and so are the next {0} states: at most {most} transitions may follow each other in a tick", most = super::MOST_TRANSITIONS)]
    Chain(usize),
    /// A state that is never left has transitions, or states inside it.
    #[error("it is final, so it can have neither transitions nor states inside it")]
    FinalState,
    /// A state with others inside it has an act of its own, or none of them is its start.
    #[error("it has states inside it, so it needs a `start`, and has no `act` of its own")]
    Composite,
    /// A state without others inside it has a start.
    #[error("it has no states inside it, so it has no `start`")]
    Leaf,
    /// More than a brain may have.
    #[error("there are {found} {what}; a brain has at most {most}")]
    TooMany {
        /// What there is too much of.
        what: &'static str,
        /// How many.
        found: usize,
        /// How many there may be.
        most: usize,
    },
    /// Joints of a leg or of the head that cannot be moved by inverse kinematics.
    #[error("the {limb} of {joints} cannot be moved: {fault}")]
    Limb {
        /// The leg or the head.
        limb: &'static str,
        /// Its joints, in the order of the file.
        joints: String,
        /// Why they cannot be moved.
        fault: String,
    },
    /// A walk's `strike` names a clip with which no state attacks.
    #[error("`strike` names the clip `{clip}`, and no state attacks with that")]
    NoAttack {
        /// The clip.
        clip: String,
    },
    /// An act needs a gait, and the body has none.
    #[error("it walks or turns, and `body` has no `gait`")]
    NoGait,
    /// A clip of an attack lacks a marker, or has them in another order.
    #[error("the clip `{clip}` of an attack needs the markers `active` and, later, `recovery`")]
    Phases {
        /// The clip.
        clip: String,
    },
}
