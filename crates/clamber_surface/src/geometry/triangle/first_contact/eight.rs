//! Eight moving triangles at a time: the scalar source on SIMD registers, with the same bits.

use fearless_simd::{Simd, SimdBase, dispatch};
use glam::DVec3;

use super::super::eight::{Corners8Wide, splat};
use super::super::{Corners8, EIGHT};
use super::path::Path;
use super::{Contact, MISS, MovingCore, UNDECIDED};
use crate::geometry::lanes::Wide;
use crate::geometry::widen;
use crate::simd::SimdLevel;

/// The results of [`first_contact`](super::first_contact) for eight triangles.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Contacts8 {
    verdict: [f64; EIGHT],
    time: [f64; EIGHT],
    barycentric: [[f64; EIGHT]; 3],
    distance: [f64; EIGHT],
    /// Largest number of steps of any lane.
    pub(crate) steps: u32,
}

impl Contacts8 {
    pub(crate) fn get(&self, lane: usize) -> Option<Contact> {
        let [a, b, c] = &self.barycentric;
        (self.verdict[lane] != MISS).then(|| Contact {
            barycentric: DVec3::new(a[lane], b[lane], c[lane]),
            time: self.time[lane],
            distance: self.distance[lane],
            undecided: self.verdict[lane] == UNDECIDED,
        })
    }
}

/// [`first_contact`](super::first_contact) for each triangle, with the same bits. Callers fill unused lanes with a used
/// triangle.
pub(crate) fn first_contact_of_eight<const N: usize, const P: usize>(
    level: SimdLevel,
    corners: &[Corners8; P],
    core: &MovingCore<N>,
    limit: f64,
) -> Contacts8 {
    dispatch!(level.level(), simd => first_contact_simd(simd, corners, core, limit))
}

#[cfg_attr(not(unoptimized), inline(always))]
fn first_contact_simd<S: Simd, const N: usize, const P: usize>(
    simd: S,
    corners: &[Corners8; P],
    core: &MovingCore<N>,
    limit: f64,
) -> Contacts8 {
    let corners = corners.each_ref().map(Corners8Wide::new);
    let origin = splat(simd, widen(core.origin));
    let (mut core_start, mut core_end) = ([origin; N], [origin; N]);
    for end in 0..N {
        core_start[end] = splat(simd, core.start[end]);
        core_end[end] = splat(simd, core.end[end]);
    }
    let number = |x: f64| Wide::<S>(S::f64s::splat(simd, x));
    let mut contacts = Contacts8::default();
    for first in (0..EIGHT).step_by(S::f64s::LEN) {
        let mut relative = [[origin; 3]; P];
        for (relative, corners) in relative.iter_mut().zip(&corners) {
            *relative = corners.relative_to(simd, first, origin);
        }
        let path = Path {
            corners: relative,
            core_start,
            core_end,
            radius: number(core.radius),
            tolerance: number(core.tolerance),
        };
        let (found, steps) = path.first_contact(number(limit));
        let lanes = first..first + S::f64s::LEN;
        found
            .verdict
            .0
            .store_slice(&mut contacts.verdict[lanes.clone()]);
        found.time.0.store_slice(&mut contacts.time[lanes.clone()]);
        found
            .distance
            .0
            .store_slice(&mut contacts.distance[lanes.clone()]);
        for (row, weight) in contacts.barycentric.iter_mut().zip(found.weights) {
            weight.0.store_slice(&mut row[lanes.clone()]);
        }
        contacts.steps = contacts.steps.max(steps);
    }
    contacts
}
