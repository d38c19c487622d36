//! Queries of parry's shapes, shared by the obstacles of rapier and avian, which so give the same answers.
//!
//! A shape is a set of parts: triangles, met from both sides by the solver of skinned surfaces, and solid convex
//! shapes. Of parry only the shapes themselves are asked, their trees and their support points; distances, ways out
//! and times of contact are computed here in f64.

mod convex;
mod first;
mod holds;
mod moved;
mod overlap;
mod parts;
mod reach;
mod sweep;
mod tick;

pub use first::FirstContact;
pub use holds::holds;
pub use moved::Moved;
pub use overlap::{ShapeContact, overlap_shape};
pub use reach::Reach;
pub use sweep::{ShapeSweep, ShapeTouch, sweep_shape};
pub use tick::Tick;

use std::cmp::Ordering;

use crate::Contact;

/// First radius, in metres, of the search for the closest point; it doubles until something lies
/// within. Larger looks at more triangles where something is near, smaller searches longer where
/// nothing is.
const FIRST_REACH: f64 = 1.0;

/// The contact of least distance up to `max_distance`, by overlaps of growing radius. `reach_of_all` is a radius
/// that reaches everything.
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

/// By ascending key, and by place and normal within one body, so that the order of its tree does not matter. In
/// place, so that a steady tick allocates nothing.
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
