/// How a creature got from one pose to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PoseMotion {
    /// It moved there: [`SkinnedSurface::advance`](crate::surface::SkinnedSurface::advance).
    #[default]
    Moved,
    /// It was teleported there, or nobody knows how it moved. That is no motion:
    /// [`SkinnedSurface::place`](crate::surface::SkinnedSurface::place).
    Placed,
}

impl PoseMotion {
    /// Two motions, one after the other: placed if either is.
    pub(super) fn and(self, other: Self) -> Self {
        if other == Self::Placed { other } else { self }
    }
}
