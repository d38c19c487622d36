use clamber_climber::ClimberError;
use clamber_colossus::ColossusError;
use thiserror::Error;

use crate::arena::KindId;

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
        "{found} inputs were given for {fighters} fighters: give one for each, by ascending number"
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
    /// What was read is not a saved arena, or orders that were written, or it is damaged.
    #[error("this is not what was saved, or it is damaged: {0}")]
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
    /// The arena was saved with another configuration.
    #[error(
        "this arena was saved with another `ArenaConfig` (hash {found:016x}, and here it is {expected:016x}): make the arena with the one that it was saved with"
    )]
    Config {
        /// The hash found.
        found: u64,
        /// The hash of this arena.
        expected: u64,
    },
    /// A creature is of a kind that the arena does not know.
    #[error(
        "this arena does not know a kind of creature (hash {0:016x}): load its files, unchanged, and give the kind to `Arena::add_kind`", kind.0
    )]
    Kind {
        /// The kind.
        kind: KindId,
    },
    /// Somebody joins an arena that was stepped already.
    #[error(
        "this arena was stepped already: let them join by an order, `Order::AddCreature` or `Order::AddFighter`"
    )]
    Begun,
    /// An order is none that can be followed.
    #[error("order {index} cannot be followed: {reason}")]
    Order {
        /// Its index in the list.
        index: usize,
        /// What is wrong with it.
        reason: String,
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

/// Numbers of configurations are no larger than this: sums and products of them are finite.
const MOST: f64 = 1e9;

/// Checks that a number is not negative, and not too large.
pub(crate) fn not_negative(name: &'static str, found: f64) -> Result<(), ArenaError> {
    within(name, "from 0 to 1e9", found, [0.0, MOST])
}

/// Checks that a number is positive, and not too large.
pub(crate) fn positive(name: &'static str, found: f64) -> Result<(), ArenaError> {
    within(
        name,
        "positive and at most 1e9",
        found,
        [f64::MIN_POSITIVE, MOST],
    )
}
