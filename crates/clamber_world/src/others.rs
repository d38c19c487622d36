/// What a character does where it comes into the side of another one. Whatever it is, characters stand on each other,
/// nobody is pressed through a wall, and those that overlap part by their masses.
///
/// Of two, what is softer to both counts ([`Others::between`]):
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
    /// It stops.
    #[default]
    Block,
    /// It pushes, and is pushed: two that meet go on at the common velocity that their masses give. They overlap by
    /// what they would have made against each other in a tick, at most by three quarters of the smaller radius.
    Push,
    /// It goes through. Two that stand still in each other part softly.
    Pass,
}

impl Others {
    /// What two characters do with each other.
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

/// A text that names none of [`Others`].
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
