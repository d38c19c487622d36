use clamber_climber::ClimberError;
use clamber_colossus::ColossusError;
use thiserror::Error;

use crate::arena::KindId;

/// Why an arena refuses a call. The arena is unchanged then, unless the variant says otherwise.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ArenaError {
    /// A number of a configuration is outside its range.
    #[error("`{name}` is {found}, and has to be {range}")]
    OutOfRange {
        /// Name of the number.
        name: &'static str,
        /// The valid range.
        range: &'static str,
        /// The invalid value.
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
    /// The number of inputs differs from the number of fighters.
    #[error(
        "{found} inputs were given for {fighters} fighters: give one for each, by ascending number"
    )]
    Inputs {
        /// Fighters in the arena.
        fighters: usize,
        /// Inputs given.
        found: usize,
    },
    /// An input has a number that is not finite.
    #[error("the input of fighter {fighter} has a number that is not finite")]
    InputNotFinite {
        /// The fighter's number ([`FighterId`](crate::FighterId)), which may differ from its position in the list of
        /// inputs.
        fighter: usize,
    },
    /// Two terrains have the same id.
    #[error("two terrains have the id {found}: give each its own")]
    TerrainTwice {
        /// The id.
        found: u64,
    },
    /// A terrain's id is in the range that the arena uses for creatures and fighters.
    #[error("a terrain has the id {found}, which is the arena's: take one below {below}")]
    TerrainId {
        /// The id.
        found: u64,
        /// Smallest id that the arena uses itself.
        below: u64,
    },
    /// A state does not belong to this arena, or is inconsistent. The text gives the reason.
    #[error("this state is of another arena: {0}")]
    OtherArena(&'static str),
    /// Bytes are damaged, or are neither a saved arena nor saved orders.
    #[error("this is not what was saved, or it is damaged: {0}")]
    Damaged(String),
    /// The arena was saved in another version of the format.
    #[error(
        "this arena was saved in version {found} of the format, and this is version {expected}"
    )]
    Version {
        /// The version found.
        found: u32,
        /// The version that this build reads.
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
    /// The arena does not know the kind of a creature.
    #[error(
        "this arena does not know a kind of creature (hash {0:016x}): load its files, unchanged, and give the kind to `Arena::add_kind`", kind.0
    )]
    Kind {
        /// The kind.
        kind: KindId,
    },
    /// A creature or a fighter is added without an order after the arena's first step.
    #[error(
        "this arena was stepped already: let them join by an order, `Order::AddCreature` or `Order::AddFighter`"
    )]
    Begun,
    /// An order cannot be followed.
    #[error("order {index} cannot be followed: {reason}")]
    Order {
        /// Index of the order in the list.
        index: usize,
        /// Why it cannot be followed.
        reason: String,
    },
    /// A climber rejects its configuration, its state, its input or the rules of a step.
    #[error(transparent)]
    Climber(#[from] ClimberError),
    /// A creature cannot be posed, or rejects its configuration or state. If a step returns this, the arena has to be
    /// restored.
    #[error(transparent)]
    Creature(#[from] ColossusError),
}

/// Checks that a number of a configuration is in its range.
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

/// Largest number in a configuration, in the number's own unit. It keeps sums and products of such numbers finite.
const LARGEST_NUMBER: f64 = 1e9;

/// Checks that a number is from 0 to 1e9.
pub(crate) fn not_negative(name: &'static str, found: f64) -> Result<(), ArenaError> {
    within(name, "from 0 to 1e9", found, [0.0, LARGEST_NUMBER])
}

/// Checks that a number is positive and at most 1e9.
pub(crate) fn positive(name: &'static str, found: f64) -> Result<(), ArenaError> {
    within(
        name,
        "positive and at most 1e9",
        found,
        [f64::MIN_POSITIVE, LARGEST_NUMBER],
    )
}
