use glam::DVec3;

use crate::{MaterialPoint, WorldCapsule};

/// A climber's data for a physics engine, so that dynamic bodies collide with the climber.
///
/// `Climber::proxy_body` of `clamber_climber` makes it; a controller of your own fills it in. The data are the same for
/// every engine. All vectors are in world space.
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
    /// The part of `velocity` that bodies feel, metres a second. Walking and climbing are left out: a climber stops in
    /// front of an obstacle on its way instead of running it over.
    pub drift: DVec3,
    /// Velocity of the climber's frame, metres a second: the velocity of its support, or in the air, of the obstacle
    /// that it touched last. Only bodies that approach in this frame strike the climber; bodies that it runs or jumps
    /// into do not.
    pub frame_velocity: DVec3,
    /// Unit vector opposite to gravity. A body from below does not strike the climber: the climber lands on it.
    pub up: DVec3,
    /// Unit normal of the ground or wall that the climber stands on, lies on or holds. The support takes an impact
    /// against it, and gets it as a push of the climber. `None` in the air.
    pub support_normal: Option<DVec3>,
    /// Speed, metres a second, not negative, below which an impact is no blow: the body is stopped, and the climber
    /// does not feel it.
    pub gentle: f64,
    /// The point of the engine's world that carries the climber. Its body gets the climber's weight by pushes, and does
    /// not collide with the proxy.
    pub support: Option<MaterialPoint>,
}

impl ProxyBody {
    /// Coefficient of friction of the engine's body of a climber. A body that lies on a climber slides off where the
    /// climber is steep.
    pub const FRICTION: f32 = 0.5;
}

/// A contact that the climber found by itself. The climber moves along the body there, and pushes it by its own rules.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyTouch {
    /// The touched point.
    pub material: MaterialPoint,
    /// Position of the point, in world space.
    pub position: DVec3,
    /// Unit vector from the point towards the climber, in world space.
    pub normal: DVec3,
}
