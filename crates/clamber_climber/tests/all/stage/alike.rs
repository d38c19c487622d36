//! Compares the runs of a scenario in two settings.

use glam::DVec3;

use super::setting::setting;
use super::{Played, Trace};

/// Largest allowed difference between two runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Allowed {
    /// Largest distance of positions, metres.
    pub(crate) position: f64,
    /// Largest difference of each velocity component, metres a second.
    pub(crate) velocity: f64,
}

/// The spacing of f32 at a length.
fn ulp(length: f64) -> f64 {
    let length = length as f32;
    f64::from(length.next_up() - length)
}

impl Allowed {
    /// The allowed difference between a moving frame and one at rest.
    ///
    /// - Own obstacles have no f32. Only f64 rounding and the gaps that sweeps leave matter. Velocities may differ by
    ///   ten f64 steps of the position per tick: a micrometre a second some thousands of kilometres from the origin.
    /// - Skin has a root in f64. Its corners of a tick ago are relative to the current root, so that f32 has to hold
    ///   the skin's extent plus the root's displacement. Velocities may differ by two f32 steps of that per tick.
    /// - Bodies have positions in f32. Each tick rounds each position once, and with it a climber that is carried or
    ///   finds new ground. A velocity is the difference of a body's two positions over a tick, and of the touched
    ///   points on it: six f32 steps.
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

/// Length by which this thread's setting widens a scenario's limits, metres. On bodies in a moving frame, f32 rounds
/// positions by 0.1 mm after half a minute at 30 m/s. On skin in a moving frame, f32 rounds the corners of a tick ago
/// by some tenths of a micrometre at half a metre a tick. Zero in every other setting.
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

/// Compares the runs of a scenario at rest and in another setting, in order: positions, velocities, modes and events.
/// Modes and events may be a tick early or late; in a tick whose modes differ, velocities are not compared.
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

/// Compares events: the same kinds in the same order, each at most a tick early or late.
fn same_events(rest: &Trace, other: &Trace) -> Result<(), String> {
    let (many, few) = (rest.events.len(), other.events.len());
    // An event in the last tick of one run may come only after the end of the other.
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
