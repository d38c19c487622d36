//! Casts and sweeps of hostile shapes against brute force.

use clamber_surface::geometry::{Capsule, Sphere};
use clamber_surface::surface::{BruteForce, SkinnedSurface, SurfaceError, SweepHit};
use glam::Vec3;

use crate::bytes::Bytes;

/// What came of the questions.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Swept {
    pub(crate) answered: usize,
    pub(crate) refused: usize,
    pub(crate) hits: usize,
}

/// One capsule, and the sphere about its first end, on one way each.
pub(crate) fn compare(
    surface: &SkinnedSurface,
    brute_force: &BruteForce<'_>,
    capsule: &Capsule,
    bytes: &mut Bytes<'_>,
) -> Swept {
    let way = capsule.b - capsule.a;
    let motion = match bytes.byte() % 4 {
        0 => Vec3::ZERO,
        1 => way,
        2 => way * bytes.share() * 3.0,
        _ if bytes.one_in(6) => bytes.hostile_point(),
        _ => bytes.point() * way.length(),
    };
    let tolerance = match bytes.byte() % 4 {
        0 => 0.0,
        1 => capsule.radius * 0.01,
        2 if bytes.one_in(4) => bytes.hostile(),
        _ => 1e-4,
    };
    let sphere = Sphere {
        center: capsule.a,
        radius: capsule.radius,
    };
    let motions = [motion, if bytes.one_in(2) { motion } else { way }];
    let mut swept = Swept::default();
    let (mut found, mut wanted) = (Vec::new(), Vec::new());
    let question = format!("{capsule:?}, {motions:?}, {tolerance}");
    // Where coordinates differ by some 2^50 in size, bounds may rule out what the exact test cannot decide.
    let decided = |hits: &[SweepHit]| hits.iter().all(|hit| !hit.undecided);
    // What is refused leaves nothing here.
    let _ = brute_force.sweep_sphere_all(&sphere, motion, tolerance, &mut found);
    let _ = brute_force.sweep_capsule_all(capsule, motions, tolerance, &mut wanted);
    if !(decided(&found) && decided(&wanted)) {
        return swept;
    }

    let one = surface.sweep_sphere(&sphere, motion, tolerance);
    let plain = brute_force.sweep_sphere(&sphere, motion, tolerance);
    swept.same(listed(one), listed(plain), &question);
    let one = surface.sweep_capsule(capsule, motions, tolerance);
    let plain = brute_force.sweep_capsule(capsule, motions, tolerance);
    swept.same(listed(one), listed(plain), &question);
    let all = surface.sweep_sphere_all(&sphere, motion, tolerance, &mut found);
    let plain = brute_force.sweep_sphere_all(&sphere, motion, tolerance, &mut wanted);
    swept.same(
        all.map(|()| found.clone()),
        plain.map(|()| wanted.clone()),
        &question,
    );
    let all = surface.sweep_capsule_all(capsule, motions, tolerance, &mut found);
    let plain = brute_force.sweep_capsule_all(capsule, motions, tolerance, &mut wanted);
    swept.same(
        all.map(|()| found.clone()),
        plain.map(|()| wanted.clone()),
        &question,
    );
    let one = surface.cast_sphere(&sphere, motion, tolerance);
    let plain = brute_force.cast_sphere(&sphere, motion, tolerance);
    swept.same_if_decided(listed(one), listed(plain), &question);
    let one = surface.cast_capsule(capsule, motions, tolerance);
    let plain = brute_force.cast_capsule(capsule, motions, tolerance);
    swept.same_if_decided(listed(one), listed(plain), &question);
    swept
}

fn listed(hit: Result<Option<SweepHit>, SurfaceError>) -> Result<Vec<SweepHit>, SurfaceError> {
    hit.map(|hit| hit.into_iter().collect())
}

impl Swept {
    fn same_if_decided(
        &mut self,
        found: Result<Vec<SweepHit>, SurfaceError>,
        wanted: Result<Vec<SweepHit>, SurfaceError>,
        question: &str,
    ) {
        let undecided = |hits: &Result<Vec<SweepHit>, _>| {
            hits.as_ref()
                .is_ok_and(|hits| hits.iter().any(|hit| hit.undecided))
        };
        if !(undecided(&found) || undecided(&wanted)) {
            self.same(found, wanted, question);
        }
    }

    fn same(
        &mut self,
        found: Result<Vec<SweepHit>, SurfaceError>,
        wanted: Result<Vec<SweepHit>, SurfaceError>,
        question: &str,
    ) {
        match (found, wanted) {
            (Ok(found), Ok(wanted)) => {
                assert_eq!(found, wanted, "{question}");
                for hit in &found {
                    check(hit, question);
                }
                self.answered += 1;
                self.hits += found.len();
            }
            (Err(found), Err(wanted)) => {
                // By their text: the number refused may be none.
                assert_eq!(found.to_string(), wanted.to_string(), "{question}");
                self.refused += 1;
            }
            (found, wanted) => panic!("{question}: {found:?} {wanted:?}"),
        }
    }
}

fn check(hit: &SweepHit, question: &str) {
    assert!((0.0..=1.0).contains(&hit.time), "{question}: {hit:?}");
    assert!(
        hit.distance >= 0.0 && hit.distance.is_finite(),
        "{question}: {hit:?}"
    );
    assert!(hit.point.is_finite(), "{question}: {hit:?}");
    for normal in [hit.normal, hit.surface_normal] {
        let length = normal.as_dvec3().length();
        assert!((length - 1.0).abs() < 1e-6, "{question}: {hit:?}");
    }
    assert!(
        !hit.started_inside || hit.time == 0.0,
        "{question}: {hit:?}"
    );
}
