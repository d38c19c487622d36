/// What a surface is made of, as far as a climber cares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum SurfaceKind {
    /// Bare: can be stood on or slid on.
    #[default]
    Skin,
    /// Fur or vegetation: can be gripped and climbed.
    Fur,
    /// Armour or rock: can be stood on; its edges may be ledges.
    Stone,
}

/// What a triangle is tagged with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SurfaceTag {
    /// Material.
    pub kind: SurfaceKind,
    /// True if its rim may be hung from.
    pub ledge: bool,
    /// The game's own: a material for sounds, a surface id. 0 where none is given; nothing here reads it.
    pub user: u32,
}

impl SurfaceTag {
    /// A material, no ledge, and 0 for the game's own number.
    pub const fn new(kind: SurfaceKind) -> Self {
        Self {
            kind,
            ledge: false,
            user: 0,
        }
    }

    /// The same with a rim that may be hung from.
    #[must_use]
    pub const fn with_ledge(self) -> Self {
        Self {
            ledge: true,
            ..self
        }
    }

    /// The same with another number of the game's own.
    #[must_use]
    pub const fn with_user(self, user: u32) -> Self {
        Self { user, ..self }
    }
}
