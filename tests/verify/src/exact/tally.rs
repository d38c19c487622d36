use super::verdict::Claim;
use crate::cases::{Case, Known};

/// Number of false claims whose descriptions are kept. More would fill a failed test's message.
const SHOWN: usize = 3;

/// Counts of the answers of sweeps, and of the false answers among them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tally {
    /// Number of claims.
    pub cases: usize,
    /// Claims with a time of contact.
    pub hits: usize,
    /// Claims of a time after the first contact, or of no contact where there is one.
    pub late: usize,
    /// Claims of a contact that are not flagged as undecided, although the distance exceeds radius plus tolerance or
    /// the pair is known to miss.
    pub too_far: usize,
    /// Claims for which it could be neither proved nor refuted that they are late.
    pub unproved: usize,
    /// Claims that are flagged as undecided.
    pub undecided: usize,
    /// Descriptions of the first 3 claims that are late, too far or unproved.
    pub shown: Vec<String>,
}

impl Tally {
    /// Checks a claim, and counts the result.
    ///
    /// # Panics
    /// If a number of the case or the claim is not finite, or the claimed time is not in 0..=1.
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
        let is_false = late || far && !claim.undecided || verdict.is_unknown();
        if is_false && self.shown.len() < SHOWN {
            let answer = format!("{claim:?} {verdict:?} {known:?}");
            self.shown.push(format!("{answer} of {case:?}"));
        }
    }

    /// True if no claim was late, too far or unproved.
    pub fn holds(&self) -> bool {
        self.late + self.too_far + self.unproved == 0
    }
}
