use clamber_animation::rig::{Palette, Pose, Skeleton};
use clamber_animation::{AnimationSet, Animator, ClipId, Layer, PoseBuffers};
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::skin::skin_into;
use clamber_surface::surface::SurfaceError;
use glam::DVec3;

use super::{Gait, RestSkin};
use crate::error::ColossusError;

/// Where bands of height begin and end, as shares of the height. What is lower belongs to the first one, what is higher
/// to the last.
pub(crate) const EDGES: [f64; BANDS + 1] = [0.08, 0.16, 0.32, 0.56, 0.8, 1.04];
pub(crate) const BANDS: usize = 5;

/// Each clip is looked at in so many phases.
const PHASES: u32 = 16;

/// The room that a kind of creature takes up beside and before its origin in some clips, in model space: a box for each
/// band of height, around the skin in all phases of those clips.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// From low to high. A band without skin has a box without width.
    pub(crate) bands: [Band; BANDS],
}

/// The box of one band: from right to left (X) and from back to front (Z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Band {
    pub(crate) right: f64,
    pub(crate) left: f64,
    pub(crate) back: f64,
    pub(crate) front: f64,
}

/// The room that a kind of creature takes up in its clips of moving, and while it turns on the spot: with its feet where
/// they stand and turn, and not where they walk.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extents {
    pub(crate) on_spot: Extent,
    pub(crate) walking: Extent,
}

impl Extents {
    pub(crate) fn new(
        skeleton: &Skeleton,
        clips: &AnimationSet,
        mesh: &ColliderMesh,
        rest: &RestSkin,
        gait: &Gait,
    ) -> Result<Self, ColossusError> {
        let on_spot = Extent::new(skeleton, clips, mesh, rest, gait.on_spot())?;
        let walk = core::iter::once(gait.walk);
        let walking = on_spot.and(&Extent::new(skeleton, clips, mesh, rest, walk)?);
        // Its body may still swing from its walk.
        let mut bands = walking.bands;
        bands[0] = on_spot.bands[0];
        let on_spot = Extent { bands };
        Ok(Self { on_spot, walking })
    }
}

impl Extent {
    fn new(
        skeleton: &Skeleton,
        clips: &AnimationSet,
        mesh: &ColliderMesh,
        rest: &RestSkin,
        played: impl Iterator<Item = ClipId>,
    ) -> Result<Self, ColossusError> {
        let mut bands = [Band {
            right: 0.0,
            left: 0.0,
            back: 0.0,
            front: 0.0,
        }; BANDS];
        let (mut pose, mut buffers) = (Pose::default(), PoseBuffers::default());
        let (mut palette, mut positions) = (Palette::default(), Vec::new());
        let height = rest.height();
        for id in played {
            let duration = clips.clip(id)?.duration();
            for phase in 0..PHASES {
                let mut layer = Layer::new(id);
                layer.time = duration * f64::from(phase) / f64::from(PHASES);
                Animator::new(vec![layer]).pose_into(clips, &mut pose, &mut buffers)?;
                skeleton.palette_into(&pose, &mut palette)?;
                skin_into(mesh, palette.matrices(), &mut positions).map_err(SurfaceError::from)?;
                for corner in mesh.triangles().iter().flatten() {
                    let place = positions[corner.index()].as_dvec3();
                    let share = place.y / height;
                    bands[band_of(share)].hold(place);
                }
            }
        }
        Ok(Self { bands })
    }
}

impl Extent {
    /// The room of both.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let bands = core::array::from_fn(|index| self.bands[index].and(other.bands[index]));
        Self { bands }
    }

    /// What takes up as much room to both sides as the widest band, and none before and behind: enough to walk along a
    /// way, if it turns where that is wide enough.
    pub(crate) fn slim(&self) -> Self {
        let sides = self.bands.iter().map(|band| band.left.max(-band.right));
        let half = sides.fold(0.0, f64::max);
        let band = Band {
            right: -half,
            left: half,
            back: 0.0,
            front: 0.0,
        };
        Self {
            bands: [band; BANDS],
        }
    }
}

impl Extent {
    /// The room that it needs to turn anywhere: in each band as much to all sides as its corner that is furthest out.
    pub(crate) fn stout(&self) -> Self {
        let bands = self.bands.map(|band| {
            let aside = band.left.max(-band.right);
            let half = libm::hypot(aside, band.front.max(-band.back));
            Band {
                right: -half,
                left: half,
                back: -half,
                front: half,
            }
        });
        Self { bands }
    }

    /// How far its corner that is furthest out is from its origin.
    pub(crate) fn farthest(&self) -> f64 {
        self.stout()
            .bands
            .iter()
            .map(|band| band.left)
            .fold(0.0, f64::max)
    }

    /// Its room as seen looking back.
    pub(crate) fn behind(&self) -> Self {
        let bands = self.bands.map(|band| Band {
            right: -band.left,
            left: -band.right,
            back: -band.front,
            front: -band.back,
        });
        Self { bands }
    }
}

impl Band {
    /// The box around both.
    pub(crate) fn and(self, other: Self) -> Self {
        Self {
            right: self.right.min(other.right),
            left: self.left.max(other.left),
            back: self.back.min(other.back),
            front: self.front.max(other.front),
        }
    }

    fn hold(&mut self, place: DVec3) {
        self.right = self.right.min(place.x);
        self.left = self.left.max(place.x);
        self.back = self.back.min(place.z);
        self.front = self.front.max(place.z);
    }
}

/// The band of a height, as a share of the creature's.
fn band_of(share: f64) -> usize {
    let inner = &EDGES[1..BANDS];
    inner.iter().filter(|edge| share > **edge).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_height_has_a_band() {
        let shares = [-1.0, 0.0, 0.16, 0.17, 0.5, 0.6, 0.9, 3.0, f64::NAN];
        assert_eq!(shares.map(band_of), [0, 0, 0, 1, 2, 3, 4, 4, 0]);
    }
}
