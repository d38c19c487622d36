//! A bot fights and kills animals from files that were not made for clamber, with brains that are proposed for them.

use std::path::PathBuf;

use clamber_colossus::BrainFile;
use clamber_scenes::battle::{Battle, BattleOptions};
use clamber_scenes::{Creature, test_data};

/// Number of fights that the bot won against an animal, with the seeds from 1 to `seeds`; `None` without the test data.
fn won(animal: &str, seeds: u64) -> Option<u64> {
    let path = test_data::file("fights with animals", &format!("models/{animal}"))?;
    let rig = clamber::gltf::load(&path).unwrap().rig;
    let brain = BrainFile::propose(&rig, 20.0).unwrap();
    let file = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{animal}.brain.json"));
    std::fs::write(&file, serde_json::to_string(&brain).unwrap()).unwrap();
    let options = BattleOptions {
        creature: Some(path),
        brain: Some(file),
        seconds: Some(300.0),
        rocks: 0,
        seed: 1,
        ..BattleOptions::default()
    };
    let creature = Creature::load(options.creature.as_ref().unwrap()).unwrap();
    let kills = |seed: u64| {
        let options = BattleOptions {
            seed,
            ..options.clone()
        };
        let mut battle = Battle::new(&creature, &options).unwrap();
        let mut ticks = 0..options.ticks();
        while battle.counts.killed == 0
            && let Some(tick) = ticks.next()
        {
            battle.step(options.input_at(tick)).unwrap();
        }
        println!("{animal:<16} seed {seed}: {:?}", battle.counts);
        u64::from(battle.counts.killed > 0)
    };
    let kills = &kills;
    std::thread::scope(|scope| {
        let fights: Vec<_> = (1..=seeds)
            .map(|seed| scope.spawn(move || kills(seed)))
            .collect();
        Some(fights.into_iter().map(|fight| fight.join().unwrap()).sum())
    })
}

#[test]
fn animals_from_elsewhere_are_killed() {
    for animal in ["Trex.glb", "Triceratops.glb", "Bull.glb"] {
        let Some(won) = won(animal, 1) else { return };
        assert_eq!(won, 1, "{animal}");
    }
}

#[test]
#[ignore = "takes a minute: 30 fights"]
fn animals_from_elsewhere_are_killed_in_three_of_five_fights() {
    // The first five have four legs.
    for animal in [
        "Apatosaurus.glb",
        "Bull.glb",
        "Fox.glb",
        "Stag.glb",
        "Triceratops.glb",
        "Trex.glb",
    ] {
        let Some(won) = won(animal, 5) else { return };
        println!("{animal}: {won} of 5");
        assert!(won >= 3, "{animal}: {won} of 5");
    }
}
