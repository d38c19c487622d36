use glam::DVec3;

/// What a player wants of a climber this tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ClimberInput {
    /// Direction to go in, in world space; its length, at most 1, is the share of full speed. The part along up does not
    /// count. On a hold it is tilted as the hold is from level ground: pushing against a wall climbs it, pulling away
    /// climbs down.
    pub walk: DVec3,
    /// Direction to climb in, in world space, of which the part along the hold counts; if it is zero, `walk` does. For
    /// those who know where they want to go: bots, and cameras that look at the wall.
    pub climb: DVec3,
    /// True to jump, off the ground or off a hold. Once is enough: what comes a little early or late counts.
    pub jump: bool,
    /// True as long as it grips, or wants to.
    pub grip: bool,
    /// What struck it.
    pub blow: Option<Blow>,
}

/// A blow that strikes a climber.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Blow {
    /// By how much it changes the climber's velocity, in world space, metres a second.
    pub velocity: DVec3,
    /// Hit points that it costs, 0 to 1.
    pub damage: f64,
}

impl ClimberInput {
    pub(crate) fn is_finite(&self) -> bool {
        let blow = self
            .blow
            .is_none_or(|blow| blow.velocity.is_finite() && blow.damage.is_finite());
        self.walk.is_finite() && self.climb.is_finite() && blow
    }
}
