//! Bodies that are far heavier than the climber, and climbers that hang.

use clamber_climber::{ClimberConfig, ClimberMode};
use clamber_world::rapier3d::prelude::{ColliderBuilder, RigidBodyBuilder};
use glam::DVec3;

use crate::cases::pairs;
use crate::input::{HOLD, IDLE};
use crate::proxies::scene::{SETTINGS, Scene};

/// A boulder strikes a climber like a fall onto the boulder: the climber gets no faster than the boulder came.
#[test]
fn a_boulder_throws_nobody_into_the_sky() {
    for (setting, mass) in pairs(SETTINGS, [800.0, 4_800.0, 8e4]) {
        let mut scene = Scene::on_floor(setting);
        scene.rest(0.3);
        let size = setting.0;
        let from = scene.climber.state().position;
        let boulder = RigidBodyBuilder::dynamic()
            .translation((from + DVec3::new(0.1, 3.1, 0.0) * size).as_vec3())
            .linvel(scene.frame.as_vec3())
            .can_sleep(false);
        let ball = ColliderBuilder::ball((0.6 * size) as f32).mass(mass);
        scene.world.insert(boulder, ball);
        let mut came = false;
        for tick in 0..scene.ticks(3.0) {
            scene.tick(&IDLE);
            came |= scene.hit.is_some();
            let rises = scene.own().y / scene.speed();
            let height = (scene.climber.state().position.y - from.y) / size;
            let told = format!("{setting:?}, {mass} kg, tick {tick}: {rises} m/s, {height} m");
            assert!(rises < 7.0 && height < 1.5, "{told}");
        }
        assert!(came, "{setting:?}, {mass} kg");
    }
}

/// No support is below a climber that hangs from a ledge: it goes on with the crate at their common velocity.
#[test]
fn a_crate_takes_a_climber_off_its_ledge_at_their_common_velocity() {
    for (setting, mass) in pairs(SETTINGS, [80.0, 500.0, 5_000.0]) {
        let config = ClimberConfig::colossus_climber();
        let mut scene = Scene::new(setting, config, DVec3::new(0.1, 21.4, 0.0));
        let wall = RigidBodyBuilder::kinematic_velocity_based();
        scene.add(wall, [2.0, 40.0, 8.0], DVec3::new(1.5, 2.0, 0.0), 0.0);
        let mut state = *scene.climber.state();
        state.heading = DVec3::X;
        scene.climber.restore(state).unwrap();
        for _ in 0..scene.ticks(0.5) {
            scene.tick(&HOLD);
        }
        let mode = scene.climber.state().mode;
        assert_eq!(mode, ClimberMode::LedgeHanging, "{setting:?}");
        let load = scene.drop_crate(0.5, 3.5, mass);
        let mut came = 0.0_f64;
        for _ in 0..scene.ticks(2.0) {
            came = came.max(-scene.velocity(load).y);
            scene.tick(&HOLD);
            if scene.climber.state().mode != ClimberMode::LedgeHanging {
                break;
            }
        }
        let left = -scene.own().y;
        let common = came * mass / (mass + 80.0);
        let told = format!("{setting:?}, {mass} kg: {left} m/s of {common}");
        // Gravity adds to both velocities in the tick.
        let slack = 0.03 * came + 2.0 * 9.81 * scene.dt();
        assert!((left - common).abs() < slack, "{told}");
    }
}
