//! For tests: every query of a surface, held against brute force or against another surface, bit for bit.

use clamber_verify::agreement::{Agreement, Aims, Answers, Question, extent};

use super::SkinnedSurface;
use crate::measure::BruteForce;

clamber_verify::answer_as_surface!(crate);

/// Asks `rounds` times one question of every kind and aim; returns the number of rows that brute force found as well.
pub(crate) fn assert_queries_agree(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    rounds: usize,
) -> usize {
    let brute_force = BruteForce::new(surface.in_model());
    assert_same_answers(surface, &brute_force, &questions(surface, rng, rounds))
}

/// `rounds` questions of every kind, around a surface in its current pose: aimed, and at any place.
pub(crate) fn questions(
    surface: &SkinnedSurface,
    rng: &mut fastrand::Rng,
    rounds: usize,
) -> Vec<Question> {
    let triangles = BruteForce::new(surface.in_model()).posed_triangles();
    let mut aims = Aims::new(&triangles, extent(&triangles), rng);
    let (mut all, mut round) = (Vec::new(), Vec::new());
    for _ in 0..rounds {
        aims.all(&mut round);
        all.append(&mut round);
    }
    all
}

/// Puts questions to a surface and to a reference; returns the number of rows.
#[track_caller]
pub(crate) fn assert_same_answers(
    surface: &SkinnedSurface,
    reference: &impl Answers,
    questions: &[Question],
) -> usize {
    let mut agreement = Agreement::default();
    agreement.compare(reference, &surface.in_model(), questions);
    if let Some(first) = agreement.first {
        panic!(
            "{} wrong answers, the first {first}",
            agreement.disagreements
        );
    }
    agreement.found
}
