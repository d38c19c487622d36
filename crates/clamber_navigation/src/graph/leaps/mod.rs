//! Jumps from one part of a creature to another: onto parts beside or below, onto holds, and up to ledges.

mod find;
mod play;

use clamber_climber::{ClimberConfig, ClimberInput};
use clamber_surface::mesh::Rig;
use glam::DVec3;

#[cfg(feature = "cache")]
use super::Patch;
use super::{ClimbGraph, Footing};
use crate::NavigationError;
use crate::clips::SLICE_SECONDS;
use crate::progress::{Stage, Tell};
use play::{Moment, Theatre};

/// A jump from a patch on which a climber stands to another patch. The graph's build has played it, at rest and in the
/// clips.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Leap {
    /// The patch where it begins.
    pub(crate) from: u32,
    /// The patch where it comes to rest.
    pub(crate) to: u32,
    /// The patch at which it is aimed.
    pub(crate) aimed: u32,
    /// The footing with which it comes to rest.
    pub(crate) lands: Footing,
    /// Longest time from the take-off until the climber is at rest, seconds.
    seconds: f32,
    /// Largest stamina that it costs.
    costs: f32,
}

impl Leap {
    /// Longest time from the take-off until the climber is at rest, seconds.
    pub(crate) fn seconds(&self) -> f64 {
        f64::from(self.seconds)
    }

    /// Largest stamina that it costs.
    pub(crate) fn costs(&self) -> f64 {
        f64::from(self.costs)
    }
}

/// All jumps of a creature.
#[derive(Clone, Debug, Default)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Leaps {
    /// Sorted by the patch where they begin, then by the patch where they end.
    leaps: Vec<Leap>,
    /// The jumps' indices, sorted by the patch where they end.
    by_end: Vec<u32>,
    /// For each jump and clip, whether the jump lands whenever it begins: `leap * clips + clip`.
    lands: Vec<bool>,
    /// Number of clips.
    clips: usize,
}

/// Offsets from a jump's beginning at which it is played, in radii, along two horizontal axes. A jump that lands only
/// from the exact place is dropped.
const START_OFFSETS: [[f64; 2]; 4] = [[0.25, 0.0], [0.0, 0.25], [-0.25, 0.0], [0.0, -0.25]];

/// In each clip a jump is played at least this many times, evenly spread, and at least once per slice.
const FEWEST_PHASES: f64 = 8.0;
/// Clips with more slices than this have no jumps. It limits the time of the build.
const MOST_PHASES: f64 = 128.0;

/// Number of climbers that jump in one pass over the skin's motion.
const AT_ONCE: usize = 64;

/// Two jumps whose beginnings are within this many radii of each other, and whose ends are as well, count as one. The
/// one that saves most time is kept.
const SAME_JUMP_DISTANCE: f64 = 4.0;

/// In a clip a jump has to land within this many radii of where it lands at rest.
const SAME_LANDING_DISTANCE: f64 = 2.0;

/// The most jumps that are played at rest: those that save most time. It limits the time of the build.
const MOST_TRIED: usize = 512;
/// The most jumps that are kept of those that land at rest, and are then played in the clips. It limits the time of the
/// build.
const MOST_JUMPS: usize = 64;

impl Leaps {
    /// Plays jumps, and keeps those that land where no short way leads.
    pub(super) fn find(
        graph: &ClimbGraph,
        rig: &Rig,
        tell: &mut Tell<'_>,
    ) -> Result<Self, NavigationError> {
        let clips = graph.clips.clips.len();
        let mut theatre = Theatre::new(graph, rig)?;
        // The clips are played after all cubes are searched, so both count as steps.
        let mut cubes = 0;
        let tries = find::tries(graph, theatre.at_rest()?, &mut |done, of| {
            cubes = of;
            tell.now(Stage::Jumps, done, of + clips)
        })?;
        let mut tell = |clip: usize| tell.now(Stage::Jumps, cubes + clip, cubes + clips);
        let mut leaps = Self::at_rest(graph, &mut theatre, &tries, &mut || tell(0))?;
        leaps.sort_unstable_by_key(|leap| (leap.from, leap.to));
        let mut lands = vec![false; leaps.len() * clips];
        for clip in 0..clips {
            let lasts = theatre.seconds(clip);
            let phases = (lasts / SLICE_SECONDS).ceil().max(FEWEST_PHASES);
            if phases > MOST_PHASES {
                continue;
            }
            let mut left: Vec<(usize, Leap)> = leaps.iter().copied().enumerate().collect();
            for phase in 0..phases as u32 {
                if left.is_empty() {
                    break;
                }
                let begins = lasts * f64::from(phase) / phases;
                let off = START_OFFSETS[phase as usize % START_OFFSETS.len()];
                let when = Moment {
                    clip: Some(clip),
                    begins,
                    off,
                };
                Self::keep(graph, &mut theatre, &mut left, when, &mut || tell(clip))?;
            }
            for (number, leap) in left {
                lands[number * clips + clip] = true;
                leaps[number] = leap;
            }
        }
        let mut by_end: Vec<u32> = (0..leaps.len() as u32).collect();
        by_end.sort_by_key(|leap| leaps[*leap as usize].to);
        Ok(Self {
            leaps,
            by_end,
            lands,
            clips,
        })
    }

    /// The tried jumps that land at rest, also from a little aside.
    fn at_rest(
        graph: &ClimbGraph,
        theatre: &mut Theatre<'_>,
        tries: &[find::Tried],
        tell: &mut dyn FnMut() -> Result<(), NavigationError>,
    ) -> Result<Vec<Leap>, NavigationError> {
        let mut leaps: Vec<Leap> = Vec::new();
        let mut beside = find::Beside::new(graph);
        let is_known = |leaps: &[Leap], leap: &Leap| {
            leaps.iter().any(|known| {
                near(graph, (known.from, leap.from), SAME_JUMP_DISTANCE)
                    && near(graph, (known.to, leap.to), SAME_JUMP_DISTANCE)
            })
        };
        for tries in tries[..tries.len().min(MOST_TRIED)].chunks(AT_ONCE) {
            if leaps.len() == MOST_JUMPS {
                break;
            }
            let ends: Vec<[u32; 2]> = tries.iter().map(|tried| tried.ends).collect();
            let landed = theatre.play(&ends, Moment::AT_REST, tell)?;
            let mut new: Vec<(usize, Leap)> = Vec::new();
            for ([from, aimed], landed) in ends.into_iter().zip(landed) {
                let Some(landed) = landed else {
                    continue;
                };
                let leap = Leap {
                    from,
                    to: landed.patch,
                    aimed,
                    lands: landed.footing,
                    seconds: landed.seconds,
                    costs: landed.costs,
                };
                let mut footings = graph.footings(leap.to as usize);
                // The climber may have caught hold of a patch on the way.
                if footings.any(|footing| footing == leap.lands)
                    && !is_known(&leaps, &leap)
                    && !beside.is_short(graph, [from, leap.to], leap.seconds())
                {
                    new.push((new.len(), leap));
                }
            }
            for off in START_OFFSETS {
                let when = Moment {
                    off,
                    ..Moment::AT_REST
                };
                Self::keep(graph, theatre, &mut new, when, tell)?;
            }
            for (_, leap) in new {
                if leaps.len() < MOST_JUMPS && !is_known(&leaps, &leap) {
                    leaps.push(leap);
                }
            }
        }
        Ok(leaps)
    }

    /// Plays jumps once more, and keeps those that land where they do at rest. Raises the kept jumps' times and costs
    /// to the largest ones.
    fn keep(
        graph: &ClimbGraph,
        theatre: &mut Theatre<'_>,
        leaps: &mut Vec<(usize, Leap)>,
        when: Moment,
        tell: &mut dyn FnMut() -> Result<(), NavigationError>,
    ) -> Result<(), NavigationError> {
        let ends: Vec<[u32; 2]> = leaps
            .iter()
            .map(|(_, leap)| [leap.from, leap.aimed])
            .collect();
        let mut played = theatre.play(&ends, when, tell)?.into_iter();
        leaps.retain_mut(|(_, leap)| {
            let landed = played.next().flatten();
            let landed =
                landed.filter(|landed| near(graph, (landed.patch, leap.to), SAME_LANDING_DISTANCE));
            landed.is_some_and(|landed| {
                leap.seconds = leap.seconds.max(landed.seconds);
                leap.costs = leap.costs.max(landed.costs);
                true
            })
        });
        Ok(())
    }

    /// The jumps that begin on a patch, with their indices.
    pub(crate) fn of(&self, patch: usize) -> impl Iterator<Item = (usize, &Leap)> {
        let first = self
            .leaps
            .partition_point(|leap| (leap.from as usize) < patch);
        let numbered = self.leaps.iter().enumerate().skip(first);
        numbered.take_while(move |(_, leap)| leap.from as usize == patch)
    }

    /// The jumps that end on a patch.
    pub(crate) fn to(&self, patch: usize) -> impl Iterator<Item = &Leap> {
        let end = |number: &u32| self.leaps[*number as usize].to as usize;
        let first = self.by_end.partition_point(|number| end(number) < patch);
        let ending = self.by_end[first..].iter();
        ending
            .map(|number| &self.leaps[*number as usize])
            .take_while(move |leap| leap.to as usize == patch)
    }

    /// The jump from one patch to another, with its index.
    pub(crate) fn between(&self, from: usize, to: usize) -> Option<(usize, &Leap)> {
        self.of(from).find(|(_, leap)| leap.to as usize == to)
    }

    /// The jump with an index.
    pub(crate) fn get(&self, number: usize) -> Option<&Leap> {
        self.leaps.get(number)
    }

    /// True if a jump lands in a clip whenever it begins.
    pub(crate) fn lands_in(&self, leap: usize, clip: usize) -> bool {
        let lands = self.lands.get(leap * self.clips + clip);
        clip < self.clips && lands.copied().unwrap_or(false)
    }

    /// All jumps.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Leap> {
        self.leaps.iter()
    }

    /// Number of jumps.
    pub(crate) fn len(&self) -> usize {
        self.leaps.len()
    }

    /// True if the jumps fit these patches and this number of clips.
    #[cfg(feature = "cache")]
    pub(crate) fn is_sound(&self, patches: &[Patch], clips: usize) -> bool {
        let leap = |leap: &Leap| {
            let [from, to, aimed] =
                [leap.from, leap.to, leap.aimed].map(|end| patches.get(end as usize));
            let lands = to.is_some_and(|to| match leap.lands {
                Footing::Stands => to.can_stand,
                Footing::Holds => to.can_hold,
            });
            from.is_some_and(|from| from.can_stand)
                && lands
                && aimed.is_some()
                && (0.0..=2.0 * LONGEST_FLIGHT + 1.0).contains(&leap.seconds())
                && leap.costs() >= 0.0
                && leap.costs().is_finite()
        };
        let mut numbers = self.by_end.clone();
        numbers.sort_unstable();
        self.clips == clips
            && numbers.into_iter().eq(0..self.leaps.len() as u32)
            && self
                .by_end
                .is_sorted_by_key(|number| self.leaps[*number as usize].to)
            && self.leaps.is_sorted_by_key(|leap| (leap.from, leap.to))
            && Some(self.lands.len()) == self.leaps.len().checked_mul(clips)
            && self.leaps.iter().all(leap)
    }
}

/// True if two patches are within this many radii of each other at rest.
fn near(graph: &ClimbGraph, (a, b): (u32, u32), radii: f64) -> bool {
    let [a, b] = [a, b].map(|patch| graph.patches[patch as usize].seat);
    a.distance(b) <= radii * graph.config.radius()
}

/// Input for a jump from one place to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aim {
    /// Walk input of the jump: horizontal, with the share of the walking speed as its length.
    pub(crate) walk: DVec3,
    /// Time of flight, seconds.
    pub(crate) seconds: f64,
}

/// A jump whose ends are nearer than this many radii horizontally goes straight up.
const STRAIGHT_UP_DISTANCE: f64 = 0.1;

/// The longest time of flight of a jump, seconds. It excludes jumps under nearly no gravity.
pub(super) const LONGEST_FLIGHT: f64 = 10.0;

/// Hands grip again after this share of the time for which the jump rises. Earlier they would hold the skin that the
/// climber leaves.
const GRIP_AGAIN_SHARE: f64 = 0.4;

impl Aim {
    /// Aims a jump from one place of a climber's ball to another, so that it comes down there or catches it at the
    /// highest point. `None` if the place is out of reach.
    pub(crate) fn at(climber: &ClimberConfig, from: DVec3, to: DVec3) -> Option<Self> {
        let (ground, gravity) = (&climber.ground, climber.gravity.length());
        let up = climber.up();
        let rise = ground.jump_speed;
        let height = (to - from).dot(up);
        let level = to - from - up * height;
        let under = rise * rise - 2.0 * gravity * height;
        // A place higher than the jump's highest point is caught there by the hands.
        let seconds = (rise + libm::sqrt(under.max(0.0))) / gravity;
        let hands = climber.grip.map_or(0.0, |grip| grip.reach);
        let ledge = climber
            .ledge
            .map_or(0.0, |ledge| ledge.reach_up + climber.body.radius);
        let lacks = -under / (2.0 * gravity);
        let share = level.length() / (ground.walk_speed * seconds);
        let is_straight = level.length() < STRAIGHT_UP_DISTANCE * climber.body.radius;
        let flies = seconds > 0.0 && seconds <= LONGEST_FLIGHT;
        let reaches = flies && lacks <= hands.max(ledge) && (is_straight || share <= 1.0);
        reaches.then(|| Self {
            walk: if is_straight {
                DVec3::ZERO
            } else {
                level.normalize() * share
            },
            seconds,
        })
    }

    /// The input of a tick that begins `seconds` after the take-off. The take-off's own tick is at 0.
    pub(crate) fn input(&self, climber: &ClimberConfig, seconds: f64) -> ClimberInput {
        let rises = climber.ground.jump_speed / climber.gravity.length();
        ClimberInput {
            walk: self.walk,
            climb: climber.up(),
            jump: seconds == 0.0,
            jump_held: true,
            // An earlier grip would hold the skin that the climber leaves.
            grip: seconds > GRIP_AGAIN_SHARE * rises,
            ..ClimberInput::IDLE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_is_aimed_no_farther_than_it_goes() {
        let climber = ClimberConfig::colossus_climber();
        let rises = climber.ground.jump_speed / climber.gravity.length();
        let far = 2.0 * rises * climber.ground.walk_speed;
        let aim = |to: DVec3| Aim::at(&climber, DVec3::ZERO, to);
        let level = aim(DVec3::X * 0.5 * far).unwrap();
        assert!((level.walk - DVec3::X * 0.5).length() < 1e-12);
        assert!((level.seconds - 2.0 * rises).abs() < 1e-12);
        assert!(aim(DVec3::X * 0.999 * far).is_some());
        assert!(aim(DVec3::X * 1.001 * far).is_none());
        assert!(aim(DVec3::X * 1.001 * far - DVec3::Y * 0.1).is_some());
        let high = 0.5 * climber.ground.jump_speed * rises;
        let hands = climber.ledge.unwrap().reach_up + climber.body.radius;
        assert!(aim(DVec3::Y * (high + hands - 1e-6)).is_some());
        assert!(aim(DVec3::Y * (high + hands + 1e-6)).is_none());
    }

    #[test]
    fn without_gravity_or_a_jump_nobody_leaps() {
        let mut climber = ClimberConfig::colossus_climber();
        for gravity in [0.0, 1e-9, 0.9] {
            climber.gravity = DVec3::Y * -gravity;
            assert!(Aim::at(&climber, DVec3::ZERO, DVec3::X).is_none());
        }
        let mut climber = ClimberConfig::colossus_climber();
        climber.ground.walk_speed = 0.0;
        assert!(Aim::at(&climber, DVec3::ZERO, DVec3::X).is_none());
    }
}
