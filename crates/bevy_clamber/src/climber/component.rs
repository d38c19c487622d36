use bevy_ecs::change_detection::Tick;
use bevy_ecs::entity::{EntityMapper, MapEntities};
use bevy_ecs::prelude::*;
use bevy_ecs::reflect::ReflectMapEntities;
use bevy_math::Vec3;
use bevy_platform::collections::HashSet;
use bevy_reflect::prelude::*;
use bevy_transform::components::Transform;
use clamber_climber::{ClimberConfig, ClimberContact, StepReport};
use clamber_surface::geometry::WorldCapsule;
use clamber_surface::mesh::MeshId;
use clamber_world::ObstacleId;
use glam::DVec3;
use std::ops::Deref;

use super::ClimberInput;
use super::input::LatchedInput;
use super::obstacles::map_entities;
use super::shown::Shown;

/// A character that stands on, climbs, grips and hangs from everything that it can touch: skin, other climbers, the
/// physics engine's world, and [`CustomObstacle`](crate::CustomObstacle)s.
///
/// Insert it with a `Transform` where the character starts; [`ClimberPlugin`](crate::ClimberPlugin) does the rest. The
/// entity must not have a parent. Its `Transform` is the centre of the body's ball, [`BodyConfig::radius`] above the
/// feet, as this frame should draw it; its -Z looks where the climber is heading. To teleport the climber, write
/// another translation into it.
///
/// The configuration can be changed at any time. One that is refused is logged, and the last one stays. A body that
/// grows does so as soon as it has room; until then it keeps the whole last configuration ([`ClimberBody::config`]).
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// # use bevy_clamber::prelude::*;
/// fn spawn(mut commands: Commands) {
///     commands.spawn((Climber::colossus_climber(), Transform::from_xyz(0.0, 1.0, 8.0)));
/// }
/// ```
///
/// [`BodyConfig::radius`]: clamber_climber::BodyConfig::radius
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
#[require(Transform, ClimberInput, LatchedInput)]
pub struct Climber {
    /// The climber's body and abilities.
    pub config: ClimberConfig,
}

impl Climber {
    /// A climber with a body and abilities of its own.
    pub const fn new(config: ClimberConfig) -> Self {
        Self { config }
    }

    /// [`ClimberConfig::colossus_climber`]: a person with every ability, for creatures of 5 to 50 m.
    pub const fn colossus_climber() -> Self {
        Self::new(ClimberConfig::colossus_climber())
    }

    /// [`ClimberConfig::walker`]: stands, walks, jumps, slides and falls, and never tires.
    pub const fn walker() -> Self {
        Self::new(ClimberConfig::walker())
    }
}

impl Default for Climber {
    /// [`Climber::colossus_climber`].
    fn default() -> Self {
        Self::colossus_climber()
    }
}

/// All that a [`Climber`] remembers, as of the last tick: position, velocity, mode, support, stamina and more. Inserted
/// by its first tick.
///
/// To load a saved state, or to roll back, write it: the next tick goes on from there. The state says where the climber
/// is: a `Transform` that is written beside it, as saved with it, is no teleport. If only other fields than the position
/// are written, such as hit points, a `Transform` elsewhere is one as usual. A state that is refused is logged, and the
/// last one stays. An entity that is spawned with a state starts with it.
///
/// The support's obstacle id is the bits of an entity. Where Bevy maps entities, as when it loads a scene, it is
/// mapped. On a physics engine's world, avian's colliders are mapped; rapier numbers its own anew, so that support may
/// be lost.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[component(map_entities)]
#[reflect(Component, Clone, Debug, PartialEq, MapEntities)]
pub struct ClimberState(pub clamber_climber::ClimberState);

impl ClimberState {
    /// Velocity, in world space, metres a second.
    pub fn velocity(&self) -> Vec3 {
        self.0.velocity.as_vec3()
    }
}

impl MapEntities for ClimberState {
    fn map_entities<E: EntityMapper>(&mut self, mapper: &mut E) {
        if let Some(support) = &mut self.0.support {
            map_entities(&mut support.attachment, mapper);
        }
    }
}

impl Deref for ClimberState {
    type Target = clamber_climber::ClimberState;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

/// Selects the obstacles that a [`Climber`] touches. Without this component, it touches everything.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ClimberFilter {
    /// Entities that it passes through: surfaces, climbers, [`CustomObstacle`](crate::CustomObstacle)s, and colliders
    /// of avian.
    #[entities]
    pub ignored: HashSet<Entity>,
    /// The layers of the physics engine that it touches, one bit each: avian's `LayerMask`, rapier's `Group`. All by
    /// default.
    pub layers: u32,
}

impl Default for ClimberFilter {
    fn default() -> Self {
        Self {
            ignored: HashSet::default(),
            layers: u32::MAX,
        }
    }
}

/// A [`Climber`]'s body, as of the last tick: its contacts, and how much room it takes. Inserted by its first tick.
#[derive(Component, Clone, Debug)]
pub struct ClimberBody {
    pub(super) climber: clamber_climber::Climber,
    pub(super) report: StepReport,
    /// The mesh of the surface that supports it.
    pub(super) support_mesh: Option<(ObstacleId, MeshId)>,
    pub(super) shown: Shown,
    /// When this crate has written the climber's [`ClimberState`].
    pub(super) written: Tick,
    /// The last drawn place: the transform that this crate has written, and the origin that it is relative to.
    pub(super) drawn: Transform,
    pub(super) origin: DVec3,
}

/// Rounding that an app's move of the origin may add to a translation, as a share of it, and metres.
const ROUNDING: [f64; 2] = [1e-6, 1e-4];

impl ClimberBody {
    /// True if somebody else has written the climber's translation since it was drawn. A move of the origin does not
    /// count.
    pub(super) fn is_moved(&self, transform: &Transform, origin: DVec3) -> bool {
        let (found, drawn) = (transform.translation, self.drawn.translation);
        if found == drawn || self.origin == origin {
            return found != drawn;
        }
        let expected = drawn.as_dvec3() + self.origin - origin;
        let [share, least] = ROUNDING;
        let slack = share * expected.length().max(drawn.as_dvec3().length()) + least;
        found.as_dvec3().distance(expected) > slack
    }

    /// The climber itself.
    #[cfg(any(feature = "avian", feature = "rapier"))]
    pub(crate) fn climber(&self) -> &clamber_climber::Climber {
        &self.climber
    }

    /// The contacts of the last tick, in the order in which they were found.
    pub fn contacts(&self) -> &[ClimberContact] {
        self.climber.contacts()
    }

    /// The report of the last tick.
    pub fn report(&self) -> &StepReport {
        &self.report
    }

    /// The body's capsule in world space.
    pub fn capsule(&self) -> WorldCapsule {
        self.climber.body()
    }

    /// How far its support has carried it from the last frame to this one, metres, as they are drawn: for
    /// entities that move with it, such as a camera.
    pub fn carried(&self) -> DVec3 {
        self.shown.carried()
    }

    /// The configuration that the last tick used.
    pub fn config(&self) -> &ClimberConfig {
        self.climber.config()
    }
}
