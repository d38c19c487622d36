//! Whole battles, with a check in every tick that all numbers are finite.

use clamber_scenes::Creature;
use clamber_scenes::battle::{Battle, BattleOptions, Story, Watch};

/// Length of a battle, seconds.
const SECONDS: f64 = 15.0;

/// Runs a battle; returns the number of checks. Panics if a check fails, a number is not finite, or the battle ends
/// with an error.
pub(crate) fn fight(giant: &Creature, seed: u64) -> usize {
    // Half of the battles are climbs, half are rides.
    let story = if seed.is_multiple_of(2) {
        Story::Climb
    } else {
        Story::Ride
    };
    let options = BattleOptions {
        story: Some(story),
        seconds: Some(SECONDS),
        ..BattleOptions::ride(24, seed)
    };
    let mut battle = match Battle::new(giant, &options) {
        Ok(battle) => battle,
        Err(error) => panic!("the battle cannot be made: {error}"),
    };
    let mut watch = Watch::default();
    for tick in 0..options.ticks() {
        if let Err(error) = battle.step(options.input_at(tick)) {
            panic!("tick {tick}: {error}");
        }
        watch.tick(&battle);
        let state = battle.climber().state();
        let support = state.support.map(|support| support.attachment.point);
        let finite = state.position.is_finite()
            && state.velocity.is_finite()
            && support.is_none_or(|contact| contact.is_finite());
        assert!(finite, "tick {tick}: {state:?}");
        let push_out = battle.report().pushed_out;
        assert!(push_out.is_finite(), "tick {tick}: {push_out}");
        for (_, body) in battle.world.bodies.iter() {
            let at = body.translation();
            assert!(at.is_finite(), "tick {tick}: a rock is at {at}");
        }
    }
    let checks = watch.checks(&battle, &options);
    for check in &checks {
        assert!(check.holds(), "{check}");
    }
    watch.ticks() * 3 + checks.len()
}
