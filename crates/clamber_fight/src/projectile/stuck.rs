//! Arrows that stick in obstacles.

use clamber_surface::geometry::rotation_from_axis_angle;
use clamber_world::{Attachment, Obstacle, ObstacleId, SweepContact};
use glam::{DQuat, DVec3};

use super::{ProjectileMotion, ProjectilePlace};

/// Attaches an arrow to the obstacle that it has hit. The obstacle is in its pose at the end of the tick. The tip goes
/// `depth` metres deeper than the contact, along `direction`, which is taken at the time of the contact. `None` if the
/// material has no motion.
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
    // The frame at the time of the contact: the rest of the tick's turn was still ahead.
    let then = part_of_turn(motion.turn, 1.0 - hit.fraction).conjugate() * now;
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

/// A share of a rotation.
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

/// Position and direction of a stuck arrow on the obstacle in its current pose; `None` if the material is gone.
pub(crate) fn place_on(
    at: &Attachment,
    direction: DVec3,
    obstacle: &dyn Obstacle,
) -> Option<ProjectilePlace> {
    // Frame and position do not depend on the length of the tick.
    let motion = obstacle.motion(&at.material, 1.0)?;
    let frame = motion.frame.unwrap_or(at.frame);
    Some(ProjectilePlace {
        tip: motion.position + frame * at.offset,
        direction: frame * direction,
    })
}
