//! The deformation of a triangle from one pose to another: its rotation and its stretch.

use glam::{DMat3, DQuat, DVec2, DVec3, Vec3};

use crate::geometry::Affine;
use crate::geometry::triangle::{scaled_normal, widened};

/// A triangle whose height is below this share of its longest edge, 2^-22, has collapsed: its orientation is rounding
/// error. A larger share would freeze the frames of slivers that still have an orientation.
const COLLAPSED: f64 = 1.0 / (1u32 << 22) as f64;

/// A triangle whose height is below this share of its corners' distance from the origin, 2^-20, has also collapsed:
/// skinning rounds each corner by some 2^-24 of that distance, which would turn the triangle by a quarter radian.
const COLLAPSED_FAR_OUT: f64 = 1.0 / (1u32 << 20) as f64;

/// True if the triangle is too thin to have an orientation of its own.
pub(super) fn is_collapsed(corners: [Vec3; 3]) -> bool {
    let [a, b, c] = widened(corners);
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

/// A triangle at rest, from which rotations of the material are measured.
pub(super) struct Rest {
    corners: [Vec3; 3],
    /// `None` if it has no orientation even at rest.
    flat: Option<Flattened>,
}

impl Rest {
    pub(super) fn new(corners: [Vec3; 3]) -> Self {
        let flat = Flattened::new(corners);
        Self { corners, flat }
    }

    /// Normal of the triangle at rest, of any length.
    pub(super) fn scaled_normal(&self) -> DVec3 {
        scaled_normal(self.corners)
    }

    /// The rotation of the material from rest to now; `None` if the triangle has collapsed. A sliver without an
    /// orientation even at rest turns with the joint of its part.
    pub(super) fn frame(&self, now: Option<&Flattened>, joint: &Affine) -> Option<DQuat> {
        // A triangle that has not collapsed but overflows when it is flattened has no frame.
        if self.flat.is_some() || !is_collapsed(self.corners) {
            return frame_between(self.flat.as_ref()?, now?);
        }
        let linear = joint.to_f64().matrix3;
        let x = linear.x_axis.try_normalize()?;
        let z = x.cross(linear.y_axis).try_normalize()?;
        Some(DQuat::from_mat3(&DMat3::from_cols(x, z.cross(x), z)).normalize())
    }
}

/// A triangle in its own plane: its orthonormal axes (first edge, in-plane perpendicular, normal), and its two edges in
/// these axes, `(length, 0)` and `(x, y)` with positive y.
pub(super) struct Flattened {
    axes: DMat3,
    first: f64,
    second: DVec2,
}

impl Flattened {
    /// `None` if the triangle has collapsed.
    pub(super) fn new(corners: [Vec3; 3]) -> Option<Self> {
        if is_collapsed(corners) {
            return None;
        }
        let [a, b, c] = widened(corners);
        let along = (b - a).try_normalize()?;
        let normal = scaled_normal(corners).try_normalize()?;
        let across = normal.cross(along);
        Some(Self {
            axes: DMat3::from_cols(along, across, normal),
            first: (b - a).length(),
            second: DVec2::new((c - a).dot(along), (c - a).dot(across)),
        })
    }

    /// The triangle's counter-clockwise unit normal.
    pub(super) fn normal(&self) -> DVec3 {
        self.axes.z_axis
    }

    /// The in-plane map from this triangle's edges to the edges of `to`, each in its own axes: `[[a, b], [0, d]]` with
    /// positive a and d, returned as (a, b, d).
    fn gradient(&self, to: &Self) -> (f64, f64, f64) {
        let a = to.first / self.first;
        let b = (to.second.x - a * self.second.x) / self.second.y;
        let d = to.second.y / self.second.y;
        (a, b, d)
    }
}

/// The rotation nearest to the map from one triangle to the other; `None` if it is not finite.
///
/// The rotation nearest to the in-plane gradient `[[a, b], [0, d]]` has a cosine proportional to `a + d` and a sine
/// proportional to `-b` (polar decomposition in two dimensions).
fn frame_between(rest: &Flattened, now: &Flattened) -> Option<DQuat> {
    let (a, b, d) = rest.gradient(now);
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

/// Area ratio and principal stretches, larger first, from one triangle to the other; 1 if the first has collapsed.
/// Takes the corners of both, and both flattened.
pub(super) fn stretch(
    [before, now]: [[Vec3; 3]; 2],
    [flat_before, flat_now]: [Option<&Flattened>; 2],
) -> (f64, [f64; 2]) {
    let Some(flat_before) = flat_before else {
        return (1.0, [1.0, 1.0]);
    };
    let Some(flat_now) = flat_now else {
        // Collapsed into a segment or a point: the longest edges give the stretch along it.
        let area = scaled_normal(now).length() / scaled_normal(before).length();
        let along = longest_edge(now) / longest_edge(before);
        let across = if along > 0.0 { area / along } else { 0.0 };
        return (area, [along.max(across), along.min(across)]);
    };
    let (a, b, d) = flat_before.gradient(flat_now);
    // Singular values of [[a, b], [0, d]] without cancellation (Blinn 1996).
    let sum = ((a + d) * (a + d) + b * b).sqrt();
    let difference = ((a - d) * (a - d) + b * b).sqrt();
    let larger = 0.5 * (sum + difference);
    (a * d, [larger, a * d / larger])
}

fn longest_edge(corners: [Vec3; 3]) -> f64 {
    let [a, b, c] = widened(corners);
    (b - a).length().max((c - b).length()).max((a - c).length())
}
