//! A giant lives by the brain in a file: it notices a person nearby, turns, walks there, and strikes.

use std::sync::Arc;

use clamber::colossus::{
    Brain, Creature, CreatureConfig, CreatureEvent, CreatureKind, Person, Surroundings,
};
use clamber::glam::DVec3;
use clamber::world::{HalfSpace, Obstacle, WorldCapsule};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rig = clamber::gltf::load("assets/colossus.glb")?.rig;
    let brain = std::fs::read_to_string("assets/colossus.brain.json")?;
    let brain = Brain::from_json(&brain, 1.0 / 60.0)?; // 60 ticks a second
    let kind = Arc::new(CreatureKind::new(&rig, brain)?);
    let mut giant = Creature::new(Arc::clone(&kind), CreatureConfig::default())?;

    let ground = HalfSpace::below(0.0);
    let terrain: [&dyn Obstacle; 1] = [&ground];
    let (mut states, mut blows) = (0, 0);
    for tick in 0..60 * 60 {
        // A person of 1.75 m comes nearer, and stops. If it rode on the giant, `riding` would say how.
        let feet = DVec3::new(0.0, 0.0, (40.0 - 0.05 * f64::from(tick)).max(12.0));
        let ends = [feet + DVec3::Y * 0.3, feet + DVec3::Y * 1.45];
        let body = WorldCapsule { ends, radius: 0.3 };
        let people = [Person {
            id: 1,
            body,
            riding: None,
        }];
        let report = giant.step(&Surroundings {
            terrain: &terrain,
            people: &people,
            ..Surroundings::default()
        })?;
        let seconds = f64::from(tick) / 60.0;
        for event in &report.events {
            if let CreatureEvent::Entered { to, .. } = event {
                println!("{seconds:5.2} s  {}", kind.brain().path(*to));
                states += 1;
            }
        }
        for blow in &report.blows {
            println!(
                "{seconds:5.2} s  a blow of {:.1} m/s",
                blow.velocity.length()
            );
            blows += 1;
        }
    }
    assert!(states > 3 && blows > 0, "it has not noticed the person");
    // A copy of its state continues with the same bits: that is a save.
    let saved = giant.state().clone();
    giant.restore(saved)?;
    Ok(())
}
