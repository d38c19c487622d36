use clamber_climber::ClimberMode;
use clamber_colossus::brain::StateId;

/// One tick of a battle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time since the beginning at the end of the tick, seconds.
    pub seconds: f64,
    /// Y of the climber's centre in the world, metres.
    pub height: f64,
    /// The climber's mode.
    pub mode: ClimberMode,
    /// True if the climber's support is the creature: it stands on it or holds on to it.
    pub riding: bool,
    /// Drift of the climber from its material point on the creature, metres; `None` where it is not defined.
    ///
    /// For a rider that stands without input: the distance of its contact from the material point recorded when its
    /// input ended, or the depth of its body in that point if larger. In a climb, and while it holds on: the distance
    /// of its contact from its own material point.
    pub drift: Option<f64>,
    /// The state of the creature's brain; `None` without a brain.
    pub state: Option<StateId>,
    /// Distance by which contacts kept the climber from where it was carried and wanted to go, metres.
    pub push_out: f64,
    /// Vertices of the creature that were skinned for the tick, as a share of all.
    pub skinned_share: f64,
    /// The climber's stamina, 0 to 1.
    pub stamina: f64,
    /// Time of the pose, the script and the climber's step, microseconds.
    pub microseconds: f64,
}

impl Sample {
    /// The climber's activity in one word, padded to eight characters.
    pub fn activity(&self) -> &'static str {
        match (self.mode, self.riding) {
            (ClimberMode::Falling, _) => "falling ",
            (ClimberMode::Tumbling, _) => "tumbling",
            (ClimberMode::Sliding, _) => "sliding ",
            (ClimberMode::Standing, true) => "riding  ",
            (ClimberMode::Standing, false) => "grounded",
            (ClimberMode::Holding, _) => "holding ",
            (ClimberMode::Hanging | ClimberMode::LedgeHanging, _) => "hanging ",
            (ClimberMode::Custom(_), _) => "custom  ",
        }
    }
}

/// All ticks of a battle.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    samples: Vec<Sample>,
    /// Hash of the ticks' fingerprints.
    hash: u64,
}

impl Recording {
    pub(super) fn push(&mut self, sample: Sample, fingerprint: u64) {
        self.samples.push(sample);
        self.hash = (self.hash.rotate_left(5) ^ fingerprint).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    /// The ticks, in order.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// A 64-bit hash of the climber's states, the rocks' poses and all that changes in a fight, in all ticks, for
    /// comparing battles.
    pub fn hash(&self) -> u64 {
        self.hash
    }

    /// The `part` quantile (0 to 1) of the ticks' times, microseconds; 0 without ticks.
    pub fn tick_us(&self, part: f64) -> f64 {
        let mut costs: Vec<f64> = self.samples.iter().map(|s| s.microseconds).collect();
        costs.sort_by(f64::total_cmp);
        let index = (costs.len() as f64 * part) as usize;
        costs
            .get(index.min(costs.len().saturating_sub(1)))
            .copied()
            .unwrap_or(0.0)
    }

    /// The largest drift of all ticks, metres; 0 if there was none.
    pub fn max_drift(&self) -> f64 {
        self.samples
            .iter()
            .filter_map(|s| s.drift)
            .fold(0.0, f64::max)
    }

    /// The longest push-out of the ticks in which the climber stands and has a drift, metres: in a ride, those without
    /// input. 0 if there is none.
    pub fn max_push_out(&self) -> f64 {
        let stands = |s: &&Sample| s.drift.is_some() && s.mode == ClimberMode::Standing;
        let standing = self.samples.iter().filter(stands);
        standing.map(|s| s.push_out).fold(0.0, f64::max)
    }

    /// Mean share of the creature's vertices that were skinned in a tick.
    pub fn skinned_share(&self) -> f64 {
        let sum: f64 = self.samples.iter().map(|s| s.skinned_share).sum();
        sum / self.samples.len().max(1) as f64
    }

    /// Number of ticks that end in a mode.
    pub fn ticks_in(&self, mode: ClimberMode) -> usize {
        self.samples.iter().filter(|s| s.mode == mode).count()
    }

    /// How often a state of the creature's brain was entered, and the number of ticks that end in it.
    pub fn stays_in(&self, state: StateId) -> (usize, usize) {
        let is_in = |sample: &Sample| sample.state == Some(state);
        let ticks = self.samples.iter().filter(|sample| is_in(sample)).count();
        let later = self.samples.windows(2);
        let later = later.filter(|pair| !is_in(&pair[0]) && is_in(&pair[1]));
        let first = self.samples.first().is_some_and(is_in);
        (later.count() + usize::from(first), ticks)
    }

    /// The lowest stamina; 1 without ticks.
    pub fn least_stamina(&self) -> f64 {
        let all = self.samples.iter().map(|s| s.stamina);
        all.fold(1.0, f64::min)
    }

    /// All stamina that was spent: 1 is as much as a climber has.
    pub fn spent_stamina(&self) -> f64 {
        let pairs = self.samples.windows(2);
        pairs
            .map(|pair| (pair[0].stamina - pair[1].stamina).max(0.0))
            .sum()
    }

    /// The share of ticks spent on the creature.
    pub fn riding_share(&self) -> f64 {
        let riding = self.samples.iter().filter(|s| s.riding).count();
        riding as f64 / self.samples.len().max(1) as f64
    }
}
