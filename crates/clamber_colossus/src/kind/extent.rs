use clamber_animation::rig::{Palette, Pose, Skeleton};
use clamber_animation::{AnimationSet, Animator, ClipId, Layer, PoseBuffers};
use clamber_surface::mesh::ColliderMesh;
use clamber_surface::skin::skin_into;
use clamber_surface::surface::SurfaceError;
use glam::DVec3;

use super::{Gait, RestSkin};
use crate::error::ColossusError;

/// Edges of the bands of height, as shares of the creature's height. Skin below the first edge belongs to the first
/// band, skin above the last edge to the last one.
pub(crate) const BAND_EDGES: [f64; BAND_COUNT + 1] = [0.08, 0.16, 0.32, 0.56, 0.8, 1.04];
/// Number of bands of height.
pub(crate) const BAND_COUNT: usize = 5;

/// Number of evenly spread times at which a clip is measured.
const MEASURED_PHASES: u32 = 16;

/// The room around its origin that a kind of creature takes up in some clips, in model space. Per band of height it is
/// a box around the origin and the band's skin at all measured times of these clips.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// From low to high. The box of a band without skin has no width.
    pub(crate) bands: [Band; BAND_COUNT],
}

/// The box of one band: from right to left along X, and from back to front along Z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Band {
    pub(crate) right: f64,
    pub(crate) left: f64,
    pub(crate) back: f64,
    pub(crate) front: f64,
}

/// The room that a kind of creature takes up on the spot, and while it walks. On the spot the lowest band holds only
/// the feet in the clips that stand and turn; the other bands hold the walk as well.
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
        // The body may still swing from the walk.
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
        }; BAND_COUNT];
        let (mut pose, mut buffers) = (Pose::default(), PoseBuffers::default());
        let (mut palette, mut positions) = (Palette::default(), Vec::new());
        let height = rest.height();
        for id in played {
            let duration = clips.clip(id)?.duration();
            for phase in 0..MEASURED_PHASES {
                let mut layer = Layer::new(id);
                layer.time = duration * f64::from(phase) / f64::from(MEASURED_PHASES);
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

    /// The union of both rooms.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let bands = core::array::from_fn(|index| self.bands[index].and(other.bands[index]));
        Self { bands }
    }

    /// A room without length that is as wide to both sides as the widest band. It is enough for walking along a path
    /// that has wide places to turn in.
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
            bands: [band; BAND_COUNT],
        }
    }

    /// The room for turning to any heading: per band a square whose half side is the distance of the furthest corner.
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

    /// Distance of the furthest corner from the origin.
    pub(crate) fn farthest(&self) -> f64 {
        self.stout()
            .bands
            .iter()
            .map(|band| band.left)
            .fold(0.0, f64::max)
    }

    /// The same room after half a turn about Y, for going backward.
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

/// The band at a height, which is a share of the creature's height.
fn band_of(share: f64) -> usize {
    let inner = &BAND_EDGES[1..BAND_COUNT];
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
