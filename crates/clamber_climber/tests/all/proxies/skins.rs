//! Crates that fall on a climber on a creature's skin.

use clamber_climber::{ClimberConfig, ClimberEvent, ClimberInput, ClimberMode};
use clamber_surface::geometry::Similarity;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DQuat, DVec3, Vec3};

use crate::cases::pairs;
use crate::events::is_tumbled;
use crate::input::{HOLD, IDLE};
use crate::proxies::scene::{SETTINGS, Scene, Setting};
use crate::scene::{FUR, STONE, cuboid, rest};

/// Id of the creature as an obstacle.
const CREATURE: ObstacleId = ObstacleId(3);

/// A climber on a creature that heaves by a tenth of the climber's size, twice a second.
struct Ride {
    scene: Scene,
    creature: SkinnedSurface,
    tick: u32,
}

impl Ride {
    fn new(setting: Setting, creature: SkinnedSurface, position: DVec3) -> Self {
        let scene = Scene::new(setting, ClimberConfig::colossus_climber(), position);
        let mut ride = Self {
            scene,
            creature,
            tick: 0,
        };
        let at = ride.at();
        ride.creature.teleport(&rest(), at).unwrap();
        ride
    }

    fn at(&self) -> Similarity {
        let (size, hz, _) = self.scene.setting;
        let time = f64::from(self.tick) / hz;
        let heave = 0.05 * size * libm::sin(time / size.sqrt() * std::f64::consts::TAU);
        Similarity {
            translation: self.scene.frame * time + DVec3::Y * heave,
            rotation: DQuat::IDENTITY,
            scale: size,
        }
    }

    fn tick(&mut self, input: &ClimberInput) -> Vec<ClimberEvent> {
        self.tick += 1;
        let at = self.at();
        self.creature.advance(&rest(), at).unwrap();
        let skin: &dyn Obstacle = &self.creature;
        self.scene.tick_with(input, &[(CREATURE, skin)]).events
    }
}

#[test]
fn a_crate_rests_on_a_climber_on_a_back_or_knocks_it_down() {
    let crates = [(10.0, 1.2, false), (80.0, 2.4, true)];
    for (setting, (mass, height, knocks)) in pairs(SETTINGS, crates) {
        let back = cuboid(Vec3::new(6.0, 1.0, 6.0), STONE);
        let mut ride = Ride::new(setting, back, DVec3::Y * 1.42);
        for _ in 0..ride.scene.ticks(0.5) {
            ride.tick(&IDLE);
        }
        let mode = ride.scene.climber.state().mode;
        assert_eq!(mode, ClimberMode::Standing, "{setting:?}");
        let load = ride.scene.drop_crate(0.5, height, mass);
        let mut events = Vec::new();
        for tick in 0..ride.scene.ticks(2.5) {
            events.extend(ride.tick(&IDLE));
            let above = ride.scene.above(load).y;
            let told = format!("{setting:?}, {mass} kg, tick {tick}: {above} {events:?}");
            assert!(above > 0.6, "{told}");
        }
        let told = format!("{setting:?}, {mass} kg: {events:?}");
        assert_eq!(events.iter().any(is_tumbled), knocks, "{told}");
        if !knocks {
            let above = ride.scene.above(load).y;
            assert!((above - 0.66).abs() < 0.02, "{told}: {above}");
        }
    }
}

#[test]
fn a_heavy_crate_knocks_a_climber_off_its_hold_and_a_light_one_does_not() {
    for (setting, (mass, knocks)) in pairs(SETTINGS, [(4.0, false), (200.0, true)]) {
        let wall = cuboid(Vec3::new(4.0, 9.0, 3.0), FUR);
        let mut ride = Ride::new(setting, wall, DVec3::new(0.0, 1.0, 3.5));
        for _ in 0..ride.scene.ticks(0.5) {
            ride.tick(&HOLD);
        }
        assert!(ride.scene.climber.state().mode.is_holding(), "{setting:?}");
        let load = ride.scene.drop_crate(0.5, 2.4, mass);
        let mut events = Vec::new();
        for tick in 0..ride.scene.ticks(1.0) {
            events.extend(ride.tick(&HOLD));
            let apart = ride.scene.above(load).length();
            let told = format!("{setting:?}, {mass} kg, tick {tick}: {apart} {events:?}");
            assert!(apart > 0.6, "{told}");
        }
        let told = format!("{setting:?}, {mass} kg: {events:?}");
        assert_eq!(events.iter().any(is_tumbled), knocks, "{told}");
        if !knocks {
            assert!(ride.scene.climber.state().mode.is_holding(), "{told}");
        }
    }
}
