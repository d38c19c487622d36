use clamber_climber::ClimberConfig;
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{SurfaceKind, SurfaceTag, TriangleId};

use crate::NavigationError;

/// Settings of a climb graph: the climber and what it can grip; the creature's place, size, rate of clips and removable
/// plates; the height of the ground; and how finely the skin is divided into patches.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub struct GraphConfig {
    /// The climber's body and abilities.
    pub climber: ClimberConfig,
    /// Largest side of a patch of skin, metres, positive, at most 1.4 radii of the climber. Default: the climber's
    /// radius. Smaller patches follow narrow ways better, and cost more.
    pub spacing: f64,
    /// Materials that can be gripped. Default: fur. The climber's own steps do not read this list. Give them the same
    /// rule, as `StepRules::by(&|query| query.usual().with_grip(config.can_grip(&query.tag())))`; otherwise the climber
    /// does not find the holds that the graph promises.
    pub grips: Vec<SurfaceKind>,
    /// The creature's transform from model space to world space. Its scale is the metres per unit of the model.
    /// Default: identity.
    pub world_from_model: Similarity,
    /// Height of the ground below the creature, metres: one level plane, at this distance from the world's origin along
    /// the climber's up ([`ClimberConfig::up`]). Climbers get on from it. Skin has no patches where the climber's ball
    /// would be in the ground. Default: 0, which fits most files, whose feet stand at the origin.
    pub ground: f64,
    /// The rate at which the creature plays its clips, as a share of the file's, from 0.0001 to 10,000: 1 for a
    /// creature of the size for which the clips were made, less for a larger one. A living creature's rate is
    /// `clamber_colossus::Creature::rate`. Default: 1.
    pub clip_rate: f64,
    /// Parts of the skin that can be removed one by one, such as plates of armour. The skin below them is divided into
    /// patches as well. Every triangle must exist in the skin ([`NavigationError::Surface`]). In the division into
    /// patches, a triangle that is in several plates belongs to the last of them. A living creature's plates are
    /// `clamber_colossus::CreatureKind::plates`. Default: none; at most 65,536.
    pub plates: Vec<Vec<TriangleId>>,
}

/// Allowed rates of clips, as a share of the file's rate.
const CLIP_RATES: std::ops::RangeInclusive<f64> = 1e-4..=1e4;

/// Largest number of plates: patches store their plate's number in 16 bits.
const MOST_PLATES: usize = 1 << 16;

impl GraphConfig {
    /// The configuration for a climber, with the defaults of all other fields.
    pub fn new(climber: ClimberConfig) -> Self {
        Self {
            climber,
            spacing: climber.body.radius,
            grips: vec![SurfaceKind::Fur],
            world_from_model: Similarity::IDENTITY,
            ground: 0.0,
            clip_rate: 1.0,
            plates: Vec::new(),
        }
    }

    /// True if skin with this tag can be gripped.
    pub fn can_grip(&self, tag: &SurfaceTag) -> bool {
        self.grips.contains(&tag.kind)
    }

    /// Radius of the climber's ball, metres.
    pub(crate) fn radius(&self) -> f64 {
        self.climber.body.radius
    }

    /// How far from its ball the climber grips, metres; negative if it cannot grip.
    pub(crate) fn reach(&self) -> f64 {
        self.climber.grip.map_or(-1.0, |grip| grip.reach)
    }

    /// Largest distance of two free balls, metres, at which the space between them is free as well: a sheet of skin
    /// that passes between them enters one of them. Less than twice the radius.
    pub(crate) fn link(&self) -> f64 {
        1.4 * self.radius()
    }

    pub(crate) fn check(&self) -> Result<(), NavigationError> {
        // Creating a climber validates its configuration.
        clamber_climber::Climber::new(self.climber, glam::DVec3::ZERO)?;
        let out_of_range = |name, range, found| NavigationError::OutOfRange { name, range, found };
        if !(self.spacing > 0.0 && self.spacing <= self.link()) {
            let range = "positive, and at most 1.4 radii of the climber";
            return Err(out_of_range("spacing", range, self.spacing));
        }
        if !CLIP_RATES.contains(&self.clip_rate) {
            let range = "from 0.0001 to 10,000";
            return Err(out_of_range("clip_rate", range, self.clip_rate));
        }
        if !self.ground.is_finite() {
            return Err(out_of_range("ground", "finite", self.ground));
        }
        if self.plates.len() > MOST_PLATES {
            let found = self.plates.len() as f64;
            return Err(out_of_range("plates.len()", "at most 65,536", found));
        }
        Ok(())
    }
}
