//! The body of a climber, drawn: a humanoid rig whose hands and feet are on the surfaces that the climber touches.

mod component;
mod pose;

use bevy_app::{App, Plugin, PostUpdate};
use bevy_ecs::prelude::*;

pub use component::{ClimberFigure, ClimberFigures, ClimberPlant, FigureOf, WrongJoints};
#[cfg(feature = "fight")]
pub(crate) use pose::pose;

use crate::needs::need_plugin;
use crate::{ClamberSystems, ClimberPlugin};

/// Poses [`ClimberFigure`]s, in [`ClamberSystems::Body`]. Add it beside [`ClimberPlugin`].
#[derive(Clone, Copy, Debug, Default)]
pub struct ClimberFigurePlugin;

impl Plugin for ClimberFigurePlugin {
    fn build(&self, app: &mut App) {
        app.add_message::<ClimberPlant>()
            .register_type::<FigureOf>()
            .register_type::<ClimberFigures>()
            .add_systems(PostUpdate, pose::pose.in_set(ClamberSystems::Body));
    }

    fn finish(&self, app: &mut App) {
        need_plugin::<ClimberPlugin>(app, "clamber's ClimberFigurePlugin", "ClimberPlugin");
    }
}
