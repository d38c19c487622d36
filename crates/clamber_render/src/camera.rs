use glam::dcamera::rh::proj::directx::perspective_infinite_reverse;
use glam::dcamera::rh::view::look_to_mat4;
use glam::{DMat4, DVec3};

/// The viewpoint of a picture, in world space, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the camera.
    pub eye: DVec3,
    /// The point in the middle of the picture; not equal to `eye`.
    pub target: DVec3,
    /// The direction that is up in the picture; not parallel to the view.
    pub up: DVec3,
    /// Vertical field of view, radians: greater than 0 and less than pi.
    pub field_of_view: f64,
}

/// Distance of the near plane, metres: parts of meshes nearer than this are not drawn. `overlay.wgsl` has the same
/// value.
const NEAR: f64 = 0.1;

impl Camera {
    /// Looks from `eye` at `target`, with a field of view of 50 degrees.
    pub fn new(eye: DVec3, target: DVec3) -> Self {
        Self {
            eye,
            target,
            up: DVec3::Y,
            field_of_view: 50f64.to_radians(),
        }
    }

    /// Looks at a point from `distance` metres away, `heading` radians around Y from +Z, and `pitch` radians
    /// above the horizon.
    pub fn orbit(target: DVec3, distance: f64, heading: f64, pitch: f64) -> Self {
        let level = libm::cos(pitch);
        let from = DVec3::new(
            level * libm::sin(heading),
            libm::sin(pitch),
            level * libm::cos(heading),
        );
        Self::new(target + from * distance, target)
    }

    pub(crate) fn is_valid(&self) -> bool {
        let view = self.target - self.eye;
        let finite = self.eye.is_finite() && self.target.is_finite() && self.up.is_finite();
        let angle = self.field_of_view > 0.0 && self.field_of_view < core::f64::consts::PI;
        finite && angle && view.cross(self.up).length_squared() > 0.0
    }

    /// The matrix from world space relative to the eye to clip space; depth is 1 at the near plane and 0 at infinity.
    pub(crate) fn clip_from_view(&self, aspect: f64) -> DMat4 {
        let ahead = (self.target - self.eye).normalize();
        let view = look_to_mat4(DVec3::ZERO, ahead, self.up.normalize());
        let projection = perspective_infinite_reverse(self.field_of_view, aspect, NEAR);
        projection * view
    }
}
