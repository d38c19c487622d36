use clamber_climber::ClimberMode;

/// One tick of a battle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Since the beginning, at the end of the tick.
    pub seconds: f64,
    /// Of the climber's centre over the origin, metres.
    pub height: f64,
    /// What the climber is doing.
    pub mode: ClimberMode,
    /// True if it stands on the creature, or holds on to it.
    pub riding: bool,
    /// Distance from a standing rider's contact to the material point recorded when its input ended, metres. In a climb,
    /// and while it holds on, from its contact to its own material point, on the creature. `None` elsewhere.
    pub drift: Option<f64>,
    /// By how much contacts kept it from where it was carried and wanted to go, metres.
    pub push_out: f64,
    /// Vertices of the creature that were skinned for the tick, as a share of all.
    pub skinned_share: f64,
    /// What the tick cost: pose, script, climber.
    pub microseconds: f64,
}

impl Sample {
    /// In a word.
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
    /// Fingerprints of the ticks, folded.
    hash: u64,
}

impl Recording {
    pub(super) fn push(&mut self, sample: Sample, fingerprint: u64) {
        self.samples.push(sample);
        self.hash = (self.hash.rotate_left(5) ^ fingerprint).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    /// In order.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// A number over every bit of the climber's states and the rocks' places: equal for equal battles.
    pub fn hash(&self) -> u64 {
        self.hash
    }

    /// The share of `part` (0 to 1) of the ticks cost no more than this, microseconds.
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

    /// The longest push-out of the ticks with a drift in which it stands: without input.
    pub fn max_push_out(&self) -> f64 {
        let stands = |s: &&Sample| s.drift.is_some() && s.mode == ClimberMode::Standing;
        let standing = self.samples.iter().filter(stands);
        standing.map(|s| s.push_out).fold(0.0, f64::max)
    }

    /// Vertices skinned per tick, as a share of all: the mean over the ticks.
    pub fn skinned_share(&self) -> f64 {
        let sum: f64 = self.samples.iter().map(|s| s.skinned_share).sum();
        sum / self.samples.len().max(1) as f64
    }

    /// How many ticks end in a mode.
    pub fn ticks_in(&self, mode: ClimberMode) -> usize {
        self.samples.iter().filter(|s| s.mode == mode).count()
    }

    /// The share of ticks spent on the creature.
    pub fn riding_share(&self) -> f64 {
        let riding = self.samples.iter().filter(|s| s.riding).count();
        riding as f64 / self.samples.len().max(1) as f64
    }
}
