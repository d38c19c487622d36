use glam::DVec3;

use crate::{Mover, MoverBody, MoverContact};

/// Contacts farther than the nearest by less than this fraction of the body's radius count as equally near.
const AS_NEAR: f64 = 0.05;

/// Maximum number of contacts for which a hand's reach is tested: a surface behind a wall has many triangles.
const TRIES: usize = 16;

/// Length at the end of the line to a contact that may be blocked, as a fraction of the body's radius: the triangles
/// around the contact are there, and rounding moves them. Armour above fur that is thicker than this keeps hands off.
const AT_HAND: f64 = 0.0025;

impl Mover<'_> {
    /// Finds the contact that hands grip at a position: the nearest one within `reach` metres of the body's ball that
    /// `can_grip` accepts and that a hand can reach. Among contacts about equally near, the one with the highest
    /// `merit` is chosen; a merit of 1 outweighs a tenth of the radius in distance.
    pub fn find_grip(
        &mut self,
        body: &MoverBody,
        position: DVec3,
        reach: f64,
        can_grip: impl Fn(&MoverContact) -> bool,
        merit: impl Fn(&MoverContact) -> f64,
    ) -> Option<MoverContact> {
        // Nearly always there is a grip close to the body. A contact that is farther than the nearest grip by more than
        // `as_near` cannot be chosen. So the grip found within this short reach is also the grip of the whole reach.
        let as_near = AS_NEAR * body.radius;
        let at_body = as_near + 0.5 * body.margin;
        if at_body < reach {
            let found = self.grip_within(body, position, at_body, &can_grip, &merit);
            if found.is_some_and(|touch| touch.contact.distance + as_near <= at_body + body.radius)
            {
                return found;
            }
        }
        self.grip_within(body, position, reach, &can_grip, &merit)
    }

    fn grip_within(
        &mut self,
        body: &MoverBody,
        position: DVec3,
        reach: f64,
        can_grip: &impl Fn(&MoverContact) -> bool,
        merit: &impl Fn(&MoverContact) -> f64,
    ) -> Option<MoverContact> {
        let overlaps = self.overlap(&body.crouched(), position, reach).iter();
        let distances = overlaps.map(|touch| touch.contact.distance);
        // Within this distance no obstacle can block the line to a contact: no contact is nearer than the nearest one,
        // and no obstacle is inside the core unless it crushes the body.
        let clear = distances
            .fold(f64::INFINITY, f64::min)
            .max(body.core_radius());
        let as_near = AS_NEAR * body.radius;
        let mut blocked = [usize::MAX; TRIES];
        for tries in 0..TRIES {
            let blocked_so_far = &blocked[..tries];
            let candidates = || {
                let all = self.overlaps().iter().enumerate();
                all.filter(|(index, touch)| !blocked_so_far.contains(index) && can_grip(touch))
            };
            let distances = candidates().map(|(_, touch)| touch.contact.distance);
            let nearest = distances.fold(f64::INFINITY, f64::min);
            let mut best: Option<(f64, usize)> = None;
            for (index, touch) in candidates() {
                let farther = touch.contact.distance - nearest;
                if farther > as_near {
                    continue;
                }
                let cost = farther - merit(touch) * as_near * 2.0;
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, index));
                }
            }
            let (_, index) = best?;
            let touch = self.overlaps()[index];
            let at_hand = AT_HAND * body.radius;
            let is_clear = touch.contact.distance - at_hand <= clear;
            if is_clear || self.can_reach(position, &touch, at_hand) {
                return Some(touch);
            }
            blocked[tries] = index;
        }
        None
    }

    /// True if no obstacle blocks the line from a position to a contact, with obstacles in their current state. The
    /// last `slack` metres of the line are ignored. Also true for input that is not finite.
    pub fn can_reach(&mut self, position: DVec3, touch: &MoverContact, slack: f64) -> bool {
        let way = touch.contact.point - position;
        let length = way.length() - slack;
        length <= 0.0 || self.cast_ray(position, way, length).is_none()
    }
}

#[cfg(test)]
mod tests;
