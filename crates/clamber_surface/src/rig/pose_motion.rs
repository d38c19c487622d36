/// The motion of a creature from one pose to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum PoseMotion {
    /// The creature moved there: pose the surface by
    /// [`SkinnedSurface::advance`](crate::surface::SkinnedSurface::advance).
    #[default]
    Moved,
    /// The creature was teleported there, or its motion is not known: pose the surface by
    /// [`SkinnedSurface::teleport`](crate::surface::SkinnedSurface::teleport), without motion.
    Teleported,
}

impl PoseMotion {
    /// Two motions, one after the other: `Teleported` if either is.
    pub(super) fn and(self, other: Self) -> Self {
        if other == Self::Teleported {
            other
        } else {
            self
        }
    }
}
