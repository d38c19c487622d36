use bevy_ecs::prelude::*;
use bevy_math::DVec3;
use bevy_reflect::prelude::*;

/// The point of the world that Bevy's origin is at, metres: for worlds that are too large for `f32`.
///
/// Surfaces and climbers are kept in world space, in `f64`. Transforms, rays and hits are relative to this origin. To
/// move the origin, change it and every `Transform` that has no parent in the same system, by the same amount: nothing
/// has moved then. Do so in a schedule that runs once a frame, such as `Update`.
///
/// Zero by default: Bevy's space is the world.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Resource, Default, Clone, Debug, PartialEq)]
pub struct WorldOrigin(pub DVec3);
