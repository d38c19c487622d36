use rapier3d::geometry::InteractionGroups;

/// Friction, restitution and collision groups of the skin that debris touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebrisConfig {
    /// Coefficient of friction, at least 0; rapier uses the mean of both colliders' coefficients. A higher value keeps
    /// rocks on steeper backs.
    pub friction: f32,
    /// Coefficient of restitution, 0 to 1. A higher value makes rocks bounce more.
    pub restitution: f32,
    /// Collision groups of the skin patches. Queries of rapier's world can leave the skin out by these groups. In any
    /// case, a body collides with its own patch only.
    pub groups: InteractionGroups,
}

impl Default for DebrisConfig {
    /// Friction of rough stone on hide, no bounce, all groups.
    fn default() -> Self {
        Self {
            friction: 0.8,
            restitution: 0.0,
            groups: InteractionGroups::all(),
        }
    }
}
