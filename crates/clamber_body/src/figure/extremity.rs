use crate::Side;

/// A hand or a foot of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Extremity {
    /// A hand.
    Hand(Side),
    /// A foot.
    Foot(Side),
}

impl Extremity {
    /// All four: left hand, right hand, left foot, right foot.
    pub const ALL: [Self; 4] = [
        Self::Hand(Side::Left),
        Self::Hand(Side::Right),
        Self::Foot(Side::Left),
        Self::Foot(Side::Right),
    ];

    /// The index in [`Extremity::ALL`].
    pub const fn index(self) -> usize {
        match self {
            Self::Hand(side) => side as usize,
            Self::Foot(side) => 2 + side as usize,
        }
    }

    /// True for hands.
    pub const fn is_hand(self) -> bool {
        matches!(self, Self::Hand(_))
    }
}
