use std::ops::Deref;
use std::sync::Arc;

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
use clamber_climber::{ContactQuery, ContactRule, CustomMode};
use glam::DVec3;

/// Decides what a climber may stand on, step onto, hang from, grip and pass through, and with which friction. Insert it
/// on the climber; the resource [`DefaultClimberRule`] is for all climbers without one. Without either, everything is
/// solid, fur is gripped and other climbers are not held ([`ContactQuery::usual`]).
///
/// ```
/// # use bevy_app::App;
/// # use bevy_clamber::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # let mut app = App::new();
/// # let (door, owner) = (Entity::PLACEHOLDER, Entity::PLACEHOLDER);
/// // Everything but stone is gripped, and a door lets its owner pass.
/// let rule = ClimberRule::new(move |at| {
///     if at.entity == Some(door) && at.climber == owner {
///         return ContactRule::PASS;
///     }
///     at.usual().with_grip(at.tag().kind != SurfaceKind::Stone)
/// });
/// app.insert_resource(DefaultClimberRule(rule));
/// // This climber grips nothing.
/// let climber = (Climber::default(), ClimberRule::new(|at| at.usual().with_grip(false)));
/// app.world_mut().spawn(climber);
/// ```
///
/// The rule must be a pure function: during a tick it is called any number of times and in any order.
#[derive(Component, Clone)]
pub struct ClimberRule(Arc<RuleFn>);

/// The [`ClimberRule`] of all climbers that have none of their own.
#[derive(Resource, Clone)]
pub struct DefaultClimberRule(pub ClimberRule);

type RuleFn = dyn Fn(&ClimberTouch<'_>) -> ContactRule + Send + Sync;

/// A contact of a climber that a [`ClimberRule`] decides about: a [`ContactQuery`], with the entities.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct ClimberTouch<'a> {
    /// The climber.
    pub climber: Entity,
    /// The obstacle that it touches: a surface, a climber, a [`CustomObstacle`](crate::CustomObstacle), or a collider
    /// of the physics engine. `None` for a collider that has no entity.
    pub entity: Option<Entity>,
    /// The contact, in world space, and the climber as it was at the tick's beginning.
    pub query: &'a ContactQuery<'a>,
}

impl<'a> Deref for ClimberTouch<'a> {
    type Target = ContactQuery<'a>;

    fn deref(&self) -> &ContactQuery<'a> {
        self.query
    }
}

impl ClimberRule {
    /// A rule by a function.
    pub fn new(rule: impl Fn(&ClimberTouch<'_>) -> ContactRule + Send + Sync + 'static) -> Self {
        Self(Arc::new(rule))
    }

    pub(super) fn decide(&self, touch: &ClimberTouch<'_>) -> ContactRule {
        (self.0)(touch)
    }
}

/// A resource with the game's own modes of moving, such as a dash or swimming, for all climbers. In each tick they are
/// asked in this order whether they begin. See [`CustomMode`].
#[derive(Resource, Default)]
pub struct ClimberModes(pub Vec<Box<dyn CustomMode + Send + Sync>>);

/// A resource with the velocity of the air, in world space, metres a second: a wind. A climber that has touched nothing
/// for a second steers against it; its greatest speed of fall is relative to it
/// ([`StepRules::air_velocity`](clamber_climber::StepRules::air_velocity)). It moves no climber that does not steer.
/// For a wind that pushes, [strike](super::ClimberInput::strike) the climber in each tick with a small blow. Zero by
/// default. While it is not finite, climbers stand still.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Clone, Debug, PartialEq)]
pub struct AirVelocity(pub DVec3);
