//! Shoots an arrow where the mouse is pressed, through the picking backend of `bevy_clamber`. A press carries the point
//! of skin under the pointer in the pose that the last frame drew, which is the pose that the user aimed at.

use bevy::picking::events::PointerPress;
use bevy::picking::pointer::PointerButton;
use bevy::prelude::*;
use bevy_clamber::prelude::*;

use crate::arrows::{Arrow, Bow};

pub fn plugin(app: &mut App) {
    app.add_plugins(SurfacePickingPlugin)
        .add_observer(shoot_where_pressed);
}

/// A press, not a click: a click would need the button to be released over the same mesh, which walks on.
fn shoot_where_pressed(
    press: On<PointerPress>,
    cameras: Query<(&Camera, &GlobalTransform)>,
    mut bow: Bow,
) {
    let (Some(pick), Some(point)) = (press.hit.extra_as::<SurfacePick>(), press.hit.position)
    else {
        return;
    };
    // The event bubbles up to the parents of the pressed entity.
    if press.button != PointerButton::Primary || press.entity != pick.anchor.surface {
        return;
    }
    let Ok((camera, place)) = cameras.get(press.hit.camera) else {
        return;
    };
    if let Ok(direction) = Dir3::new(point - place.translation())
        && let Ok(seen) = camera.world_to_viewport(place, point)
    {
        let missed = seen.distance(press.pointer.position);
        bow.stick(&pick.anchor, Arrow { hit: point, missed }, direction);
    }
}
