/// What a climber is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ClimberMode {
    /// On its feet, carried by what it stands on.
    Standing,
    /// Down what is too steep to stand on.
    Sliding,
    /// Crouched on what it grips, and climbs.
    Holding,
    /// By its hands from a grip that is too unstable to climb: it can only hold on.
    Hanging,
    /// By its hands from a ledge.
    LedgeHanging,
    /// In the air.
    Falling,
    /// Knocked off its feet.
    Tumbling,
    /// A mode of the game's own, by the number of its [`CustomMode`](crate::CustomMode).
    Custom(u16),
}

use ClimberMode::{Custom, Falling, Hanging, Holding, LedgeHanging, Sliding, Standing, Tumbling};

/// Every change between the modes of this crate: from, to, and why. Several may happen in one tick: a climber that lets
/// go of a slope stands, and slips. Modes of a game's own may begin from any mode, and end in any.
pub const TRANSITIONS: &[(ClimberMode, ClimberMode, &str)] = &[
    (Standing, Sliding, "the ground is or becomes too steep"),
    (Standing, Holding, "grips"),
    (Standing, LedgeHanging, "grips a ledge"),
    (
        Standing,
        Falling,
        "jumps, is thrown, is struck by a blow, or the ground ends",
    ),
    (
        Standing,
        Tumbling,
        "a shake, a blow or a landing knocks it down",
    ),
    (Sliding, Standing, "the ground is level enough"),
    (Sliding, Holding, "grips"),
    (Sliding, LedgeHanging, "grips a ledge"),
    (Sliding, Falling, "jumps, or the slope ends"),
    (Sliding, Tumbling, "is struck by a blow"),
    (
        Holding,
        Standing,
        "climbs onto what can be stood on, or lets go there",
    ),
    (
        Holding,
        Hanging,
        "the hold shakes or leans over too far, or a weak blow strikes",
    ),
    (Holding, LedgeHanging, "reaches a ledge"),
    (
        Holding,
        Falling,
        "jumps, lets go, tires, is struck by a blow, or the hold ends",
    ),
    (Holding, Tumbling, "is struck by a blow"),
    (Hanging, Holding, "the hold is calm again"),
    (
        Hanging,
        Falling,
        "lets go, tires, is torn off, is struck by a blow, or the hold ends",
    ),
    (Hanging, Tumbling, "is struck by a blow"),
    (
        LedgeHanging,
        Standing,
        "pulls itself up, or the wall tips to ground",
    ),
    (LedgeHanging, Holding, "climbs down onto what it grips"),
    (
        LedgeHanging,
        Falling,
        "jumps, lets go, tires, is struck by a blow, or the ledge ends, tips or crushes it",
    ),
    (LedgeHanging, Tumbling, "is struck by a blow"),
    (Falling, Standing, "lands"),
    (Falling, Sliding, "lands on what is too steep"),
    (Falling, Holding, "grips"),
    (Falling, LedgeHanging, "catches a ledge"),
    (Falling, Tumbling, "is struck by a blow"),
    (Tumbling, Standing, "lies still on what can be stood on"),
    (Tumbling, Falling, "its configuration knows no tumbling"),
];

impl ClimberMode {
    /// All of this crate's.
    pub const ALL: [Self; 7] = [
        Standing,
        Sliding,
        Holding,
        Hanging,
        LedgeHanging,
        Falling,
        Tumbling,
    ];

    /// It is attached to something that carries it: its state has a support then, and otherwise none. A mode of a game's
    /// own may have a support or not; this says false of it.
    pub const fn is_supported(self) -> bool {
        matches!(self, Standing | Holding | Hanging | LedgeHanging)
    }

    /// It is a mode of a game's own.
    pub const fn is_custom(self) -> bool {
        matches!(self, Custom(_))
    }

    /// A number for each mode, the same in every version: 0 to 6 for this crate's, 65,536 plus its own for a mode of a
    /// game's. For recordings and fingerprints.
    pub const fn number(self) -> u32 {
        match self {
            Falling => 0,
            Standing => 1,
            Sliding => 2,
            Holding => 3,
            Hanging => 4,
            LedgeHanging => 5,
            Tumbling => 6,
            Custom(id) => (1 << 16) + id as u32,
        }
    }

    /// The mode of a [`ClimberMode::number`]; `None` if no mode has it.
    pub fn from_number(number: u32) -> Option<Self> {
        let custom = || {
            number
                .checked_sub(1 << 16)
                .and_then(|id| u16::try_from(id).ok())
        };
        let built_in = Self::ALL.into_iter().find(|mode| mode.number() == number);
        built_in.or_else(|| custom().map(Custom))
    }

    /// It holds on with its hands, which tires.
    pub const fn is_holding(self) -> bool {
        matches!(self, Holding | Hanging | LedgeHanging)
    }

    /// Whether it may stay or become another: what [`TRANSITIONS`] lists, and everything to and from a mode of a game's
    /// own.
    pub fn may_become(self, other: Self) -> bool {
        self == other
            || self.is_custom()
            || other.is_custom()
            || TRANSITIONS
                .iter()
                .any(|(from, to, _)| (*from, *to) == (self, other))
    }
}
