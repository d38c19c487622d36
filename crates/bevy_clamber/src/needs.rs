//! Checks that the plugins which ours need are there.

use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;

/// Ends the app if a plugin is missing that `needed_by` cannot do without: the panic of the first system that misses a
/// resource would not name it.
pub(crate) fn need(is_there: bool, needed_by: &str, missing: &str) {
    assert!(
        is_there,
        "{needed_by} needs {missing}: add it to the app, before or after {needed_by}. `DefaultPlugins` has all of \
         Bevy's"
    );
}

/// [`need`] for a plugin of this crate.
pub(crate) fn need_plugin<P: Plugin>(app: &App, needed_by: &str, missing: &str) {
    need(app.is_plugin_added::<P>(), needed_by, missing);
}

/// [`need`] for a plugin that adds a resource.
pub(crate) fn need_resource<R: Resource>(app: &App, needed_by: &str, missing: &str) {
    need(app.world().contains_resource::<R>(), needed_by, missing);
}
