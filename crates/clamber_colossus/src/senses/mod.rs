//! A creature's senses: numbers that its brain compares.

mod sense;

use serde::{Deserialize, Serialize};

pub use sense::{RegionSense, Sense};

/// All senses of a creature in a tick.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Senses {
    #[serde(with = "bits")]
    numbers: Vec<f64>,
    /// Per region, one number for each [`RegionSense`].
    #[serde(with = "bits")]
    regions: Vec<f64>,
    /// The game's own senses.
    #[serde(with = "bits")]
    own: Vec<f64>,
}

impl Senses {
    /// The senses of a creature that senses nothing, for a brain with this many regions and senses of the game's own.
    pub(crate) fn nothing(regions: usize, own: usize) -> Self {
        let mut senses = Self {
            numbers: vec![0.0; Sense::COUNT],
            regions: vec![0.0; regions * RegionSense::ALL.len()],
            own: vec![0.0; own],
        };
        senses.forget();
        senses
    }

    /// Resets all senses to the values of a creature that senses nothing. The game's own senses, [`Sense::Done`] and
    /// [`Sense::Blocked`] stay.
    pub(crate) fn forget(&mut self) {
        let ends = [Sense::Done, Sense::Blocked];
        let kept = ends.map(|end| self.numbers[end as usize]);
        self.numbers.fill(0.0);
        self.regions.fill(0.0);
        for far in [
            Sense::PreyDistance,
            Sense::PreyUnseenSeconds,
            Sense::WallDistance,
        ] {
            self.set(far, f64::INFINITY);
        }
        self.set(Sense::Health, 1.0);
        for (end, value) in ends.into_iter().zip(kept) {
            self.set(end, value);
        }
    }

    /// Resets [`Sense::Done`] and [`Sense::Blocked`] when another act begins.
    pub(crate) fn begin_act(&mut self) {
        self.set(Sense::Done, 0.0);
        self.set(Sense::Blocked, 0.0);
    }

    /// The value of a sense, in the unit that [`Sense`] gives.
    pub fn get(&self, sense: Sense) -> f64 {
        self.numbers[sense as usize]
    }

    /// Sets a sense, for tests of a brain.
    pub fn set(&mut self, sense: Sense, value: f64) {
        self.numbers[sense as usize] = value;
    }

    /// The value of a region's sense, by the region's index in [`Brain::regions`](crate::Brain::regions); 0 if there is
    /// no such region.
    pub fn in_region(&self, sense: RegionSense, region: usize) -> f64 {
        let index = region * RegionSense::ALL.len() + sense as usize;
        self.regions.get(index).copied().unwrap_or(0.0)
    }

    /// Sets a sense of a region, for tests of a brain. Does nothing if there is no such region.
    pub fn set_in_region(&mut self, sense: RegionSense, region: usize, value: f64) {
        if let Some(number) = self
            .regions
            .get_mut(region * RegionSense::ALL.len() + sense as usize)
        {
            *number = value;
        }
    }

    /// The value of one of the game's own senses, by its index in [`Brain::own_senses`](crate::Brain::own_senses); 0 if
    /// there is no such sense.
    pub fn own(&self, index: usize) -> f64 {
        self.own.get(index).copied().unwrap_or(0.0)
    }

    /// Sets one of the game's own senses. Does nothing if there is no such sense.
    pub fn set_own(&mut self, index: usize, value: f64) {
        if let Some(number) = self.own.get_mut(index) {
            *number = value;
        }
    }

    /// True if the senses have the sizes that a brain with these counts needs, and no value is NaN.
    pub(crate) fn fits(&self, regions: usize, own: usize) -> bool {
        let per_region = RegionSense::ALL.len();
        (self.numbers.len(), self.regions.len(), self.own.len())
            == (Sense::COUNT, regions * per_region, own)
            && [&self.numbers[..], &self.regions, &self.own]
                .into_iter()
                .flatten()
                .all(|number| !number.is_nan())
    }
}

/// Serialises numbers as their bits, since JSON has no infinity.
mod bits {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(
        numbers: &[f64],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        let bits: Vec<u64> = numbers.iter().map(|number| number.to_bits()).collect();
        bits.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<f64>, D::Error> {
        let bits = Vec::<u64>::deserialize(deserializer)?;
        Ok(bits.into_iter().map(f64::from_bits).collect())
    }
}
