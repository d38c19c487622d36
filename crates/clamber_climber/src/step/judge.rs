//! Queries of the game's rule for contacts.

use clamber_mover::MoverContact;
use clamber_world::{Contact, Obstacle, ObstacleId, SurfaceKind};
use glam::DVec3;

use super::{NextMode, Tick};
use crate::climber::StepRules;
use crate::{
    ClimberConfig, ClimberEvent, ClimberMode, ClimberState, ContactQuery, ContactRule, Support,
};

/// The rule for contacts, with the climber as it was at the tick's beginning.
#[derive(Clone, Copy)]
pub(crate) struct Judge<'a> {
    pub(crate) rules: &'a StepRules<'a>,
    pub(crate) config: &'a ClimberConfig,
    pub(crate) state: &'a ClimberState,
    pub(crate) obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    pub(crate) dt: f64,
}

impl Judge<'_> {
    /// The rule for a contact. A climber that this one carries cannot be gripped or hung from.
    pub(crate) fn rule(
        &self,
        id: ObstacleId,
        obstacle: &dyn Obstacle,
        contact: &Contact,
    ) -> ContactRule {
        let query = ContactQuery {
            climber: self.rules.id,
            state: self.state,
            config: self.config,
            dt: self.dt,
            id,
            contact,
            obstacle,
        };
        let Some(rule) = self.rules.contact else {
            return query.usual();
        };
        let rule = rule(&query);
        if (rule.grip || rule.hang) && self.carries(obstacle) {
            rule.with_grip(false).with_hang(false)
        } else {
            rule
        }
    }

    /// True for another climber that this one carries, directly or through others.
    pub(super) fn carries(&self, other: &dyn Obstacle) -> bool {
        let own = self.rules.id;
        let carrier = || other.character().and_then(|other| other.carried_by);
        own.is_some() && carrier() == own
    }

    /// The rule for a contact that the mover found.
    pub(super) fn rule_of(&self, touch: &MoverContact) -> ContactRule {
        match self.obstacle(touch.obstacle) {
            Some(obstacle) => self.rule(touch.obstacle, obstacle, &touch.contact),
            None => ContactRule::PASS,
        }
    }

    /// True if hands may grip a contact.
    pub(super) fn grips(&self, touch: &MoverContact) -> bool {
        // The tag is checked first: the usual rule looks up the obstacle, and there may be many.
        let is_ruled = self.rules.contact.is_some();
        (is_ruled || touch.contact.tag.kind == SurfaceKind::Fur) && self.rule_of(touch).grip
    }

    fn obstacle(&self, id: ObstacleId) -> Option<&dyn Obstacle> {
        let mut known = self.obstacles.iter().filter(|(known, _)| *known == id);
        known.next().map(|(_, obstacle)| *obstacle)
    }

    /// The rule for a support whose material is at `place`. Without the game's own rule, no support is refused.
    pub(super) fn rule_of_support(&self, support: &Support, place: DVec3) -> ContactRule {
        if self.rules.contact.is_none() {
            return ContactRule::GRIP;
        }
        let on = &support.attachment;
        let Some(obstacle) = self.obstacle(on.obstacle) else {
            return ContactRule::GRIP;
        };
        let contact = Contact {
            point: place,
            normal: on.frame * support.face,
            distance: self.config.body.radius,
            material: on.material,
            tag: support.tag,
        };
        self.rule(on.obstacle, obstacle, &contact)
    }

    /// True if the climber begins the tick without a support, or on ground that may be stepped onto. Contacts without
    /// [`ContactRule::step`] are then no way up.
    pub(crate) fn keeps_off_curbs(&self) -> bool {
        let on = self.state.support;
        on.is_none_or(|on| self.rule_of_support(&on, on.attachment.point).step)
    }
}

impl Tick<'_> {
    /// True if a ledge can carry the climber, and may be hung from.
    pub(super) fn can_hang_from(&self, touch: &MoverContact) -> bool {
        self.carries(touch) && self.judge.rule_of(touch).hang
    }

    /// True if the rule keeps the climber from standing on a contact, however level it is.
    pub(super) fn is_refused(&self, touch: &MoverContact) -> bool {
        self.judge.rules.contact.is_some() && !self.judge.rule_of(touch).stand
    }

    /// Leaves ground that the rule refuses: the climber falls through it, or slides off.
    pub(super) fn be_refused_by_ground(&mut self, own: DVec3) -> Option<NextMode> {
        if self.on.solid && self.on.stand {
            return None;
        }
        self.state.velocity += own;
        if self.on.solid {
            self.event(ClimberEvent::Slipped);
            return Some(self.leave(ClimberMode::Sliding));
        }
        // Without this, a late jump would lead back up.
        self.state.coyote = 0.0;
        Some(self.lose_footing())
    }

    /// Loses a hold or a ledge that the rule refuses.
    pub(super) fn be_refused_by_hold(&mut self, holds: bool) -> Option<NextMode> {
        (!self.on.solid || !holds).then(|| self.lose_footing())
    }
}
