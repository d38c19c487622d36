//! Arrows in skin.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_world::{Attachment, Obstacle, ObstacleId, SweepContact};
use glam::{DQuat, DVec3};

use super::{ProjectileMotion, ProjectilePlace};

/// Sticks into what was touched, in its current state, at a share of the tick that ends now: the tip goes `depth`
/// deeper than the contact along `direction`. `None` if the material has no motion.
pub(super) fn stick(
    obstacle: ObstacleId,
    touched: &dyn Obstacle,
    hit: &SweepContact,
    direction: DVec3,
    depth: f64,
    dt: f64,
) -> Option<ProjectileMotion> {
    let motion = touched.motion(&hit.contact.material, dt)?;
    let now = motion.frame.unwrap_or(DQuat::IDENTITY);
    // The frame at the time of the contact: so much of the turn was still ahead.
    let then = part_of_turn(motion.turn, 1.0 - hit.time).conjugate() * now;
    let in_material = then.conjugate() * direction;
    Some(ProjectileMotion::Stuck {
        at: Attachment {
            obstacle,
            material: hit.contact.material,
            point: motion.position,
            frame: now,
            offset: in_material * depth,
        },
        direction: in_material,
    })
}

/// A share of a turn.
fn part_of_turn(turn: DQuat, share: f64) -> DQuat {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    let axis = DVec3::new(turn.x, turn.y, turn.z);
    let sin = axis.length();
    if sin == 0.0 {
        return DQuat::IDENTITY;
    }
    let angle = 2.0 * libm::atan2(sin, turn.w) * share;
    rotation_from_axis_angle(axis / sin, angle)
}

/// Where a stuck arrow is on the obstacle in its current state; `None` if the material is gone.
pub(crate) fn place_on(
    at: &Attachment,
    direction: DVec3,
    obstacle: &dyn Obstacle,
) -> Option<ProjectilePlace> {
    // Neither frame nor position depend on the length of the tick.
    let motion = obstacle.motion(&at.material, 1.0)?;
    let frame = motion.frame.unwrap_or(at.frame);
    Some(ProjectilePlace {
        tip: motion.position + frame * at.offset,
        direction: frame * direction,
    })
}
