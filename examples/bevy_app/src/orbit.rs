//! A camera that goes around the creature: dragged with the right button, nearer and farther with the wheel.

use bevy::input::mouse::{AccumulatedMouseScroll, MouseScrollUnit};
use bevy::prelude::*;
use bevy::window::CursorMoved;

use crate::creature::Creature;

/// Radians that the camera turns for each pixel of a drag.
const TURN: f32 = 0.005;

/// Share of the distance that a line of the wheel goes.
const ZOOM: f32 = 0.1;

/// How near to straight up or down the camera may look, radians.
const STEEPEST: f32 = 1.5;

/// Pixels that trackpads call a line.
const LINE: f32 = 40.0;

pub fn plugin(app: &mut App) {
    app.add_systems(Update, orbit.run_if(resource_exists::<Creature>));
}

fn orbit(
    mut camera: Single<&mut Transform, With<Camera3d>>,
    creature: Res<Creature>,
    buttons: Res<ButtonInput<MouseButton>>,
    mut moved: MessageReader<CursorMoved>,
    scroll: Res<AccumulatedMouseScroll>,
) {
    let lines = match scroll.unit {
        MouseScrollUnit::Line => scroll.delta.y,
        MouseScrollUnit::Pixel => scroll.delta.y / LINE,
    };
    // The cursor's way: what the mouse itself reports is missing on remote desktops.
    let way: Vec2 = moved.read().filter_map(|moved| moved.delta).sum();
    let dragged = if buttons.pressed(MouseButton::Right) {
        way * TURN
    } else {
        Vec2::ZERO
    };
    if lines == 0.0 && dragged == Vec2::ZERO {
        return;
    }
    let (yaw, pitch, _) = camera.rotation.to_euler(EulerRot::YXZ);
    let pitch = (pitch - dragged.y).clamp(-STEEPEST, STEEPEST);
    camera.rotation = Quat::from_euler(EulerRot::YXZ, yaw - dragged.x, pitch, 0.0);
    let distance = camera.translation.distance(creature.center) * (1.0 - ZOOM).powf(lines);
    let radius = creature.radius();
    let distance = distance.clamp(0.2 * radius, 10.0 * radius);
    camera.translation = creature.center + distance * camera.back();
}
