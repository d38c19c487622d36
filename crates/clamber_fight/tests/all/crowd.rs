//! An arena looks for the climbers near each one. All of them, near and far, have the same effect.

use clamber_climber::{Climber, ClimberGroup, ClimberInput, StepRules};
use clamber_fight::{Arena, ArenaConfig, FighterConfig, fighter_obstacle};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::DVec3;

#[test]
fn climbers_far_away_make_no_difference() {
    let ground = HalfSpace::below(0.0);
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
    let mut random = fastrand::Rng::with_seed(11);
    // From a small creature's to a giant's, and so close that they push each other, fall on each other and climb.
    for scale in [0.2, 1.0, 5.0] {
        let mut arena = Arena::new(ArenaConfig::default()).unwrap();
        for index in 0..60 {
            let mut config = FighterConfig {
                sword: None,
                bow: None,
                stones: None,
                respawn: None,
                crush: None,
                ..FighterConfig::hero()
            };
            config.climber = config.climber.scaled(scale);
            config.climber.health = None;
            let (x, z) = (f64::from(index % 8), f64::from(index / 8));
            let height = 0.5 + 3.0 * random.f64();
            let place = DVec3::new(1.5 * x, height, 1.5 * z) * scale;
            arena.add_fighter(config, place).unwrap();
        }
        // Those who join look for room first.
        arena.step(&[ClimberInput::IDLE; 60], &terrain).unwrap();
        let mut climbers: Vec<(ObstacleId, Climber)> = arena
            .fighters()
            .iter()
            .map(|one| (fighter_obstacle(one.id()), one.climber().clone()))
            .collect();
        let mut group = ClimberGroup::default();
        let dt = arena.config().tick;
        let mut touches = 0;
        for tick in 0..240 {
            let inputs: Vec<ClimberInput> = (0..60)
                .map(|_| ClimberInput {
                    walk: DVec3::new(random.f64() - 0.5, 0.0, random.f64() - 0.5) * 2.0,
                    jump: random.u8(..) < 8,
                    grip: random.bool(),
                    ..ClimberInput::IDLE
                })
                .collect();
            arena.step(&inputs, &terrain).unwrap();
            let all = climbers.iter().map(|(id, climber)| (*id, climber));
            group.update(all, &terrain, dt);
            for ((id, climber), input) in climbers.iter_mut().zip(&inputs) {
                let obstacles: Vec<_> = terrain.into_iter().chain(group.others(*id)).collect();
                let rules = StepRules {
                    id: Some(*id),
                    ..StepRules::default()
                };
                climber.step_with(input, &obstacles, &rules, dt).unwrap();
                let others = climber.contacts().iter();
                touches += others.filter(|one| one.obstacle.0 > 0).count();
            }
            for (fighter, (_, climber)) in arena.fighters().iter().zip(&climbers) {
                let found = fighter.climber().state();
                assert!(
                    found == climber.state(),
                    "scale {scale}, tick {tick}: {found:?}"
                );
            }
        }
        assert!(touches > 300, "{touches} touches");
    }
}
