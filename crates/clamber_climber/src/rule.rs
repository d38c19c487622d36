use clamber_world::{
    Contact, MaterialPoint, Obstacle, ObstacleId, SurfaceKind, SurfaceTag, WorldPath,
};
use glam::DVec3;

use crate::{ClimberConfig, ClimberMode, ClimberState};

/// The uses that a climber may make of a contact, and its friction: the result of a [`ContactRuleFn`].
///
/// ```
/// use clamber_climber::ContactRule;
///
/// let wet_fur = ContactRule::GRIP.with_friction(0.7);
/// let armour = ContactRule { grip: false, hang: false, ..ContactRule::GRIP };
/// assert!(wet_fur.grip && !armour.hang);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRule {
    /// Whether the contact blocks the body. If not, the contact does not exist for the climber: the climber falls,
    /// walks and reaches through it, and the other fields do not matter.
    pub solid: bool,
    /// Whether the climber may stand on the ground. If not, it slides off, as off a slope that is too steep. Level
    /// ground of this kind leaves it lying in [`ClimberMode::Sliding`].
    pub stand: bool,
    /// Whether walking may lead up onto the obstacle; other characters are never steps. If not, its steps, slopes and
    /// edges block like a vertical wall for a climber that stands on ground with `step`. Ground that is flush with the
    /// feet, or lower, can be walked onto in any case; `stand` decides there.
    pub step: bool,
    /// Whether the climber may hang from the obstacle, where it has the shape of a ledge.
    pub hang: bool,
    /// Whether hands may grip the surface.
    pub grip: bool,
    /// Grip of feet and hands, as a multiple of the usual: 1 as usual, 0 none. Any value is allowed: NaN and both
    /// infinities count as 1, and other negative values as 0.
    ///
    /// - Below 1, as on ice: feet accelerate and brake by no more than this times
    ///   [`GroundConfig::friction`](crate::GroundConfig::friction), gravity pulls the climber down slopes that it
    ///   stands on, and ground that speeds up or turns accelerates the climber by no more than that. Hands that climb
    ///   slip down along the hold at (1 - friction) times the [climbing speed](crate::GripConfig::climb_speed), times
    ///   the sine of the hold's slope, but not off its end.
    /// - Above 1, as in mud: walking and climbing are this many times slower, and feet brake this many times harder
    ///   down from more than the walking speed.
    /// - Always: a factor on [`GroundConfig::slide_friction`](crate::GroundConfig::slide_friction) and
    ///   [`TumbleConfig::friction`](crate::TumbleConfig::friction).
    ///
    /// The friction of the support at the tick's beginning applies.
    pub friction: f64,
}

impl ContactRule {
    /// Can be stood on, stepped onto and hung from, but not gripped: ground and walls. The default.
    pub const SOLID: Self = Self {
        solid: true,
        stand: true,
        step: true,
        hang: true,
        grip: false,
        friction: 1.0,
    };

    /// Like [`ContactRule::SOLID`], and can be gripped: fur, vines.
    pub const GRIP: Self = Self {
        grip: true,
        ..Self::SOLID
    };

    /// Only blocks the body: slick walls, force fields.
    pub const BLOCK: Self = Self {
        stand: false,
        step: false,
        hang: false,
        ..Self::SOLID
    };

    /// Does not exist for this climber: open doors, ghosts, one-way platforms from below.
    pub const PASS: Self = Self {
        solid: false,
        ..Self::BLOCK
    };

    /// The same rule with another [`solid`](Self::solid).
    #[must_use]
    pub const fn with_solid(self, solid: bool) -> Self {
        Self { solid, ..self }
    }

    /// The same rule with another [`stand`](Self::stand).
    #[must_use]
    pub const fn with_stand(self, stand: bool) -> Self {
        Self { stand, ..self }
    }

    /// The same rule with another [`step`](Self::step).
    #[must_use]
    pub const fn with_step(self, step: bool) -> Self {
        Self { step, ..self }
    }

    /// The same rule with another [`hang`](Self::hang).
    #[must_use]
    pub const fn with_hang(self, hang: bool) -> Self {
        Self { hang, ..self }
    }

    /// The same rule with another [`grip`](Self::grip).
    #[must_use]
    pub const fn with_grip(self, grip: bool) -> Self {
        Self { grip, ..self }
    }

    /// The same rule with another [`friction`](Self::friction).
    #[must_use]
    pub const fn with_friction(self, friction: f64) -> Self {
        Self { friction, ..self }
    }

    /// The friction, made finite and not negative.
    pub(crate) fn usable_friction(&self) -> f64 {
        if self.friction.is_finite() {
            self.friction.max(0.0)
        } else {
            1.0
        }
    }
}

impl Default for ContactRule {
    fn default() -> Self {
        Self::SOLID
    }
}

/// A game's rule for contacts, passed to [`Climber::step_with`](crate::Climber::step_with) by
/// [`StepRules::contact`](crate::StepRules::contact).
///
/// The function must be pure during a tick: it is called any number of times and in any order, for contacts at any time
/// of the tick, and once for the climber's support.
pub type ContactRuleFn<'a> = dyn Fn(&ContactQuery<'_>) -> ContactRule + 'a;

/// A contact that a [`ContactRuleFn`] decides about, and the climber as it was at the tick's beginning.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct ContactQuery<'a> {
    /// The climber, by [`StepRules::id`](crate::StepRules::id).
    pub climber: Option<ObstacleId>,
    /// The climber's state at the tick's beginning. Through its [`custom_slots`](ClimberState::custom_slots), a rule
    /// can depend on the game's modes.
    pub state: &'a ClimberState,
    /// The climber's configuration.
    pub config: &'a ClimberConfig,
    /// Length of the tick, seconds.
    pub dt: f64,
    /// The obstacle.
    pub id: ObstacleId,
    /// The contact. In sweeps it is the contact at the time of the sweep. For the climber's support, its normal is the
    /// normal of the last face that the climber lay flat on, and its distance is the body's radius.
    pub contact: &'a Contact,
    pub(crate) obstacle: &'a dyn Obstacle,
}

/// A body below a plane by up to this fraction of its margin counts as on it: far more than the rounding of a
/// creature's skin.
const ON_PLANE_TOLERANCE: f64 = 0.1;

/// Depth, as a fraction of its radius, by which a climber that stands on an obstacle may be below a plane of that
/// obstacle and still count as above it: deformation pushes its feet into the obstacle.
const SUNK_DEPTH: f64 = 0.5;

/// Cosine from up of a face's normal, up to which the face is a wall or a ceiling, for a climber that stands on the
/// obstacle, too.
const GRAZING_COSINE: f64 = 0.05;

impl<'a> ContactQuery<'a> {
    /// The default rule: every contact is solid, and can be stood on and stepped onto. [Fur](SurfaceKind::Fur) can be
    /// gripped, and every ledge can be hung from, except on other characters ([`ContactQuery::is_character`]).
    pub fn usual(&self) -> ContactRule {
        let holds = !self.is_character();
        ContactRule {
            hang: holds,
            grip: holds && self.contact.tag.kind == SurfaceKind::Fur,
            ..ContactRule::SOLID
        }
    }

    /// The rule of a one-way platform: [`ContactQuery::usual`] from above, and [`ContactRule::PASS`] otherwise. For a
    /// climber that jumps or falls past its edge, the platform does not exist, so that hands do not catch it.
    pub fn one_way(&self) -> ContactRule {
        if self.is_from_above() {
            self.usual()
        } else {
            ContactRule::PASS
        }
    }

    /// The contact's tag.
    pub fn tag(&self) -> SurfaceTag {
        self.contact.tag
    }

    /// The body within the obstacle ([`Obstacle::rigid_body_id`]): in a rapier world, the collider.
    pub fn body(&self) -> u64 {
        self.rigid_body_id(&self.contact.material)
    }

    fn rigid_body_id(&self, point: &MaterialPoint) -> u64 {
        self.obstacle.rigid_body_id(point)
    }

    /// True if the contact is with another character ([`Obstacle::character`]), such as a
    /// [`ClimberObstacle`](crate::ClimberObstacle).
    pub fn is_character(&self) -> bool {
        self.obstacle.character().is_some()
    }

    /// Positions of the contact's material at the tick's beginning and end, and its velocity. `None` if the obstacle
    /// reports no motion.
    pub fn path(&self) -> Option<WorldPath> {
        let path = self.obstacle.path(&self.contact.material, self.dt)?;
        path.is_finite().then_some(path)
    }

    /// True if the climber comes from above, in the sense of a one-way platform: the contact's face is level enough to
    /// be stood on, and at the tick's beginning the climber's lowest point was not below the face's plane. Down to a
    /// [margin](crate::BodyConfig::margin) below, the climber counts as above unless it rises relative to the material.
    /// If the climber stands on the same body or hangs from its edge, this is also true for steeper upward faces and
    /// for walls; while it stands, only for walls below its feet.
    ///
    /// To drop through a platform, let the rule return [`ContactRule::PASS`] until the climber has fallen by a margin:
    /// for as long as a key is held, 0.05 s at least.
    pub fn is_from_above(&self) -> bool {
        let (state, contact) = (self.state, self.contact);
        let body = &self.config.body;
        let normal = contact.normal;
        let up = self.config.up();
        let rises = normal.dot(up) > GRAZING_COSINE;
        let is_wall = normal.dot(up).abs() <= GRAZING_COSINE;
        let (place, velocity) = match self.path() {
            Some(path) => (path.previous_position, path.velocity),
            None => (contact.point, DVec3::ZERO),
        };
        let height = (state.position - place).dot(normal) - body.radius;
        if self.is_supported_by_it(ClimberMode::Standing) {
            let feet = (state.position - place).dot(up) - body.radius;
            let sunk = -SUNK_DEPTH * body.radius;
            return rises && height >= sunk || is_wall && feet >= sunk;
        }
        if self.is_supported_by_it(ClimberMode::LedgeHanging) {
            return rises || is_wall;
        }
        let is_level = self.config.slope(normal) <= self.config.ground.release_slope();
        let on = ON_PLANE_TOLERANCE * body.margin;
        let rising = (state.velocity - velocity).dot(normal) * self.dt;
        is_level && (height >= -on || height >= -body.margin && rising <= on)
    }

    fn is_supported_by_it(&self, mode: ClimberMode) -> bool {
        let on = self.state.support.map(|support| support.attachment);
        self.state.mode == mode
            && on.is_some_and(|on| {
                on.obstacle == self.id && self.rigid_body_id(&on.material) == self.body()
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_friction_out_of_its_range_counts_as_its_nearest_or_as_usual() {
        for (given, used) in [
            (0.3, 0.3),
            (7.0, 7.0),
            (-2.0, 0.0),
            (f64::NAN, 1.0),
            (f64::INFINITY, 1.0),
            (f64::NEG_INFINITY, 1.0),
        ] {
            let rule = ContactRule::SOLID.with_friction(given);
            assert_eq!(rule.usable_friction(), used, "{given}");
        }
    }
}
