//! Finding the ground underfoot.

use clamber_mover::{Ground, GroundProbe, MoverContact};
use glam::DVec3;

use super::Tick;

impl Tick<'_> {
    /// The steepest slope that a standing climber stays on, radians.
    pub(super) fn standing_slope(&self) -> f64 {
        self.config.ground.release_slope()
    }

    /// A probe for ground up to `reach` below the feet, for the body at its current height.
    pub(super) fn ground_probe(&self, reach: f64) -> GroundProbe {
        GroundProbe {
            body: self.body(),
            up: self.config.up(),
            max_slope: self.standing_slope(),
            reach,
        }
    }

    pub(super) fn ground_below(&mut self, position: DVec3, reach: f64) -> Option<Ground> {
        let probe = self.ground_probe(reach);
        let ground = self.mover.find_ground(&probe, position)?;
        self.carries(&ground.touch).then_some(ground)
    }

    /// The contact of the last movement that holds the climber up at a position, and the position at which the climber
    /// stands on this contact. The two positions differ because a turning obstacle keeps a landing climber some
    /// millimetres away.
    ///
    /// `None` if no contact holds it up, or if the climber was pushed off the contact later in the same movement.
    pub(super) fn held_up(&mut self, position: DVec3, max_slope: f64) -> Option<Ground> {
        let up = self.config.up();
        let met = self.mover.holding_up(up, max_slope)?;
        let body = self.body();
        let mut touch = self.mover.still_underfoot(&body, position, up, &met)?;
        if !self.carries(&touch) {
            return None;
        }
        let gap = touch.contact.distance - body.radius;
        let mut position = position;
        if gap > 0.0 {
            position -= touch.normal * gap;
            touch.contact.distance -= gap;
        }
        Some(Ground { touch, position })
    }

    /// True if the climber touches a slope that is too steep and has no level ground beside it. At the edge of level
    /// ground the ground counts as ended, whichever of the two faces that meet there is reported as the contact.
    pub(super) fn is_on_slope(&mut self, position: DVec3, max_slope: f64) -> bool {
        let up = self.config.up();
        let body = self.body();
        let margin = body.margin;
        self.mover.overlap(&body, position, margin);
        let is_steep = |touch: &MoverContact| {
            self.config.slope(touch.contact.normal) > max_slope || self.is_refused(touch)
        };
        let ends = |slope: &MoverContact| {
            let mut level = self
                .mover
                .overlaps()
                .iter()
                .filter(|touch| !is_steep(touch));
            level.any(|touch| touch.contact.point.distance(slope.contact.point) <= margin)
        };
        let mut touched = self.mover.touched().iter();
        touched
            .any(|touch| touch.normal.dot(up) > GRAZING_COSINE && is_steep(touch) && !ends(touch))
    }

    /// True if a slope, of any steepness up to nearly vertical, is within the margin.
    pub(super) fn is_beside_slope(&mut self, position: DVec3) -> bool {
        let up = self.config.up();
        let body = self.body();
        let touches = self.mover.overlap(&body, position, body.margin);
        touches
            .iter()
            .any(|touch| touch.normal.dot(up) > GRAZING_COSINE)
    }
}

/// Cosine from up of a contact normal above which a face is a slope, and not a wall.
pub(super) const GRAZING_COSINE: f64 = 0.05;
