//! A camera that moves around the creature: drag with the right button to turn it, use the wheel to zoom.

use bevy::input::mouse::{AccumulatedMouseScroll, MouseScrollUnit};
use bevy::prelude::*;
use bevy::window::CursorMoved;

use crate::creature::Creature;

/// Radians that the camera turns for each pixel of a drag.
const TURN: f32 = 0.005;

/// Share of the distance by which one line of the wheel zooms.
const ZOOM: f32 = 0.1;

/// Steepest angle at which the camera may look up or down, radians.
const STEEPEST: f32 = 1.5;

/// Pixels of a trackpad that count as one line.
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
    // The motion of the cursor: remote desktops do not report the motion of the mouse itself.
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
