use std::fmt;
use std::path::Path;

use clamber_climber::ClimberMode;
use serde::Serialize;

use super::checks::{
    DRIFT, FALLS, INSIDE, MAX_DRIFT, MAX_PUSH_OUT, MAX_PUSHED_OFF, MAX_STANDS_OFF, NOT_RIDING,
    OUT_OF_REACH, PUSH_OUT, PUSHED_OFF, ROCKS_INSIDE, STANDS_OFF,
};
use super::{Battle, BattleError, BattleOptions, Story};
use crate::json::number;
use crate::measure::quantile;

/// Largest share of a ride's ticks that may be spent off the creature: one in ten.
const MAX_OFF: f64 = 0.1;

/// Seconds that the script of a ride spends in the air by itself, on the drop and on the jump: more than `MAX_OFF` of a ride
/// shorter than 20 s.
const SCRIPT_OFF: f64 = 2.0;

/// Something that a battle must fulfil.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Check {
    /// What was looked at.
    pub name: &'static str,
    /// What was found.
    #[serde(serialize_with = "number")]
    pub found: f64,
    /// What it may be at most.
    pub at_most: f64,
    /// True if it is.
    pub holds: bool,
    /// Where and when it first failed, if it did.
    pub cause: Option<String>,
}

/// How long a climber did something.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeTicks {
    /// What.
    pub mode: String,
    /// For how many ticks.
    pub ticks: usize,
}

/// What came of a battle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Who was ridden.
    pub creature: String,
    /// Its joints.
    pub joints: usize,
    /// Its vertices, after welding.
    pub vertices: usize,
    /// Its triangles.
    pub triangles: usize,
    /// Its height, metres.
    pub height_m: f64,
    /// Clips that are no loops, and are played back and forth.
    pub turned_back: Vec<String>,
    /// Ticks fought.
    pub ticks: usize,
    /// Their length, seconds.
    pub seconds: f64,
    /// A number over every bit of the climber's states: equal for equal battles.
    pub hash: String,
    /// Times that a rider was dropped on the creature: 1 if it never fell to the ground; 0 of a climb.
    pub drops: u32,
    /// Times that a rider came to the ground, or out of the valley.
    pub falls: u32,
    /// Ticks at which the climber was seen inside the creature or below the ground.
    pub ticks_inside: u32,
    /// Times that it landed on anything.
    pub landings: u32,
    /// Ticks in each mode of the climber.
    pub modes: Vec<ModeTicks>,
    /// When it came to the creature's top, if it climbed there, seconds.
    pub arrived_s: Option<f64>,
    /// Share of the ticks spent on the creature.
    pub riding_share: f64,
    /// Largest distance from a standing rider's contact to the material point recorded when its input ended; in a climb
    /// from its contact to its own material point.
    pub max_anchor_drift_m: f64,
    /// Farthest that other skin pushed a rider's body off its material point while standing without input.
    pub max_pushed_off_m: Option<f64>,
    /// Farthest that a rider stood off its material point with no skin in between while standing without input.
    pub max_stands_off_m: Option<f64>,
    /// Longest push-out of a rider while standing without input.
    pub max_push_out_m: Option<f64>,
    /// Deepest that a rider's ball reached into the skin while standing without input.
    pub max_penetration_m: Option<f64>,
    /// Vertices skinned per tick, as a share of all: the mean over the ticks.
    pub vertices_skinned_share: f64,
    /// Rocks.
    pub rocks: usize,
    /// How often any of them was let fall.
    pub rock_drops: u32,
    /// How often a rock was seen inside the creature or below the ground.
    pub rocks_inside: u32,
    /// Rocks batted out of the valley, which fell again.
    pub rocks_left: u32,
    /// Rocks at the creature's skin: the mean over the ticks.
    pub rocks_near: f64,
    /// Rocks that the physics let skin into, and that were put back in front of it.
    pub rocks_put_back: u32,
    /// What half of the ticks cost at most for the rocks, the physics included.
    pub rocks_us_median: f64,
    /// What half of the ticks cost at most, without the rocks: pose, script, climber.
    pub tick_us_median: f64,
    /// What 99 of 100 ticks cost at most.
    pub tick_us_p99: f64,
    /// What had to hold.
    pub checks: Vec<Check>,
}

impl Summary {
    /// Of a battle as it stands, fought with these options.
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
        if !rides && options.is_whole() {
            let missed = if battle.arrived().is_some() { 0.0 } else { 1.0 };
            checks.push(check("never at the top", missed, 0.0));
            // A creature from a file need not have a clip that shakes and one that stomps.
            if options.creature.is_none() {
                checks.push(check("modes never seen", never as f64, 0.0));
            }
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
            modes: modes.to_vec(),
            arrived_s: battle.arrived(),
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

    /// Writes `summary.json` into a folder that exists.
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
            row(f, "no loops, back and forth", self.turned_back.join(", "))?;
        }
        if let Some(seconds) = self.arrived_s {
            row(f, "at the top", format!("after {seconds:.1} s"))?;
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
            "rocks, drops, at the skin",
            format!(
                "{}, {}, {:.1}; {} left the valley",
                self.rocks, self.rock_drops, self.rocks_near, self.rocks_left
            ),
        )?;
        row(
            f,
            "rocks, physics and all",
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
