//! Climbers that grow and shrink.

use bevy_clamber::clamber_climber::ClimberMode;
use bevy_clamber::clamber_world::HalfSpace;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use glam::DVec3;

use super::common;

/// Ground at height 0, and a ceiling.
fn gap(height: f64) -> (bevy_app::App, Entity) {
    let mut app = common::app_with(60.0, (ClamberPlugins::default(), ClimberPlugin::default()));
    let world = app.world_mut();
    world.spawn(CustomObstacle::new(HalfSpace::below(0.0)));
    let ceiling = HalfSpace::behind(DVec3::Y * height, DVec3::NEG_Y).unwrap();
    let ceiling = world.spawn(CustomObstacle::new(ceiling)).id();
    (app, ceiling)
}

#[test]
fn a_climber_grows_when_it_has_room_and_shrinks_at_once() {
    for size in [0.5, 1.0, 20.0] {
        let config = Climber::colossus_climber().config.scaled(size);
        let radius = config.body.radius;
        let (mut app, ceiling) = gap(2.5 * radius);
        let start = Transform::from_xyz(0.0, radius as f32 * 1.05, 0.0);
        let climber = app.world_mut().spawn((Climber::new(config), start)).id();
        let run = |app: &mut bevy_app::App| {
            for _ in 0..60 {
                app.update();
            }
            let state = *app.world().get::<ClimberState>(climber).unwrap();
            assert_eq!(state.mode, ClimberMode::Standing, "{size}");
            let config = *app.world().get::<ClimberBody>(climber).unwrap().config();
            assert!(state.position.y > 0.99 * config.body.radius, "{size}");
            assert!(state.position.y < 1.05 * config.body.radius, "{size}");
            config
        };
        assert_eq!(run(&mut app), config);
        let want = |app: &mut bevy_app::App, wanted| {
            app.world_mut().get_mut::<Climber>(climber).unwrap().config = wanted;
        };
        for (share, fits) in [(2.0, false), (0.5, true), (1.2, true), (1.3, false)] {
            let before = *app.world().get::<ClimberBody>(climber).unwrap().config();
            let wanted = config.scaled(share);
            want(&mut app, wanted);
            let is = run(&mut app);
            assert_eq!(is, if fits { wanted } else { before }, "{size}, {share}");
        }
        app.world_mut().despawn(ceiling);
        assert_eq!(run(&mut app), config.scaled(1.3));
    }
}
