//! The battle's climb from the ground to the head passes its own checks.

use clamber::climber::ClimberMode;
use clamber_scenes::battle::{Battle, BattleOptions, CREATURE, Story, Summary, run};
use clamber_scenes::giant::giant;

#[test]
fn the_climb_goes_from_the_ground_to_the_head_through_all_modes() {
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
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Seeds of the other climbs.
const SEEDS: [u64; 6] = [2, 3, 4, 5, 6, 7];

/// Even if a climber does not arrive, it is never inside the giant, and never far from its hold.
#[test]
fn climbs_with_other_seeds_pass_all_checks() {
    let creature = giant().unwrap();
    let mut arrived = 0;
    for seed in SEEDS {
        let options = BattleOptions {
            seed,
            rocks: 0,
            ..BattleOptions::default()
        };
        let mut battle = Battle::new(&creature, &options).unwrap();
        let mut on_head = false;
        for tick in 0..options.ticks() {
            battle.step(options.input_at(tick)).unwrap();
            let state = battle.climber().state();
            let on_creature = state
                .support
                .is_some_and(|s| s.attachment.obstacle == CREATURE);
            let stands = state.mode == ClimberMode::Standing;
            on_head |= battle.arrived().is_some() && on_creature && stands;
        }
        let summary = Summary::new(&battle, &options);
        println!(
            "seed {seed}: top after {:?} s, stood there: {on_head}",
            summary.arrived_s
        );
        // A climber may be shaken off and not arrive in time: that is no fault.
        assert!(summary.holds(), "seed {seed}: {summary}");
        arrived += usize::from(on_head);
    }
    assert!(arrived > 0, "nobody stood on the head");
}
