//! Tests the sweeps with adversarial motions of spheres and capsules. Every answer is proved.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber_verify::cases::{Case, KINDS, Kind, Known, adversarial};
use clamber_verify::ccd::{Answer, CAP, Stage};
use clamber_verify::exact::Tally;

fn each(kind: Kind, cases: u32, seed: u64, mut visit: impl FnMut(&Case, &Answer)) {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut stage = Stage::new().unwrap();
    for _ in 0..cases {
        let case = adversarial(kind, &mut rng);
        let answer = stage.sweep(&case.pair, case.tolerance).unwrap();
        visit(&case, &answer);
    }
}

/// Checks `cases` cases of every kind.
fn check(cases: u32, seed: u64) {
    let mut capped = 0;
    for kind in KINDS {
        let mut tally = Tally::default();
        each(kind, cases, seed, |case, answer| {
            tally.count(case, Known::Nothing, &answer.claim());
            capped += usize::from(answer.steps >= CAP);
        });
        println!("{kind:?}: {tally:?}");
        assert!(tally.holds(), "{kind:?}: {tally:?}");
    }
    let all = cases as usize * KINDS.len();
    println!("{capped} of {all} reached the step limit");
    assert!(capped * 500 <= all, "{capped} of {all}");
}

#[test]
fn no_answer_is_late_or_too_far() {
    check(10_000, 80);
}

#[test]
#[ignore = "a million: run it in release"]
fn no_answer_of_a_million_is_late_or_too_far() {
    check(84_000, 81);
}

#[test]
fn sliding_past_is_no_contact_and_starting_inside_is_one_at_time_zero() {
    each(Kind::Slide, 500, 82, |case, answer| {
        assert!(
            answer.hit.is_none_or(|hit| hit.undecided),
            "{case:?} {answer:?}"
        );
    });
    each(Kind::Inside, 500, 83, |case, answer| {
        let hit = answer.hit.unwrap();
        assert!(
            hit.fraction == 0.0 && hit.started_inside,
            "{case:?} {hit:?}"
        );
        for normal in [hit.separation_normal, hit.hit.normal] {
            let length = normal.length();
            assert!((length - 1.0).abs() < 1e-6, "{case:?} {hit:?}");
        }
    });
}
