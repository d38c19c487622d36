//! How a material point moves and its skin stretches from the previous tick to the current one.

use glam::{DMat3, DQuat, DVec2, DVec3, Quat, Vec3};

use super::anchor::check_barycentric;
use super::{Anchor, SkinnedSurface, SurfaceError};
use crate::geometry::triangle::{point_at, scaled_normal};
use crate::geometry::{Affine, rotation_vector, round_to_f32, widen};
use crate::rig::{rotation_f32, rotation_f64};

/// A triangle lower than this share of its longest edge has collapsed, 2^-22: its direction is
/// rounding. Larger freezes frames of slivers that still have one.
const COLLAPSED: f64 = 1.0 / (1u32 << 22) as f64;

/// So has one lower than this share of its corners' distance from the origin, 2^-20: skinning
/// rounds each corner by some 2^-24 of that, which would turn the triangle by a quarter radian.
const COLLAPSED_FAR_OUT: f64 = 1.0 / (1u32 << 20) as f64;

/// The motion of an anchor over one tick, in the *current* model frame: a moving root moves it
/// too. Differences of positions over `dt`, never an instantaneous velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Where the point is now.
    pub position: Vec3,
    /// Where it was a tick ago.
    pub previous_position: Vec3,
    /// Displacement over the tick, per second.
    pub velocity: Vec3,
    /// Rotation of the material around the point from rest to now: the rotation nearest to the
    /// triangle's deformation, so that stretch and shear do not turn it. Times a direction given
    /// in the rest pose it is that direction's heading now.
    pub frame: Quat,
    /// Axis times radians per second that turns the frame of a tick ago into the current one, by
    /// at most half a turn.
    pub angular_velocity: Vec3,
    /// Outward unit normal of the triangle now; of a collapsed triangle, as its frame keeps it.
    pub normal: Vec3,
    /// True if the triangle has no area of its own now: frame and normal are remembered ones.
    pub collapsed: bool,
    /// Area now over area a tick ago; 1 where it was collapsed.
    pub area_ratio: f32,
    /// How much longer the most and the least stretched direction of the triangle became since a
    /// tick ago, larger first; 1 and 1 where it was collapsed.
    pub stretches: [f32; 2],
}

impl SkinnedSurface {
    /// The motion of a material point over a tick of `dt` seconds. Skins six vertices at most.
    ///
    /// # Errors
    /// [`SurfaceError::Triangle`] if the triangle does not exist or was removed,
    /// [`SurfaceError::Barycentric`], or [`SurfaceError::Query`] if `dt` is not positive.
    pub fn motion(&self, anchor: &Anchor, dt: f64) -> Result<Motion, SurfaceError> {
        let triangle = anchor.triangle;
        let part = self
            .mesh
            .part_of(triangle)
            .ok_or(SurfaceError::Triangle(triangle))?;
        check_barycentric(anchor.barycentric)?;
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(SurfaceError::Query {
                what: "the length of a tick",
                found: dt,
            });
        }
        let rest = self.mesh.rest_corners(triangle);
        let before = self.previous_corners(triangle);
        let now = self.corners(triangle);

        let weights = widen(Vec3::from_array(anchor.barycentric));
        let (position, previous) = (point_at(now, weights), point_at(before, weights));
        let joint = self.mesh.parts()[part.index()].joint.0 as usize;
        let previous_frame = material_frame(rest, before, &self.previous_palette[joint]);
        let current_frame = material_frame(rest, now, &self.palette[joint]);
        let frame = current_frame
            .or(previous_frame)
            .unwrap_or_else(|| last_frame(anchor));
        let previous_frame = previous_frame.unwrap_or(frame);
        let normal = match self.outward_normal(triangle, part) {
            Some(normal) if !is_collapsed(now) => normal,
            _ => {
                let sign = if self.mirrored[part.index()] {
                    -1.0
                } else {
                    1.0
                };
                frame * scaled_normal(rest).normalize_or(DVec3::Y) * sign
            }
        };
        let (area_ratio, stretches) = stretch(before, now);
        let velocity = (position - previous) / dt;
        let angular_velocity = rotation_vector(frame * previous_frame.conjugate()) / dt;
        if velocity.length().max(angular_velocity.length()) > f64::from(f32::MAX) {
            return Err(SurfaceError::Query {
                what: "the length of a tick, too short for what moved,",
                found: dt,
            });
        }
        Ok(Motion {
            position: round_to_f32(position),
            previous_position: round_to_f32(previous),
            velocity: round_to_f32(velocity),
            frame: rotation_f32(frame),
            angular_velocity: round_to_f32(angular_velocity),
            normal: round_to_f32(normal),
            collapsed: current_frame.is_none(),
            area_ratio: area_ratio as f32,
            stretches: stretches.map(|s| s as f32),
        })
    }
}

/// The frame that an anchor remembers; no rotation if that is none.
fn last_frame(anchor: &Anchor) -> DQuat {
    let frame = rotation_f64(anchor.frame);
    if frame.is_finite() && frame.length_squared() > 0.0 {
        frame.normalize()
    } else {
        DQuat::IDENTITY
    }
}

/// True if the triangle has no direction of its own.
fn is_collapsed(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = corners.map(widen);
    let longest_sq = (b - a)
        .length_squared()
        .max((c - b).length_squared())
        .max((a - c).length_squared());
    let longest = longest_sq.sqrt();
    let farthest = a.length().max(b.length()).max(c.length());
    let lowest = (COLLAPSED * longest).max(COLLAPSED_FAR_OUT * farthest);
    // Twice the area is the longest edge times the height over it.
    scaled_normal(corners).length() <= longest * lowest
}

/// The rotation of the material from rest to now. A sliver that has no frame even at rest turns with
/// the joint of its part.
pub(super) fn material_frame(rest: [Vec3; 3], now: [Vec3; 3], joint: &Affine) -> Option<DQuat> {
    if !is_collapsed(rest) {
        return frame_of(rest, now);
    }
    let linear = joint.to_f64().matrix3;
    let x = linear.x_axis.try_normalize()?;
    let z = x.cross(linear.y_axis).try_normalize()?;
    Some(DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)).normalize())
}

/// A triangle in the plane: its orthonormal axes (first edge, in-plane perpendicular, normal) and
/// its two edges in them, `(length, 0)` and `(x, y)` with y positive.
struct Flattened {
    axes: DMat3,
    first: f64,
    second: DVec2,
}

impl Flattened {
    fn new(corners: [Vec3; 3]) -> Option<Self> {
        if is_collapsed(corners) {
            return None;
        }
        let [a, b, c] = corners.map(widen);
        let along = (b - a).try_normalize()?;
        let normal = scaled_normal(corners).try_normalize()?;
        let across = normal.cross(along);
        Some(Self {
            axes: DMat3::from_cols(along, across, normal),
            first: (b - a).length(),
            second: DVec2::new((c - a).dot(along), (c - a).dot(across)),
        })
    }

    /// The in-plane map that takes this triangle's edges to `to`'s, each in its own axes. It is
    /// `[[a, b], [0, d]]` with positive a and d, given as (a, b, d).
    fn gradient(&self, to: &Self) -> (f64, f64, f64) {
        let a = to.first / self.first;
        let b = (to.second.x - a * self.second.x) / self.second.y;
        let d = to.second.y / self.second.y;
        (a, b, d)
    }
}

/// The rotation nearest to the map from one triangle to the other; `None` if either collapsed.
///
/// The in-plane gradient `[[a, b], [0, d]]` has as its nearest rotation the one with cosine and
/// sine proportional to `a + d` and `-b` (polar decomposition in two dimensions).
fn frame_of(rest: [Vec3; 3], now: [Vec3; 3]) -> Option<DQuat> {
    let (rest, now) = (Flattened::new(rest)?, Flattened::new(now)?);
    let (a, b, d) = rest.gradient(&now);
    let (cos, sin) = (a + d, -b);
    let length = (cos * cos + sin * sin).sqrt();
    let (cos, sin) = (cos / length, sin / length);
    let in_plane = DMat3::from_cols(
        DVec3::new(cos, sin, 0.0),
        DVec3::new(-sin, cos, 0.0),
        DVec3::Z,
    );
    let rotation = now.axes * in_plane * rest.axes.transpose();
    let frame = DQuat::from_mat3(&rotation).normalize();
    frame.is_finite().then_some(frame)
}

/// Area ratio and principal stretches, larger first, from one triangle to the other.
fn stretch(before: [Vec3; 3], now: [Vec3; 3]) -> (f64, [f64; 2]) {
    let Some(flat_before) = Flattened::new(before) else {
        return (1.0, [1.0, 1.0]);
    };
    let Some(flat_now) = Flattened::new(now) else {
        // Collapsed into a segment or a point: the longest edge tells the stretch along it.
        let area = scaled_normal(now).length() / scaled_normal(before).length();
        let along = longest_edge(now) / longest_edge(before);
        return (area, [along, if along > 0.0 { area / along } else { 0.0 }]);
    };
    let (a, b, d) = flat_before.gradient(&flat_now);
    // Singular values of [[a, b], [0, d]] without cancellation (Blinn 1996).
    let sum = ((a + d) * (a + d) + b * b).sqrt();
    let difference = ((a - d) * (a - d) + b * b).sqrt();
    let larger = 0.5 * (sum + difference);
    (a * d, [larger, a * d / larger])
}

fn longest_edge(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = corners.map(widen);
    (b - a).length().max((c - b).length()).max((a - c).length())
}

#[cfg(test)]
mod tests;
