use std::sync::Arc;

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::{Clip, Skeleton, WeakPoint};

use crate::NavigationError;

/// A creature, as a file brings it: `clamber_gltf::Rig` has these fields.
#[derive(Clone, Copy, Debug)]
pub struct GraphSource<'a> {
    /// The skeleton. Its rest pose is the one in which distances are measured.
    pub skeleton: &'a Skeleton,
    /// The skin.
    pub mesh: &'a Arc<ColliderMesh>,
    /// What it moves by.
    pub clips: &'a [Clip],
    /// How fast it plays its clips, as a share of what its file says, from 0.0001 to 10,000: 1 for a creature of the
    /// size for which it was made, less for a larger one. Of a living creature it is
    /// `clamber_colossus::Creature::rate`.
    pub rate: f64,
    /// Parts of the skin that can be removed one by one, such as plates of armour: the skin below them is divided as
    /// well. None is a good answer; those of a living creature are `clamber_colossus::CreatureKind::plates`.
    pub plates: &'a [Vec<TriangleId>],
    /// Where it can be wounded.
    pub weak_points: &'a [WeakPoint],
    /// Where it stands, and how large it is.
    pub world_from_model: Similarity,
    /// Height of the ground that it stands on, in the world, metres: 0 for most files, whose feet stand at the origin.
    pub ground: f64,
}

/// How fast clips may be played.
const RATES: std::ops::RangeInclusive<f64> = 1e-4..=1e4;

impl GraphSource<'_> {
    pub(crate) fn check(&self) -> Result<(), NavigationError> {
        if !RATES.contains(&self.rate) {
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
