//! Two worlds with the same input have the same bits, and so does a world that is restored.

use clamber_climber::{Climber, ClimberInput};
use clamber_world::rapier3d::prelude::RigidBodyBuilder;
use clamber_world::{Debris, DebrisConfig, DebrisSnapshot};
use glam::DVec3;

use crate::input::IDLE;
use crate::proxies::scene::{SETTINGS, Scene, Setting};

fn rain(setting: Setting) -> Scene {
    let mut scene = Scene::on_floor(setting);
    let mut rng = fastrand::Rng::with_seed(5);
    for index in 0..12 {
        let mut any = || rng.f64() - 0.5;
        let at = DVec3::new(any(), 1.5 + 0.8 * f64::from(index), any());
        let mass = 40.0 * (any() + 0.6);
        scene.add(RigidBodyBuilder::dynamic(), [0.5; 3], at, mass);
    }
    scene
}

/// Every bit of the climber and of the bodies.
fn bits(scene: &Scene) -> Vec<u64> {
    let mut all = vec![scene.climber.state().fingerprint()];
    for (_, body) in scene.world.bodies.iter() {
        let (place, turn, velocity) = (body.translation(), body.rotation(), body.linvel());
        let numbers = [place.to_array(), velocity.to_array()].concat();
        all.extend(numbers.iter().map(|x| u64::from(x.to_bits())));
        all.extend(turn.to_array().iter().map(|x| u64::from(x.to_bits())));
    }
    all
}

fn input(tick: u32) -> ClimberInput {
    let angle = f64::from(tick) * 0.05;
    ClimberInput {
        walk: DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)),
        jump: tick % 40 == 7,
        ..IDLE
    }
}

fn run(scene: &mut Scene, ticks: std::ops::Range<u32>) -> Vec<Vec<u64>> {
    ticks
        .map(|tick| {
            scene.tick(&input(tick));
            bits(scene)
        })
        .collect()
}

#[test]
fn the_same_input_gives_the_same_bits_again_and_after_a_restore() {
    for setting in SETTINGS {
        let (mut one, mut two) = (rain(setting), rain(setting));
        run(&mut one, 0..100);
        run(&mut two, 0..100);
        let mut debris = Debris::new(DebrisConfig::default());
        let saved = DebrisSnapshot::save(&one.world, &debris);
        let (state, proxy) = (*one.climber.state(), one.proxy.clone());
        let first = run(&mut one, 100..250);
        assert_eq!(run(&mut two, 100..250), first, "{setting:?}: another run");
        saved.restore(&mut one.world, &mut debris);
        one.climber.restore(state).unwrap();
        one.proxy.clone_from(&proxy);
        assert_eq!(run(&mut one, 100..250), first, "{setting:?}: restored");
        let config = *one.climber.config();
        let mut fresh = Scene::new(setting, config, DVec3::ZERO);
        fresh.climber = Climber::new(config, DVec3::ZERO).unwrap();
        saved.restore(&mut fresh.world, &mut debris);
        fresh.climber.restore(state).unwrap();
        fresh.proxy = proxy;
        let again = run(&mut fresh, 100..250);
        assert_eq!(again, first, "{setting:?}: in a fresh scene");
    }
}
