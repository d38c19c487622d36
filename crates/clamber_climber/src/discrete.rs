//! The thesis's collision resolution, kept as the baseline for better ones (5.5.2, "Collision
//! detection and resolution"): every touching triangle pushes the sphere out by itself, the
//! climber moves by the mean of the pushes, once a tick, and what remains is left to the next.

use clamber_world::Contact;
use glam::DVec3;

/// Penetrations below this share of the radius are rounding of coordinates up to some hundred
/// metres: a contact that just touches must not dilute the mean of those that push.
const TOUCH: f64 = 1e-4;

/// What the contacts of a tick do to a sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PushOut {
    /// By how much to move the sphere: the mean of all push-outs.
    pub displacement: DVec3,
    /// How many contacts pushed.
    pub contacts: usize,
    /// The deepest penetration among them, metres.
    pub deepest: f64,
}

/// The mean of the push-outs of all contacts that penetrate a sphere by more than 1e-4 of its
/// radius.
///
/// Sums in the order given, so contacts must come in an order of their own, by obstacle and
/// triangle. Contacts that are not finite push nothing.
///
/// ```
/// use clamber_climber::average_push_out;
/// use clamber_world::{Contact, MaterialPoint};
/// use glam::DVec3;
///
/// // The ground, 0.9 m below the centre of a sphere of radius 1.
/// let ground = Contact {
///     point: DVec3::new(0.0, -0.9, 0.0),
///     normal: DVec3::Y,
///     distance: 0.9,
///     material: MaterialPoint { key: 0, coordinates: [1.0, 0.0, 0.0] },
///     tag: Default::default(),
/// };
/// let push = average_push_out(&[ground], DVec3::ZERO, 1.0);
/// assert!((push.displacement - DVec3::new(0.0, 0.1, 0.0)).length() < 1e-12);
/// ```
pub fn average_push_out(contacts: &[Contact], center: DVec3, radius: f64) -> PushOut {
    let mut sum = DVec3::ZERO;
    let (mut count, mut deepest) = (0, 0.0f64);
    for contact in contacts {
        let depth = radius - contact.distance;
        let push = contact.away(center) * depth;
        if depth > TOUCH * radius && push.is_finite() {
            sum += push;
            count += 1;
            deepest = deepest.max(depth);
        }
    }
    PushOut {
        displacement: if count > 0 {
            sum / f64::from(count)
        } else {
            DVec3::ZERO
        },
        contacts: count as usize,
        deepest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_surface::mesh::SurfaceTag;
    use clamber_world::MaterialPoint;

    fn contact(normal: DVec3, distance: f64) -> Contact {
        Contact {
            point: -normal * distance,
            normal,
            distance,
            material: MaterialPoint {
                key: 0,
                coordinates: [0.0; 3],
            },
            tag: SurfaceTag::default(),
        }
    }

    #[test]
    fn pushes_are_averaged_not_added() {
        let contacts = [
            contact(DVec3::Y, 0.8),
            contact(DVec3::Y, 0.6),
            contact(DVec3::X, 1.0),
        ];
        let push = average_push_out(&contacts, DVec3::ZERO, 1.0);
        assert!(
            (push.displacement - DVec3::Y * 0.3).length() < 1e-12,
            "{push:?}"
        );
        assert_eq!(push.contacts, 2);
        assert!((push.deepest - 0.4).abs() < 1e-12);
    }

    #[test]
    fn inside_a_solid_the_way_out_is_the_normal() {
        let push = average_push_out(&[contact(DVec3::Y, -0.2)], DVec3::ZERO, 1.0);
        assert!(
            (push.displacement - DVec3::Y * 1.2).length() < 1e-12,
            "{push:?}"
        );
    }

    #[test]
    fn nonsense_pushes_nothing() {
        let contacts = [contact(DVec3::NAN, 0.5), contact(DVec3::Y, f64::NAN)];
        let push = average_push_out(&contacts, DVec3::ZERO, 1.0);
        assert_eq!((push.displacement, push.contacts), (DVec3::ZERO, 0));
    }
}
