//! Many fights, one for each seed, on all cores.

use std::sync::atomic::{AtomicU64, Ordering};

use clamber_scenes::Creature;
use clamber_scenes::battle::{Battle, BattleError, BattleOptions, TICK};

use crate::Failure;

/// The heading of the table of fights.
const HEADING: &str = "  seed  at top  killed  plate  weak damage blows  deaths  hash";

/// How a fight went.
struct Fight {
    /// Its line in the table.
    line: String,
    /// The climber came to the highest weak point.
    arrived: bool,
    /// When the creature was killed, seconds.
    killed: Option<f64>,
}

/// Fights battles of several seeds, the one of the options and the next ones, and prints the result of each.
pub(crate) fn fight_all(options: &BattleOptions, count: u64) -> Result<bool, Failure> {
    let creature = options.load_creature()?;
    let bar = indicatif::ProgressBar::new(count);
    let next = AtomicU64::new(0);
    let work = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return done;
            }
            let seed = options.seed.wrapping_add(index);
            let fight = fight(
                &creature,
                &BattleOptions {
                    seed,
                    ..options.clone()
                },
            );
            done.push((index, fight));
            bar.inc(1);
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let mut fights = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().map(|thread| thread.join());
        let done = joined.map(|done| done.unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        done.flatten().collect::<Vec<_>>()
    });
    bar.finish_and_clear();
    fights.sort_by_key(|(index, _)| *index);
    let fights: Vec<Fight> = fights
        .into_iter()
        .map(|(_, fight)| fight)
        .collect::<Result<_, _>>()?;
    println!("{HEADING}");
    for fight in &fights {
        println!("{}", fight.line);
    }
    let killed: Vec<f64> = fights.iter().filter_map(|fight| fight.killed).collect();
    println!(
        "of {} fights: {} came to the highest weak point, {} killed the creature, after {:.1} s on average",
        fights.len(),
        fights.iter().filter(|fight| fight.arrived).count(),
        killed.len(),
        killed.iter().sum::<f64>() / killed.len().max(1) as f64,
    );
    Ok(true)
}

fn fight(creature: &Creature, options: &BattleOptions) -> Result<Fight, BattleError> {
    let mut battle = Battle::new(creature, options)?;
    let mut ticks = 0..options.ticks();
    while battle.counts().killed == 0
        && let Some(tick) = ticks.next()
    {
        battle.step(options.input_at(tick))?;
    }
    let counts = *battle.counts();
    let time = |seconds: Option<f64>| {
        seconds.map_or("     -".to_owned(), |seconds| format!("{seconds:6.1}"))
    };
    let arrived = battle.bot().and_then(|(_, _, arrived)| arrived);
    let killed = (counts.killed > 0).then_some(counts.killed as f64 * TICK);
    let line = format!(
        "{:6}  {}  {}  {:5}  {:3}  {:5.1}  {:5}  {:6}  {:016x}",
        options.seed,
        time(arrived),
        time(killed),
        counts.plates,
        counts.weak_points,
        counts.damage,
        counts.blows,
        counts.deaths,
        battle.hash()
    );
    Ok(Fight {
        line,
        arrived: arrived.is_some(),
        killed,
    })
}
