//! The thesis's collision resolution (5.5.2, "Collision detection and resolution"): every touching triangle gives a
//! push that moves the sphere out of it, and the climber moves by the mean of the pushes, once a tick. The next tick
//! resolves the rest.

use glam::DVec3;

/// Share of the radius below which a penetration is ignored. The rounding of coordinates up to a few hundred metres
/// causes penetrations of this size, and a contact that just touches must not dilute the mean of the others.
const TOUCH: f64 = 1e-4;

/// The mean of the push-outs of all contacts that penetrate a sphere by more than 1e-4 of its radius.
///
/// A contact is the unit vector out of the obstacle, and the distance of the sphere's centre from the obstacle, which
/// is negative inside. Contacts are summed in the given order; those that are not finite are ignored. Zero without
/// contacts.
pub fn mean_push_out(contacts: impl IntoIterator<Item = (DVec3, f64)>, radius: f64) -> DVec3 {
    let (mut sum, mut count) = (DVec3::ZERO, 0);
    for (away, distance) in contacts {
        let depth = radius - distance;
        let push = away * depth;
        if depth > TOUCH * radius && push.is_finite() {
            sum += push;
            count += 1;
        }
    }
    if count > 0 {
        sum / f64::from(count)
    } else {
        DVec3::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushes_are_averaged_not_added() {
        let contacts = [(DVec3::Y, 0.8), (DVec3::Y, 0.6), (DVec3::X, 1.0)];
        let push = mean_push_out(contacts, 1.0);
        assert!((push - DVec3::Y * 0.3).length() < 1e-12, "{push}");
    }

    #[test]
    fn a_centre_inside_a_solid_is_pushed_out_along_the_normal() {
        let push = mean_push_out([(DVec3::Y, -0.2)], 1.0);
        assert!((push - DVec3::Y * 1.2).length() < 1e-12, "{push}");
    }

    #[test]
    fn contacts_that_are_not_finite_are_ignored() {
        let contacts = [(DVec3::NAN, 0.5), (DVec3::Y, f64::NAN)];
        assert_eq!(mean_push_out(contacts, 1.0), DVec3::ZERO);
    }
}
