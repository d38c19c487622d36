use clamber_climber::ClimberConfig;
use clamber_surface::mesh::{SurfaceKind, SurfaceTag};

use crate::NavigationError;

/// The climber of a graph, and how finely its skin is divided.
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
}

impl GraphConfig {
    /// The defaults for a climber.
    pub fn new(climber: ClimberConfig) -> Self {
        Self {
            climber,
            spacing: climber.body.radius,
            grips: vec![SurfaceKind::Fur],
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
        let most = self.link();
        if self.spacing > 0.0 && self.spacing <= most {
            return Ok(());
        }
        Err(NavigationError::OutOfRange {
            name: "spacing",
            range: "positive, and at most 1.4 radii of the climber",
            found: self.spacing,
        })
    }
}
