use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;

use super::bindings::ControlBindings;

/// Lets a player steer the [`Climber`](crate::Climber) of this entity, and the
/// [`ClimberCamera`](crate::ClimberCamera)s that follow it, by keyboard, mouse and gamepads.
///
/// | | keyboard and mouse | gamepad |
/// |---|---|---|
/// | walk, climb | W, A, S, D or arrows | left stick, or directional pad |
/// | jump | space | south button (A, cross) |
/// | grip, hold on | left shift, or right mouse button | right trigger, or right shoulder button |
/// | crouch | C, or left control | east button (B, circle) |
/// | turn the camera, aim | mouse | right stick |
/// | stab | left mouse button | west button (X, square) |
/// | cut | F | north button (Y, triangle) |
/// | draw the bow, shoot | Q | left trigger |
/// | throw a stone | E | left shoulder button |
///
/// The last four are for fighters of an arena (feature `fight`). Another crate's input, or a game's own, fills
/// [`ClimberInput`](crate::ClimberInput) itself, in [`ClamberSystems::Input`](crate::ClamberSystems::Input).
///
/// Directions are relative to the camera that follows the climber; without one, to the world, with -Z ahead. If the
/// component is removed, for a menu or a scene, the climber and its cameras have no input until something else fills it.
///
/// ```
/// # use bevy_ecs::prelude::*;
/// # use bevy_input::gamepad::Gamepad;
/// # use bevy_input::keyboard::KeyCode;
/// use bevy_clamber::{ControlButton, ControlDevice};
/// use bevy_clamber::prelude::*;
///
/// /// The second player has the first gamepad, and the first one the keyboard, on which X jumps.
/// fn join(mut commands: Commands, gamepads: Query<Entity, With<Gamepad>>) {
///     let mut first = ClimberControls { device: ControlDevice::Keyboard, ..ClimberControls::default() };
///     first.bindings.jump = vec![ControlButton::Key(KeyCode::KeyX)];
///     commands.spawn((Climber::default(), first));
///     if let Some(gamepad) = gamepads.iter().next() {
///         let device = ControlDevice::Gamepad(gamepad);
///         commands.spawn((Climber::default(), ClimberControls { device, ..ClimberControls::default() }));
///     }
/// }
/// # let _ = join;
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Default, Clone, Debug, PartialEq)]
pub struct ClimberControls {
    /// The device in the player's hands. All by default.
    pub device: ControlDevice,
    /// The buttons of each act.
    pub bindings: ControlBindings,
    /// Radians that the camera turns for each pixel that the mouse moves. 0 if the mouse is for something else.
    pub mouse: f32,
    /// Whether the camera looks down where the mouse or the stick goes up.
    pub is_inverted: bool,
    /// Radius of the middle of a gamepad's sticks in which they are at rest, as a share of their way.
    pub dead_zone: f32,
}

impl Default for ClimberControls {
    fn default() -> Self {
        Self {
            device: ControlDevice::All,
            bindings: ControlBindings::default(),
            mouse: 0.003,
            is_inverted: false,
            dead_zone: 0.15,
        }
    }
}

/// The device that a player holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq, Hash)]
pub enum ControlDevice {
    /// Keyboard, mouse and every gamepad: for one player.
    #[default]
    All,
    /// Keyboard and mouse.
    Keyboard,
    /// The gamepad on this entity.
    Gamepad(Entity),
}
