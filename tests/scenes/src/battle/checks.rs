//! Checks of a battle in every tick, computed independently of the climber and mostly of the surface's queries.

use std::collections::BTreeMap;
use std::fmt;

use clamber_climber::{Climber, ClimberEvent, ClimberInput, ClimberMode};
use clamber_surface::mesh::TriangleId;
use clamber_world::{Attachment, MaterialPoint, Obstacle};
use glam::DVec3;
use serde::Serialize;

use super::footing::{is_inside, off_its_point, reach, reference_position};
use super::{Battle, BattleOptions, CREATURE, Story, TERRAIN, TICK};
use crate::json::number;
use crate::measure::larger;
use crate::valley;

/// Ticks between two checks of whether the climber is inside the creature. Such a check goes over all triangles and
/// takes longer than the tick itself.
const INSIDE_EVERY: u64 = 10;

/// Name of the check of a contact's distance from its material point.
pub const DRIFT: &str = "anchor drift, m";
/// Name of the check of a body that other skin pushes off its material point.
pub const PUSHED_OFF: &str = "pushed off its point, m";
/// Name of the check of a gap between a body and its material point.
pub const STANDS_OFF: &str = "stands off its point, m";
/// Name of the check of the distance by which a body is pushed out of skin.
pub const PUSH_OUT: &str = "push-out while standing, m";
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

/// The largest number that a check allows.
fn bound(check: &str) -> f64 {
    match check {
        DRIFT => MAX_DRIFT,
        PUSHED_OFF => MAX_PUSHED_OFF,
        STANDS_OFF => MAX_STANDS_OFF,
        PUSH_OUT => MAX_PUSH_OUT,
        _ => 0.0,
    }
}

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
    /// Place and time of the first fault. `None` if the check holds, or if its number has no place and time.
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
    /// Number of ticks with a drift: see [`Watch::look`].
    pub drift_ticks: usize,
    /// Number of ticks that ended with the climber on the creature.
    riding: usize,
    /// Number of ticks that ended in each mode of [`ClimberMode::ALL`].
    pub modes: [usize; ClimberMode::ALL.len()],
    /// For each check, the number found and a description of the first fault.
    found: BTreeMap<&'static str, (f64, Option<String>)>,
}

/// A battle, and where in the world the checked thing is.
type At<'a> = (&'a Battle<'a>, DVec3);

impl Watch {
    /// Checks a battle after a tick. Call it after every tick.
    pub fn tick(&mut self, battle: &Battle<'_>) {
        let (climber, drops) = (battle.climber(), battle.counts.drops);
        let idle = battle.input == ClimberInput::default() && !self.slides;
        self.look(battle, climber, idle);
        let state = climber.state();
        let before = self.drops.replace(drops);
        if before.is_some_and(|before| before != drops) {
            self.fell((battle, state.position));
            (self.is_down, self.left) = (false, None);
        }
        for (rock, place, what) in &battle.rocks.faults {
            let what = format!("rock {rock} {what}");
            self.count(ROCKS_INSIDE, (battle, *place), &what);
        }
        let own = state.velocity - state.base_velocity;
        self.slides = own.length() > climber.config().ground.walk_speed;
        self.riding += usize::from(self.was_riding);
        let mode = ClimberMode::ALL.iter().position(|mode| *mode == state.mode);
        if let Some(mode) = mode {
            self.modes[mode] += 1;
        }
    }

    /// Number of ticks that were checked.
    pub fn ticks(&self) -> usize {
        self.modes.iter().sum()
    }

    /// Share of the ticks that ended with the climber on the creature.
    pub fn riding_share(&self) -> f64 {
        self.riding as f64 / self.ticks().max(1) as f64
    }

    /// The number that a check found so far: the largest distance in metres, or how often a fault was found.
    pub fn found(&self, check: &str) -> f64 {
        self.found.get(check).map_or(0.0, |(number, _)| *number)
    }

    /// The first fault of a check, as text; `None` without a fault.
    pub fn first_fault(&self, check: &str) -> Option<&str> {
        self.found.get(check)?.1.as_deref()
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
        let found = |name| check(name, self.found(name), bound(name));
        let rides = options.story() == Story::Ride;
        let mut checks = vec![found(DRIFT)];
        if rides {
            checks.extend([PUSHED_OFF, STANDS_OFF, PUSH_OUT].map(found));
        }
        checks.extend([INSIDE, ROCKS_INSIDE, OUT_OF_REACH].map(found));
        if rides {
            let most = MAX_OFF.max(SCRIPT_OFF / options.seconds());
            checks.push(check(NOT_RIDING, 1.0 - self.riding_share(), most));
            checks.push(found(FALLS));
        } else if options.is_default_fight() {
            // With other seeds, brains and creatures the climber may lose the fight, or never be knocked over.
            let counts = &battle.counts;
            let lives = f64::from(u8::from(counts.killed == 0));
            let points = battle.life().map(|life| life.kind().weak_points().len());
            let whole = points.map_or(0, |all| all.saturating_sub(counts.weak_points as usize));
            let never = self.modes.iter().filter(|ticks| **ticks == 0).count();
            checks.extend([
                check("creatures alive at the end", lives, 0.0),
                check("weak points not used up", whole as f64, 0.0),
                check("modes never seen", never as f64, 0.0),
            ]);
        }
        checks
    }

    /// Checks the climber, which is the battle's or one in another state. Returns the drift, metres, where it is
    /// defined.
    ///
    /// For a rider that stands without input (`idle`): the distance of its contact from the recorded material point, or
    /// the depth of its body in that point if larger. For a climber in a climb, or that holds on, and may be shoved
    /// where creases close: the distance of its contact from its own material point.
    pub fn look(&mut self, battle: &Battle<'_>, climber: &Climber, idle: bool) -> Option<f64> {
        let state = climber.state();
        let at = (battle, state.position);
        self.look_inside(at);
        self.look_at_leaving(at, climber);
        let support = state.support.map(|support| support.attachment);
        let support = support.filter(|support| support.obstacle == CREATURE);
        let drift = if state.mode.is_holding() || battle.arena().is_some() {
            self.recorded = None;
            self.look_at_hold(at, climber, &support?)
        } else if let Some(support) = support.filter(|_| idle) {
            self.look_at_footing(at, climber, &support)?
        } else {
            self.recorded = None;
            return None;
        };
        self.drift_ticks += 1;
        if state.mode == ClimberMode::Standing {
            let pushed = battle.report().pushed_out.length();
            let what = format!("pushed out by {pushed:.3} m");
            self.measure(PUSH_OUT, pushed, at, &what);
        }
        Some(drift)
    }

    /// Checks a climber that climbs or holds on. Returns the drift.
    fn look_at_hold(&mut self, at: At<'_>, climber: &Climber, hold: &Attachment) -> f64 {
        let place = reference_position(at.0, &hold.material).unwrap_or(DVec3::INFINITY);
        let distance = at.1.distance(place);
        if distance.is_nan() || distance > reach(climber) {
            self.count(OUT_OF_REACH, at, "out of reach");
        }
        let drift = hold.point.distance(place);
        let what = format!("hold {drift:.1e} m from its material point");
        self.measure(DRIFT, drift, at, &what);
        drift
    }

    /// Checks a rider that stands without input. Returns the drift, unless its material point is a new one.
    fn look_at_footing(
        &mut self,
        at: At<'_>,
        climber: &Climber,
        support: &Attachment,
    ) -> Option<f64> {
        // It may slip and land on another point within one tick.
        let landed = |event: &ClimberEvent| matches!(event, ClimberEvent::Landed { .. });
        let has_landed = at.0.report().events.iter().any(landed);
        let Some(recorded) = self.recorded.filter(|_| !has_landed) else {
            self.recorded = Some(support.material);
            return None;
        };
        let radius = climber.config().body.radius;
        let (point, off, is_pushed) = off_its_point(at, &recorded, radius);
        let (contact, sunk) = (support.point.distance(point), larger(-off, 0.0));
        let drift = larger(sunk, contact);
        let what = format!(
            "contact {contact:.1e} m from its material point, body {sunk:.1e} m deep in it"
        );
        self.measure(DRIFT, drift, at, &what);
        if drift > MAX_DRIFT {
            // A lost point counts once. Drift below the limit accumulates against the recorded point.
            self.recorded = Some(support.material);
        } else if is_pushed {
            self.measure(PUSHED_OFF, off, at, &format!("pushed off by {off:.3} m"));
        } else {
            self.measure(STANDS_OFF, off, at, &format!("stands off by {off:.3} m"));
        }
        Some(drift)
    }

    fn look_inside(&mut self, at: At<'_>) {
        let (battle, DVec3 { x, y, z }) = at;
        let look = battle.tick().is_multiple_of(INSIDE_EVERY);
        let what = if !at.1.is_finite() {
            "not finite"
        } else if valley::contains(x, z) && y < valley::height(x, z) {
            "below the ground"
        } else if look && is_inside(battle.surface(), at.1) {
            "inside"
        } else {
            return;
        };
        self.count(INSIDE, at, what);
    }

    /// Notes how the climber left the creature, and the fall when it comes to the ground.
    fn look_at_leaving(&mut self, at: At<'_>, climber: &Climber) {
        let support = climber.state().support;
        let stands_on = support.map(|support| support.attachment.obstacle);
        let rides = stands_on == Some(CREATURE);
        if self.was_riding && !rides {
            let what = format!("left the creature, {:?}", at.0.report().events);
            self.count(NOT_RIDING, at, &what);
            self.left = Some(describe(at, &what));
        }
        if stands_on == Some(TERRAIN) {
            self.fell(at);
        }
        self.is_down &= !rides;
        self.was_riding = rides;
    }

    /// The climber is on the ground or out of the valley: counts a fall, if it is a new one.
    fn fell(&mut self, at: At<'_>) {
        if std::mem::replace(&mut self.is_down, true) {
            return;
        }
        let left = self.left.take();
        let (falls, cause) = self.found.entry(FALLS).or_default();
        *falls += 1.0;
        let never = || describe(at, "never came to stand on the creature");
        cause.get_or_insert_with(|| left.unwrap_or_else(never));
    }

    /// Counts a fault of a check.
    fn count(&mut self, check: &'static str, at: At<'_>, what: &str) {
        self.measure(check, self.found(check) + 1.0, at, what);
    }

    /// Keeps the largest number of a check, and describes the first one beyond its bound.
    fn measure(&mut self, check: &'static str, number: f64, at: At<'_>, what: &str) {
        // `f64::max` and the comparison ignore NaN.
        let number = if number.is_nan() {
            f64::INFINITY
        } else {
            number
        };
        let (largest, cause) = self.found.entry(check).or_default();
        *largest = largest.max(number);
        if number > bound(check) {
            cause.get_or_insert_with(|| describe(at, what));
        }
    }
}

/// Describes a fault `what` at a place: tick, clip, position, and the nearest skin with its speed.
fn describe((battle, place): At<'_>, what: &str) -> String {
    let (tick, surface) = (battle.tick(), battle.surface());
    let near = surface.closest_point(place, NEAR * battle.height);
    let skin = near.map_or("no skin near".into(), |near| {
        let motion = surface.motion(&near.material, TICK);
        let speed = motion.map_or(0.0, |motion| motion.velocity.length());
        let triangle = TriangleId(near.material.key as u32);
        let joints = battle.creature.rig.skeleton.joints();
        let joint = surface.mesh().joint_of(triangle);
        let joint = joint.and_then(|joint| joints.get(joint.index()));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::giant::giant;

    #[test]
    fn nan_fails_a_check() {
        let (giant, options) = (giant().unwrap(), BattleOptions::ride(0, 1));
        let battle = Battle::new(&giant, &options).unwrap();
        let mut watch = Watch::default();
        watch.measure(DRIFT, f64::NAN, (&battle, DVec3::ZERO), "lost");
        watch.look_inside((&battle, DVec3::Y * f64::NAN));
        let checks = watch.checks(&battle, &options);
        for name in [DRIFT, INSIDE] {
            let check = checks.iter().find(|check| check.name == name).unwrap();
            assert!(!check.holds() && check.cause.is_some(), "{check:?}");
        }
    }
}
