use bevy_input::gamepad::GamepadButton;
use bevy_input::keyboard::KeyCode;
use bevy_input::mouse::MouseButton;
use bevy_reflect::prelude::*;

/// The buttons of each act of a player. Any one of a list is enough.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[reflect(Default, Clone, Debug, PartialEq)]
pub struct ControlBindings {
    /// Walk or climb to where the camera looks.
    pub ahead: Vec<ControlButton>,
    /// Walk or climb towards the camera.
    pub back: Vec<ControlButton>,
    /// Walk or climb to the left.
    pub left: Vec<ControlButton>,
    /// Walk or climb to the right.
    pub right: Vec<ControlButton>,
    /// [`ClimberInput::jump`](crate::ClimberInput::jump).
    pub jump: Vec<ControlButton>,
    /// [`ClimberInput::grip`](crate::ClimberInput::grip).
    pub grip: Vec<ControlButton>,
    /// [`ClimberInput::crouch`](crate::ClimberInput::crouch).
    pub crouch: Vec<ControlButton>,
    /// Bits of [`ClimberInput::actions`](crate::ClimberInput::actions), and the buttons that set them. With the feature
    /// `fight`, stab, cut, bow and throw by default; otherwise empty.
    pub actions: Vec<(u32, Vec<ControlButton>)>,
}

/// A button of a keyboard, a mouse or a gamepad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, PartialEq, Hash)]
pub enum ControlButton {
    /// A key, by its place on the keyboard.
    Key(KeyCode),
    /// A button of the mouse.
    Mouse(MouseButton),
    /// A button of a gamepad.
    Gamepad(GamepadButton),
}

impl From<KeyCode> for ControlButton {
    fn from(key: KeyCode) -> Self {
        Self::Key(key)
    }
}

impl From<MouseButton> for ControlButton {
    fn from(button: MouseButton) -> Self {
        Self::Mouse(button)
    }
}

impl From<GamepadButton> for ControlButton {
    fn from(button: GamepadButton) -> Self {
        Self::Gamepad(button)
    }
}

impl Default for ControlBindings {
    fn default() -> Self {
        use ControlButton::{Gamepad, Key, Mouse};
        let walk = |keys: [KeyCode; 2], pad| vec![Key(keys[0]), Key(keys[1]), Gamepad(pad)];
        Self {
            ahead: walk([KeyCode::KeyW, KeyCode::ArrowUp], GamepadButton::DPadUp),
            back: walk([KeyCode::KeyS, KeyCode::ArrowDown], GamepadButton::DPadDown),
            left: walk([KeyCode::KeyA, KeyCode::ArrowLeft], GamepadButton::DPadLeft),
            right: walk(
                [KeyCode::KeyD, KeyCode::ArrowRight],
                GamepadButton::DPadRight,
            ),
            jump: vec![Key(KeyCode::Space), Gamepad(GamepadButton::South)],
            grip: vec![
                Key(KeyCode::ShiftLeft),
                Mouse(MouseButton::Right),
                Gamepad(GamepadButton::RightTrigger),
                Gamepad(GamepadButton::RightTrigger2),
            ],
            crouch: vec![
                Key(KeyCode::KeyC),
                Key(KeyCode::ControlLeft),
                Gamepad(GamepadButton::East),
            ],
            actions: fight(),
        }
    }
}

#[cfg(feature = "fight")]
fn fight() -> Vec<(u32, Vec<ControlButton>)> {
    use ControlButton::{Gamepad, Key, Mouse};
    use clamber_fight::actions::{BOW, CUT, STAB, THROW};
    vec![
        (
            STAB,
            vec![Mouse(MouseButton::Left), Gamepad(GamepadButton::West)],
        ),
        (CUT, vec![Key(KeyCode::KeyF), Gamepad(GamepadButton::North)]),
        (
            BOW,
            vec![Key(KeyCode::KeyQ), Gamepad(GamepadButton::LeftTrigger2)],
        ),
        (
            THROW,
            vec![Key(KeyCode::KeyE), Gamepad(GamepadButton::LeftTrigger)],
        ),
    ]
}

#[cfg(not(feature = "fight"))]
fn fight() -> Vec<(u32, Vec<ControlButton>)> {
    Vec::new()
}
