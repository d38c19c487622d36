//! What a climber's mode means for its body: how the model stands in the world.

use clamber_climber::{ClimberConfig, ClimberMode, ClimberState};
use glam::{DQuat, DVec3};

use super::root::Root;
use crate::Figure;

/// Kinds of posture. Within one, the model moves without a break; between two, differences fade.
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
    /// Holds on with hands and feet.
    Wall,
    /// Hangs by its hands.
    Hang,
    /// Hangs from a ledge, or pulls itself up.
    Ledge,
}

/// How far below the ball's centre the hips hang, as a share of the leg.
const BELOW: f64 = 0.13;

/// Height of the ball's centre above the hips on a wall, as a share of the leg.
const WAIST: f64 = 0.16;

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

    /// True if hands hold what carries the climber.
    pub(crate) fn is_held(self) -> bool {
        matches!(self, Self::Wall | Self::Hang | Self::Ledge)
    }

    /// Where the front of the body faces, and where its head is, in world space.
    pub(crate) fn directions(self, state: &ClimberState, up: DVec3) -> [DVec3; 2] {
        let support = state.support.as_ref();
        match (self, support) {
            (Self::Wall, Some(support)) => {
                let normal = support.normal_in_world();
                [-normal, arc(up, normal) * state.heading]
            }
            (Self::Hang, Some(support)) => {
                let arm = support.attachment.point - state.position;
                // Half upright: arms give way before the trunk does.
                [state.heading, arm.normalize_or(up) + up]
            }
            _ => [state.heading, up],
        }
    }

    /// Where the model stands, turned by `rotation`. `ground` is the height of the ground along up, for who stands.
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
                // By the ball's centre, so that around corners it turns and does not jump.
                let far = postures.wall[0].dot(ahead) - away;
                let waist = DVec3::Y * (postures.wall_hips.y + WAIST * leg) + ahead * far;
                Root::with_point_at(waist, state.position, rotation)
            }
            (Self::Hang, Some(_)) => {
                let hips = state.position - above * (BELOW * leg);
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
                // By the ball's centre: hands go from hold to hold, and around a corner the body turns.
                let front = rotation * ahead;
                let front = (front - up * front.dot(up)).normalize_or(state.heading);
                let edge = place + front * out + up * ledge.drop;
                let hangs = Root::with_point_at(postures.edge, edge, rotation).position;
                // From hanging to standing on top, the model goes as far as from below the edge onto it.
                let stands = edge + up * config.body.margin;
                let rises = ledge.drop + config.body.radius + config.body.margin;
                let whole = stands - hangs;
                let level = whole - up * whole.dot(up);
                let near = NEAR * config.body.radius;
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

/// A body that is off its place below a ledge by up to this share of the ball's radius moves with the ball: hands that
/// go on to the next hold, over a step, do not move it.
const NEAR: f64 = 0.5;

/// How far the model has gone when the ball has gone `way`: as far at first, and the `whole` way of the model where the
/// ball has gone its own.
fn gone(way: f64, [ball, whole]: [f64; 2], near: f64) -> f64 {
    let near = near.min(ball);
    if way <= near {
        return way;
    }
    near + (way - near) * (whole - near) / (ball - near).max(1e-6)
}

/// Distance of a ledge's contact ahead of the ball's centre, as a share of its radius: what
/// `LedgeProbe::hands_ahead` of `clamber_mover` says.
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
