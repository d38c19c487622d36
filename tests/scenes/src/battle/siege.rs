//! Many fights, one for each seed.

use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use super::{Battle, BattleError, BattleOptions, TICK, Tally};
use crate::Creature;

/// How a fight went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fight {
    /// Its seed.
    pub seed: u64,
    /// What was shot, struck and killed.
    pub tally: Tally,
    /// When the climber first came to the highest weak point, seconds.
    pub arrived: Option<f64>,
    /// How often it died.
    pub deaths: u32,
    /// How often it fell from the creature to the ground.
    pub falls: u32,
    /// Shares of its time on the ground, holding or standing on the creature, hanging from it.
    pub shares: [f64; 3],
    /// [`Recording::hash`](super::Recording::hash).
    pub hash: u64,
}

impl fmt::Display for Fight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = |seconds: Option<f64>| match seconds {
            Some(seconds) => format!("{seconds:6.1}"),
            None => "     -".to_owned(),
        };
        let killed = (self.tally.killed > 0).then_some(self.tally.killed as f64 * TICK);
        let [ground, on, hangs] = self.shares.map(|share| 100.0 * share);
        write!(
            f,
            "{:6}  {}  {}  {:5}  {:3}  {:5.1}  {:3}  {:5}  {:6}  {:6.0} {:4.0} {:4.0}  {:016x}",
            self.seed,
            time(self.arrived),
            time(killed),
            self.tally.plates,
            self.tally.weak_points,
            self.tally.damage,
            self.falls,
            self.tally.blows,
            self.deaths,
            ground,
            on,
            hangs,
            self.hash
        )
    }
}

/// The heading of a table of fights.
pub const HEADING: &str =
    "  seed  at top  killed  plate  weak damage falls blows  deaths  ground   on hang %  hash";

/// Fights battles of several seeds, the one of the options and the next ones, on all cores. Calls `watch` after each
/// with the number of fights done.
///
/// # Errors
/// The first [`BattleError`] of a fight.
pub fn fight_all(
    options: &BattleOptions,
    count: u64,
    watch: impl Fn(u64) + Sync,
) -> Result<Vec<Fight>, BattleError> {
    let creature = options.load_creature()?;
    let next = AtomicU64::new(0);
    let done = Mutex::new((Vec::new(), 0));
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    std::thread::scope(|scope| {
        for _ in 0..cores {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    if index >= count {
                        return;
                    }
                    let options = BattleOptions {
                        seed: options.seed.wrapping_add(index),
                        ..options.clone()
                    };
                    let fight = fight(&creature, &options);
                    if let Ok(mut done) = done.lock() {
                        done.0.push((index, fight));
                        done.1 += 1;
                        watch(done.1);
                    }
                }
            });
        }
    });
    let (mut fights, _) = done.into_inner().unwrap_or_default();
    fights.sort_by_key(|(index, _)| *index);
    fights.into_iter().map(|(_, fight)| fight).collect()
}

fn fight(creature: &Creature, options: &BattleOptions) -> Result<Fight, BattleError> {
    let mut battle = Battle::new(creature, options)?;
    let (mut falls, mut was_on) = (0, false);
    let mut ticks = [0u64; 3];
    for tick in 0..options.ticks() {
        battle.step(options.input_at(tick))?;
        let Some(sample) = battle.recording().samples().last() else {
            continue;
        };
        let hangs = sample.mode == clamber_climber::ClimberMode::Hanging;
        let on = sample.riding || hangs;
        ticks[if hangs { 2 } else { usize::from(on) }] += 1;
        let state = battle.climber().state();
        let ground = state
            .support
            .is_some_and(|support| support.attachment.obstacle == super::TERRAIN);
        falls += u32::from(was_on && ground);
        was_on = if ground { false } else { was_on || on };
        if battle.tally().killed > 0 {
            break;
        }
    }
    let all: u64 = ticks.iter().sum();
    Ok(Fight {
        seed: options.seed,
        tally: *battle.tally(),
        arrived: battle.arrived(),
        deaths: battle.deaths(),
        falls,
        shares: ticks.map(|ticks| ticks as f64 / all.max(1) as f64),
        hash: battle.recording().hash(),
    })
}
