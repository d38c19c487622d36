use clamber_climber::Climber;
use clamber_surface::geometry::slerp;
use glam::{DMat3, DQuat, DVec3};

/// A climber's body as its weapons see it: an origin, and the directions right, up and ahead. On a hold, ahead is into
/// the surface that it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FighterFrame {
    /// Centre of the climber's ball, in world space, metres.
    pub origin: DVec3,
    /// The body's rotation in world space: x is its right, y is up, and -z is ahead. A model that looks along +Z has to
    /// be turned round.
    pub rotation: DQuat,
}

/// Weight of the heading in the up direction of a body on a hold; the climber's own up has weight 1. On level skin,
/// where that up has no component along the surface, the heading decides.
const HEADING_WEIGHT: f64 = 0.5;

impl FighterFrame {
    /// The centre of the climber's ball and the rotation of its body after its last step, in world space.
    pub fn of(climber: &Climber) -> Self {
        let (state, up) = (climber.state(), climber.config().up());
        let out = state
            .support
            .filter(|_| state.mode.is_holding())
            .map(|support| support.normal_in_world());
        let (up, ahead) = match out {
            None => (up, state.heading),
            Some(out) => {
                let wanted = up + state.heading * HEADING_WEIGHT;
                let along = wanted - out * wanted.dot(out);
                (along.normalize_or(out.any_orthonormal_vector()), -out)
            }
        };
        let right = ahead.cross(up).normalize_or(up.any_orthonormal_vector());
        let back = right.cross(up);
        Self {
            origin: state.position,
            rotation: DQuat::from_mat3(&DMat3::from_cols(right, up, back)).normalize(),
        }
    }

    /// World position of a point that is given relative to this frame's own `origin`, the centre of the climber's ball:
    /// metres to the right, up, and ahead, so the third number is positive in front of the body.
    pub fn at(&self, place: DVec3) -> DVec3 {
        self.origin + self.direction(place)
    }

    /// World direction of a vector that is given by its components right, up, and ahead. Its length stays.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.rotation * DVec3::new(direction.x, direction.y, -direction.z)
    }

    /// The frame between this one and `other`, for drawing between two ticks: this one at `share` 0, `other` at 1,
    /// which is the range of `share`. The origin moves on a straight line, the rotation on the shorter arc.
    pub fn to(&self, other: &Self, share: f64) -> Self {
        Self {
            origin: self.origin + (other.origin - self.origin) * share,
            rotation: slerp(self.rotation, other.rotation, share),
        }
    }

    /// The angle between two frames, radians.
    pub(super) fn angle_to(&self, other: &Self) -> f64 {
        let turn = self.rotation.conjugate() * other.rotation;
        let sin = DVec3::new(turn.x, turn.y, turn.z).length();
        2.0 * libm::atan2(sin, turn.w.abs())
    }
}
