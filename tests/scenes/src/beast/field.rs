//! The beast's body as a function of position: negative inside, positive outside, zero on the skin.

use glam::DVec3;

use super::body::Bone;

/// Distance over which two limbs blend into each other, metres.
const MELT: f64 = 1.1;

pub(super) struct Field<'a> {
    bones: &'a [Bone],
}

impl<'a> Field<'a> {
    pub(super) fn new(bones: &'a [Bone]) -> Self {
        Self { bones }
    }

    /// Smooth union of all limbs, by Quilez's polynomial smooth minimum.
    pub(super) fn at(&self, p: DVec3) -> f64 {
        let mut union = f64::INFINITY;
        for bone in self.bones {
            let limb = limb_distance(bone, p);
            let overlap = (MELT - (union - limb).abs()).max(0.0) / MELT;
            union = union.min(limb);
            if overlap > 0.0 {
                union -= overlap * overlap * MELT * 0.25;
            }
        }
        union
    }

    /// Moves a point near the skin onto it, by two Newton steps along the gradient. Each step is at most half of
    /// `reach` long.
    pub(super) fn onto_skin(&self, mut p: DVec3, reach: f64) -> DVec3 {
        let step = reach * 0.05;
        for _ in 0..2 {
            let slope =
                |axis: DVec3| (self.at(p + axis * step) - self.at(p - axis * step)) / (2.0 * step);
            let gradient = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            let steepness = gradient.length_squared();
            if steepness > 0.01 {
                let move_by = gradient * (self.at(p) / steepness);
                p -= move_by.clamp_length_max(reach * 0.5);
            }
        }
        p
    }

    /// Lowest and highest corner of a box around the body, with a margin.
    pub(super) fn bounds(&self) -> (DVec3, DVec3) {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        for bone in self.bones {
            let room = DVec3::splat(bone.radii[0].max(bone.radii[1]) + MELT);
            low = low.min(bone.at.min(bone.tip) - room);
            high = high.max(bone.at.max(bone.tip) + room);
        }
        (low, high)
    }
}

/// Approximate signed distance from the flesh of one bone, a cone with round ends. Infinite without flesh.
pub(super) fn limb_distance(bone: &Bone, p: DVec3) -> f64 {
    if bone.radii == [0.0, 0.0] {
        return f64::INFINITY;
    }
    let along = bone.tip - bone.at;
    let t = ((p - bone.at).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    let radius = bone.radii[0] + (bone.radii[1] - bone.radii[0]) * t;
    (p - (bone.at + along * t)).length() - radius
}
