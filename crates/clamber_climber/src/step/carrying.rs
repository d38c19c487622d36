//! Being carried by a material point, attaching to one, and detaching from it.

use clamber_mover::MoverContact;
use clamber_world::{Attachment, Continuity, PointMotion};
use glam::{DQuat, DVec3};

use super::{NextMode, Tick};
use crate::{ClimberEvent, ClimberMode, Support};

/// Largest gap, as a share of the radius, between the position that a support had after the last tick and the previous
/// position that its obstacle reports. Beyond it, the support did not move in one step. Far above rounding, far below
/// what is visible.
pub(crate) const CONTINUOUS_GAP: f64 = 0.025;

/// How a support has carried the climber since the last tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct Carried {
    pub(super) support: Support,
    pub(super) motion: PointMotion,
    /// Velocity of the support over the previous tick; `None` if that is not known, or the support was teleported.
    pub(super) velocity_before: Option<DVec3>,
    /// The climber's position a tick ago. If the support was teleported, the corresponding position at the new place.
    pub(super) start: DVec3,
    /// The position to which its support has carried it.
    pub(super) position: DVec3,
    /// False if the support was teleported: the body did not move there, and is not swept.
    pub(super) swept: bool,
}

impl Carried {
    pub(super) fn normal(&self) -> DVec3 {
        self.support.normal_in_world()
    }

    pub(super) fn velocity(&self) -> DVec3 {
        self.motion.velocity
    }
}

impl Tick<'_> {
    /// Follows the support to its current position, and measures its shake. If the support is gone, the climber loses
    /// it.
    pub(super) fn be_carried(&mut self) {
        let Some(mut support) = self.state.support else {
            return;
        };
        let slack = CONTINUOUS_GAP * self.config.body.radius;
        let dt = self.dt();
        let attachment = &mut support.attachment;
        let obstacle = self.mover.obstacle(attachment.obstacle);
        // A climber is not carried by another one that it carries.
        let obstacle = obstacle.filter(|obstacle| !self.judge.carries(*obstacle));
        let followed = obstacle.and_then(|obstacle| attachment.follow(obstacle, dt, slack));
        let followed = followed.filter(|followed| followed.motion.is_finite());
        let Some(followed) = followed else {
            self.lose_footing();
            if !self.state.mode.is_custom() {
                self.change_to(ClimberMode::Falling);
            }
            return;
        };
        let motion = followed.motion;
        let was_placed = followed.continuity == Continuity::Teleported;
        if followed.continuity == Continuity::SkippedTicks {
            let obstacle = support.attachment.obstacle;
            self.event(ClimberEvent::SkippedTicks { obstacle });
        }
        let velocity_before = self.state.support_velocity.filter(|_| !was_placed);
        self.feel(&motion, was_placed);
        self.on = self.judge.rule_of_support(&support, motion.position);
        self.state.support = Some(support);
        self.state.velocity = motion.velocity;
        self.state.base_velocity = motion.velocity;
        self.state.untouched = 0.0;
        self.face(motion.turn * self.state.heading);
        let offset = support.attachment.offset_in_world();
        self.carried = Some(Carried {
            support,
            motion,
            velocity_before,
            start: if was_placed {
                motion.previous_position + offset
            } else {
                self.before.position
            },
            position: motion.position + offset,
            swept: !was_placed,
        });
    }

    /// The climber's position before its own movement in this tick.
    pub(super) fn place(&self) -> DVec3 {
        let carried = self.carried.as_ref();
        carried.map_or(self.state.position, |carried| carried.position)
    }

    /// The climber's own velocity at the tick's beginning: relative to its support, and rotated with it.
    pub(super) fn own_velocity(&self) -> DVec3 {
        let own = self.before.velocity - self.before.base_velocity;
        let carried = self.carried.as_ref();
        carried.map_or(own, |carried| carried.motion.turn * own)
    }

    /// The climber's velocity if it does nothing in this tick: its own velocity at the tick's beginning, plus its
    /// support's.
    pub(super) fn carried_velocity(&self) -> DVec3 {
        match &self.carried {
            Some(carried) => carried.velocity() + self.own_velocity(),
            None => self.state.velocity,
        }
    }

    /// True if the material can carry the climber: its motion is known. An obstacle that answers queries but reports no
    /// motion blocks the climber, but cannot be stood on or held.
    pub(super) fn carries(&self, touch: &MoverContact) -> bool {
        self.mover.path_of(touch).is_some()
    }

    /// Attaches the climber, at a position, to a contact.
    pub(super) fn attach(&mut self, touch: &MoverContact, position: DVec3) {
        let motion = self.mover.motion(touch.obstacle, &touch.contact.material);
        let attachment =
            Attachment::with_motion(touch.obstacle, &touch.contact, motion.as_ref(), position);
        let into_frame = attachment.frame.conjugate();
        let support = Support {
            attachment,
            normal: into_frame * touch.normal,
            face: into_frame * touch.contact.normal,
            tag: touch.contact.tag,
        };
        self.state.support = Some(support);
        self.state.support_velocity = motion.map(|motion| motion.velocity);
        self.state.base_velocity = motion.map_or(DVec3::ZERO, |motion| motion.velocity);
        self.state.untouched = 0.0;
        // The last support has already carried the climber in this tick. The new one is at its final position, so it
        // adds no motion.
        self.carried = motion.map(|motion| Carried {
            support,
            motion: PointMotion {
                previous_position: motion.position,
                turn: DQuat::IDENTITY,
                ..motion
            },
            velocity_before: Some(motion.velocity),
            start: self.before.position,
            position: attachment.position(),
            swept: true,
        });
    }

    /// Keeps the support, with another position relative to it.
    pub(super) fn keep_support(&mut self, carried: &Carried, position: DVec3) {
        self.state.position = position;
        self.state.support = Some(Support {
            attachment: carried.support.attachment.moved_to(position),
            ..carried.support
        });
    }

    /// Drops the support.
    pub(super) fn detach(&mut self) {
        self.state.support = None;
        self.state.support_velocity = None;
        self.carried = None;
    }

    /// Drops the support, keeps the velocity, and changes to a mode.
    pub(super) fn leave(&mut self, mode: ClimberMode) -> NextMode {
        self.detach();
        NextMode::Change(mode)
    }

    /// [`Tick::leave`] for a fall, with [`ClimberEvent::LostFooting`].
    pub(super) fn lose_footing(&mut self) -> NextMode {
        if let Some(support) = self.state.support {
            let from = support.attachment;
            self.event(ClimberEvent::LostFooting { from });
        }
        self.leave(ClimberMode::Falling)
    }

    /// The attachment of the support.
    pub(super) fn attachment(&self) -> Option<Attachment> {
        self.state.support.map(|support| support.attachment)
    }
}
