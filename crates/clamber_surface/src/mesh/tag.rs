/// The material of a surface, as far as climbing depends on it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub enum SurfaceKind {
    /// Bare skin: a climber can stand or slide on it.
    #[default]
    Skin,
    /// Fur or vegetation: a climber can grip and climb it.
    Fur,
    /// Armour or rock: a climber can stand on it, and by default cannot grip it. As on every material, a climber can
    /// hang from an edge that has the shape of a ledge.
    Stone,
}

/// The tag of a triangle: its material, and data for the game.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct SurfaceTag {
    /// The material.
    pub kind: SurfaceKind,
    /// A number for the game, such as a sound material or a surface id. 0 by default. This crate does not read it;
    /// plates of a `clamber_colossus` brain and the game's rules do.
    pub user: u32,
}

impl SurfaceTag {
    /// A tag with this material, and with `user` 0.
    pub const fn new(kind: SurfaceKind) -> Self {
        Self { kind, user: 0 }
    }

    /// The same tag with another `user` number.
    #[must_use]
    pub const fn with_user(self, user: u32) -> Self {
        Self { user, ..self }
    }
}
