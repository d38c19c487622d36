//! Checks of a battle in every tick, computed independently of the climber and mostly of the surface's queries.

use std::collections::BTreeMap;
use std::fmt;

use clamber_climber::{Climber, ClimberEvent, ClimberInput, ClimberMode};
use clamber_surface::mesh::TriangleId;
use clamber_world::{MaterialPoint, Obstacle};
use glam::DVec3;
use serde::Serialize;

use super::footing::{Off, is_inside, reach, reference_position};
use super::{Battle, BattleOptions, CREATURE, Story, TERRAIN, TICK};
use crate::json::number;
use crate::valley;

/// Ticks between two checks of whether the climber is inside the creature. Such a check goes over all triangles and
/// takes longer than the tick itself.
const INSIDE_EVERY: u64 = 10;

/// Name of the check of a contact's distance from its material point.
pub const DRIFT: &str = "anchor drift, m";
const PUSHED_OFF: &str = "pushed off its point, m";
/// Name of the check of a gap between a body and its material point.
pub const STANDS_OFF: &str = "stands off its point, m";
const PUSH_OUT: &str = "push-out while standing, m";
/// Name of the check of a climber inside the creature or below the ground.
pub const INSIDE: &str = "ticks inside or below";
const OUT_OF_REACH: &str = "ticks out of its reach";
const NOT_RIDING: &str = "share of ticks not riding";
/// Name of the check of rocks inside the creature or below the ground.
pub const ROCKS_INSIDE: &str = "rocks inside or below";
/// Name of the check of a rider that falls to the ground.
pub const FALLS: &str = "falls to the ground";

/// Largest distance of a standing climber's contact from its material point, metres.
pub const MAX_DRIFT: f64 = 1e-4;

/// Longest push-out of a climber that stands without input, metres.
const MAX_PUSH_OUT: f64 = 0.01;

/// Largest distance by which other skin may push a climber's body off the material point that it stands on, metres: a
/// tenth of the body's radius. Beyond it the climber has to find new ground.
const MAX_PUSHED_OFF: f64 = 0.04;

/// Largest gap between a climber's body and its material point with no skin in between, metres: the contact margin,
/// within which the body counts as touching.
pub const MAX_STANDS_OFF: f64 = 0.01;

/// Largest share of a ride's ticks that the climber may spend off the creature: one in ten.
const MAX_OFF: f64 = 0.1;

/// Seconds in the air that the script of a ride needs for the drop and the jump. In a ride shorter than 20 s they are
/// more than `MAX_OFF`.
const SCRIPT_OFF: f64 = 2.0;

/// Distance of the nearest skin up to which descriptions of faults name it, as a share of the creature's height.
const NEAR: f64 = 0.25;

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
    /// Place and time of the first failure; `None` if the check holds.
    pub cause: Option<String>,
}

impl Check {
    /// True if the number found is allowed.
    pub fn holds(&self) -> bool {
        self.found <= self.at_most
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.holds() { "ok" } else { "FAILED" };
        let (name, found, most) = (self.name, self.found, self.at_most);
        write!(
            f,
            "  {name:<28}{found:<12.3e} at most {most:<8.1e} {verdict}"
        )?;
        let mut cause = self.cause.iter();
        cause.try_for_each(|cause| write!(f, "\n    {cause}"))
    }
}

/// Checks a battle from tick to tick.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// The material point under the climber when it landed or its input ended.
    recorded: Option<MaterialPoint>,
    /// The climber was on the creature a tick ago.
    was_riding: bool,
    /// The climber ended the last tick faster than it walks, as after a landing: friction slows it down, and it leaves
    /// its material point.
    slides: bool,
    /// Description of how the climber last left the creature.
    left: Option<String>,
    /// The climber came to the ground, and has not been on the creature since.
    is_down: bool,
    /// [`Counts::drops`](super::Counts::drops) a tick ago.
    drops: Option<u32>,
    /// How often the climber came to the ground or out of the valley. A start on the ground counts as well.
    pub falls: u32,
    /// Ticks at which the climber's centre was found inside the creature or below the ground.
    pub inside: u32,
    /// How often a rock was found inside the creature without being caught, or below the ground.
    pub rocks_inside: u32,
    /// Ticks at which a climber that climbs or holds on was farther from its hold than it can reach.
    out_of_reach: u32,
    /// Largest distance of the contact of a climber that stands without input, climbs or holds on from its material
    /// point, metres.
    pub drift: f64,
    /// Number of ticks with such a distance.
    pub drift_ticks: usize,
    /// Largest distance by which other skin pushed the body off its material point while it stood without input,
    /// metres.
    pub pushed_off: f64,
    /// Largest gap between the body and its material point with no skin in between, while it stood without input,
    /// metres.
    pub stands_off: f64,
    /// Longest push-out of a climber that stood without input, metres.
    pub push_out: f64,
    /// Number of ticks that ended with the climber on the creature.
    pub riding: usize,
    /// Number of ticks that ended in each mode of [`ClimberMode::ALL`].
    pub modes: [usize; ClimberMode::ALL.len()],
    /// Sum over all ticks: share of the creature's vertices that were skinned for the climber.
    skinned: f64,
    faults: BTreeMap<&'static str, String>,
}

impl Watch {
    /// Checks a battle after a tick. Call it after every tick.
    pub fn tick(&mut self, battle: &Battle<'_>) {
        let (climber, drops) = (battle.climber(), battle.counts.drops);
        let idle = battle.input == ClimberInput::default() && !self.slides;
        self.look(battle, climber, idle);
        let before = self.drops.replace(drops);
        if before.is_some_and(|before| before != drops) {
            self.fell(battle, climber.state().position);
            (self.is_down, self.left) = (false, None);
        }
        for (rock, place, what) in &battle.rocks.faults {
            self.rocks_inside += 1;
            self.note(ROCKS_INSIDE, battle, &format!("rock {rock} {what}"), *place);
        }
        let state = climber.state();
        let own = state.velocity - state.base_velocity;
        self.slides = own.length() > climber.config().ground.walk_speed;
        self.riding += usize::from(self.was_riding);
        let mode = ClimberMode::ALL.iter().position(|mode| *mode == state.mode);
        if let Some(mode) = mode {
            self.modes[mode] += 1;
        }
        let skinned = &battle.skinned;
        self.skinned += skinned.vertices_skinned as f64 / skinned.vertices.max(1) as f64;
    }

    /// Number of ticks that were checked.
    pub fn ticks(&self) -> usize {
        self.modes.iter().sum()
    }

    /// Share of the ticks that ended with the climber on the creature.
    pub fn riding_share(&self) -> f64 {
        self.riding as f64 / self.ticks().max(1) as f64
    }

    /// Mean share of the creature's vertices that were skinned for the climber in a tick.
    pub fn skinned_share(&self) -> f64 {
        self.skinned / self.ticks().max(1) as f64
    }

    /// The first fault of a check, as text; `None` without a fault.
    pub fn first_fault(&self, check: &str) -> Option<&str> {
        self.faults.get(check).map(String::as_str)
    }

    /// The checks of a battle so far. `options` are the options that the battle was made with.
    pub fn checks(&self, battle: &Battle<'_>, options: &BattleOptions) -> Vec<Check> {
        let check = |name, found: f64, at_most: f64| Check {
            name,
            found,
            at_most,
            cause: self
                .first_fault(name)
                .filter(|_| found > at_most)
                .map(str::to_owned),
        };
        let rides = options.story() == Story::Ride;
        let mut checks = vec![check(DRIFT, self.drift, MAX_DRIFT)];
        if rides {
            checks.extend([
                check(PUSHED_OFF, self.pushed_off, MAX_PUSHED_OFF),
                check(STANDS_OFF, self.stands_off, MAX_STANDS_OFF),
                check(PUSH_OUT, self.push_out, MAX_PUSH_OUT),
            ]);
        }
        checks.extend([
            check(INSIDE, f64::from(self.inside), 0.0),
            check(ROCKS_INSIDE, f64::from(self.rocks_inside), 0.0),
            check(OUT_OF_REACH, f64::from(self.out_of_reach), 0.0),
        ]);
        if rides {
            let most = MAX_OFF.max(SCRIPT_OFF / options.seconds());
            checks.push(check(NOT_RIDING, 1.0 - self.riding_share(), most));
            checks.push(check(FALLS, f64::from(self.falls), 0.0));
        } else if options.is_default_fight() {
            // With other seeds, brains and creatures the climber may lose the fight, or never be knocked over.
            let counts = &battle.counts;
            let lives = f64::from(u8::from(counts.killed == 0));
            let points = battle
                .life()
                .map_or(0, |life| life.kind().weak_points().len());
            let whole = points.saturating_sub(counts.weak_points as usize);
            let never = self.modes.iter().filter(|ticks| **ticks == 0).count();
            checks.extend([
                check("creatures alive at the end", lives, 0.0),
                check("weak points not used up", whole as f64, 0.0),
                check("modes never seen", never as f64, 0.0),
            ]);
        }
        checks
    }

    /// Checks the climber, which is the battle's or one in another state. Returns the drift, metres, where it is defined.
    ///
    /// For a rider that stands without input (`idle`): the distance of its contact from the recorded material point, or
    /// the depth of its body in that point if larger. For a climber in a climb, or that holds on, and may be shoved
    /// where creases close: the distance of its contact from its own material point.
    pub fn look(&mut self, battle: &Battle<'_>, climber: &Climber, idle: bool) -> Option<f64> {
        let state = climber.state();
        self.look_inside(battle, state.position);
        self.look_at_leaving(battle, climber);
        let drift = if state.mode.is_holding() || battle.arena().is_some() {
            self.recorded = None;
            self.look_at_hold(battle, climber)
        } else {
            self.look_at_footing(battle, climber, idle)
        };
        if let Some(drift) = drift {
            self.drift = self.drift.max(drift);
            self.drift_ticks += 1;
            if state.mode == ClimberMode::Standing {
                self.push_out = self.push_out.max(battle.report().pushed_out.length());
            }
        }
        drift
    }

    /// Checks a climber that climbs or holds on.
    fn look_at_hold(&mut self, battle: &Battle<'_>, climber: &Climber) -> Option<f64> {
        let state = climber.state();
        let support = state
            .support
            .filter(|s| s.attachment.obstacle == CREATURE)?;
        let (surface, palette) = (battle.surface(), battle.palette());
        let place = reference_position(surface, palette, &support.attachment.material);
        let place = place.unwrap_or(DVec3::INFINITY);
        if state.position.distance(place) > reach(climber) {
            self.out_of_reach += 1;
            self.note(OUT_OF_REACH, battle, "out of reach", state.position);
        }
        let drift = support.attachment.point.distance(place);
        if drift > MAX_DRIFT {
            let what = format!("hold {drift:.1e} m from its material point");
            self.note(DRIFT, battle, &what, state.position);
        }
        Some(drift)
    }

    /// Checks a rider that stands, or is in the air.
    fn look_at_footing(
        &mut self,
        battle: &Battle<'_>,
        climber: &Climber,
        idle: bool,
    ) -> Option<f64> {
        let (state, report) = (climber.state(), battle.report());
        let support = state
            .support
            .filter(|s| s.attachment.obstacle == CREATURE && idle);
        let Some(support) = support else {
            self.recorded = None;
            return None;
        };
        // It may slip and land on another point within one tick.
        let landed = |event: &ClimberEvent| matches!(event, ClimberEvent::Landed { .. });
        let kept = self.recorded.filter(|_| !report.events.iter().any(landed));
        let Some(recorded) = kept else {
            self.recorded = Some(support.attachment.material);
            return None;
        };
        let center = state.position;
        let push_out = report.pushed_out.length();
        if push_out > MAX_PUSH_OUT {
            let what = format!("pushed out by {push_out:.3} m");
            self.note(PUSH_OUT, battle, &what, center);
        }
        let (surface, palette) = (battle.surface(), battle.palette());
        let radius = climber.config().body.radius;
        let off = Off::measure(surface, palette, &recorded, center, radius);
        let contact = support.attachment.point.distance(off.point);
        let drift = contact.max(off.sunk);
        if drift > MAX_DRIFT {
            let sunk = off.sunk;
            let what = format!(
                "contact {contact:.1e} m from its material point, body {sunk:.1e} m deep in it"
            );
            self.note(DRIFT, battle, &what, center);
            // A lost point counts once. Drift below the limit accumulates against the recorded point.
            self.recorded = Some(support.attachment.material);
            return Some(drift);
        }
        self.pushed_off = self.pushed_off.max(off.pushed);
        if off.pushed > MAX_PUSHED_OFF {
            let what = format!("pushed off by {:.3} m", off.pushed);
            self.note(PUSHED_OFF, battle, &what, center);
        }
        self.stands_off = self.stands_off.max(off.gap);
        if off.gap > MAX_STANDS_OFF {
            let what = format!("stands off by {:.3} m", off.gap);
            self.note(STANDS_OFF, battle, &what, center);
        }
        Some(drift)
    }

    fn look_inside(&mut self, battle: &Battle<'_>, center: DVec3) {
        let look = battle.tick().is_multiple_of(INSIDE_EVERY);
        let below =
            valley::contains(center.x, center.z) && center.y < valley::height(center.x, center.z);
        if below || look && is_inside(battle.surface(), center) {
            self.inside += 1;
            let what = if below { "below the ground" } else { "inside" };
            self.note(INSIDE, battle, what, center);
        }
    }

    /// Notes how the climber left the creature, and the fall when it comes to the ground.
    fn look_at_leaving(&mut self, battle: &Battle<'_>, climber: &Climber) {
        let state = climber.state();
        let stands_on = state.support.map(|support| support.attachment.obstacle);
        let rides = stands_on == Some(CREATURE);
        if self.was_riding && !rides {
            let what = format!("left the creature, {:?}", battle.report().events);
            self.note(NOT_RIDING, battle, &what, state.position);
            self.left = Some(describe(battle, &what, state.position));
        }
        if stands_on == Some(TERRAIN) {
            self.fell(battle, state.position);
        }
        self.is_down &= !rides;
        self.was_riding = rides;
    }

    /// The climber is on the ground or out of the valley: counts a fall, if it is a new one.
    fn fell(&mut self, battle: &Battle<'_>, place: DVec3) {
        if std::mem::replace(&mut self.is_down, true) {
            return;
        }
        self.falls += 1;
        if let Some(left) = self.left.take() {
            self.faults.entry(FALLS).or_insert(left);
        } else {
            self.note(FALLS, battle, "never came to stand on the creature", place);
        }
    }

    /// Keeps the description of a fault if it is the check's first one.
    fn note(&mut self, check: &'static str, battle: &Battle<'_>, what: &str, place: DVec3) {
        let first = self.faults.entry(check);
        first.or_insert_with(|| describe(battle, what, place));
    }
}

/// Describes a fault `what` at a place: tick, clip, position, and the nearest skin with its speed.
fn describe(battle: &Battle<'_>, what: &str, place: DVec3) -> String {
    let (tick, surface) = (battle.tick(), battle.surface());
    let near = surface.closest_point(place, NEAR * battle.height);
    let skin = near.map_or("no skin near".into(), |near| {
        let motion = surface.motion(&near.material, TICK);
        let speed = motion.map_or(0.0, |motion| motion.velocity.length());
        let joint = surface
            .mesh()
            .joint_of(TriangleId(near.material.key as u32));
        let joint =
            joint.and_then(|joint| battle.creature.rig.skeleton.joints().get(joint.index()));
        let (distance, joint) = (near.distance, joint.map_or("no joint", |joint| &joint.name));
        format!("{distance:.3} m from skin of {joint} that moves at {speed:.1} m/s")
    });
    format!(
        "tick {tick} ({:.2} s, {}): {what} at ({:.2}, {:.2}, {:.2}), {skin}",
        tick as f64 * TICK,
        battle.playing(),
        place.x,
        place.y,
        place.z,
    )
}
