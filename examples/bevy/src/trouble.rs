//! Reports errors of the creature's file. They are logged. If the app cannot go on, it ends; otherwise the window's
//! title shows the error as well. In both cases the exit code is not 0.

use core::fmt::Display;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::ExitSystems;

/// The creature's file, as the user has written it.
#[derive(Resource)]
struct File(String);

/// Inserted after an error that the app survives.
#[derive(Resource)]
struct GoesOn;

pub fn plugin(file: String) -> impl Plugin {
    move |app: &mut App| {
        app.insert_resource(File(file.clone())).add_systems(
            Last,
            fail_at_the_end
                .after(ExitSystems)
                .run_if(resource_exists::<GoesOn>),
        );
    }
}

/// Reports errors to the user.
#[derive(SystemParam)]
pub struct Trouble<'w, 's> {
    file: Res<'w, File>,
    windows: Query<'w, 's, &'static mut Window>,
    commands: Commands<'w, 's>,
}

impl Trouble<'_, '_> {
    /// Reports that the file cannot be used, and ends the app.
    pub fn end(&mut self, what: impl Display) {
        error!("{}: {what}", self.file.0);
        self.commands.write_message(AppExit::error());
    }

    /// Reports that the file can be used only in part.
    pub fn go_on(&mut self, what: impl Display) {
        error!("{}: {what}", self.file.0);
        for mut window in &mut self.windows {
            window.title = format!("{}: {what}", self.file.0);
        }
        self.commands.insert_resource(GoesOn);
    }
}

/// Adds an error to a regular exit: of several exits in a frame, Bevy takes one that is an error.
fn fail_at_the_end(mut exits: ResMut<Messages<AppExit>>) {
    if !exits.is_empty() {
        exits.write(AppExit::error());
    }
}
