//! Maps a climber's mode to its body's stance, and the stance to the model's place in the world.

use clamber_climber::{ClimberConfig, ClimberMode, ClimberState};
use glam::{DQuat, DVec3};

use super::root::Root;
use crate::Figure;

/// The kind of a body's posture. Within one stance the model moves continuously. Between two, the difference decays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stance {
    /// On its feet.
    Upright,
    /// In the air.
    Air,
    /// Knocked over, in motion.
    Tumble,
    /// Knocked over, at rest.
    Lie,
    /// Holds on to a wall with hands and feet.
    Wall,
    /// Hangs by its hands.
    Hang,
    /// Hangs from a ledge, or pulls itself up.
    Ledge,
}

/// Height of the ball's centre above the hips while hanging, as a share of the leg's length.
const HANGING_HIPS_DEPTH: f64 = 0.13;

/// Height of the ball's centre above the hips on a wall, as a share of the leg's length.
const WAIST_HEIGHT: f64 = 0.16;

impl Stance {
    pub(crate) fn of(state: &ClimberState) -> Self {
        match state.mode {
            ClimberMode::Standing | ClimberMode::Sliding => Self::Upright,
            ClimberMode::Falling => Self::Air,
            ClimberMode::Tumbling if state.tumbling.still > 0.0 => Self::Lie,
            ClimberMode::Tumbling => Self::Tumble,
            ClimberMode::Holding => Self::Wall,
            ClimberMode::Hanging => Self::Hang,
            ClimberMode::LedgeHanging => Self::Ledge,
            ClimberMode::Custom(_) if state.support.is_some() => Self::Upright,
            ClimberMode::Custom(_) => Self::Air,
        }
    }

    /// True if the hands hold the climber's support.
    pub(crate) fn is_held(self) -> bool {
        matches!(self, Self::Wall | Self::Hang | Self::Ledge)
    }

    /// Directions that the front and the head of the body face, in world space. The second one need not be a unit
    /// vector.
    pub(crate) fn directions(self, state: &ClimberState, up: DVec3) -> [DVec3; 2] {
        let support = state.support.as_ref();
        match (self, support) {
            (Self::Wall, Some(support)) => {
                let normal = support.normal_in_world();
                [-normal, arc(up, normal) * state.heading]
            }
            (Self::Hang, Some(support)) => {
                let arm = support.attachment.point - state.position;
                // The trunk is halfway between the arms' direction and upright: arms give way before the trunk does.
                [state.heading, arm.normalize_or(up) + up]
            }
            _ => [state.heading, up],
        }
    }

    /// The model's root when it is turned by `rotation`. `ground` is the ground's height along up; only an upright body
    /// needs it.
    pub(crate) fn root(
        self,
        figure: &Figure,
        state: &ClimberState,
        config: &ClimberConfig,
        rotation: DQuat,
        ground: f64,
    ) -> Root {
        let up = config.up();
        let (postures, leg) = (figure.postures(), figure.leg_length());
        let ahead = figure.humanoid().facing;
        let bottom = state.position - up * config.body.radius;
        let above = rotation * DVec3::Y;
        match (self, state.support.as_ref()) {
            (Self::Upright, _) => Root {
                position: bottom + up * (ground - bottom.dot(up)),
                rotation,
            },
            (Self::Tumble, _) => {
                Root::with_point_at(postures.tumble_hips, state.position, rotation)
            }
            (Self::Wall, Some(support)) => {
                let normal = support.normal_in_world();
                let away = (state.position - support.attachment.point).dot(normal);
                // The waist is at the ball's centre, so that the body turns around corners without a jump.
                let far = postures.wall[0].dot(ahead) - away;
                let waist = DVec3::Y * (postures.wall_hips.y + WAIST_HEIGHT * leg) + ahead * far;
                Root::with_point_at(waist, state.position, rotation)
            }
            (Self::Hang, Some(_)) => {
                let hips = state.position - above * (HANGING_HIPS_DEPTH * leg);
                Root::with_point_at(postures.hang_hips, hips, rotation)
            }
            (Self::Ledge, Some(support)) => {
                let edge = support.attachment.point;
                let Some(ledge) = config.ledge else {
                    return Root::with_point_at(postures.edge, edge, rotation);
                };
                let out = config.body.radius * HANDS_AHEAD;
                let place = edge - state.heading * out - up * ledge.drop;
                let way = state.position - place;
                // The edge turns with the model about the ball's place: around a corner the hands go from hold to hold,
                // but the body turns.
                let front = rotation * ahead;
                let front = (front - up * front.dot(up)).normalize_or(state.heading);
                let edge = place + front * out + up * ledge.drop;
                let hangs = Root::with_point_at(postures.edge, edge, rotation).position;
                // The model moves from hanging below the edge to standing on it, while the ball makes its own,
                // different way.
                let stands = edge + up * config.body.margin;
                let rises = ledge.drop + config.body.radius + config.body.margin;
                let whole = stands - hangs;
                let level = whole - up * whole.dot(up);
                let near = LEDGE_FOLLOW_DISTANCE * config.body.radius;
                let high = gone(way.dot(up), [rises, whole.dot(up)], near);
                let deep = gone(way.dot(state.heading), [out, level.length()], near);
                let inward = level.normalize_or(state.heading);
                let aside = way - up * way.dot(up) - state.heading * way.dot(state.heading);
                let position = hangs + up * high + inward * deep + aside;
                Root { position, rotation }
            }
            _ => Root {
                position: bottom,
                rotation,
            },
        }
    }
}

/// Distance from its place below a ledge up to which the model moves exactly as the ball, as a share of the ball's
/// radius. Within it, the model does not move when the hands change to a hold at another height.
const LEDGE_FOLLOW_DISTANCE: f64 = 0.5;

/// Displacement of the model when the ball has moved by `way`: the same up to `near`, then linearly growing to `whole`,
/// where the ball has moved by `ball`.
fn gone(way: f64, [ball, whole]: [f64; 2], near: f64) -> f64 {
    let near = near.min(ball);
    if way <= near {
        return way;
    }
    near + (way - near) * (whole - near) / (ball - near).max(1e-6)
}

/// Distance of a ledge's contact ahead of the ball's centre, as a share of the ball's radius. It must equal
/// `LedgeProbe::hands_ahead` of `clamber_mover`.
const HANDS_AHEAD: f64 = 1.4;

/// The smallest rotation from one unit vector to another.
pub(crate) fn arc(from: DVec3, to: DVec3) -> DQuat {
    let half = from + to;
    if half.length_squared() < 1e-18 {
        let axis = from.any_orthonormal_vector();
        return DQuat::from_xyzw(axis.x, axis.y, axis.z, 0.0);
    }
    let axis = from.cross(half);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, from.dot(half)).normalize()
}
