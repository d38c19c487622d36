//! What a creature senses, as numbers that its brain compares.

mod sense;

use serde::{Deserialize, Serialize};

pub use sense::{RegionSense, Sense};

/// All that a creature senses in a tick.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Senses {
    #[serde(with = "bits")]
    numbers: Vec<f64>,
    /// Of each region, one number for each [`RegionSense`].
    #[serde(with = "bits")]
    regions: Vec<f64>,
    /// The game's own.
    #[serde(with = "bits")]
    own: Vec<f64>,
}

impl Senses {
    /// Nothing sensed, for a brain with this many regions and senses of the game's own.
    pub(crate) fn nothing(regions: usize, own: usize) -> Self {
        let mut senses = Self {
            numbers: vec![0.0; Sense::COUNT],
            regions: vec![0.0; regions * RegionSense::ALL.len()],
            own: vec![0.0; own],
        };
        senses.forget();
        senses
    }

    /// Nothing is sensed any more; the game's own senses stay, and how its act ended in the last tick.
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

    /// Another act begins: it is neither done nor blocked.
    pub(crate) fn begin_act(&mut self) {
        self.set(Sense::Done, 0.0);
        self.set(Sense::Blocked, 0.0);
    }

    /// A sense.
    pub fn get(&self, sense: Sense) -> f64 {
        self.numbers[sense as usize]
    }

    /// Sets a sense, for tests of a brain.
    pub fn set(&mut self, sense: Sense, value: f64) {
        self.numbers[sense as usize] = value;
    }

    /// A sense of a region, by the region's index in [`Brain::regions`](crate::Brain::regions); 0 if there is none.
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

    /// One of the game's own senses, by its index in [`Brain::own_senses`](crate::Brain::own_senses); 0 if there is
    /// none.
    pub fn own(&self, index: usize) -> f64 {
        self.own.get(index).copied().unwrap_or(0.0)
    }

    /// Sets one of the game's own senses. Does nothing if there is no such sense.
    pub fn set_own(&mut self, index: usize, value: f64) {
        if let Some(number) = self.own.get_mut(index) {
            *number = value;
        }
    }

    /// True if it has the numbers that a brain reads.
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

/// Numbers as their bits: JSON has no infinity.
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
