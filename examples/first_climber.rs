//! A character on rapier's terrain falls, lands on a turning platform, is carried round, and jumps off.

use clamber::glam::DVec3;
use clamber::prelude::*;
use clamber::world::rapier3d::prelude::*;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let dt = 1.0 / 60.0;
    let mut world = PhysicsWorld::default();
    world.insert_collider(ColliderBuilder::cuboid(50.0, 0.5, 50.0), None);
    let spin = RigidBodyBuilder::kinematic_velocity_based().angvel(Vector::Y * 0.5);
    let disc = ColliderBuilder::cylinder(0.5, 6.0);
    world.insert(spin.translation(Vector::Y * 1.5), disc);

    let mut before = BodyPoses::default();
    let mut climber = Climber::new(ClimberConfig::default(), DVec3::new(4.0, 4.0, 0.0))?;
    for tick in 0..300 {
        before.record(&world.bodies);
        world.step();
        let terrain = RapierTerrain::of_world(&world, &before);
        let input = ClimberInput {
            jump: tick == 200,
            walk: if tick > 200 { DVec3::X } else { DVec3::ZERO },
            ..ClimberInput::default()
        };
        let report = climber.step(&input, &[(ObstacleId(0), &terrain)], dt)?;
        for event in report.events {
            let at = climber.state().position;
            println!("tick {tick:3}  {event:?} at {at:.2}");
        }
        if tick == 199 {
            // The climber is still 4 m from the axis, as when it landed: it is carried on a circle, not along tangents.
            let level = climber.state().position * DVec3::new(1.0, 0.0, 1.0);
            assert!((level.length() - 4.0).abs() < 1e-4, "{level}");
            assert!(level.z.abs() > 1.0, "not carried");
        }
    }
    assert_eq!(climber.state().mode, ClimberMode::Standing);
    Ok(())
}
