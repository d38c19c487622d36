use glam::DVec3;

use crate::{MaterialPoint, WorldCapsule};

/// What a physics engine needs to know of a climber, so that dynamic bodies collide with it.
///
/// `Climber::proxy_body` of `clamber_climber` makes it; a controller of your own fills it in. It is plain data, the
/// same for every engine. All vectors are in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyBody {
    /// The climber's body, its margin included.
    pub capsule: WorldCapsule,
    /// Bodies are kept out of a layer of this thickness around the capsule, metres, positive: the margin of the
    /// climber's body. Then a body that rests on the climber does not press it into the ground. It must be larger than
    /// the depth that the engine lets resting bodies overlap, 5 mm in a rapier world whose `length_unit` is 1.
    pub margin: f64,
    /// Mass, kilograms, positive.
    pub mass: f64,
    /// The climber's velocity, metres a second.
    pub velocity: DVec3,
    /// The part of it that bodies feel, metres a second: without walking and climbing, by which a climber stops in
    /// front of what is in its way instead of running it over.
    pub drift: DVec3,
    /// Velocity of the climber's frame, metres a second: its support's, or in the air, that of what it touched last.
    /// Only bodies that approach in this frame strike the climber; those that it runs or jumps into do not.
    pub frame_velocity: DVec3,
    /// Unit vector opposite to gravity. What comes from below does not strike the climber, which lands on it.
    pub up: DVec3,
    /// Unit normal of the ground or wall that the climber stands on, lies on or holds. An impact against it is taken by
    /// the support, which gets it by the climber's pushes. `None` in the air.
    pub support_normal: Option<DVec3>,
    /// Impacts slower than this are no blows, metres a second, not negative: the body is stopped, and the climber does
    /// not feel it.
    pub gentle: f64,
    /// The point of the engine's world that carries the climber, which gets its weight by pushes and does not collide
    /// with it.
    pub support: Option<MaterialPoint>,
}

impl ProxyBody {
    /// Coefficient of friction that the engine's body of a climber has: what lies on a climber slides off where it is
    /// steep.
    pub const FRICTION: f32 = 0.5;
}

/// A contact that the climber found by itself: it moves along the body there, and pushes it by its own rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyTouch {
    /// The touched point.
    pub material: MaterialPoint,
    /// Its position, in world space.
    pub position: DVec3,
    /// Unit vector from it towards the climber, in world space.
    pub normal: DVec3,
}
