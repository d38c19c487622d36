use bevy_app::{App, Plugin, PreUpdate};
use bevy_ecs::prelude::*;
use bevy_input::InputSystems;
use bevy_input::gamepad::{Gamepad, GamepadButton};
use bevy_input::keyboard::KeyCode;
use bevy_input::mouse::{AccumulatedMouseMotion, MouseButton};
use bevy_input::prelude::ButtonInput;
use bevy_math::{Quat, Vec2, Vec3};
use bevy_reflect::prelude::*;
use bevy_transform::components::Transform;

use crate::needs::need_resource;
use crate::{ClimberCamera, ClimberCameraInput, ClimberInput};

/// Lets keyboard, mouse and gamepads steer the [`Climber`](crate::Climber) of this entity, and the
/// [`ClimberCamera`]s that follow it.
///
/// | | keyboard and mouse | gamepad |
/// |---|---|---|
/// | walk, climb | W, A, S, D or arrows | left stick, or directional pad |
/// | jump | space | south button (A, cross) |
/// | grip, hold on | left shift, or right mouse button | right trigger, or right shoulder button |
/// | crouch | C, or left control | east button (B, circle) |
/// | turn the camera | mouse | right stick |
///
/// Directions are relative to the camera that follows the climber; without one, to the world, with -Z ahead.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ClimberControls {
    /// Radians that the camera turns for each pixel that the mouse moves. 0 if the mouse is for something else.
    pub mouse: f32,
    /// Radius of the middle of a gamepad's sticks in which they are at rest, as a share of their way.
    pub dead_zone: f32,
}

impl Default for ClimberControls {
    fn default() -> Self {
        Self {
            mouse: 0.003,
            dead_zone: 0.15,
        }
    }
}

/// Fills the [`ClimberInput`]s of entities with [`ClimberControls`], in `PreUpdate`, after Bevy's `InputSystems`.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClimberControlsPlugin;

impl Plugin for ClimberControlsPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClimberControls>()
            .add_systems(PreUpdate, steer.after(InputSystems));
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's ClimberControlsPlugin";
        need_resource::<ButtonInput<KeyCode>>(app, me, "InputPlugin of bevy_input");
        need_resource::<AccumulatedMouseMotion>(app, me, "InputPlugin of bevy_input");
    }
}

/// The player's actions in a frame.
#[derive(Clone, Copy, Debug, Default)]
struct Pressed {
    /// To the right, and ahead.
    walk: Vec2,
    look: Vec2,
    jump: bool,
    jump_held: bool,
    grip: bool,
    crouch: bool,
}

fn steer(
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    mouse: Res<AccumulatedMouseMotion>,
    gamepads: Query<&Gamepad>,
    mut climbers: Query<(Entity, &ClimberControls, &mut ClimberInput)>,
    mut cameras: Query<(&ClimberCamera, &mut ClimberCameraInput, &Transform)>,
) {
    for (entity, controls, mut input) in &mut climbers {
        let mut pressed = of_keys(&keys, &buttons);
        for gamepad in &gamepads {
            pressed.add(gamepad, controls.dead_zone);
        }
        let mut ahead = Quat::IDENTITY;
        for (camera, mut turn, transform) in &mut cameras {
            if camera.target == entity {
                ahead = transform.rotation;
                turn.stick = pressed.look;
                turn.swing += mouse.delta * controls.mouse * Vec2::new(1.0, -1.0);
            }
        }
        input.walk = walk(ahead, pressed.walk);
        input.grip = pressed.grip;
        input.crouch = pressed.crouch;
        input.jump |= pressed.jump;
        input.jump_held = pressed.jump_held;
    }
}

/// The direction in which to walk if `ahead` turns -Z to where the camera looks.
fn walk(ahead: Quat, stick: Vec2) -> Vec3 {
    let right = ahead * Vec3::X;
    // A camera that looks straight down has its top ahead.
    let ahead = Vec3::Y.cross(right).normalize_or(ahead * Vec3::NEG_Z);
    right * stick.x + ahead * stick.y
}

fn of_keys(keys: &ButtonInput<KeyCode>, buttons: &ButtonInput<MouseButton>) -> Pressed {
    let axis = |less: [KeyCode; 2], more: [KeyCode; 2]| {
        let down = |keys_of: [KeyCode; 2]| f32::from(u8::from(keys.any_pressed(keys_of)));
        down(more) - down(less)
    };
    let walk = Vec2::new(
        axis(
            [KeyCode::KeyA, KeyCode::ArrowLeft],
            [KeyCode::KeyD, KeyCode::ArrowRight],
        ),
        axis(
            [KeyCode::KeyS, KeyCode::ArrowDown],
            [KeyCode::KeyW, KeyCode::ArrowUp],
        ),
    );
    Pressed {
        walk: walk.clamp_length_max(1.0),
        look: Vec2::ZERO,
        jump: keys.just_pressed(KeyCode::Space),
        jump_held: keys.pressed(KeyCode::Space),
        grip: keys.pressed(KeyCode::ShiftLeft) || buttons.pressed(MouseButton::Right),
        crouch: keys.any_pressed([KeyCode::KeyC, KeyCode::ControlLeft]),
    }
}

impl Pressed {
    fn add(&mut self, gamepad: &Gamepad, dead_zone: f32) {
        let pad = gamepad.dpad();
        let stick = live(gamepad.left_stick(), dead_zone);
        self.walk = (self.walk + stick + pad).clamp_length_max(1.0);
        self.look = (self.look + live(gamepad.right_stick(), dead_zone)).clamp_length_max(1.0);
        self.jump |= gamepad.just_pressed(GamepadButton::South);
        self.jump_held |= gamepad.pressed(GamepadButton::South);
        self.grip |= gamepad.pressed(GamepadButton::RightTrigger)
            || gamepad.pressed(GamepadButton::RightTrigger2);
        self.crouch |= gamepad.pressed(GamepadButton::East);
    }
}

/// A stick without its dead zone: 0 at the zone's border, 1 at the end of its way.
fn live(stick: Vec2, dead_zone: f32) -> Vec2 {
    let length = stick.length();
    if length <= dead_zone || dead_zone >= 1.0 {
        return Vec2::ZERO;
    }
    stick / length * ((length - dead_zone) / (1.0 - dead_zone)).min(1.0)
}
