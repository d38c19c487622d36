/// How a character behaves when it runs into the side of another one. In each case, characters can stand on each other,
/// no character is pressed through a wall, and overlapping characters move apart by their masses.
///
/// Pass wins over block, and block over push, for both characters ([`Others::between`]):
///
/// | | block | push | pass |
/// |---|---|---|---|
/// | **block** | block | block | pass |
/// | **push** | block | push | pass |
/// | **pass** | pass | pass | pass |
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub enum Others {
    /// The character stops.
    #[default]
    Block,
    /// The character pushes and is pushed: both go on at the common velocity that their masses give. They overlap by
    /// the way that each would make against the other in a tick, at most by three quarters of the smaller radius.
    Push,
    /// The character goes through the other one. Two characters that stand still in each other part softly.
    Pass,
}

impl Others {
    /// The behaviour of two characters towards each other.
    #[must_use]
    pub fn between(self, other: Self) -> Self {
        match (self, other) {
            (Self::Pass, _) | (_, Self::Pass) => Self::Pass,
            (Self::Block, _) | (_, Self::Block) => Self::Block,
            (Self::Push, Self::Push) => Self::Push,
        }
    }
}

impl core::fmt::Display for Others {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Block => "block",
            Self::Push => "push",
            Self::Pass => "pass",
        })
    }
}

/// The error for a text that is no name of [`Others`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OthersError;

impl core::fmt::Display for OthersError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("expected block, push or pass")
    }
}

impl core::error::Error for OthersError {}

impl core::str::FromStr for Others {
    type Err = OthersError;

    fn from_str(text: &str) -> Result<Self, OthersError> {
        let all = [Self::Block, Self::Push, Self::Pass];
        let known = all.into_iter().find(|one| one.to_string() == text);
        known.ok_or(OthersError)
    }
}
