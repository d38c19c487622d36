//! Where the mouse points. With a picking backend that knows posed skin, this whole file becomes an observer of
//! `Pointer<Click>`, whose hit already has the point.

use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use crate::arrows::Bow;

pub fn plugin(app: &mut App) {
    app.add_systems(Update, shoot_where_clicked);
}

fn shoot_where_clicked(
    buttons: Res<ButtonInput<MouseButton>>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&Camera, &GlobalTransform)>,
    mut bow: Bow,
) {
    if !buttons.just_pressed(MouseButton::Left) {
        return;
    }
    let Some(cursor) = window.cursor_position() else {
        return;
    };
    let (camera, place) = *camera;
    if let Ok(ray) = camera.viewport_to_world(place, cursor) {
        bow.shoot(ray);
    }
}
