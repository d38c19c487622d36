//! Updates the senses of a creature from its surroundings. A step does this before the brain decides, so that all
//! senses are one tick old.

use clamber_animation::rig::JointId;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::hurt::Felt;
use super::state::is_far;
use super::{Creature, Noise, Person, Surroundings};
use crate::angle::nearest_turn;
use crate::feet::Carried;
use crate::senses::{RegionSense, Sense, Senses};

/// Half of the horizontal field of view: the largest bearing from the creature's heading, radians.
const FIELD_OF_VIEW: f64 = 1.8;

/// Interval between looks for people, and between measurements of the distance to a wall in one direction, in ticks.
const LOOK_INTERVAL: u64 = 4;

/// Time for which a rider may leave the skin without ending the ride, seconds: a leap, a stumble.
const LONGEST_LEAP: f64 = 0.6;

/// Size of the area under a foot, relative to the sole.
const UNDERFOOT_RATIO: f64 = 1.2;

/// Distance that stands for no wall in reach, because JSON has no infinity.
const NO_WALL: f32 = f32::MAX;

/// Number of directions in which walls are measured.
const WALL_DIRECTIONS: usize = 8;

/// Knowledge from the senses that a creature keeps beyond the tick.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Perceived {
    /// Id of the last visible prey, and where it was seen last.
    prey: Option<(u64, DVec3)>,
    /// Ticks since the prey was last visible.
    unseen: u32,
    /// Place of the last noise.
    noise: DVec3,
    rides: Vec<Ride>,
    /// Distances to walls around the creature, metres. The directions are measured in turn.
    walls: [f32; WALL_DIRECTIONS],
}

/// The time that a person has been on the creature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Ride {
    person: u64,
    ticks: u32,
    joint: u32,
    /// Ticks since the person was last on the creature. A short leap does not end a ride.
    off: u32,
}

impl Perceived {
    /// No prey, riders or walls. The last noise was at `place`.
    pub(super) fn nothing(place: DVec3) -> Self {
        Self {
            prey: None,
            unseen: u32::MAX,
            noise: place,
            rides: Vec::new(),
            walls: [NO_WALL; WALL_DIRECTIONS],
        }
    }

    /// The same prey and noise, without riders and walls.
    pub(super) fn elsewhere(&self) -> Self {
        Self {
            rides: Vec::new(),
            walls: [NO_WALL; WALL_DIRECTIONS],
            ..*self
        }
    }

    /// Where the prey was seen last.
    pub(super) fn prey(&self) -> Option<DVec3> {
        self.prey.map(|(_, place)| place)
    }

    /// Place of the prey that is visible in this tick.
    pub(super) fn visible_prey(&self) -> Option<DVec3> {
        self.prey().filter(|_| self.unseen == 0)
    }

    /// Place of the last noise.
    pub(super) fn noise(&self) -> DVec3 {
        self.noise
    }

    /// The person that has been on the creature for the longest time.
    pub(super) fn longest_rider(&self) -> Option<u64> {
        let longest = self.rides.iter().max_by_key(|ride| ride.ticks);
        longest.map(|ride| ride.person)
    }

    /// Direction of the nearest wall for a heading, radians about Y, and its distance, metres. `None` if no wall is in
    /// reach.
    pub(super) fn nearest_wall(&self, yaw: f64) -> Option<(f64, f64)> {
        let walls = self.walls.iter().enumerate();
        let (index, distance) = walls.min_by(|a, b| a.1.total_cmp(b.1))?;
        (*distance < NO_WALL).then(|| (wall_direction(yaw, index), f64::from(*distance)))
    }

    /// Moves the known places with the ground that carries the creature. They may be far away: the ground's yaw turns
    /// them, but not its pitch and roll.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        self.noise = carried.level_place(self.noise);
        if let Some((_, place)) = &mut self.prey {
            *place = carried.level_place(*place);
        }
    }

    /// True if the distances to walls are numbers, and not negative.
    pub(super) fn has_valid_walls(&self) -> bool {
        let is_wall = |wall: &f32| (0.0..=f32::MAX).contains(wall);
        self.walls.iter().all(is_wall)
    }

    /// True if all places are numbers that a creature reaches.
    pub(super) fn is_within_range(&self) -> bool {
        !is_far(self.noise) && !self.prey().is_some_and(is_far)
    }
}

/// Direction in which a wall is measured, radians about Y, for a heading.
fn wall_direction(yaw: f64, index: usize) -> f64 {
    yaw + index as f64 * core::f64::consts::TAU / WALL_DIRECTIONS as f64
}

impl Creature {
    /// Updates all senses. A sleeping creature sees nothing, but feels and hears.
    pub(super) fn feel(&mut self, around: &Surroundings<'_>) {
        let mut senses = std::mem::take(&mut self.state.senses);
        senses.forget();
        self.feel_riders(around.people, &mut senses);
        self.feel_wounds(&mut senses);
        if !self.state.clock.is_asleep() {
            self.see(around, &mut senses);
            self.feel_walls(around, &mut senses);
        } else {
            let perceived = &mut self.state.perceived;
            perceived.unseen = perceived.unseen.saturating_add(1);
        }
        self.hear(around, &mut senses);
        let home = self.state.territory.home() - self.state.position();
        senses.set(
            Sense::HomeDistance,
            DVec3::new(home.x, 0.0, home.z).length(),
        );
        self.state.senses = senses;
    }

    fn feel_riders(&mut self, people: &[Person], senses: &mut Senses) {
        let tick = self.kind.brain().tick();
        let leap = (LONGEST_LEAP / tick).round() as u32;
        let origin = self.state.position();
        let mut rides = std::mem::take(&mut self.state.perceived.rides);
        for ride in rides.iter_mut() {
            ride.off = ride.off.saturating_add(1);
            ride.ticks = ride.ticks.saturating_add(1);
        }
        let (mut highest, mut hanging) = (f64::NEG_INFINITY, 0.0);
        for person in people {
            let Some(riding) = person.riding else {
                continue;
            };
            let Some(JointId(joint)) = self.joint_at(&riding.at) else {
                continue;
            };
            highest = highest.max(person.middle().y - origin.y);
            hanging += f64::from(riding.hangs);
            match rides.iter_mut().find(|ride| ride.person == person.id) {
                Some(ride) => (ride.joint, ride.off) = (joint, 0),
                None => rides.push(Ride {
                    person: person.id,
                    ticks: 0,
                    joint,
                    off: 0,
                }),
            }
        }
        // A ride ends when the person has been off the skin for too long, or no longer exists.
        let is_there = |ride: &Ride| people.iter().any(|person| person.id == ride.person);
        rides.retain(|ride| ride.off <= leap && is_there(ride));
        let seconds = |ticks: u32| f64::from(ticks) * tick;
        let longest = rides.iter().map(|ride| ride.ticks).max();
        senses.set(Sense::Riders, rides.len() as f64);
        senses.set(Sense::RiderSeconds, longest.map_or(0.0, seconds));
        senses.set(Sense::RidersHanging, hanging);
        senses.set(
            Sense::RiderHeight,
            if highest.is_finite() { highest } else { 0.0 },
        );
        for region in 0..self.kind.brain().regions().len() {
            let here = |ride: &&Ride| self.kind.is_in_region(JointId(ride.joint), region);
            let here = rides.iter().filter(here);
            let longest = here.clone().map(|ride| ride.ticks).max();
            senses.set_in_region(RegionSense::Riders, region, here.count() as f64);
            senses.set_in_region(
                RegionSense::RiderSeconds,
                region,
                longest.map_or(0.0, seconds),
            );
        }
        self.state.perceived.rides = rides;
    }

    fn feel_wounds(&mut self, senses: &mut Senses) {
        let wounds = self.state.damage.take_wounds();
        let damage =
            |wounds: &mut dyn Iterator<Item = &Felt>| wounds.map(|felt| felt.damage).sum::<f64>();
        senses.set(Sense::Struck, wounds.len() as f64);
        senses.set(Sense::Hurt, damage(&mut wounds.iter()));
        for region in 0..self.kind.brain().regions().len() {
            let here = |felt: &&Felt| self.kind.is_in_region(JointId(felt.joint), region);
            let felt = || wounds.iter().filter(here);
            senses.set_in_region(RegionSense::Struck, region, felt().count() as f64);
            senses.set_in_region(RegionSense::Hurt, region, damage(&mut felt()));
        }
        senses.set(Sense::Health, self.health());
        let staggered = self.state.damage.take_staggered();
        senses.set(Sense::Staggered, f64::from(staggered));
        let whole = self.state.damage.whole_plates();
        senses.set(Sense::Plates, whole as f64);
        let points = self.state.hit_points().iter();
        let count = points.filter(|hit_points| **hit_points > 0.0).count();
        senses.set(Sense::WeakPoints, count as f64);
    }

    /// Looks for prey: the nearest person that does not ride, is in the field of view, and is not hidden by terrain.
    fn see(&mut self, around: &Surroundings<'_>, senses: &mut Senses) {
        let eye = self.eye();
        let perceived = &self.state.perceived;
        let is_prey = |person: &Person| {
            let prey = perceived.prey.map(|(id, _)| id);
            prey == Some(person.id) && person.riding.is_none() && person.body.is_valid()
        };
        // When the visible prey begins to ride or disappears, look for other people at once.
        let has_prey = perceived.visible_prey().is_some();
        let is_lost = has_prey && !around.people.iter().any(is_prey);
        let looks = is_lost || self.state.ticks().is_multiple_of(LOOK_INTERVAL);
        let mut nearest: Option<(f64, u64, DVec3)> = None;
        let mut underfoot = 0;
        for person in around.people {
            let middle = person.middle();
            if person.riding.is_some() || !person.body.is_valid() {
                continue;
            }
            underfoot += usize::from(self.is_underfoot(middle));
            let way = middle - self.state.position();
            let level = DVec3::new(way.x, 0.0, way.z);
            let distance = level.length();
            if distance > self.config.sight || nearest.is_some_and(|(other, ..)| distance >= other)
            {
                continue;
            }
            // A person right below the creature is felt rather than seen.
            let is_near = distance < self.size.girth;
            let is_ahead = self.bearing(middle).abs() < FIELD_OF_VIEW;
            // Between two looks, visible prey stays visible.
            let is_known = perceived.unseen == 0 && !looks && is_prey(person);
            if is_near || is_ahead && (is_known || looks && !around.hides(eye, person)) {
                nearest = Some((distance, person.id, middle));
            }
        }
        let seen = nearest.is_some();
        let perceived = &mut self.state.perceived;
        match nearest {
            Some((_, id, place)) => (perceived.prey, perceived.unseen) = (Some((id, place)), 0),
            None => perceived.unseen = perceived.unseen.saturating_add(1),
        }
        senses.set(Sense::PreySeen, f64::from(seen));
        senses.set(Sense::Underfoot, underfoot as f64);
        if let Some(place) = self.state.perceived.prey() {
            let way = place - self.state.position();
            senses.set(Sense::PreyDistance, DVec3::new(way.x, 0.0, way.z).length());
            senses.set(Sense::PreyBearingDeg, self.bearing(place).to_degrees());
            let unseen = f64::from(self.state.perceived.unseen) * self.kind.brain().tick();
            senses.set(Sense::PreyUnseenSeconds, unseen);
        }
    }

    fn feel_walls(&mut self, around: &Surroundings<'_>, senses: &mut Senses) {
        if self.state.ticks().is_multiple_of(LOOK_INTERVAL) {
            self.look_for_wall(around);
        }
        let walls = self.state.perceived.walls.iter().copied();
        let nearest = walls.fold(f32::INFINITY, f32::min);
        if nearest < NO_WALL {
            senses.set(Sense::WallDistance, f64::from(nearest));
        }
    }

    /// Measures the distance to a wall in the next direction.
    fn look_for_wall(&mut self, around: &Surroundings<'_>) {
        let height = self.size.height;
        let index = (self.state.ticks() / LOOK_INTERVAL % WALL_DIRECTIONS as u64) as usize;
        let angle = wall_direction(self.state.yaw(), index);
        let from = self.state.position() + DVec3::Y * (0.3 * height);
        let direction = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let hits = around
            .terrain
            .iter()
            .filter_map(|obstacle| obstacle.cast_ray(from, direction, height));
        let nearest = hits.map(|hit| hit.distance).fold(f64::INFINITY, f64::min);
        self.state.perceived.walls[index] = (nearest as f32).min(NO_WALL);
    }

    fn hear(&mut self, around: &Surroundings<'_>, senses: &mut Senses) {
        let heard = |noise: &Noise| {
            let distance = self.eye().distance(noise.place);
            let near = self.config.hearing;
            let share = if distance > near {
                near / distance
            } else {
                1.0
            };
            noise.loudness * share * share
        };
        let known = around.noises.iter().filter(|noise| noise.place.is_finite());
        let loudest = known.map(|noise| (heard(noise), noise));
        let loudest = loudest.max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((loudness, noise)) = loudest else {
            return;
        };
        self.state.perceived.noise = noise.place;
        senses.set(Sense::Noise, loudness);
        senses.set(
            Sense::NoiseBearingDeg,
            self.bearing(noise.place).to_degrees(),
        );
    }

    /// Bearing of a place, radians: 0 ahead, positive to the left.
    pub(super) fn bearing(&self, place: DVec3) -> f64 {
        let way = place - self.state.position();
        nearest_turn(libm::atan2(way.x, way.z) - self.state.yaw())
    }

    /// Position of the eye, in world space.
    pub(super) fn eye(&self) -> DVec3 {
        let world = self.surface.world_from_model();
        let frame = |joint| self.palette.model_from_joint(joint).copied();
        world.transform_point(self.kind.eye_in(frame))
    }

    fn is_underfoot(&self, place: DVec3) -> bool {
        let world = self.surface.world_from_model();
        self.kind.legs().iter().any(|leg| {
            let Some(ball) = self.palette.model_from_joint(leg.ball) else {
                return false;
            };
            let at = world.inverse_transform_point(place) - leg.ball_in(ball);
            let [low, high] = [
                leg.sole.corners[0] * UNDERFOOT_RATIO,
                leg.sole.corners[3] * UNDERFOOT_RATIO,
            ];
            at.y < 0.2 * leg.length
                && (low.x..=high.x).contains(&at.x)
                && (low.z..=high.z).contains(&at.z)
        })
    }
}
