//! Queries against parry's shapes. The obstacles of rapier and avian share them, so both give the same answers.
//!
//! A shape is a set of parts: triangles, which are two-sided and go through the solver of skinned surfaces, and solid
//! convex shapes. From parry come only the shapes, their trees and their support points. Distances, minimum
//! translations and times of contact are computed here, in f64.

mod convex;
mod first;
mod holds;
mod moved;
mod overlap;
mod parts;
mod sweep;
mod swept_bounds;
mod tick;

pub use first::FirstContact;
pub use holds::holds;
pub use moved::Moved;
pub use overlap::{ShapeContact, overlap_shape};
pub use sweep::{ShapeSweep, sweep_shape};
pub use swept_bounds::SweptBounds;
pub use tick::Tick;

use std::cmp::Ordering;

use crate::Contact;

/// First search radius for the closest point, metres; it doubles until a contact is found. A larger radius tests more
/// triangles where something is near; a smaller one takes more rounds where nothing is.
const FIRST_REACH: f64 = 1.0;

/// The closest contact up to `max_distance` metres, found by overlaps of growing radius. `overlap` appends the contacts
/// within a radius; `reach_of_all` is a radius that contains the whole obstacle.
pub fn closest_by_overlap(
    max_distance: f64,
    reach_of_all: f64,
    mut overlap: impl FnMut(f64, &mut Vec<Contact>),
) -> Option<Contact> {
    if max_distance.is_nan() {
        return None;
    }
    let limit = max_distance.min(reach_of_all * 1.001);
    let mut contacts = Vec::new();
    let mut reach = FIRST_REACH.min(limit);
    loop {
        overlap(reach, &mut contacts);
        let nearest = contacts.iter().copied().min_by(|a, b| {
            let by_key = a.material.key.cmp(&b.material.key);
            a.distance.total_cmp(&b.distance).then(by_key)
        });
        if nearest.is_some() || reach >= limit {
            return nearest.filter(|contact| contact.distance <= max_distance);
        }
        reach = (reach * 2.0).min(limit);
    }
}

/// Sorts contacts by key, then by local coordinates, then by normal, so that the order of an engine's tree does not
/// matter. In place, so that a steady tick allocates nothing.
pub fn sort_contacts(contacts: &mut [Contact]) {
    contacts.sort_unstable_by(compare);
}

fn compare(a: &Contact, b: &Contact) -> Ordering {
    let compare = |a: [f64; 3], b: [f64; 3]| {
        let each = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
        each.fold(Ordering::Equal, Ordering::then)
    };
    let by_key = a.material.key.cmp(&b.material.key);
    by_key
        .then_with(|| compare(a.material.coordinates, b.material.coordinates))
        .then_with(|| compare(a.normal.to_array(), b.normal.to_array()))
}
