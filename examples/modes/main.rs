//! Custom modes: a dash, a vault, a wall run, swimming. Each is a file of under 100 lines beside this one.
//!
//! A climber does all four on its way through a course of rapier's bodies.

mod dash;
mod swim;
mod vault;
mod wall_run;

use clamber::climber::CustomMode;
use clamber::glam::DVec3;
use clamber::prelude::*;
use clamber::world::rapier3d::prelude::*;
use dash::Dash;
use swim::Swim;
use vault::Vault;
use wall_run::WallRun;

/// Length of a tick, seconds.
const DT: f64 = 1.0 / 60.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut world = PhysicsWorld::default();
    let mut put = |half: [f32; 3], at: [f32; 3]| {
        let cuboid = ColliderBuilder::cuboid(half[0], half[1], half[2]);
        world.insert_collider(cuboid.translation(Vector::from_array(at)), None);
    };
    put([16.0, 2.0, 9.0], [9.0, -2.0, 0.0]); // the ground, to x = 25
    put([0.2, 0.5, 9.0], [8.0, 0.5, 0.0]); // a wall to vault over
    put([5.0, 4.0, 0.5], [18.0, 4.0, 0.95]); // a wall to run along
    put([20.0, 1.0, 9.0], [45.0, -4.0, 0.0]); // the bottom of a pool behind the ground
    world.detect_collisions(&(), &());

    let before = BodyPoses::default();
    let terrain = RapierTerrain::of_world(&world, &before);
    // Handlers have no state: they may be made once, or anew in each tick.
    let (dash, vault, wall_run) = (Dash::default(), Vault::default(), WallRun { action: 4 });
    let pool = [DVec3::new(25.0, -3.0, -9.0), DVec3::new(65.0, -0.5, 9.0)];
    let swim = Swim::new(pool, DVec3::ZERO);
    let modes: [&dyn CustomMode; 4] = [&dash, &vault, &wall_run, &swim];
    let names = ["dashes", "vaults", "runs along the wall", "swims"];
    let rules = StepRules::with_modes(&modes);

    let mut climber = Climber::new(ClimberConfig::default(), DVec3::new(0.0, 0.5, 0.0))?;
    let mut done = Vec::new();
    for tick in 0..900 {
        let at = climber.state().position;
        let runs = (13.0..23.0).contains(&at.x);
        let input = ClimberInput {
            // Beside the wall the climber also presses against it.
            walk: DVec3::new(1.0, 0.0, if runs { 0.2 } else { 0.0 }),
            jump: (14.0..14.5).contains(&at.x) && climber.state().mode == ClimberMode::Standing,
            // The input presses the dash's button once, and holds the other buttons.
            actions: vault.action | wall_run.action | if tick == 60 { dash.action } else { 0 },
            ..ClimberInput::default()
        };
        let report = climber.step_with(&input, &[(ObstacleId(0), &terrain)], &rules, DT)?;
        for event in report.events {
            if let ClimberEvent::Changed {
                to: ClimberMode::Custom(id),
                ..
            } = event
            {
                println!("tick {tick:3}  {} at {at:.2}", names[usize::from(id) - 1]);
                done.push(id);
            }
        }
    }
    // Each mode once, in the order of the course.
    assert_eq!(done, [1, 2, 3, 4]);
    assert_eq!(climber.state().mode, ClimberMode::Custom(swim.id()));
    Ok(())
}
