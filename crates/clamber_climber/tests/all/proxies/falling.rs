//! Crates that fall on a climber on a rapier floor.

use clamber_climber::{ClimberEvent, ClimberMode};
use clamber_world::rapier3d::prelude::RigidBodyBuilder;
use glam::DVec3;

use crate::cases::pairs;
use crate::input::IDLE;
use crate::proxies::scene::{SETTINGS, Scene, WORLD};

#[test]
fn a_light_crate_rests_on_a_standing_climber() {
    for setting in SETTINGS {
        let mut scene = Scene::standing(setting);
        let load = scene.drop_crate(0.6, 1.2, 10.0);
        let mut felt = 0.0f64;
        for tick in 0..scene.ticks(3.0) {
            let report = scene.tick(&IDLE);
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
    let mut scene = Scene::standing((1.0, 60.0, 0.0)).without_proxy();
    let load = scene.drop_crate(0.6, 1.2, 10.0);
    let mut least = f64::INFINITY;
    for _ in 0..120 {
        scene.tick(&IDLE);
        least = least.min(scene.above(load).y);
    }
    assert!(least < 0.65, "{least}");
}

#[test]
fn a_fast_heavy_crate_knocks_a_standing_climber_down() {
    let crates = [(10.0, false), (30.0, false), (60.0, true), (400.0, true)];
    for (setting, (mass, knocks)) in pairs(SETTINGS, crates) {
        let mut scene = Scene::standing(setting);
        // The crate hits at 5.8 m/s: 60 kg change the speed of 80 kg by 4.4 m/s.
        let load = scene.drop_crate(0.6, 2.4, mass);
        let mut events = Vec::new();
        for tick in 0..scene.ticks(2.0) {
            events.extend(scene.tick(&IDLE).events);
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

#[test]
fn a_heavy_crate_that_is_put_down_slowly_rests() {
    for setting in SETTINGS {
        let mut scene = Scene::standing(setting);
        let load = scene.drop_crate(0.6, 0.72, 400.0);
        for tick in 0..scene.ticks(2.0) {
            scene.tick(&IDLE);
            let told = format!("{setting:?}, tick {tick}: {}", scene.above(load));
            assert_eq!(scene.climber.state().mode, ClimberMode::Standing, "{told}");
            assert!(scene.above(load).y > 0.69, "{told}");
        }
    }
}

#[test]
fn a_crate_that_falls_off_center_ends_beside_the_climber() {
    for (setting, aside) in pairs(SETTINGS, [0.1, 0.25, 0.4, 0.6]) {
        let mut scene = Scene::standing(setting);
        let at = scene.beside(DVec3::new(aside, 1.3, 0.0));
        let load = scene.add(RigidBodyBuilder::dynamic(), [0.6; 3], at, 20.0);
        for tick in 0..scene.ticks(4.0) {
            let report = scene.tick(&IDLE);
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
