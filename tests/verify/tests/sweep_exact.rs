//! Tests the sweeps with edge-edge and vertex-face motions in exact numbers. Some contacts and near misses are known by
//! construction; the claims about all other motions are proved.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber_verify::cases::{Known, constructed};
use clamber_verify::ccd::Stage;
use clamber_verify::exact::{Claim, Tally};

fn answers(cases: u32, seed: u64) -> Tally {
    let mut rng = fastrand::Rng::with_seed(seed);
    let mut stage = Stage::new().unwrap();
    let mut tally = Tally::default();
    for _ in 0..cases {
        let (case, known) = constructed(&mut rng);
        let answer = stage.sweep(&case.pair, case.tolerance).unwrap();
        tally.count(&case, known, &answer.claim());
    }
    tally
}

#[test]
fn no_contact_of_a_hundred_thousand_is_missed_or_late_and_none_is_invented() {
    let tally = answers(100_000, 70);
    println!("{tally:?}");
    assert!(tally.holds(), "{tally:?}");
    assert!(tally.hits > 40_000 && tally.hits < 90_000, "{tally:?}");
}

/// The tally if all answers are changed by `change`.
fn changed(change: impl Fn(f64) -> Option<f64>) -> Tally {
    let mut rng = fastrand::Rng::with_seed(72);
    let mut stage = Stage::new().unwrap();
    let mut tally = Tally::default();
    for _ in 0..1_000 {
        let (case, known) = constructed(&mut rng);
        let answer = stage.sweep(&case.pair, case.tolerance).unwrap();
        let claim = Claim {
            time: answer.claim().time.and_then(&change),
            undecided: false,
        };
        tally.count(&case, known, &claim);
    }
    tally
}

#[test]
fn late_and_missing_answers_are_detected() {
    let late = changed(|time| Some((time + 1e-3).min(1.0)));
    assert!(late.late > 300, "{late:?}");
    let missing = changed(|_| None);
    assert!(missing.late > 500, "{missing:?}");
    let early = changed(|time| Some((time - 1e-2).max(0.0)));
    assert!(early.late == 0 && early.too_far > 300, "{early:?}");
}

#[test]
fn a_sweep_with_three_times_the_tolerance_is_detected() {
    let mut rng = fastrand::Rng::with_seed(73);
    let mut stage = Stage::new().unwrap();
    let (mut tally, mut invented) = (Tally::default(), 0);
    for _ in 0..1_000 {
        let (case, known) = constructed(&mut rng);
        let answer = stage.sweep(&case.pair, case.tolerance * 3.0).unwrap();
        invented += usize::from(known == Known::Misses && answer.hit.is_some());
        tally.count(&case, known, &answer.claim());
    }
    assert!(tally.late == 0 && tally.too_far > 100, "{tally:?}");
    assert!(invented > 20, "{invented} {tally:?}");
}
