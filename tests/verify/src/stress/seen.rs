use core::ops::AddAssign;

/// Numbers of checks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Poses that were accepted.
    pub ticks: usize,
    /// Ticks in which a faulty palette was rejected, and left no trace.
    pub refused: usize,
    /// Questions whose answers were compared.
    pub questions: usize,
    /// Hits among the answers.
    pub hits: usize,
    /// Comparisons of a vertex with a bound.
    pub bounds: usize,
    /// Rays that had to hit closed skin.
    pub rays: usize,
    /// Closest points that were checked in f64.
    pub nearest: usize,
    /// Casts and sweeps that had to touch.
    pub contacts: usize,
    /// Questions and motions in world space.
    pub world: usize,
    /// Contacts that were flagged as undecided.
    pub undecided: usize,
    /// Largest number of steps that a cast or sweep took for a triangle.
    pub steps: usize,
}

impl AddAssign for Seen {
    fn add_assign(&mut self, other: Self) {
        self.ticks += other.ticks;
        self.refused += other.refused;
        self.questions += other.questions;
        self.hits += other.hits;
        self.bounds += other.bounds;
        self.rays += other.rays;
        self.nearest += other.nearest;
        self.contacts += other.contacts;
        self.world += other.world;
        self.undecided += other.undecided;
        self.steps = self.steps.max(other.steps);
    }
}

impl Seen {
    /// Number of all checks.
    pub fn checks(&self) -> usize {
        self.refused
            + self.questions
            + self.bounds
            + self.rays
            + self.nearest
            + self.contacts
            + self.world
    }
}
