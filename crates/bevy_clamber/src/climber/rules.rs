use std::sync::Arc;

use bevy_ecs::prelude::*;
use clamber_climber::CustomMode;
use clamber_world::Contact;

/// Decides what climbers can grip: as a resource for all of them, as a component for one. Without either, it is what has
/// the tag [`SurfaceKind::Fur`](clamber_surface::mesh::SurfaceKind::Fur).
///
/// ```
/// # use bevy_app::App;
/// # use bevy_clamber::prelude::*;
/// # let mut app = App::new();
/// // Everything but stone.
/// app.insert_resource(GripRule::new(|grip| grip.contact.tag.kind != SurfaceKind::Stone));
/// ```
#[derive(Resource, Clone)]
pub struct GripRule(Arc<dyn Fn(&Grip<'_>) -> bool + Send + Sync>);

/// A hold that a climber may grip.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Grip<'a> {
    /// The climber.
    pub climber: Entity,
    /// What it would hold: a surface, a climber, a [`CustomObstacle`](crate::CustomObstacle), or a collider of the
    /// physics engine. `None` for a collider that has no entity.
    pub entity: Option<Entity>,
    /// The contact, in world space.
    pub contact: &'a Contact,
}

impl GripRule {
    /// A rule by a function.
    pub fn new(can_grip: impl Fn(&Grip<'_>) -> bool + Send + Sync + 'static) -> Self {
        Self(Arc::new(can_grip))
    }

    pub(super) fn allows(&self, grip: &Grip<'_>) -> bool {
        (self.0)(grip)
    }
}

/// A resource with the game's own modes of moving, such as a dash or swimming, for all climbers. In each tick they are
/// asked in this order whether they begin. See [`CustomMode`].
#[derive(Resource, Default)]
pub struct ClimberModes(pub Vec<Box<dyn CustomMode + Send + Sync>>);
