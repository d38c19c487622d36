//! A hash of all that does not change.

use clamber_colossus::{CreatureConfig, CreatureKind};
use glam::DVec3;

use super::ArenaConfig;
use super::fingerprint::hash_of;
use crate::fighter::FighterConfig;

pub(super) fn of_arena(config: &ArenaConfig) -> u64 {
    hash_of(0xcbf2_9ce4_8422_2325, config)
}

pub(super) fn with_creature(hash: u64, kind: &CreatureKind, config: &CreatureConfig) -> u64 {
    hash_of(hash, &(kind.fingerprint(), config))
}

pub(super) fn with_fighter(hash: u64, config: &FighterConfig, spawn: DVec3) -> u64 {
    hash_of(hash, &(config, spawn))
}
