//! A hero on the giant's nape stabs through its shell; the fight is saved, restored, and repeated with the same bits.

use std::sync::Arc;

use clamber::climber::ClimberInput;
use clamber::colossus::{Brain, CreatureConfig, CreatureKind};
use clamber::fight::{Arena, ArenaConfig, ArenaEvent, FighterConfig, actions};
use clamber::glam::DVec3;
use clamber::world::{HalfSpace, Obstacle, ObstacleId};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rig = clamber::gltf::load("assets/colossus.glb")?.rig;
    let config = ArenaConfig::default(); // 60 ticks a second
    let brain = std::fs::read_to_string("assets/colossus.brain.json")?;
    let kind = CreatureKind::new(&rig, Brain::from_json(&brain, config.tick)?)?;

    let mut arena = Arena::new(config)?;
    arena.add_creature(Arc::new(kind), CreatureConfig::default())?;
    arena.add_fighter(FighterConfig::hero(), DVec3::new(1.0, 38.0, 1.0))?; // falls onto the nape
    let ground = HalfSpace::below(0.0); // or a `RapierTerrain`, or your own `Obstacle`
    let terrain: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];

    let (mut saved, mut hits) = (arena.save(), 0);
    let mut play = |arena: &mut Arena, tick: u32| -> Result<(), Box<dyn std::error::Error>> {
        // Holds on, charges the stab while the button is down, and strikes with the next press.
        let stabs = tick % 180 < 150;
        let input = ClimberInput {
            grip: true,
            actions: if stabs { actions::STAB } else { 0 },
            ..ClimberInput::default()
        };
        for event in arena.step(&[input], &terrain)? {
            if let ArenaEvent::Hit { plate, damage, .. } = event {
                println!("tick {tick}: a stab, plate {plate:?}, damage {damage:.2}");
                hits += 1;
            }
        }
        Ok(())
    };
    for tick in 0..1200 {
        if tick == 600 {
            saved = arena.save(); // or `to_bytes`, for a file
        }
        play(&mut arena, tick)?;
    }
    let first = arena.fingerprint();
    arena.restore(&saved)?;
    for tick in 600..1200 {
        play(&mut arena, tick)?;
    }
    assert_eq!(arena.fingerprint(), first, "the same bits again");
    assert!(hits >= 4, "{hits} hits");
    Ok(())
}
