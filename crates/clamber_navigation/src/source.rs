use std::sync::Arc;

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::{Clip, Skeleton, WeakPoint};

use crate::NavigationError;

/// The creature for which a graph is built. `clamber_gltf::Rig` has most of these fields.
#[derive(Clone, Copy, Debug)]
pub struct GraphSource<'a> {
    /// The skeleton. Distances are measured in its rest pose.
    pub skeleton: &'a Skeleton,
    /// The skin.
    pub mesh: &'a Arc<ColliderMesh>,
    /// The clips that the creature plays.
    pub clips: &'a [Clip],
    /// The rate at which the creature plays its clips, as a share of the file's, from 0.0001 to 10,000: 1 for a
    /// creature of the size for which the clips were made, less for a larger one. A living creature's rate is
    /// `clamber_colossus::Creature::rate`.
    pub rate: f64,
    /// Parts of the skin that can be removed one by one, such as plates of armour. The skin below them is divided into
    /// patches as well. May be empty; a living creature's plates are `clamber_colossus::CreatureKind::plates`.
    pub plates: &'a [Vec<TriangleId>],
    /// The points at which the creature can be wounded.
    pub weak_points: &'a [WeakPoint],
    /// The creature's transform in the world, with its scale.
    pub world_from_model: Similarity,
    /// Height of the ground below the creature, in the world, metres: 0 for most files, whose feet stand at the origin.
    pub ground: f64,
}

/// Allowed rates of clips, as a share of the file's rate.
const RATE_RANGE: std::ops::RangeInclusive<f64> = 1e-4..=1e4;

impl GraphSource<'_> {
    pub(crate) fn check(&self) -> Result<(), NavigationError> {
        if !RATE_RANGE.contains(&self.rate) {
            return Err(NavigationError::OutOfRange {
                name: "rate",
                range: "from 0.0001 to 10,000",
                found: self.rate,
            });
        }
        if self.ground.is_finite() {
            return Ok(());
        }
        Err(NavigationError::OutOfRange {
            name: "ground",
            range: "finite",
            found: self.ground,
        })
    }
}
