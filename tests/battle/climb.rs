//! The battle is a fight to the death that passes its own checks.

use clamber_scenes::battle::{BattleOptions, Story};
use clamber_scenes::giant::giant;

use crate::{failed, fight};

#[test]
fn the_giant_dies_of_three_weak_points_and_the_climber_goes_through_all_modes() {
    let options = BattleOptions::default();
    assert_eq!(options.story(), Story::Climb);
    let creature = giant().unwrap();
    let (battle, watch) = fight(&creature, &options);
    let counts = &battle.counts;
    println!("{counts:?}, modes {:?}", watch.modes);
    assert_eq!(failed(&battle, &watch, &options), "");
    assert!(
        watch.modes.iter().all(|ticks| *ticks > 0),
        "{:?}",
        watch.modes
    );
    assert_eq!(
        (counts.arrows, counts.weak_points, counts.plates),
        (2, 3, 1),
        "{counts:?}"
    );
    assert!(
        counts.stabs >= 9 && counts.damage >= 6.9 && counts.killed > 0,
        "{counts:?}"
    );
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
        let (battle, watch) = fight(&creature, &options);
        println!("seed {seed}: {:?}", battle.counts);
        // A climber may be shaken off and not reach a weak point in time; that is not a failure.
        assert_eq!(failed(&battle, &watch, &options), "", "seed {seed}");
        assert_eq!(battle.counts.arrows, 2, "seed {seed}");
        wounded += usize::from(battle.counts.damage >= 1.0);
    }
    assert!(wounded > 1, "{wounded} have wounded the giant");
}
