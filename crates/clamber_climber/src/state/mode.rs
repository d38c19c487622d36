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
}

use ClimberMode::{Falling, Hanging, Holding, LedgeHanging, Sliding, Standing, Tumbling};

/// Every change of mode that there is: from, to, and why. Two may happen in one tick: who lets go of a slope stands, and
/// slips.
pub const TRANSITIONS: &[(ClimberMode, ClimberMode, &str)] = &[
    (Standing, Sliding, "the ground is or becomes too steep"),
    (Standing, Holding, "grips"),
    (Standing, LedgeHanging, "grips a ledge"),
    (Standing, Falling, "jumps, is thrown, or the ground ends"),
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
    (Holding, Hanging, "the hold shakes or leans over too far"),
    (Holding, LedgeHanging, "reaches a ledge"),
    (Holding, Falling, "jumps, lets go, tires, or the hold ends"),
    (Holding, Tumbling, "is struck by a blow"),
    (Hanging, Holding, "the hold is calm again"),
    (
        Hanging,
        Falling,
        "lets go, tires, is torn off, or the hold ends",
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
        "jumps, lets go, tires, or the ledge ends, tips or crushes it",
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
    /// All of them.
    pub const ALL: [Self; 7] = [
        Standing,
        Sliding,
        Holding,
        Hanging,
        LedgeHanging,
        Falling,
        Tumbling,
    ];

    /// It is attached to something that carries it: its state has a support then, and else none.
    pub const fn is_supported(self) -> bool {
        matches!(self, Standing | Holding | Hanging | LedgeHanging)
    }

    /// It holds on with its hands, which tires.
    pub const fn is_holding(self) -> bool {
        matches!(self, Holding | Hanging | LedgeHanging)
    }

    /// Whether [`TRANSITIONS`] lets it become another, or stay.
    pub fn may_become(self, other: Self) -> bool {
        self == other
            || TRANSITIONS
                .iter()
                .any(|(from, to, _)| (*from, *to) == (self, other))
    }
}
