use clamber_colossus::{Creature, CreatureConfig, CreatureKind};
use clamber_surface::surface::SkinnedSurface;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

use super::fingerprint::hash_of;
use crate::error::ArenaError;

/// Number of a creature in an arena. Creatures are numbered in the order in which they join, and no number is used
/// twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct CreatureId(pub u32);

/// A kind of creature that an arena knows: a hash of its files, which is the same on every machine
/// ([`CreatureKind::fingerprint`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct KindId(pub u64);

/// A creature that has joined.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) id: CreatureId,
    pub(super) kind: KindId,
    pub(super) creature: Creature,
    /// Hash of the number, the kind and the configuration, which never change.
    pub(super) mark: u64,
}

impl Member {
    pub(super) fn new(
        id: CreatureId,
        kind: (KindId, &Arc<CreatureKind>),
        config: CreatureConfig,
    ) -> Result<Self, ArenaError> {
        let creature = Creature::new(Arc::clone(kind.1), config)?;
        Ok(Self {
            id,
            kind: kind.0,
            mark: mark(id, kind.0, &config),
            creature,
        })
    }
}

/// Hash of the constant part of a creature: number, kind and configuration.
pub(super) fn mark(id: CreatureId, kind: KindId, config: &CreatureConfig) -> u64 {
    hash_of(1, &(id, kind, config))
}

/// The skins of creatures, for [`Skins`].
pub(super) fn skins_of(creatures: &[Member]) -> Vec<(CreatureId, &SkinnedSurface)> {
    let skins = creatures.iter();
    skins.map(|one| (one.id, one.creature.surface())).collect()
}

/// The skins of all creatures, by ascending number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Skins<'a>(pub(crate) &'a [(CreatureId, &'a SkinnedSurface)]);

impl<'a> Skins<'a> {
    pub(crate) fn iter(self) -> impl Iterator<Item = (CreatureId, &'a SkinnedSurface)> {
        self.0.iter().copied()
    }

    pub(crate) fn get(self, creature: CreatureId) -> Option<&'a SkinnedSurface> {
        let found = self.0.binary_search_by_key(&creature, |one| one.0).ok()?;
        Some(self.0.get(found)?.1)
    }
}
