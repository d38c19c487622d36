//! Compares casts and sweeps of hostile shapes with brute force.

use clamber_surface::geometry::Capsule;
use clamber_surface::surface::{CastOptions, SweepHit};
use glam::Vec3;

use crate::bytes::Bytes;
use crate::queries::Both;
use crate::same::same_sweeps;

/// Counts of what was checked.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Swept {
    pub(crate) answered: usize,
    /// Questions with invalid displacements or tolerances, which found nothing.
    pub(crate) refused: usize,
    pub(crate) hits: usize,
}

/// Displacements of shapes, and the tolerance of a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moves {
    motion: Vec3,
    /// Displacement of a capsule's second end.
    other: Vec3,
    pub(crate) tolerance: f32,
}

impl Moves {
    /// Moves for a capsule whose second end is at `way` from its first.
    pub(crate) fn any(bytes: &mut Bytes<'_>, way: Vec3, radius: f32) -> Self {
        let motion = match bytes.byte() % 4 {
            0 => Vec3::ZERO,
            1 => way,
            2 => way * bytes.share() * 3.0,
            _ if bytes.one_in(6) => bytes.hostile_point(),
            _ => bytes.point() * way.length(),
        };
        let tolerance = match bytes.byte() % 4 {
            0 => 0.0,
            1 => radius * 0.01,
            2 if bytes.one_in(4) => bytes.hostile(),
            _ => 1e-4,
        };
        let other = if bytes.one_in(2) { motion } else { way };
        Self {
            motion,
            other,
            tolerance,
        }
    }

    pub(crate) fn of_ball(&self) -> [Vec3; 2] {
        [self.motion; 2]
    }

    pub(crate) fn of_capsule(&self) -> [Vec3; 2] {
        [self.motion, self.other]
    }
}

/// Compares the casts of one capsule, against moving skin and against still skin.
pub(crate) fn compare(
    both: &Both<'_>,
    capsule: &Capsule,
    motions: [Vec3; 2],
    tolerance: f32,
) -> Swept {
    let mut swept = Swept::default();
    let usable = tolerance >= 0.0 && tolerance.is_finite() && motions.iter().all(|m| m.is_finite());
    for options in [CastOptions::MOVING, CastOptions::STILL] {
        let options = options.with_tolerance(tolerance.into());
        let found = swept.cast(both, capsule, motions, &options);
        assert!(
            usable || found == 0,
            "{capsule:?}, {motions:?}, {options:?}: {found} hits"
        );
    }
    if !usable {
        swept.refused = std::mem::take(&mut swept.answered);
    }
    swept
}

impl Swept {
    /// Compares the first contact and all contacts with brute force; returns how many were found.
    ///
    /// If coordinates differ in size by about 2^50, bounds may rule out contacts that the exact test cannot decide. So
    /// if brute force leaves a contact undecided, only the first contact is compared, and only if both sides have
    /// decided it.
    fn cast(
        &mut self,
        both: &Both<'_>,
        capsule: &Capsule,
        motions: [Vec3; 2],
        options: &CastOptions,
    ) -> usize {
        let Both { space, brute_force } = both;
        let question = format!("{capsule:?}, {motions:?}, {options:?}");
        let (mut all, mut wanted) = (Vec::new(), Vec::new());
        space.cast_capsule_all(capsule, motions, options, &mut all);
        brute_force.cast_capsule_all(capsule, motions, options, &mut wanted);
        let all_decided = decided(&wanted);
        if all_decided {
            self.same(&all, &wanted, &question);
        }
        let one = space.cast_capsule(capsule, motions, options);
        let wanted = brute_force.cast_capsule(capsule, motions, options);
        let (one, wanted) = (one.as_slice(), wanted.as_slice());
        if all_decided || (decided(one) && decided(wanted)) {
            self.same(one, wanted, &question);
        }
        all.len() + one.len()
    }

    fn same(&mut self, found: &[SweepHit], wanted: &[SweepHit], question: &str) {
        let same = same_sweeps(found, wanted);
        assert!(same, "{question}:\n{found:?}\n{wanted:?}");
        for hit in found {
            check(hit, question);
        }
        self.answered += 1;
        self.hits += found.len();
    }
}

fn decided(hits: &[SweepHit]) -> bool {
    hits.iter().all(|hit| !hit.undecided)
}

fn check(hit: &SweepHit, question: &str) {
    assert!((0.0..=1.0).contains(&hit.time), "{question}: {hit:?}");
    assert!(
        hit.distance >= 0.0 && hit.distance.is_finite(),
        "{question}: {hit:?}"
    );
    assert!(hit.point.is_finite(), "{question}: {hit:?}");
    for normal in [hit.separation_normal, hit.normal] {
        let length = normal.as_dvec3().length();
        assert!((length - 1.0).abs() < 1e-6, "{question}: {hit:?}");
    }
    assert!(
        !hit.started_inside || hit.time == 0.0,
        "{question}: {hit:?}"
    );
}
