use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_input::gamepad::Gamepad;
use bevy_input::keyboard::KeyCode;
use bevy_input::mouse::{AccumulatedMouseMotion, MouseButton};
use bevy_input::prelude::ButtonInput;
use bevy_math::{Quat, Vec2, Vec3};
use bevy_transform::components::Transform;

use super::{ClimberControls, ControlButton, ControlDevice};
use crate::{ClimberCamera, ClimberCameraInput, ClimberInput};

/// All devices.
#[derive(SystemParam)]
pub(super) struct Devices<'w, 's> {
    keys: Res<'w, ButtonInput<KeyCode>>,
    buttons: Res<'w, ButtonInput<MouseButton>>,
    mouse: Res<'w, AccumulatedMouseMotion>,
    gamepads: Query<'w, 's, (Entity, &'static Gamepad)>,
}

/// The devices of one player.
struct Held<'a> {
    device: ControlDevice,
    all: &'a Devices<'a, 'a>,
}

impl Held<'_> {
    /// True if keyboard and mouse are among them.
    fn has_keys(&self) -> bool {
        !matches!(self.device, ControlDevice::Gamepad(_))
    }

    fn gamepads(&self) -> impl Iterator<Item = &Gamepad> {
        let all = self.all.gamepads.iter();
        all.filter_map(|(entity, gamepad)| match self.device {
            ControlDevice::All => Some(gamepad),
            ControlDevice::Keyboard => None,
            ControlDevice::Gamepad(held) => (held == entity).then_some(gamepad),
        })
    }

    fn is_down(&self, buttons: &[ControlButton]) -> bool {
        buttons.iter().any(|button| match *button {
            ControlButton::Key(key) => self.has_keys() && self.all.keys.pressed(key),
            ControlButton::Mouse(button) => self.has_keys() && self.all.buttons.pressed(button),
            ControlButton::Gamepad(button) => self.gamepads().any(|pad| pad.pressed(button)),
        })
    }

    fn is_pressed_now(&self, buttons: &[ControlButton]) -> bool {
        buttons.iter().any(|button| match *button {
            ControlButton::Key(key) => self.has_keys() && self.all.keys.just_pressed(key),
            ControlButton::Mouse(button) => {
                self.has_keys() && self.all.buttons.just_pressed(button)
            }
            ControlButton::Gamepad(button) => self.gamepads().any(|pad| pad.just_pressed(button)),
        })
    }

    /// 1 for the buttons `more`, -1 for `less`.
    fn axis(&self, less: &[ControlButton], more: &[ControlButton]) -> f32 {
        let down = |buttons| f32::from(u8::from(self.is_down(buttons)));
        down(more) - down(less)
    }

    fn stick(&self, dead_zone: f32, stick: impl Fn(&Gamepad) -> Vec2) -> Vec2 {
        let sticks = self
            .gamepads()
            .map(|gamepad| live(stick(gamepad), dead_zone));
        sticks.sum::<Vec2>().clamp_length_max(1.0)
    }

    fn mouse(&self) -> Vec2 {
        if self.has_keys() {
            self.all.mouse.delta
        } else {
            Vec2::ZERO
        }
    }
}

/// Fills the inputs of climbers and cameras.
pub(super) fn steer(
    devices: Devices<'_, '_>,
    mut climbers: Query<(Entity, &ClimberControls, &mut ClimberInput)>,
    mut cameras: Query<(&ClimberCamera, &mut ClimberCameraInput, &Transform)>,
) {
    for (entity, controls, mut input) in &mut climbers {
        let held = Held {
            device: controls.device,
            all: &devices,
        };
        let bindings = &controls.bindings;
        let up = if controls.is_inverted { -1.0 } else { 1.0 };
        let mut ahead = Quat::IDENTITY;
        for (camera, mut turn, transform) in &mut cameras {
            if camera.target == entity {
                ahead = transform.rotation;
                let look = held.stick(controls.dead_zone, Gamepad::right_stick);
                turn.stick = look * Vec2::new(1.0, up);
                turn.swing += held.mouse() * controls.mouse * Vec2::new(1.0, -up);
            }
        }
        let keys = Vec2::new(
            held.axis(&bindings.left, &bindings.right),
            held.axis(&bindings.back, &bindings.ahead),
        );
        let stick = held.stick(controls.dead_zone, Gamepad::left_stick);
        input.walk = walk(ahead, (keys + stick).clamp_length_max(1.0));
        input.aim = ahead * Vec3::NEG_Z;
        input.grip = held.is_down(&bindings.grip);
        input.crouch = held.is_down(&bindings.crouch);
        input.jump |= held.is_pressed_now(&bindings.jump);
        input.jump_held = held.is_down(&bindings.jump);
        // Bits without a binding are left to the game. A bit may have several bindings.
        let bound = bindings.actions.iter().fold(0, |all, (bits, _)| all | bits);
        let down = bindings.actions.iter();
        let down = down.filter(|(_, buttons)| held.is_down(buttons));
        input.actions = down.fold(input.actions & !bound, |all, (bits, _)| all | bits);
    }
}

/// Warns once if several players have all devices.
pub(super) fn tell_shared_devices(
    added: Query<(), Added<ClimberControls>>,
    all: Query<&ClimberControls>,
    mut told: Local<bool>,
) {
    let shared = |controls: &&ClimberControls| controls.device == ControlDevice::All;
    if !*told && !added.is_empty() && all.iter().filter(shared).nth(1).is_some() {
        *told = true;
        tracing::warn!(
            "several climbers are steered by the same keyboard, mouse and gamepads: set ClimberControls::device of each"
        );
    }
}

/// Where controls are removed, nobody holds a key any more.
pub(super) fn let_go(
    removed: On<Remove<ClimberControls>>,
    mut climbers: Query<&mut ClimberInput>,
    mut cameras: Query<(&ClimberCamera, &mut ClimberCameraInput)>,
) {
    if let Ok(mut input) = climbers.get_mut(removed.entity) {
        *input = ClimberInput {
            blow: input.blow,
            ..ClimberInput::default()
        };
    }
    for (camera, mut turn) in &mut cameras {
        if camera.target == removed.entity {
            *turn = ClimberCameraInput::default();
        }
    }
}

/// The direction in which to walk if `ahead` turns -Z to where the camera looks.
fn walk(ahead: Quat, stick: Vec2) -> Vec3 {
    let right = ahead * Vec3::X;
    // A camera that looks straight down has its top ahead.
    let ahead = Vec3::Y.cross(right).normalize_or(ahead * Vec3::NEG_Z);
    right * stick.x + ahead * stick.y
}

/// A stick without its dead zone: 0 at the zone's border, 1 at the end of its way.
fn live(stick: Vec2, dead_zone: f32) -> Vec2 {
    let length = stick.length();
    if length <= dead_zone || dead_zone >= 1.0 {
        return Vec2::ZERO;
    }
    stick / length * ((length - dead_zone) / (1.0 - dead_zone)).min(1.0)
}
