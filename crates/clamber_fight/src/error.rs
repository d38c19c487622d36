use clamber_climber::ClimberError;
use clamber_colossus::ColossusError;
use thiserror::Error;

/// Why an arena refuses something. It is unchanged then, if not said otherwise.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ArenaError {
    /// A number of a configuration is outside its range.
    #[error("`{name}` is {found}, and has to be {range}")]
    OutOfRange {
        /// The number.
        name: &'static str,
        /// What it may be.
        range: &'static str,
        /// What it is.
        found: f64,
    },
    /// The brain of a creature was made for another tick.
    #[error(
        "this creature's brain was made for ticks of {creature} s, and the arena's are {arena} s: give `Brain::from_json` the arena's tick"
    )]
    Tick {
        /// Tick of the creature, seconds.
        creature: f64,
        /// Tick of the arena, seconds.
        arena: f64,
    },
    /// There is not one input for each fighter.
    #[error(
        "{found} inputs were given for {fighters} fighters: give one for each, in the order in which they were added"
    )]
    Inputs {
        /// Fighters in the arena.
        fighters: usize,
        /// Inputs given.
        found: usize,
    },
    /// An input holds a blow.
    #[error("the input of fighter {fighter} holds a blow; the arena deals the blows itself")]
    Blow {
        /// The fighter, by its number.
        fighter: usize,
    },
    /// An input has a number that is not finite.
    #[error("the input of fighter {fighter} has a number that is not finite")]
    InputNotFinite {
        /// The fighter, by its number.
        fighter: usize,
    },
    /// Two terrains have the same id.
    #[error("two terrains have the id {found}: give each its own")]
    TerrainTwice {
        /// The id.
        found: u64,
    },
    /// A terrain's id is one of those that the arena gives to creatures and fighters.
    #[error("a terrain has the id {found}, which is the arena's: take one below {below}")]
    TerrainId {
        /// The id.
        found: u64,
        /// Where the arena's ids begin.
        below: u64,
    },
    /// A state is of another arena.
    #[error("this state is of another arena: {0}")]
    OtherArena(&'static str),
    /// What was read is not a saved arena, or it is damaged.
    #[error("this is not a saved arena, or it is damaged: {0}")]
    Damaged(String),
    /// The arena was saved by another version.
    #[error(
        "this arena was saved in version {found} of the format, and this is version {expected}"
    )]
    Version {
        /// The version found.
        found: u32,
        /// The version that can be read.
        expected: u32,
    },
    /// The arena was saved with other creatures or configurations.
    #[error(
        "this arena was saved with other creatures, brains, fighters or configurations (hash {found:016x}, and here it is {expected:016x}): load the files that it was saved with, and add the same creatures and fighters in the same order"
    )]
    Assets {
        /// The hash found.
        found: u64,
        /// The hash of this arena.
        expected: u64,
    },
    /// A climber refuses its configuration, its state or its input.
    #[error(transparent)]
    Climber(#[from] ClimberError),
    /// A creature cannot be posed, or refuses its state. After a failed step the arena has to be restored.
    #[error(transparent)]
    Creature(#[from] ColossusError),
}

/// Checks a number of a configuration.
pub(crate) fn within(
    name: &'static str,
    range: &'static str,
    found: f64,
    [least, most]: [f64; 2],
) -> Result<(), ArenaError> {
    if (least..=most).contains(&found) {
        Ok(())
    } else {
        Err(ArenaError::OutOfRange { name, range, found })
    }
}

/// Checks that a number is not negative, and finite.
pub(crate) fn not_negative(name: &'static str, found: f64) -> Result<(), ArenaError> {
    within(name, "not negative and finite", found, [0.0, f64::MAX])
}

/// Checks that a number is positive, and finite.
pub(crate) fn positive(name: &'static str, found: f64) -> Result<(), ArenaError> {
    within(
        name,
        "positive and finite",
        found,
        [f64::MIN_POSITIVE, f64::MAX],
    )
}
