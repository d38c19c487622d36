use std::io::Write;

use clamber::climber::ClimberMode;
use clamber_scenes::battle::{Battle, Check, TICK, Watch};
use clamber_scenes::measure::quantile;
use serde_json::json;

use crate::Failure;

/// What the table shows, summed over all ticks of a battle.
#[derive(Default)]
pub(crate) struct Sums {
    /// Shares of the creature's vertices that were skinned for the climber.
    skinned: f64,
    /// Rocks with skin near them.
    near: u64,
    /// Rocks that were put back in front of the skin.
    put_back: u32,
}

impl Sums {
    /// Adds a battle's last tick.
    pub(crate) fn add(&mut self, battle: &Battle<'_>) {
        self.skinned += skinned_share(battle);
        self.near += u64::from(battle.rocks.report.near);
        self.put_back += battle.rocks.report.put_back;
    }
}

/// The share of the creature's vertices that were skinned for the climber in the last tick.
pub(crate) fn skinned_share(battle: &Battle<'_>) -> f64 {
    let skinned = &battle.skinned;
    skinned.vertices_skinned as f64 / skinned.vertices.max(1) as f64
}

/// The results of a battle as a table.
pub(crate) fn table(battle: &Battle<'_>, watch: &Watch, sums: &Sums, checks: &[Check]) -> String {
    let (mesh, counts, rocks) = (battle.surface().mesh(), &battle.counts, &battle.rocks);
    let time_us = |part: usize, share: f64| {
        let mut times: Vec<f64> = battle.times.iter().map(|times| times[part]).collect();
        quantile(&mut times, share)
    };
    let ticks = counts.tick as f64;
    let modes = ClimberMode::ALL.iter().zip(watch.modes);
    let modes: Vec<String> = modes
        .map(|(mode, ticks)| format!("{mode:?} {ticks}"))
        .collect();
    let mut table = format!(
        "{}: {:.0} m, {} joints, {} vertices, {} triangles
  ticks                       {ticks} ({:.1} s), {:.1} % riding
  ticks by mode               {}
  drops, landings             {}, {}\n",
        battle.creature.name,
        battle.height,
        mesh.joint_count(),
        mesh.positions().len(),
        mesh.triangles().len(),
        ticks * TICK,
        watch.riding_share() * 100.0,
        modes.join(", "),
        counts.drops,
        counts.landings,
    );
    if let Some((_, _, arrived)) = battle.bot() {
        let after = |seconds: Option<f64>| {
            seconds.map_or("never".into(), |seconds| format!("after {seconds:.1} s"))
        };
        table += &format!(
            "  blows, deaths               {}, {}
  arrows, hits                {}, {}
  stabs, broken off           {}, {}; damage {:.2}
  weak points, plates         {}, {}
  killed the creature         {}
  at the top                  {}\n",
            counts.blows,
            counts.deaths,
            counts.arrows,
            counts.arrow_hits,
            counts.stabs,
            counts.broken_off,
            counts.damage,
            counts.weak_points,
            counts.plates,
            after((counts.killed > 0).then_some(counts.killed as f64 * TICK)),
            after(arrived),
        );
    }
    table += &format!(
        "  vertices skinned per tick   {:.1} %
  tick, median and p99        {:.0} us, {:.0} us
  rocks, drops, near the skin {}, {}, {:.1}; {} left the valley
  rocks with physics, median  {:.0} us, {} put back
  hash                        {:016x}\n",
        sums.skinned / ticks * 100.0,
        time_us(0, 0.5),
        time_us(0, 0.99),
        rocks.bodies().len(),
        rocks.drops,
        sums.near as f64 / ticks,
        rocks.left,
        time_us(1, 0.5),
        sums.put_back,
        battle.hash(),
    );
    checks
        .iter()
        .fold(table, |table, check| format!("{table}{check}\n"))
}

/// Writes the results of a battle as JSON.
pub(crate) fn write(
    battle: &Battle<'_>,
    checks: &[Check],
    mut out: impl Write,
) -> Result<(), Failure> {
    let summary = json!({
        "creature": battle.creature.name,
        "hash": format!("{:016x}", battle.hash()),
        "counts": battle.counts,
        "checks": checks,
    });
    writeln!(out, "{summary:#}")?;
    Ok(out.flush()?)
}
