use core::fmt;

use super::{Found, Question};

/// An implementation of the queries: a surface, a reference, a peer.
pub trait Answers {
    /// Appends the answer to `found`, which is empty, in the order that [`Question`] states.
    fn answer(&self, question: &Question, found: &mut Vec<Found>);
}

/// A question, and the reference's answer to it. Its memory is reused from one question to the next.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    question: Option<Question>,
    wanted: Vec<Found>,
    found: Vec<Found>,
}

impl Comparison {
    /// Asks the reference, and keeps its answer.
    pub fn ask(&mut self, reference: &impl Answers, question: &Question) {
        self.question = Some(*question);
        self.wanted.clear();
        reference.answer(question, &mut self.wanted);
    }

    /// Asks `tested` the last question, compares its answer with the reference's in every bit, and returns the answer.
    /// Before the first question, returns an empty answer.
    ///
    /// # Errors
    /// [`Disagreement`] if the answers differ, or if both have the same invalid number ([`Found::fault`]).
    pub fn hold(&mut self, tested: &impl Answers) -> Result<&[Found], Box<Disagreement>> {
        self.found.clear();
        let Some(question) = &self.question else {
            return Ok(&[]);
        };
        tested.answer(question, &mut self.found);
        match self.fault() {
            None => Ok(&self.found),
            Some((row, field)) => Err(Box::new(Disagreement {
                question: *question,
                field,
                row,
                found: self.found.get(row).copied(),
                wanted: self.wanted.get(row).copied(),
            })),
        }
    }

    /// The reference's answer to the last question.
    pub fn wanted(&self) -> &[Found] {
        &self.wanted
    }

    /// The last answer that was compared.
    pub fn found(&self) -> &[Found] {
        &self.found
    }

    /// The first row that differs or is invalid, and the field.
    fn fault(&self) -> Option<(usize, &'static str)> {
        let rows = self.found.iter().zip(&self.wanted).enumerate();
        for (row, (found, wanted)) in rows {
            if let Some(field) = found.difference(wanted).or_else(|| found.fault()) {
                return Some((row, field));
            }
        }
        let (found, wanted) = (self.found.len(), self.wanted.len());
        (found != wanted).then_some((found.min(wanted), "number of rows"))
    }
}

/// Two answers to one question that differ, or an answer that is invalid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disagreement {
    /// The question.
    pub question: Question,
    /// The first field that differs or is invalid.
    pub field: &'static str,
    /// The first row that differs or is invalid.
    pub row: usize,
    /// That row of the tested answer; `None` if the answer has fewer rows.
    pub found: Option<Found>,
    /// That row of the reference's answer; `None` if the answer has fewer rows.
    pub wanted: Option<Found>,
}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            question,
            field,
            row,
            found,
            wanted,
        } = self;
        write!(
            f,
            "wrong in {field} of row {row}:\n{found:?}\nwanted {wanted:?}\nof {question:?}"
        )
    }
}

impl core::error::Error for Disagreement {}

/// Counts of comparisons.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Number of answers that were compared.
    pub questions: usize,
    /// Number of rows in the answers that agree.
    pub found: usize,
    /// Number of answers that differ from the reference in any bit or are invalid.
    pub disagreements: usize,
    /// The first disagreement.
    pub first: Option<Disagreement>,
}

impl Agreement {
    /// Counts a comparison.
    pub fn count(&mut self, result: Result<&[Found], Box<Disagreement>>) {
        self.questions += 1;
        match result {
            Ok(found) => self.found += found.len(),
            Err(disagreement) => {
                self.disagreements += 1;
                self.first = self.first.or(Some(*disagreement));
            }
        }
    }

    /// Asks a reference and the tested implementation every question, and counts the results.
    pub fn compare(
        &mut self,
        reference: &impl Answers,
        tested: &impl Answers,
        questions: &[Question],
    ) {
        let mut comparison = Comparison::default();
        for question in questions {
            comparison.ask(reference, question);
            self.count(comparison.hold(tested));
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::agreement::Hit;

    /// Answers every question with the same rows.
    struct Same(Vec<Found>);

    impl Answers for Same {
        fn answer(&self, _: &Question, found: &mut Vec<Found>) {
            found.extend(&self.0);
        }
    }

    /// The question of the tests; the answers do not depend on it.
    const QUESTION: Question = Question::ClosestPoint {
        point: Vec3::ZERO,
        max_distance: 1.0,
    };

    /// A valid hit.
    const HIT: Hit = Hit {
        mesh: 7,
        triangle: 3,
        part: 1,
        tag: 0,
        barycentric: [0.5, 0.25, 0.25],
        point: Vec3::ZERO,
        normal: Vec3::Y,
        distance: 0.0,
    };

    /// The field in which two answers differ.
    fn wrong(reference: &[Found], tested: &[Found]) -> Option<&'static str> {
        let mut comparison = Comparison::default();
        comparison.ask(&Same(reference.to_vec()), &QUESTION);
        let result = comparison.hold(&Same(tested.to_vec()));
        result.err().map(|disagreement| disagreement.field)
    }

    type Change = fn(&mut Hit);

    #[test]
    fn every_bit_counts() {
        let hit = Found::Hit(HIT);
        assert_eq!(wrong(&[hit], &[hit]), None);
        assert_eq!(wrong(&[], &[]), None);
        assert_eq!(wrong(&[hit], &[]), Some("number of rows"));
        assert_eq!(wrong(&[hit], &[hit, hit]), Some("number of rows"));
        assert_eq!(wrong(&[hit], &[Found::Any]), Some("kind"));
        let changes: [(&str, Change); 8] = [
            ("mesh", |hit| hit.mesh = 8),
            ("triangle", |hit| hit.triangle = 4),
            ("part", |hit| hit.part = 4),
            ("tag", |hit| hit.tag = 4),
            ("barycentric", |hit| hit.barycentric = [0.25, 0.5, 0.25]),
            ("point", |hit| hit.point.y = -0.0),
            ("normal", |hit| hit.normal = Vec3::Z),
            ("distance", |hit| hit.distance = -0.0),
        ];
        for (field, change) in changes {
            let mut other = HIT;
            change(&mut other);
            assert_eq!(wrong(&[hit], &[Found::Hit(other)]), Some(field));
        }
    }

    #[test]
    fn answers_that_agree_may_be_invalid() {
        let faults: [(&str, Change); 6] = [
            ("barycentric", |hit| hit.barycentric = [1.0, 0.25, 0.25]),
            ("barycentric", |hit| hit.barycentric = [1.25, -0.25, 0.0]),
            ("point", |hit| hit.point = Vec3::NAN),
            ("normal", |hit| hit.normal = Vec3::ZERO),
            ("distance", |hit| hit.distance = f64::INFINITY),
            ("distance", |hit| hit.distance = -1.0),
        ];
        for (field, spoil) in faults {
            let mut hit = HIT;
            spoil(&mut hit);
            let row = Found::Hit(hit);
            assert_eq!(wrong(&[row], &[row]), Some(field), "{hit:?}");
        }
        let contact = |fraction, separation_normal, started_inside| Found::Contact {
            hit: HIT,
            fraction,
            separation_normal,
            started_inside,
            undecided: false,
        };
        let sound = contact(0.5, Vec3::Y, false);
        assert_eq!(wrong(&[sound], &[sound]), None);
        for (field, row) in [
            ("fraction", contact(1.5, Vec3::Y, false)),
            ("fraction", contact(f64::NAN, Vec3::Y, false)),
            ("fraction", contact(0.5, Vec3::Y, true)),
            ("separation_normal", contact(0.5, Vec3::ZERO, false)),
        ] {
            assert_eq!(wrong(&[row], &[row]), Some(field));
        }
    }

    #[test]
    fn an_agreement_keeps_the_first_difference() {
        let hit = Found::Hit(HIT);
        let mut agreement = Agreement::default();
        agreement.compare(&Same(vec![hit]), &Same(vec![hit]), &[QUESTION; 3]);
        agreement.compare(&Same(vec![hit]), &Same(vec![]), &[QUESTION; 2]);
        assert_eq!((agreement.questions, agreement.found), (5, 3));
        assert_eq!(agreement.disagreements, 2);
        let first = agreement.first.unwrap();
        assert_eq!((first.row, first.wanted), (0, Some(hit)));
        assert!(
            first.to_string().contains("number of rows of row 0"),
            "{first}"
        );
    }
}
