//! The programs of the README: it has them word for word, and they run.

/// Bevy's umbrella crate asks for a newer Rust than this crate, so its names are those of Bevy's sub-crates here.
mod bevy {
    pub(crate) mod mesh {
        pub(crate) use bevy_mesh::*;
    }

    pub(crate) mod prelude {
        pub(crate) use bevy_app::prelude::*;
        pub(crate) use bevy_asset::prelude::*;
        #[cfg(any(feature = "avian", feature = "rapier"))]
        pub(crate) use bevy_camera::prelude::*;
        pub(crate) use bevy_ecs::prelude::*;
        #[cfg(any(feature = "avian", feature = "rapier"))]
        pub(crate) use bevy_math::prelude::*;
        pub(crate) use bevy_transform::prelude::*;

        /// The plugins that surfaces need.
        pub(crate) struct DefaultPlugins;

        impl Plugin for DefaultPlugins {
            fn build(&self, app: &mut App) {
                app.add_plugins((
                    TaskPoolPlugin::default(),
                    bevy_time::TimePlugin,
                    TransformPlugin,
                    AssetPlugin::default(),
                    bevy_mesh::MeshPlugin,
                ));
            }
        }
    }
}

/// That of the repository's README.
mod root {
    use super::bevy;

    include!("root.rs");

    #[test]
    fn the_climber_of_the_repositorys_readme_lands() {
        use bevy::prelude::*;
        use bevy_clamber::prelude::ClimberState;
        use bevy_time::TimeUpdateStrategy;

        let mut app = App::new();
        app.add_plugins((bevy::prelude::DefaultPlugins, climbing))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        app.finish();
        app.cleanup();
        for _ in 0..3 * 64 {
            app.update();
        }
        let mut climbers = app.world_mut().query::<&ClimberState>();
        let state = climbers.single(app.world()).unwrap();
        assert!((state.position.y - 0.4).abs() < 0.02, "{state:?}");
    }
}

/// Those of the recipe about falling crates.
#[cfg(any(feature = "avian", feature = "rapier"))]
mod crates {
    use super::bevy;
    use bevy::prelude::*;
    use bevy_clamber::clamber_climber::ClimberMode;
    use bevy_clamber::prelude::ClimberState;
    use bevy_time::TimeUpdateStrategy;

    /// Whether the climber of a program is knocked down within 1.5 s.
    fn is_knocked_down(falling_crate: fn(&mut App)) -> bool {
        let mut app = App::new();
        app.add_plugins((DefaultPlugins, falling_crate))
            .insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
        app.finish();
        app.cleanup();
        let mut climbers = app.world_mut().query::<&ClimberState>();
        (0..96).any(|_| {
            app.update();
            let state = climbers.single(app.world());
            state.is_ok_and(|state| state.mode == ClimberMode::Tumbling)
        })
    }

    #[cfg(feature = "avian")]
    #[allow(dead_code, reason = "`main` opens a window")]
    mod on_avian {
        use super::bevy;

        include!("crate_on_avian.rs");

        #[test]
        fn the_crate_of_the_recipe_knocks_the_climber_down_with_avian() {
            assert!(super::is_knocked_down(falling_crate));
        }
    }

    #[cfg(feature = "rapier")]
    #[allow(dead_code, reason = "`main` opens a window")]
    mod on_rapier {
        use super::bevy;

        include!("crate_on_rapier.rs");

        #[test]
        fn the_crate_of_the_recipe_knocks_the_climber_down_with_rapier() {
            assert!(super::is_knocked_down(falling_crate));
        }
    }
}

#[cfg(feature = "clamber_gltf")]
mod headless {
    include!("headless.rs");

    #[test]
    fn the_headless_program_runs() {
        // Where its file is.
        std::env::set_current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets")).unwrap();
        main();
    }
}

#[test]
fn the_readme_has_the_programs_word_for_word() {
    // A checkout may have other line ends.
    let text = |text: &str| text.replace("\r\n", "\n");
    let readme = text(include_str!("../../README.md"));
    // The first two need a renderer; they are built with the game.
    let first = include_str!("../../../../examples/bevy/examples/first.rs");
    let fox = include_str!("../../../../examples/bevy/examples/fox.rs");
    for program in [first, fox, include_str!("headless.rs")] {
        let block = format!("```rust,ignore\n{}```\n", text(program));
        assert!(readme.contains(&block), "not in the README:\n{block}");
    }
    let recipe = text(include_str!("../../../../docs/recipes/falling_crates.md"));
    let on_avian = include_str!("crate_on_avian.rs");
    for program in [on_avian, include_str!("crate_on_rapier.rs")] {
        let block = format!("```rust,ignore\n{}```\n", text(program));
        assert!(recipe.contains(&block), "not in the recipe:\n{block}");
    }
    let readme = text(include_str!("../../../../README.md"));
    let block = format!("```rs\n{}```\n", text(include_str!("root.rs")));
    assert!(
        readme.contains(&block),
        "not in the repository's README:\n{block}"
    );
}
