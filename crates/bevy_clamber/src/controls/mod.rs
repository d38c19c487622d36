//! Keyboard, mouse and gamepads.

mod bindings;
mod component;
mod steer;

use bevy_app::{App, Plugin, PreUpdate};
use bevy_ecs::prelude::*;
use bevy_input::InputSystems;
use bevy_input::keyboard::KeyCode;
use bevy_input::mouse::AccumulatedMouseMotion;
use bevy_input::prelude::ButtonInput;

pub use bindings::{ControlBindings, ControlButton};
pub use component::{ClimberControls, ControlDevice};

use crate::ClamberSystems;
use crate::needs::need_resource;

/// Fills the [`ClimberInput`](crate::ClimberInput)s of entities with [`ClimberControls`], in [`ClamberSystems::Input`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ClimberControlsPlugin;

impl Plugin for ClimberControlsPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClimberControls>()
            .add_observer(steer::let_go)
            .configure_sets(PreUpdate, ClamberSystems::Input.after(InputSystems))
            .add_systems(
                PreUpdate,
                (steer::tell_shared_devices, steer::steer)
                    .chain()
                    .in_set(ClamberSystems::Input),
            );
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's ClimberControlsPlugin";
        need_resource::<ButtonInput<KeyCode>>(app, me, "InputPlugin of bevy_input");
        need_resource::<AccumulatedMouseMotion>(app, me, "InputPlugin of bevy_input");
    }
}
