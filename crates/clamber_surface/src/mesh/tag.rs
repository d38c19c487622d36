/// What a surface is made of, as far as a climber cares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
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
pub struct SurfaceTag {
    /// Material.
    pub kind: SurfaceKind,
    /// True if its rim may be hung from.
    pub ledge: bool,
}
