use rapier3d::geometry::InteractionGroups;

/// Friction, restitution and collision groups of the skin that debris touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebrisConfig {
    /// Coefficient of friction, at least 0; rapier takes the mean of both sides'. Higher keeps rocks on
    /// steeper backs.
    pub friction: f32,
    /// Coefficient of restitution, 0 to 1: higher lets rocks bounce.
    pub restitution: f32,
    /// Which of rapier's groups the skin belongs to. Whoever queries rapier's world can leave the skin
    /// out by them; a body meets only its own piece of skin in any case.
    pub groups: InteractionGroups,
}

impl Default for DebrisConfig {
    /// Rough stone on hide; no bounce; all groups.
    fn default() -> Self {
        Self {
            friction: 0.8,
            restitution: 0.0,
            groups: InteractionGroups::all(),
        }
    }
}
