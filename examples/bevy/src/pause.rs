//! The mouse is the game's while it runs, and the player's while it pauses.

use bevy::camera::NormalizedRenderTarget;
use bevy::picking::pointer::{Location, PointerAction, PointerId, PointerInput};
use bevy::prelude::*;
use bevy::window::{CursorGrabMode, CursorOptions, PrimaryWindow, WindowRef};

use crate::creature::Creature;
use crate::hud::Message;

pub fn plugin(app: &mut App) {
    app.add_systems(Update, (pause, grab).chain())
        .add_systems(First, aim_at_middle);
}

fn pause(
    keys: Res<ButtonInput<KeyCode>>,
    gamepads: Query<&Gamepad>,
    windows: Query<&Window, With<PrimaryWindow>>,
    mut time: ResMut<Time<Virtual>>,
    mut message: ResMut<Message>,
) {
    let by_key = keys.any_just_pressed([KeyCode::KeyP, KeyCode::Escape]);
    let by_pad = gamepads
        .iter()
        .any(|pad| pad.just_pressed(GamepadButton::Start));
    let is_away = windows.iter().any(|window| !window.focused);
    if time.is_paused() {
        if by_key || by_pad {
            time.unpause();
            message.say("", 0.0);
        }
    } else if by_key || by_pad || is_away {
        time.pause();
        message.say("Paused: P goes on", f32::INFINITY);
    }
}

fn grab(
    time: Res<Time<Virtual>>,
    creature: Option<Res<Creature>>,
    mut cursors: Query<&mut CursorOptions, With<PrimaryWindow>>,
) {
    let plays = creature.is_some() && !time.is_paused();
    for mut cursor in &mut cursors {
        if cursor.visible == plays {
            cursor.visible = !plays;
            cursor.grab_mode = if plays {
                CursorGrabMode::Locked
            } else {
                CursorGrabMode::None
            };
        }
    }
}

/// A cursor that is held sends no positions: the pointer is in the middle of the window then.
fn aim_at_middle(
    windows: Query<(Entity, &Window, &CursorOptions), With<PrimaryWindow>>,
    mut pointers: MessageWriter<PointerInput>,
) {
    for (entity, window, cursor) in &windows {
        let Some(target) = WindowRef::Primary.normalize(Some(entity)) else {
            continue;
        };
        if !cursor.visible {
            let location = Location {
                target: NormalizedRenderTarget::Window(target),
                position: 0.5 * window.size(),
            };
            let delta = Vec2::ZERO;
            let action = PointerAction::Move { delta };
            pointers.write(PointerInput::new(PointerId::Mouse, location, action));
        }
    }
}
