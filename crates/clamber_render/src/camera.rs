use glam::dcamera::rh::proj::directx::perspective_infinite_reverse;
use glam::dcamera::rh::view::look_to_mat4;
use glam::{DMat4, DVec3};

/// From where a picture is taken: in the world, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands.
    pub eye: DVec3,
    /// What is in the middle of the picture.
    pub target: DVec3,
    /// What is up in the picture; not along the view.
    pub up: DVec3,
    /// Angle between the top and the bottom of the picture, radians: below pi.
    pub field_of_view: f64,
}

/// Nothing nearer than this is drawn, metres.
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

    /// Circles around a point: `distance` metres away, `heading` radians around Y from +Z, `pitch` radians
    /// over the horizon.
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

    /// From the world relative to the eye to the picture; depth is 1 at the near plane and 0 at infinity.
    pub(crate) fn clip_from_view(&self, aspect: f64) -> DMat4 {
        let ahead = (self.target - self.eye).normalize();
        let view = look_to_mat4(DVec3::ZERO, ahead, self.up.normalize());
        let projection = perspective_infinite_reverse(self.field_of_view, aspect, NEAR);
        projection * view
    }
}
