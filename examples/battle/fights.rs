//! Many fights, one for each seed, on all cores.

use clamber_scenes::Creature;
use clamber_scenes::battle::{Battle, BattleOptions, Counts, TICK};

use crate::Failure;

/// Fights battles of several seeds, the one of the options and the next ones, and prints the result of each.
pub(crate) fn fight_all(options: &BattleOptions, count: u64) -> Result<bool, Failure> {
    let creature = options.load_creature()?;
    let seeds: Vec<u64> = (0..count)
        .map(|index| options.seed.wrapping_add(index))
        .collect();
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let (mut arrived, mut killed) = (0, Vec::new());
    println!("  seed  at top  killed  plate  weak damage blows  deaths  hash");
    for seeds in seeds.chunks(cores) {
        let fights: Vec<_> = std::thread::scope(|scope| {
            let start = |seed: &u64| {
                let (mut options, creature) = (options.clone(), &creature);
                options.seed = *seed;
                scope.spawn(move || fight(creature, &options).map_err(|error| error.to_string()))
            };
            let threads: Vec<_> = seeds.iter().map(start).collect();
            threads.into_iter().map(|thread| thread.join()).collect()
        });
        for (seed, fight) in seeds.iter().zip(fights) {
            let fight = fight.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
            let (counts, top, hash) = fight;
            let time =
                |seconds: Option<f64>| seconds.map_or("-".to_owned(), |time| format!("{time:.1}"));
            let end = (counts.killed > 0).then_some(counts.killed as f64 * TICK);
            println!(
                "{seed:6}  {:>6}  {:>6}  {:5}  {:3}  {:5.1}  {:5}  {:6}  {hash:016x}",
                time(top),
                time(end),
                counts.plates,
                counts.weak_points,
                counts.damage,
                counts.blows,
                counts.deaths,
            );
            arrived += u32::from(top.is_some());
            killed.extend(end);
        }
    }
    println!(
        "of {count} fights: {arrived} came to the highest weak point, {} killed the creature, after {:.1} s on average",
        killed.len(),
        killed.iter().sum::<f64>() / killed.len().max(1) as f64,
    );
    Ok(true)
}

/// Fights until the creature is dead, or the time is over. Returns the counts, the time at which the climber first came
/// to the highest weak point, seconds, and the hash.
fn fight(
    creature: &Creature,
    options: &BattleOptions,
) -> Result<(Counts, Option<f64>, u64), Failure> {
    let mut battle = Battle::new(creature, options)?;
    let mut ticks = 0..options.ticks();
    while battle.counts.killed == 0
        && let Some(tick) = ticks.next()
    {
        battle.step(options.input_at(tick))?;
    }
    let top = battle.bot().and_then(|(_, _, arrived)| arrived);
    Ok((battle.counts, top, battle.hash()))
}
