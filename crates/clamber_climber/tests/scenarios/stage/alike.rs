//! Whether a scenario gave the same in two settings.

use glam::DVec3;

use super::setting::setting;
use super::{Played, Trace};

/// How far runs may lead apart.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    /// Metres.
    pub(crate) position: f64,
    /// Of each coordinate, metres a second.
    pub(crate) velocity: f64,
}

/// The step from one f32 to the next, at a length.
fn ulp(length: f64) -> f64 {
    let length = length as f32;
    f64::from(length.next_up() - length)
}

impl Allowed {
    /// Between a frame that moves and one at rest.
    ///
    /// - Own obstacles have no f32: only f64 rounds, and what sweeps leave of a gap. Far from the world's origin, ten steps
    ///   of f64 over a tick are the velocity: thousands of kilometres out they are a micrometre a second.
    /// - Skin has a root in f64. Its corners of a tick ago are seen from where the root is now, so f32 holds how far it
    ///   reaches and how far its root went: two steps of that, in each tick, are the velocity.
    /// - Bodies have places in f32: each tick rounds each place once, and a climber that is carried, or finds new
    ///   ground, is rounded with it. A velocity is the difference of a body's two places over a tick, and of the points
    ///   on it that were touched: six steps of f32.
    pub(crate) fn in_frame(trace: &Trace) -> Self {
        let reach = trace.reach;
        match trace.played {
            Played::Own => Self {
                position: 1e-6,
                velocity: 1e-6 + 10.0 * (reach.far.next_up() - reach.far) / trace.dt,
            },
            Played::Root | Played::Joint => Self {
                position: 3e-4,
                velocity: 2.0 * ulp(reach.extent + reach.step) / trace.dt,
            },
            Played::Body => {
                let ticks = trace.positions.len() as f64;
                Self {
                    position: ulp(reach.place) * (ticks + 2.0),
                    velocity: 6.0 * ulp(reach.place) / trace.dt,
                }
            }
        }
    }
}

/// What a scenario's demand is wider by in the setting of this thread, metres: on bodies in a moving frame, whose places
/// f32 rounds by a tenth of a millimetre after half a minute at 30 m/s; on skin in one, whose corners of a tick ago f32
/// rounds by some tenths of a micrometre at half a metre a tick. Everywhere else a demand is as it is written.
pub(super) fn slack() -> f64 {
    let setting = setting();
    let is_on = |kind| setting.kinds.contains(&kind);
    if setting.frame == DVec3::ZERO {
        0.0
    } else if is_on(Played::Body) {
        1e-3
    } else if is_on(Played::Root) {
        1e-6
    } else {
        0.0
    }
}

/// Runs of a scenario at rest and in another setting: one after the other the same, in place, velocity, mode and events.
/// Modes and events may be a tick early or late; velocities then are not compared.
pub(crate) fn assert_alike(
    rest: &[Trace],
    other: &[Trace],
    allowed: impl Fn(&Trace) -> Allowed,
) -> Result<(), String> {
    if rest.len() != other.len() {
        return Err(format!("{} runs, at rest {}", other.len(), rest.len()));
    }
    for (run, (rest, other)) in rest.iter().zip(other).enumerate() {
        let allowed = allowed(other);
        compare(rest, other, &allowed).map_err(|why| format!("run {run}: {why}"))?;
    }
    Ok(())
}

fn compare(rest: &Trace, other: &Trace, allowed: &Allowed) -> Result<(), String> {
    let (many, few) = (rest.positions.len(), other.positions.len());
    if many.abs_diff(few) > 1 {
        return Err(format!("{few} ticks, at rest {many}"));
    }
    let count = many.min(few);
    let near = |tick: usize| tick.saturating_sub(1)..(tick + 2).min(count);
    let (mut farthest, mut fastest) = ((0.0, 0), (0.0, 0));
    let mut strange = None;
    for tick in 0..count {
        let apart = rest.positions[tick].distance(other.positions[tick]);
        if !apart.is_finite() {
            return Err(format!("{} at tick {tick}", other.positions[tick]));
        }
        if apart > farthest.0 {
            farthest = (apart, tick);
        }
        if rest.modes[tick] != other.modes[tick] {
            let known = rest.modes[near(tick)].contains(&other.modes[tick]);
            let told = other.modes[near(tick)].contains(&rest.modes[tick]);
            if !(known && told) {
                strange = strange.or(Some(tick));
            }
            continue;
        }
        let apart = rest.velocities[tick] - other.velocities[tick];
        let apart = apart.abs().max_element();
        if apart > fastest.0 {
            fastest = (apart, tick);
        }
    }
    let place = format!("{:.1e} m apart at tick {}", farthest.0, farthest.1);
    if let Some(tick) = strange {
        let (mode, known) = (other.modes[tick], rest.modes[tick]);
        return Err(format!(
            "{mode:?}, at rest {known:?} at tick {tick}, {place}"
        ));
    }
    if farthest.0 > allowed.position {
        return Err(format!("{place}, allowed {:.1e}", allowed.position));
    }
    if fastest.0 > allowed.velocity {
        let (apart, tick) = fastest;
        let most = allowed.velocity;
        return Err(format!(
            "{apart:.1e} m/s apart at tick {tick}, allowed {most:.1e}, {place}"
        ));
    }
    same_events(rest, other)
}

/// The same kinds in the same order, each at most a tick early or late.
fn same_events(rest: &Trace, other: &Trace) -> Result<(), String> {
    let (many, few) = (rest.events.len(), other.events.len());
    // What happens in the last tick of the one may be about to happen in the other.
    if many.abs_diff(few) > 1 {
        return Err(format!("{few} events, at rest {many}"));
    }
    let pairs = rest.events.iter().zip(&other.events);
    let ticks = rest.event_ticks.iter().zip(&other.event_ticks);
    for ((known, event), (then, tick)) in pairs.zip(ticks) {
        let same = core::mem::discriminant(known) == core::mem::discriminant(event);
        if !same || then.abs_diff(*tick) > 1 {
            return Err(format!(
                "{event:?} at tick {tick}, at rest {known:?} at {then}"
            ));
        }
    }
    Ok(())
}
