use core::ops::AddAssign;

/// What there was to check.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// Poses taken.
    pub ticks: usize,
    /// Palettes refused, and forgotten.
    pub refused: usize,
    /// Questions whose answers were compared.
    pub questions: usize,
    /// Hits among the answers.
    pub hits: usize,
    /// Times that a vertex was held against a bound.
    pub bounds: usize,
    /// Rays that closed skin had to stop.
    pub rays: usize,
    /// Nearest points compared with f64.
    pub nearest: usize,
    /// Casts and sweeps that had to touch.
    pub contacts: usize,
    /// Questions in the world.
    pub world: usize,
    /// Casts and sweeps that were flagged undecided.
    pub undecided: usize,
    /// Most steps that any of them took for a triangle.
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
    /// All checks.
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
