/// The activity of a climber: one of seven modes of this crate, or a custom mode of the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub enum ClimberMode {
    /// Stands or walks, carried by its ground.
    Standing,
    /// Slides down ground that is too steep to stand on.
    Sliding,
    /// Grips a point of an obstacle, its hold, and can climb along the surface. The body is crouched.
    Holding,
    /// Hangs by its hands from a grip that shakes or leans over too far to climb on, or swings after a blow. It can
    /// only hold on or let go.
    Hanging,
    /// Hangs by its hands from a ledge.
    LedgeHanging,
    /// In the air, falling or jumping.
    Falling,
    /// Knocked over: falls, bounces, slides or lies, and ignores input. It gets up by itself after
    /// [`TumbleConfig::recover_time`](crate::TumbleConfig::recover_time) at rest on ground.
    Tumbling,
    /// A mode of the game's own, with the id of its [`CustomMode`](crate::CustomMode).
    Custom(u16),
}

use ClimberMode::{Custom, Falling, Hanging, Holding, LedgeHanging, Sliding, Standing, Tumbling};

/// Every change between the modes of this crate: from, to, and the reason.
///
/// Several changes may happen in one tick: a climber that lets go on a slope stands, then slips. Custom modes may begin
/// in any mode and end in any mode.
pub const TRANSITIONS: &[(ClimberMode, ClimberMode, &str)] = &[
    (
        Standing,
        Sliding,
        "the ground is or becomes too steep, or the rule refuses it",
    ),
    (Standing, Holding, "grips"),
    (
        Standing,
        LedgeHanging,
        "grips a ledge, or the edge that it steps off",
    ),
    (
        Standing,
        Falling,
        "jumps, is thrown, is struck by a blow, or the ground ends or lets it through",
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
        "climbs onto ground that can be stood on, or lets go there",
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
        "jumps, lets go, tires, is struck by a blow, or the hold ends or is refused",
    ),
    (Holding, Tumbling, "is struck by a blow"),
    (Hanging, Holding, "the hold is calm again"),
    (
        Hanging,
        Falling,
        "lets go, tires, is torn off, is struck by a blow, or the hold ends or is refused",
    ),
    (Hanging, Tumbling, "is struck by a blow"),
    (
        LedgeHanging,
        Standing,
        "pulls itself up, or the wall tips and becomes ground",
    ),
    (LedgeHanging, Holding, "climbs down and grips the wall"),
    (
        LedgeHanging,
        Falling,
        "jumps, lets go, tires, is struck by a blow, or the ledge ends, tips, is refused or crushes it",
    ),
    (LedgeHanging, Tumbling, "is struck by a blow"),
    (Falling, Standing, "lands"),
    (
        Falling,
        Sliding,
        "lands on ground that is too steep, or that the rule refuses",
    ),
    (Falling, Holding, "grips"),
    (Falling, LedgeHanging, "catches a ledge"),
    (Falling, Tumbling, "is struck by a blow"),
    (
        Tumbling,
        Standing,
        "has lain still on ground that can be stood on",
    ),
    (Tumbling, Falling, "`ClimberConfig::tumble` is `None`"),
];

impl ClimberMode {
    /// All modes of this crate, without custom modes.
    pub const ALL: [Self; 7] = [
        Standing,
        Sliding,
        Holding,
        Hanging,
        LedgeHanging,
        Falling,
        Tumbling,
    ];

    /// True for the modes in which a support carries the climber:
    /// [`ClimberState::support`](crate::ClimberState::support) is `Some` in these, and `None` in the other modes of
    /// this crate. False for custom modes, which may have a support or not.
    pub const fn is_supported(self) -> bool {
        matches!(self, Standing | Holding | Hanging | LedgeHanging)
    }

    /// True for a custom mode.
    pub const fn is_custom(self) -> bool {
        matches!(self, Custom(_))
    }

    /// A number for each mode, the same in every version of this crate, for recordings and fingerprints. 0 to 6 for
    /// this crate's modes, 65,536 plus its id for a custom mode.
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

    /// The mode with a [`ClimberMode::number`]; `None` if no mode has this number.
    pub fn from_number(number: u32) -> Option<Self> {
        let custom = || {
            number
                .checked_sub(1 << 16)
                .and_then(|id| u16::try_from(id).ok())
        };
        let built_in = Self::ALL.into_iter().find(|mode| mode.number() == number);
        built_in.or_else(|| custom().map(Custom))
    }

    /// True for the modes in which the climber holds on with its hands, which costs stamina.
    pub const fn is_holding(self) -> bool {
        matches!(self, Holding | Hanging | LedgeHanging)
    }

    /// True if one change can lead from this mode to `other`, or `other` is the same mode. The changes are those that
    /// [`TRANSITIONS`] lists, and every change to or from a custom mode. A tick can make several changes, so it may be
    /// false for the modes at the ends of two successive ticks.
    pub fn may_become(self, other: Self) -> bool {
        self == other
            || self.is_custom()
            || other.is_custom()
            || TRANSITIONS
                .iter()
                .any(|(from, to, _)| (*from, *to) == (self, other))
    }
}
