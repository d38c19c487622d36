use std::path::Path;

use clamber::climber::ClimberMode;
use clamber_scenes::battle::{Battle, Check, TICK, Watch};
use clamber_scenes::measure::quantile;
use serde_json::json;

use crate::Failure;

/// The results of a battle as a table.
pub(crate) fn table(battle: &Battle<'_>, watch: &Watch, checks: &[Check]) -> String {
    let (mesh, counts, rocks) = (battle.surface().mesh(), battle.counts(), battle.rocks());
    let time_us = |part: usize, share: f64| {
        let mut times: Vec<f64> = battle.times().iter().map(|times| times[part]).collect();
        quantile(&mut times, share)
    };
    let after = |seconds: Option<f64>| {
        seconds.map_or("never".into(), |seconds| format!("after {seconds:.1} s"))
    };
    let ticks = counts.tick as f64;
    let modes = ClimberMode::ALL.iter().zip(watch.modes);
    let modes = modes.filter(|(_, ticks)| *ticks > 0);
    let modes: Vec<String> = modes
        .map(|(mode, ticks)| format!("{mode:?} {ticks}"))
        .collect();
    let mut rows = vec![
        ("ticks", format!("{ticks} ({:.1} s)", ticks * TICK)),
        (
            "riding",
            format!("{:.1} % of them", watch.riding_share() * 100.0),
        ),
        (
            "drops, landings",
            format!("{}, {}", counts.drops, counts.landings),
        ),
        ("ticks by mode", modes.join(", ")),
    ];
    if let Some((_, _, arrived)) = battle.bot() {
        let killed = (counts.killed > 0).then_some(counts.killed as f64 * TICK);
        let (stabs, damage) = (counts.stabs, counts.damage);
        rows.extend([
            (
                "blows, deaths",
                format!("{}, {}", counts.blows, counts.deaths),
            ),
            (
                "arrows, hits",
                format!("{}, {}", counts.arrows, counts.arrow_hits),
            ),
            (
                "stabs, broken off",
                format!("{stabs}, {}; damage {damage:.2}", counts.broken_off),
            ),
            (
                "weak points, plates",
                format!("{}, {}", counts.weak_points, counts.plates),
            ),
            ("killed the creature", after(killed)),
            ("at the top", after(arrived)),
        ]);
    }
    let near = rocks.near as f64 / ticks.max(1.0);
    let (count, drops, left) = (rocks.bodies().len(), rocks.drops, rocks.left);
    let put_back = rocks.put_back;
    rows.extend([
        (
            "vertices skinned per tick",
            format!("{:.1} %", watch.skinned_share() * 100.0),
        ),
        (
            "tick, median and p99",
            format!("{:.0} us, {:.0} us", time_us(0, 0.5), time_us(0, 0.99)),
        ),
        (
            "rocks, drops, near the skin",
            format!("{count}, {drops}, {near:.1}; {left} left the valley"),
        ),
        (
            "rocks with physics, median",
            format!("{:.0} us, {put_back} put back", time_us(1, 0.5)),
        ),
        ("hash", format!("{:016x}", battle.hash())),
    ]);
    let head = format!(
        "{}: {:.0} m, {} joints, {} vertices, {} triangles\n",
        battle.creature().name,
        battle.height(),
        mesh.joint_count(),
        mesh.positions().len(),
        mesh.triangles().len()
    );
    let rows = rows
        .iter()
        .map(|(name, value)| format!("  {name:<28}{value}\n"));
    let checks = checks.iter().map(|check| format!("{check}\n"));
    std::iter::once(head).chain(rows).chain(checks).collect()
}

/// Writes `summary.json` into a folder.
pub(crate) fn write(
    battle: &Battle<'_>,
    watch: &Watch,
    checks: &[Check],
    folder: &Path,
) -> Result<(), Failure> {
    let summary = json!({
        "creature": battle.creature().name,
        "height_m": battle.height(),
        "seconds": battle.tick() as f64 * TICK,
        "hash": format!("{:016x}", battle.hash()),
        "counts": battle.counts(),
        "riding_share": watch.riding_share(),
        "vertices_skinned_share": watch.skinned_share(),
        "checks": checks,
    });
    let path = folder.join("summary.json");
    let failed = |error| format!("cannot write {}: {error}", path.display());
    std::fs::write(&path, format!("{summary:#}\n")).map_err(failed)?;
    Ok(())
}
