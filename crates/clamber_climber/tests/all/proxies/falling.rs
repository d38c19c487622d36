//! Crates that fall on a climber on a rapier floor.

use clamber_climber::{ClimberConfig, ClimberEvent, ClimberInput, ClimberMode};
use clamber_world::rapier3d::prelude::RigidBodyBuilder;
use glam::DVec3;

use crate::proxies::scene::{SETTINGS, Scene, Setting, WORLD};

fn standing(setting: Setting) -> Scene {
    let config = ClimberConfig::colossus_climber();
    let mut scene = Scene::new(setting, config, DVec3::Y * 0.41).with_floor();
    for _ in 0..scene.ticks(0.5) {
        scene.tick(&ClimberInput::IDLE);
    }
    assert_eq!(scene.climber.state().mode, ClimberMode::Standing);
    scene
}

/// A crate over the climber's position.
fn above(scene: &Scene, height: f64) -> DVec3 {
    scene.climber.state().position / scene.setting.0 + DVec3::Y * height
}

#[test]
fn a_light_crate_rests_on_a_standing_climber() {
    for setting in SETTINGS {
        let mut scene = standing(setting);
        let body = RigidBodyBuilder::dynamic().lock_rotations();
        let load = scene.add(body, [0.6; 3], above(&scene, 1.2), 10.0);
        let mut felt = 0.0f64;
        for tick in 0..scene.ticks(3.0) {
            let report = scene.tick(&ClimberInput::IDLE);
            felt += scene.hit.map_or(0.0, |hit| hit.impulse.length());
            let above = scene.above(load).y;
            let told = format!("{setting:?}, tick {tick}: {above} {:?}", report.events);
            assert!(above > 0.695, "{told}");
            assert_eq!(scene.climber.state().mode, ClimberMode::Standing, "{told}");
            assert!(!scene.climber.state().crushed, "{told}");
        }
        let above = scene.above(load).y;
        assert!((above - 0.71).abs() < 0.008, "{setting:?}: {above}");
        // The crate fell by 0.49 m, to 3.1 m/s, up to the last tick before the impact.
        let expected = 10.0 * 3.1 * scene.speed();
        assert!(
            (felt / expected - 1.0).abs() < 0.13,
            "{setting:?}: {felt} of {expected}"
        );
    }
}

#[test]
fn without_a_proxy_the_crate_falls_into_the_climber() {
    let mut scene = standing((1.0, 60.0, 0.0)).without_proxy();
    let body = RigidBodyBuilder::dynamic().lock_rotations();
    let load = scene.add(body, [0.6; 3], above(&scene, 1.2), 10.0);
    let mut least = f64::INFINITY;
    for _ in 0..120 {
        scene.tick(&ClimberInput::IDLE);
        least = least.min(scene.above(load).y);
    }
    assert!(least < 0.65, "{least}");
}

#[test]
fn a_fast_heavy_crate_knocks_a_standing_climber_down() {
    for setting in SETTINGS {
        for (mass, knocks) in [(10.0, false), (30.0, false), (60.0, true), (400.0, true)] {
            let mut scene = standing(setting);
            let body = RigidBodyBuilder::dynamic().lock_rotations();
            // The crate hits at 5.8 m/s: 60 kg change the speed of 80 kg by 4.4 m/s.
            let load = scene.add(body, [0.6; 3], above(&scene, 2.4), mass);
            let mut events = Vec::new();
            for tick in 0..scene.ticks(2.0) {
                events.extend(scene.tick(&ClimberInput::IDLE).events);
                let above = scene.above(load).y;
                assert!(
                    above > 0.6,
                    "{setting:?}, {mass} kg, tick {tick}: {above} {events:?}"
                );
            }
            let by_it = |event: &ClimberEvent| match event {
                ClimberEvent::Tumbled { by, .. } => *by == Some(WORLD),
                _ => false,
            };
            let told = format!("{setting:?}, {mass} kg: {events:?}");
            assert_eq!(events.iter().any(by_it), knocks, "{told}");
        }
    }
}

#[test]
fn a_heavy_crate_that_is_put_down_slowly_rests() {
    for setting in SETTINGS {
        let mut scene = standing(setting);
        let body = RigidBodyBuilder::dynamic().lock_rotations();
        let load = scene.add(body, [0.6; 3], above(&scene, 0.72), 400.0);
        for tick in 0..scene.ticks(2.0) {
            scene.tick(&ClimberInput::IDLE);
            let told = format!("{setting:?}, tick {tick}: {}", scene.above(load));
            assert_eq!(scene.climber.state().mode, ClimberMode::Standing, "{told}");
            assert!(scene.above(load).y > 0.69, "{told}");
        }
    }
}

#[test]
fn a_crate_that_falls_off_center_ends_beside_the_climber() {
    for setting in SETTINGS {
        for aside in [0.1, 0.25, 0.4, 0.6] {
            let mut scene = standing(setting);
            let at = above(&scene, 1.3) + DVec3::X * aside;
            let load = scene.add(RigidBodyBuilder::dynamic(), [0.6; 3], at, 20.0);
            for tick in 0..scene.ticks(4.0) {
                let report = scene.tick(&ClimberInput::IDLE);
                let apart = scene.above(load);
                let told = format!(
                    "{setting:?}, {aside}, tick {tick}: {apart} {:?}",
                    report.events
                );
                assert!(apart.length() > 0.67, "{told}");
                assert!(!scene.climber.state().crushed, "{told}");
                let height = scene.climber.state().position.y / setting.0;
                assert!((height - 0.4).abs() < 0.02, "{told}: {height}");
            }
        }
    }
}
