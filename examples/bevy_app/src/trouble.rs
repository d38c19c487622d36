//! What goes wrong with the creature's file. The log says it; without what the app is for, it ends, and otherwise
//! the window's title says it as well. In both cases the exit code is not 0.

use core::fmt::Display;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;
use bevy::window::ExitSystems;

/// The creature's file, as the user has called it.
#[derive(Resource)]
struct File(String);

/// There once something went wrong that the app goes on after.
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

/// Tells the user.
#[derive(SystemParam)]
pub struct Trouble<'w, 's> {
    file: Res<'w, File>,
    windows: Query<'w, 's, &'static mut Window>,
    commands: Commands<'w, 's>,
}

impl Trouble<'_, '_> {
    /// Nothing can be done with this file.
    pub fn end(&mut self, what: impl Display) {
        error!("{}: {what}", self.file.0);
        self.commands.write_message(AppExit::error());
    }

    /// Not all can be done that should.
    pub fn go_on(&mut self, what: impl Display) {
        error!("{}: {what}", self.file.0);
        for mut window in &mut self.windows {
            window.title = format!("{}: {what}", self.file.0);
        }
        self.commands.insert_resource(GoesOn);
    }
}

/// Of several exits in a frame, Bevy takes one that is an error.
fn fail_at_the_end(mut exits: ResMut<Messages<AppExit>>) {
    if !exits.is_empty() {
        exits.write(AppExit::error());
    }
}
