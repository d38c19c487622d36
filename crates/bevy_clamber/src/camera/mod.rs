//! A camera that orbits a climber.

mod component;
mod follow;

use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::prelude::*;

pub use component::{ClimberCamera, ClimberCameraInput};

use crate::needs::need_plugin;
use crate::{ClamberSystems, ClimberPlugin};

/// Moves [`ClimberCamera`]s, in [`ClamberSystems::Follow`]. Add it beside [`ClimberPlugin`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ClimberCameraPlugin;

impl Plugin for ClimberCameraPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<ClimberCamera>()
            .register_type::<ClimberCameraInput>()
            .add_systems(PostUpdate, follow::follow.in_set(ClamberSystems::Follow));
    }

    fn finish(&self, app: &mut App) {
        need_plugin::<ClimberPlugin>(app, "clamber's ClimberCameraPlugin", "ClimberPlugin");
    }
}
