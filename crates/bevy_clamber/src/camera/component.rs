use bevy_ecs::prelude::*;
use bevy_math::Vec2;
use bevy_reflect::prelude::*;
use bevy_transform::components::Transform;
use glam::DVec3;

/// Lets a camera orbit a [`Climber`](crate::Climber): insert it on an entity with a camera.
/// [`ClimberCameraPlugin`](crate::ClimberCameraPlugin) then writes the entity's `Transform` in each frame.
///
/// The camera begins behind the climber. It moves with the climber's support, without a lag, and follows the climber's
/// own motion smoothly. It keeps [`radius`](Self::radius) away from skin as it is drawn, from terrain and from bodies:
/// where they are in the way, it comes nearer at once, and goes back over half a second. Fill [`ClimberCameraInput`] to
/// turn it.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// # use bevy_clamber::prelude::*;
/// fn spawn(mut commands: Commands) {
///     let hero = (Climber::default(), Transform::from_xyz(0.0, 2.0, 0.0));
///     let hero = commands.spawn(hero).id();
///     commands.spawn(ClimberCamera { distance: 9.0, ..ClimberCamera::new(hero) }); // and a `Camera3d`
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[require(Transform, ClimberCameraInput, CameraState)]
pub struct ClimberCamera {
    /// The climber.
    #[entities]
    pub target: Entity,
    /// How far away the camera is where nothing is in the way, metres.
    pub distance: f32,
    /// How far above the centre of the climber's ball it looks, metres.
    pub height: f32,
    /// How far it stays from skin, terrain and bodies, metres: more than the distance of its near plane. At most three
    /// quarters of the radius of the climber's ball.
    pub radius: f32,
    /// How fast the stick turns it about up and tilts it, radians a second.
    pub speed: Vec2,
    /// How far the stick has to be moved for it to tilt, as a share of its way.
    pub tilt_from: f32,
    /// Time to reach that speed and to lose it, seconds.
    pub response: f32,
    /// If not 0: within half of the stick's way, it tilts back to `level` over this time, seconds.
    pub centring: f32,
    /// The tilt at the beginning, radians: positive looks down.
    pub level: f32,
    /// The lowest and the highest tilt, radians.
    pub tilts: [f32; 2],
    /// How long it takes to follow the climber's own motion, seconds.
    pub smoothing: f32,
}

impl ClimberCamera {
    /// A camera that turns at once and stays where the player has turned it.
    pub const fn new(target: Entity) -> Self {
        Self {
            target,
            distance: 7.0,
            height: 1.0,
            radius: 0.3,
            speed: Vec2::new(3.0, 2.0),
            tilt_from: 0.0,
            response: 0.0,
            centring: 0.0,
            level: 0.25,
            tilts: [-1.2, 1.4],
            smoothing: 0.1,
        }
    }

    /// A camera with the measured limits of *Shadow of the Colossus* of 2005, in its version for PAL
    /// (<https://github.com/cylfox/sotc-camera-fix>): it turns by up to 300 degrees a second and tilts by up to 80,
    /// takes 0.87 s to reach that speed and to lose it, tilts only in the last quarter of the stick's way, and levels
    /// out by itself.
    pub const fn like_2005(target: Entity) -> Self {
        Self {
            speed: Vec2::new(5.236, 1.396),
            tilt_from: 0.75,
            response: 0.87,
            centring: 1.0,
            ..Self::new(target)
        }
    }
}

/// How the player turns a [`ClimberCamera`].
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ClimberCameraInput {
    /// A stick, -1 to 1: to the right, and up. Used as it is in each frame.
    pub stick: Vec2,
    /// A mouse: radians to turn to the right and to look up, at once. Each frame uses it up.
    pub swing: Vec2,
}

/// The memory of a camera from frame to frame.
#[derive(Component, Clone, Copy, Debug, Default)]
pub(super) struct CameraState {
    pub(super) is_placed: bool,
    /// Turn about up, and tilt downward, radians.
    pub(super) angles: Vec2,
    /// Radians a second.
    pub(super) turning: Vec2,
    /// The point that it looks at, in world space.
    pub(super) pivot: DVec3,
    /// How far it is from there, metres.
    pub(super) distance: f64,
}
