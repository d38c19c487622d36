use clamber_surface::mesh::{SurfaceKind, SurfaceTag};

use crate::Creature;

/// Which skin of a creature can be gripped: fur and stone, or all of it if it has no fur.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grips {
    has_fur: bool,
}

impl Grips {
    pub(super) fn of(creature: &Creature) -> Self {
        let mut tags = creature.collider.tags().iter();
        Self {
            has_fur: tags.any(|tag| tag.kind == SurfaceKind::Fur),
        }
    }

    pub(super) fn can(self, tag: &SurfaceTag) -> bool {
        !self.has_fur || matches!(tag.kind, SurfaceKind::Fur | SurfaceKind::Stone)
    }
}
