use super::verdict::Claim;
use crate::cases::{Case, Known};

/// False answers that are kept to be shown.
const SHOWN: usize = 3;

/// What sweeps answered, and whether that is right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Answers.
    pub cases: usize,
    /// Contacts.
    pub hits: usize,
    /// Touching before the time that was claimed, or known to touch where no contact was.
    pub late: usize,
    /// Contacts farther away than radius and tolerance, or known to be none, and not flagged.
    pub too_far: usize,
    /// Could neither be proved nor refuted.
    pub unproved: usize,
    /// Contacts that say that they may be too far away.
    pub undecided: usize,
    /// Of these, those that are.
    pub undecided_far: usize,
    /// The first false answers.
    pub shown: Vec<String>,
}

impl Tally {
    /// Counts a claim, and whether it is true.
    ///
    /// # Panics
    /// If a number of the case or the claim is not finite, or its time not in 0..=1.
    pub fn count(&mut self, case: &Case, known: Known, claim: &Claim) {
        let verdict = claim.check(&case.pair, case.tolerance);
        let known_late = match known {
            Known::Touches(touch) => claim.time.is_none_or(|time| time > touch),
            _ => false,
        };
        let late = verdict.is_late() || known_late;
        let far = !verdict.near || (known == Known::Misses && claim.time.is_some());
        self.cases += 1;
        self.hits += usize::from(claim.time.is_some());
        self.late += usize::from(late);
        self.too_far += usize::from(far && !claim.undecided);
        self.unproved += usize::from(verdict.is_unknown());
        self.undecided += usize::from(claim.undecided);
        self.undecided_far += usize::from(far && claim.undecided);
        let is_false = late || far && !claim.undecided || verdict.is_unknown();
        if is_false && self.shown.len() < SHOWN {
            let answer = format!("{claim:?} {verdict:?} {known:?}");
            self.shown.push(format!("{answer} of {case:?}"));
        }
    }

    /// True if no answer was false.
    pub fn holds(&self) -> bool {
        self.late + self.too_far + self.unproved == 0
    }
}
