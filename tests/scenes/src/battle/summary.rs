use std::fmt;
use std::path::Path;

use clamber_climber::ClimberMode;
use serde::Serialize;

use super::checks::{
    DRIFT, FALLS, INSIDE, MAX_DRIFT, MAX_PUSH_OUT, MAX_PUSHED_OFF, MAX_STANDS_OFF, NOT_RIDING,
    OUT_OF_REACH, PUSH_OUT, PUSHED_OFF, ROCKS_INSIDE, STANDS_OFF,
};
use super::{Battle, BattleError, BattleOptions, Story, TICK, Tally};
use crate::json::number;
use crate::measure::quantile;

/// Largest share of a ride's ticks that the climber may spend off the creature: one in ten.
const MAX_OFF: f64 = 0.1;

/// Seconds in the air that the script of a ride needs for the drop and the jump. In a ride shorter than 20 s they are
/// more than `MAX_OFF`.
const SCRIPT_OFF: f64 = 2.0;

/// States that are printed in a line.
const STATES_A_LINE: usize = 7;

/// A requirement of a battle: a number with an upper bound.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// Name of the checked number, with its unit.
    pub name: &'static str,
    /// The number found.
    #[serde(serialize_with = "number")]
    pub found: f64,
    /// The largest allowed number.
    pub at_most: f64,
    /// True if `found` is at most `at_most`.
    pub holds: bool,
    /// Place and time of the first failure; `None` if the check holds.
    pub cause: Option<String>,
}

/// Number of ticks that a climber spent in a mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeTicks {
    /// Name of the mode.
    pub mode: String,
    /// Number of ticks that end in the mode.
    pub ticks: usize,
}

/// Number of ticks that a creature spent in a state of its brain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StateTicks {
    /// The state, with the names of those around it.
    pub state: String,
    /// How often it was entered.
    pub entered: usize,
    /// Number of ticks that end in it.
    pub ticks: usize,
}

/// The results of a battle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Name of the creature.
    pub creature: String,
    /// Number of the creature's joints.
    pub joints: usize,
    /// Number of the collider's vertices, after welding.
    pub vertices: usize,
    /// Number of the collider's triangles.
    pub triangles: usize,
    /// Height of the creature, metres.
    pub height_m: f64,
    /// Names of the clips that are not loops and are therefore played back and forth.
    pub turned_back: Vec<String>,
    /// Number of ticks.
    pub ticks: usize,
    /// Length of the battle, seconds.
    pub seconds: f64,
    /// [`Recording::hash`](super::Recording::hash) in hexadecimal, for comparing battles.
    pub hash: String,
    /// How often a rider was dropped on the creature: 1 if it never fell to the ground; 0 in a climb.
    pub drops: u32,
    /// How often the climber came to the ground or out of the valley. In a climb its start on the ground counts as
    /// well.
    pub falls: u32,
    /// Ticks at which the climber's centre was found inside the creature or below the ground.
    pub ticks_inside: u32,
    /// How often the climber landed on anything.
    pub landings: u32,
    /// How often the creature struck the climber.
    pub blows: u32,
    /// What was shot, struck and killed; nothing in a ride.
    pub tally: Tally,
    /// How often the climber died or was thrown out of the valley, and began again; 0 in a ride.
    pub deaths: u32,
    /// The states that the creature's brain was in; empty without a brain.
    pub states: Vec<StateTicks>,
    /// Number of ticks in each built-in mode of the climber.
    pub modes: Vec<ModeTicks>,
    /// When the climber first came to the creature's top, seconds; `None` if it has not, or in a ride.
    pub arrived_s: Option<f64>,
    /// The climber's lowest stamina, 0 to 1.
    pub least_stamina: f64,
    /// All stamina that it spent, where 1 is as much as it has.
    pub spent_stamina: f64,
    /// Share of the ticks spent on the creature.
    pub riding_share: f64,
    /// Largest drift of the climber from its material point, metres: see [`Sample::drift`](super::Sample::drift).
    pub max_anchor_drift_m: f64,
    /// Largest distance by which other skin pushed a rider's body off its material point while it stood without input,
    /// metres; `None` in a climb.
    pub max_pushed_off_m: Option<f64>,
    /// Largest gap between a rider's body and its material point with no skin in between, while it stood without input,
    /// metres; `None` in a climb.
    pub max_stands_off_m: Option<f64>,
    /// Longest push-out of a rider that stood without input, metres; `None` in a climb.
    pub max_push_out_m: Option<f64>,
    /// Largest depth of a rider's ball in the skin while it stood without input, metres; `None` in a climb.
    pub max_penetration_m: Option<f64>,
    /// Mean share of the creature's vertices that were skinned in a tick.
    pub vertices_skinned_share: f64,
    /// Number of rocks.
    pub rocks: usize,
    /// How often a rock was dropped, the first drop of each included.
    pub rock_drops: u32,
    /// How often a rock was found inside the creature, unless caught under a foot or in a fold, or below the ground.
    pub rocks_inside: u32,
    /// How often a rock was knocked out of the valley, and dropped again.
    pub rocks_left: u32,
    /// Mean number of rocks near the creature's skin in a tick.
    pub rocks_near: f64,
    /// Number of rocks that the physics let into the skin, and that were put back in front of it, over all ticks.
    pub rocks_put_back: u32,
    /// Median time of a tick for the rocks, physics included, microseconds.
    pub rocks_us_median: f64,
    /// Median time of a tick without the rocks, microseconds: pose, script, climber.
    pub tick_us_median: f64,
    /// 99th percentile of the time of a tick without the rocks, microseconds.
    pub tick_us_p99: f64,
    /// The checks of the battle's story.
    pub checks: Vec<Check>,
}

impl Summary {
    /// The summary of a battle so far. `options` are those that the battle was made with.
    pub fn new(battle: &Battle<'_>, options: &BattleOptions) -> Self {
        let recording = battle.recording();
        let mesh = battle.surface().mesh();
        let watch = battle.watch();
        let (rocks, report) = (battle.rocks(), battle.rocks().report());
        let check = |name: &'static str, found: f64, at_most: f64| Check {
            name,
            found,
            at_most,
            holds: found <= at_most,
            cause: watch
                .faults
                .first(name)
                .filter(|_| found > at_most)
                .map(str::to_owned),
        };
        let modes = ClimberMode::ALL.map(|mode| ModeTicks {
            mode: format!("{mode:?}"),
            ticks: recording.ticks_in(mode),
        });
        let never = modes.iter().filter(|mode| mode.ticks == 0).count();
        let mut checks = vec![
            check(DRIFT, recording.max_drift(), MAX_DRIFT),
            check(INSIDE, f64::from(watch.fell_through), 0.0),
            check(ROCKS_INSIDE, f64::from(report.fell_through), 0.0),
        ];
        let off = 1.0 - recording.riding_share();
        let far = f64::from(watch.out_of_reach);
        checks.push(check(OUT_OF_REACH, far, 0.0));
        let rides = options.story() == Story::Ride;
        if rides {
            let push_out = recording.max_push_out();
            checks.insert(1, check(PUSHED_OFF, watch.pushed_off, MAX_PUSHED_OFF));
            checks.insert(2, check(STANDS_OFF, watch.stands_off, MAX_STANDS_OFF));
            checks.insert(3, check(PUSH_OUT, push_out, MAX_PUSH_OUT));
            let at_most = MAX_OFF.max(SCRIPT_OFF / options.seconds());
            checks.push(check(NOT_RIDING, off, at_most));
            checks.push(check(FALLS, f64::from(watch.falls), 0.0));
        }
        // With other seeds, brains and creatures the climber may lose the fight, or never be knocked over.
        if !rides && options.is_default_fight() {
            let tally = battle.tally();
            let lives = if tally.killed == 0 { 1.0 } else { 0.0 };
            checks.push(check("creatures alive at the end", lives, 0.0));
            let points = battle
                .life()
                .map_or(0, |life| life.kind().weak_points().len());
            let whole = points.saturating_sub(tally.weak_points as usize);
            checks.push(check("weak points not used up", whole as f64, 0.0));
            checks.push(check("modes never seen", never as f64, 0.0));
        }
        Self {
            creature: battle.creature().name.clone(),
            joints: mesh.joint_count(),
            vertices: mesh.positions().len(),
            triangles: mesh.triangles().len(),
            height_m: options.height(),
            turned_back: battle.turned_back(),
            ticks: recording.samples().len(),
            seconds: recording.samples().last().map_or(0.0, |s| s.seconds),
            hash: format!("{:016x}", recording.hash()),
            drops: battle.drops(),
            falls: watch.falls,
            ticks_inside: watch.fell_through,
            landings: battle.landings(),
            blows: battle.blows(),
            tally: *battle.tally(),
            deaths: battle.deaths(),
            states: states(battle),
            modes: modes.to_vec(),
            arrived_s: battle.arrived(),
            least_stamina: recording.least_stamina(),
            spent_stamina: recording.spent_stamina(),
            riding_share: recording.riding_share(),
            max_anchor_drift_m: recording.max_drift(),
            max_pushed_off_m: rides.then_some(watch.pushed_off),
            max_stands_off_m: rides.then_some(watch.stands_off),
            max_push_out_m: rides.then(|| recording.max_push_out()),
            max_penetration_m: rides.then_some(watch.deepest),
            vertices_skinned_share: recording.skinned_share(),
            rocks: rocks.len(),
            rock_drops: report.drops,
            rocks_inside: report.fell_through,
            rocks_left: report.left,
            rocks_near: report.near as f64 / recording.samples().len().max(1) as f64,
            rocks_put_back: report.put_back,
            rocks_us_median: quantile(&mut rocks.times().to_vec(), 0.5),
            tick_us_median: recording.tick_us(0.5),
            tick_us_p99: recording.tick_us(0.99),
            checks,
        }
    }

    /// True if every check holds.
    pub fn holds(&self) -> bool {
        self.checks.iter().all(|check| check.holds)
    }

    /// Writes `summary.json` into an existing folder.
    pub(super) fn write(&self, folder: &Path) -> Result<(), BattleError> {
        let path = folder.join("summary.json");
        let failed = |reason: String| BattleError::Write {
            path: path.clone(),
            reason,
        };
        let json = serde_json::to_string_pretty(self).map_err(|e| failed(e.to_string()))?;
        std::fs::write(&path, json + "\n").map_err(|e| failed(e.to_string()))
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let row = |f: &mut fmt::Formatter<'_>, name: &str, value: String| {
            writeln!(f, "  {name:<28}{value}")
        };
        writeln!(
            f,
            "{}: {:.0} m, {} joints, {} vertices, {} triangles",
            self.creature, self.height_m, self.joints, self.vertices, self.triangles
        )?;
        row(
            f,
            "ticks",
            format!("{} ({:.1} s)", self.ticks, self.seconds),
        )?;
        row(
            f,
            "riding",
            format!("{:.1} % of them", self.riding_share * 100.0),
        )?;
        row(
            f,
            "drops, landings",
            format!("{}, {}", self.drops, self.landings),
        )?;
        let seen = self.modes.iter().filter(|mode| mode.ticks > 0);
        let seen: Vec<String> = seen
            .map(|mode| format!("{} {}", mode.mode, mode.ticks))
            .collect();
        row(f, "ticks by mode", seen.join(", "))?;
        if !self.turned_back.is_empty() {
            row(f, "clips back and forth", self.turned_back.join(", "))?;
        }
        if !self.states.is_empty() {
            let states = self.states.iter().map(|state| {
                let name = state.state.rsplit('/').next().unwrap_or_default();
                format!("{name} {}", state.entered)
            });
            let states: Vec<String> = states.collect();
            for (index, states) in states.chunks(STATES_A_LINE).enumerate() {
                let name = if index == 0 { "states, entered" } else { "" };
                row(f, name, states.join(", "))?;
            }
            row(
                f,
                "blows, deaths",
                format!("{}, {}", self.blows, self.deaths),
            )?;
            let Tally {
                arrows,
                arrow_hits,
                stabs,
                broken_off,
                damage,
                weak_points,
                plates,
                killed,
                ..
            } = self.tally;
            row(f, "arrows, hits", format!("{arrows}, {arrow_hits}"))?;
            row(
                f,
                "stabs, broken off",
                format!("{stabs}, {broken_off}; damage {damage:.2}"),
            )?;
            row(f, "weak points, plates", format!("{weak_points}, {plates}"))?;
            let killed = match killed {
                0 => "never".into(),
                ticks => format!("after {:.1} s", ticks as f64 * TICK),
            };
            row(f, "killed the creature", killed)?;
            row(
                f,
                "stamina, least and spent",
                format!("{:.2}, {:.2}", self.least_stamina, self.spent_stamina),
            )?;
        }
        if !self.states.is_empty() || self.arrived_s.is_some() {
            let arrived = self
                .arrived_s
                .map(|seconds| format!("after {seconds:.1} s"));
            row(f, "at the top", arrived.unwrap_or("never".into()))?;
        }
        row(
            f,
            "vertices skinned per tick",
            format!("{:.1} %", self.vertices_skinned_share * 100.0),
        )?;
        row(
            f,
            "tick, median and p99",
            format!("{:.0} us, {:.0} us", self.tick_us_median, self.tick_us_p99),
        )?;
        row(
            f,
            "rocks, drops, near the skin",
            format!(
                "{}, {}, {:.1}; {} left the valley",
                self.rocks, self.rock_drops, self.rocks_near, self.rocks_left
            ),
        )?;
        row(
            f,
            "rocks with physics, median",
            format!(
                "{:.0} us, {} put back",
                self.rocks_us_median, self.rocks_put_back
            ),
        )?;
        row(f, "hash", self.hash.clone())?;
        for check in &self.checks {
            let verdict = if check.holds { "ok" } else { "FAILED" };
            let values = format!(
                "{:<12.3e} at most {:<8.1e} {verdict}",
                check.found, check.at_most
            );
            row(f, check.name, values)?;
            if let Some(cause) = &check.cause {
                writeln!(f, "    {cause}")?;
            }
        }
        Ok(())
    }
}

/// The states that a battle's creature was in.
fn states(battle: &Battle<'_>) -> Vec<StateTicks> {
    let Some(life) = battle.life() else {
        return Vec::new();
    };
    let brain = life.kind().brain();
    let line = |state| {
        let (entered, ticks) = battle.recording().stays_in(state);
        StateTicks {
            state: brain.path(state).to_owned(),
            entered,
            ticks,
        }
    };
    let all = brain.states().map(line);
    all.filter(|state| state.ticks > 0).collect()
}
