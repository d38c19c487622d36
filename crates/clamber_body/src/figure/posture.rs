//! Measures from the clips, once, where hands and feet touch walls and ledges.

use clamber_animation::{AnimationError, AnimationSet, joint_in_model};
use clamber_surface::rig::{Clip, Playback, Pose, Skeleton};
use glam::DVec3;

use super::{BodyClip, Clips, LimbShape};
use crate::Humanoid;

/// Height of the hips while standing, as a share of the leg's length. The value is the hero's, for a clip in which the
/// hips' joint is not found.
const HIPS_HEIGHT: f64 = 0.97;

/// Hands on a wall: distance from the middle and height, as shares of the leg's length. The value is the hero's, for a
/// figure without the clip `climb`.
const HANDS_ON_WALL: [f64; 2] = [0.31, 1.64];

/// Feet on a wall: distance from the middle and height, as shares of the leg's length. The value is the hero's, for a
/// figure without the clip `climb` or `ledge`.
const FEET_ON_WALL: [f64; 2] = [0.13, 0.23];

/// Distance of the wall ahead of the model's origin, as a share of the leg's length. The value is the hero's, for a
/// figure without the clip `climb`.
const WALL_DISTANCE: f64 = 0.54;

/// Edge of a ledge: height and distance ahead of the model's origin, as shares of the leg's length. The value is the
/// hero's, for a figure without the clip `ledge`.
const LEDGE_EDGE: [f64; 2] = [1.94, 0.43];

/// Height of the point that is held while hanging, as a share of the leg's length. The value is the hero's, for a
/// figure without the clip `hang`.
const HANG_POINT_HEIGHT: f64 = 2.39;

/// The points for which the climbing clips are made, metres in model space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Postures {
    /// Points of a wall that hands and feet touch, in the order of [`Extremity::ALL`](crate::Extremity::ALL).
    pub(crate) wall: [DVec3; 4],
    /// The hips while climbing a wall.
    pub(crate) wall_hips: DVec3,
    /// The edge of a ledge, midway between the hands.
    pub(crate) edge: DVec3,
    /// Half of the distance between the hands on a ledge.
    pub(crate) edge_width: f64,
    /// Points of the wall below a ledge that the feet touch.
    pub(crate) edge_feet: [DVec3; 2],
    /// The point that is held while hanging, midway between the hands.
    pub(crate) above: DVec3,
    /// Half of the distance between hands that hang.
    pub(crate) above_width: f64,
    /// The hips while hanging.
    pub(crate) hang_hips: DVec3,
    /// The hips while tumbling.
    pub(crate) tumble_hips: DVec3,
    /// The hips while standing.
    pub(crate) hips: DVec3,
}

impl Postures {
    pub(crate) fn new(
        skeleton: &Skeleton,
        humanoid: &Humanoid,
        set: &AnimationSet,
        clips: &Clips,
        limbs: &[LimbShape; 4],
        scale: f64,
    ) -> Result<Self, AnimationError> {
        let (ahead, leg) = (humanoid.facing, limbs[2].length);
        let left = DVec3::Y.cross(ahead);
        let sampled = |clip: BodyClip| {
            sampled(
                skeleton,
                humanoid,
                set.clip(clips.get(clip))?,
                (set, limbs, scale),
            )
        };
        let at = |aside: f64, up: f64, far: f64| (left * aside + DVec3::Y * up + ahead * far) * leg;
        let (_, hips) = sampled(BodyClip::Idle)?;
        let mut postures = Self {
            wall: [
                at(HANDS_ON_WALL[0], HANDS_ON_WALL[1], WALL_DISTANCE),
                at(-HANDS_ON_WALL[0], HANDS_ON_WALL[1], WALL_DISTANCE),
                at(FEET_ON_WALL[0], FEET_ON_WALL[1], WALL_DISTANCE),
                at(-FEET_ON_WALL[0], FEET_ON_WALL[1], WALL_DISTANCE),
            ],
            wall_hips: at(0.0, 0.82, 0.0),
            edge: at(0.0, LEDGE_EDGE[0], LEDGE_EDGE[1]),
            edge_width: 0.27 * leg,
            edge_feet: [
                at(FEET_ON_WALL[0], FEET_ON_WALL[1], LEDGE_EDGE[1]),
                at(-FEET_ON_WALL[0], FEET_ON_WALL[1], LEDGE_EDGE[1]),
            ],
            above: at(0.0, HANG_POINT_HEIGHT, 0.0),
            above_width: 0.2 * leg,
            hang_hips: hips,
            tumble_hips: hips,
            hips,
        };
        if clips.has(BodyClip::Climb) {
            let (touches, hips) = sampled(BodyClip::Climb)?;
            // All four points lie on one plane, at the palms' distance. Left and right are symmetric: each pair has its
            // mean height and its mean distance from the middle.
            let far = 0.5 * (touches[0] + touches[1]).dot(ahead);
            postures.wall = core::array::from_fn(|index| {
                let pair = [touches[index & !1], touches[index | 1]];
                let up = 0.5 * (pair[0].y + pair[1].y);
                let apart = 0.5 * (pair[0] - pair[1]).dot(left);
                let aside = if index & 1 == 0 { apart } else { -apart };
                left * aside + DVec3::Y * up + ahead * far
            });
            postures.wall_hips = hips;
        }
        let middle = |touches: &[DVec3; 4]| {
            let both = 0.5 * (touches[0] + touches[1]);
            DVec3::Y * both.y + ahead * both.dot(ahead)
        };
        let half = |touches: &[DVec3; 4]| 0.5 * (touches[0] - touches[1]).dot(left).abs();
        if clips.has(BodyClip::Ledge) {
            let (touches, _) = sampled(BodyClip::Ledge)?;
            postures.edge = middle(&touches);
            postures.edge_width = half(&touches);
            postures.edge_feet = [touches[2], touches[3]];
        }
        if clips.has(BodyClip::Hang) {
            let (touches, hips) = sampled(BodyClip::Hang)?;
            postures.above = middle(&touches);
            postures.above_width = half(&touches);
            postures.hang_hips = hips;
        }
        if clips.has(BodyClip::Tumble) {
            postures.tumble_hips = sampled(BodyClip::Tumble)?.1;
        }
        Ok(postures)
    }
}

/// Places of hands and feet at a clip's beginning, and the hips. Feet touch walls with their balls.
fn sampled(
    skeleton: &Skeleton,
    humanoid: &Humanoid,
    clip: &Clip,
    (set, limbs, scale): (&AnimationSet, &[LimbShape; 4], f64),
) -> Result<([DVec3; 4], DVec3), AnimationError> {
    let mut pose = Pose {
        transforms: set.rest().transforms.clone(),
    };
    clip.sample_into(0.0, Playback::Clamp, &mut pose)?;
    let touch = |index: usize| {
        let place = limbs[index].place(skeleton, &pose, scale)?;
        Some(place.point(limbs[index].ball))
    };
    let leg = limbs[2].length;
    let hips = joint_in_model(skeleton, &pose, humanoid.hips);
    let hips = hips.map_or(DVec3::Y * (HIPS_HEIGHT * leg), |hips| {
        hips.translation * scale
    });
    let touches = core::array::from_fn(|index| touch(index).unwrap_or_default());
    Ok((touches, hips))
}
