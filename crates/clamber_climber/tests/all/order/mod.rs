//! Climbers among creatures and each other have the same bits for any order in which obstacles are listed, creatures
//! are posed and climbers are stepped, and on any threads.

mod herd;

use clamber_climber::{ClimberEvent, ClimberMode, StepReport};

use herd::{CLIMBERS, CREATURES, Herd, Order};

/// Length of the run, ticks.
const TICKS: u32 = 900;

/// The fingerprint and report of every climber, tick by tick.
type Told = Vec<Vec<(u64, StepReport)>>;

fn play(order: &mut Order) -> Told {
    let mut herd = Herd::new();
    (0..TICKS).map(|tick| herd.tick(tick, order)).collect()
}

fn assert_same(found: &Told, expected: &Told, told: &str) {
    for (tick, (found, expected)) in found.iter().zip(expected).enumerate() {
        for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
            assert_eq!(found, expected, "{told}: climber {index} at tick {tick}");
        }
    }
}

#[test]
fn a_herd_has_the_same_bits_in_every_order() {
    let expected = play(&mut Order::Listed);
    for seed in 0..6 {
        let mut order = Order::Shuffled(fastrand::Rng::with_seed(seed));
        assert_same(&play(&mut order), &expected, &format!("seed {seed}"));
    }
}

#[test]
fn a_herd_has_the_same_bits_on_any_threads() {
    let expected = play(&mut Order::Listed);
    for threads in [2, 3, 6] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let found = pool.build().unwrap().install(|| {
            let mut herd = Herd::new();
            let mut rng = fastrand::Rng::with_seed(threads as u64);
            let ticks = 0..TICKS;
            ticks
                .map(|tick| herd.tick_on_threads(tick, &mut rng))
                .collect()
        });
        assert_same(&found, &expected, &format!("{threads} threads"));
    }
}

/// Otherwise equal bits would prove little.
#[test]
fn the_herd_touches_all_creatures_and_each_other() {
    let mut herd = Herd::new();
    let mut stood_on = [0; CREATURES];
    let mut modes = Vec::new();
    let mut events = 0;
    for tick in 0..TICKS {
        for (_, report) in herd.tick(tick, &mut Order::Listed) {
            let changed = |event: &&ClimberEvent| matches!(event, ClimberEvent::Changed { .. });
            events += report.events.iter().filter(changed).count();
        }
        for climber in &herd.climbers {
            let state = climber.state();
            modes.push(state.mode);
            let support = state
                .support
                .map_or(0, |support| support.attachment.obstacle.0);
            if let Some(count) = stood_on.get_mut((support as usize).wrapping_sub(1)) {
                *count += 1;
            }
        }
    }
    println!(
        "on {stood_on:?}, {events} changes, {} touches",
        herd.touches
    );
    assert!(stood_on.iter().all(|ticks| *ticks > 50), "{stood_on:?}");
    for mode in [
        ClimberMode::Standing,
        ClimberMode::Holding,
        ClimberMode::Falling,
    ] {
        let count = modes.iter().filter(|other| **other == mode).count();
        assert!(count > 50, "{mode:?}: {count}");
    }
    assert!(events > 40, "{events}");
    assert!(herd.touches > 50, "{}", herd.touches);
    assert_eq!(herd.climbers.len(), CLIMBERS);
    // Without the other climbers' bodies the run differs.
    let mut alone = Herd::new();
    alone.bodies_are_there = false;
    (0..TICKS).for_each(|tick| drop(alone.tick(tick, &mut Order::Listed)));
    let apart =
        |(a, b): (&clamber_climber::Climber, &clamber_climber::Climber)| a.state() != b.state();
    let differ = herd
        .climbers
        .iter()
        .zip(&alone.climbers)
        .filter(|pair| apart(*pair))
        .count();
    assert!(differ > CLIMBERS / 2, "{differ}");
}
