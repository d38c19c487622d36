//! The battle is a fight to the death that passes its own checks.

use clamber_scenes::battle::{Battle, BattleOptions, Story, Summary, run};
use clamber_scenes::giant::giant;

#[test]
fn the_giant_dies_of_three_weak_points_and_the_climber_goes_through_all_modes() {
    let folder = std::env::temp_dir().join(format!("clamber-climb-{}", std::process::id()));
    let options = BattleOptions {
        out: folder.clone(),
        ..BattleOptions::default()
    };
    assert_eq!(options.story(), Story::Climb);
    let summary = run(&options).unwrap();
    println!("{summary}");
    assert!(summary.holds(), "{summary}");
    assert!(summary.modes.iter().all(|mode| mode.ticks > 0), "{summary}");
    let tally = &summary.tally;
    assert_eq!(
        (tally.arrows, tally.weak_points, tally.plates),
        (2, 3, 1),
        "{summary}"
    );
    assert!(
        tally.stabs >= 9 && tally.damage >= 6.9 && tally.killed > 0,
        "{summary}"
    );
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Seeds of the shorter fights.
const SEEDS: [u64; 6] = [2, 3, 4, 5, 6, 7];

/// Even if a climber does not win, it is never inside the giant, and never far from its hold.
#[test]
fn fights_with_other_seeds_pass_all_checks() {
    let creature = giant().unwrap();
    let mut wounded = 0;
    for seed in SEEDS {
        let options = BattleOptions {
            seed,
            rocks: 0,
            seconds: Some(120.0),
            ..BattleOptions::default()
        };
        let mut battle = Battle::new(&creature, &options).unwrap();
        for tick in 0..options.ticks() {
            battle.step(options.input_at(tick)).unwrap();
        }
        let summary = Summary::new(&battle, &options);
        println!("seed {seed}: {:?}", summary.tally);
        // A climber may be shaken off and not reach a weak point in time; that is not a failure.
        assert!(summary.holds(), "seed {seed}: {summary}");
        assert_eq!(summary.tally.arrows, 2, "seed {seed}");
        wounded += usize::from(summary.tally.damage >= 1.0);
    }
    assert!(wounded > 1, "{wounded} have wounded the giant");
}
