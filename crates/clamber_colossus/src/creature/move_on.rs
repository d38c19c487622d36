//! Where a creature goes: walking, turning, and the height of the ground that it walks on.

use clamber_animation::AnimationEvent;
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::DVec3;

use super::hips::approach;
use super::legs::at_once;
use super::state::{Detour, GROUND, NO_GROUND, NO_WALL, Playing, WALLS};
use super::{Creature, CreatureEvent, CreatureState, Surroundings};
use crate::angle::nearest_turn;
use crate::brain::{Act, Place, Walk};
use crate::error::ColossusError;
use crate::feet::{GRAVITY, Ground, STEP_TIME};
use crate::kind::{Gait, HUMAN};
use crate::senses::Sense;

/// How fast its speed changes, metres a second squared, and a giant's turning, radians a second squared: 0.5 g is the
/// most that its limbs may start with, and riders stand on them. Smaller ones turn sharper, by their height.
const SPEEDS_UP: f64 = 1.2;
const SLOWS_DOWN: f64 = 2.0;
const HALTS: f64 = 6.0;
const TURNS: f64 = 0.12;

/// How fast a giant steers towards a goal, radians a second for each radian that it is aside.
const STEERS: f64 = 0.8;

/// It turns to within this angle at best, radians.
const LEAST_WITHIN: f64 = 0.003;

/// How far the body turns away from a foot before that steps, as a share of the leg's length, when it turns on the spot
/// by steps alone.
const TURNS_BY_STEP: f64 = 0.4;

/// The slowest walk, as a share of its speed.
const SLOWEST: f64 = 0.35;

/// How much shorter its steps are where it goes up and down: on a slope of 45 degrees, by one over one and this.
const CAREFUL: f64 = 1.2;

/// Time constant with which a giant takes the ground ahead into account, seconds.
const LOOKS_AHEAD: f64 = 1.0;

/// It looks for what is in its way in one of so many ticks.
const LOOKS: u64 = 8;

/// A way that is no further aside than this is straight ahead, radians; and what is no higher than this share of its
/// height it steps over.
const STRAIGHT: f64 = 0.15;
const STEPS_OVER: f64 = 0.06;

/// It turns on the spot first if its goal is further aside than this, radians; and walks on if it is nearer.
const TURN_FIRST: f64 = 1.2;
const WALK_ON: f64 = 0.5;

/// The largest vertical acceleration from following the ground, metres a second squared.
const CLIMBS: f64 = 0.5;

/// Seconds in which one clip of the gait fades into another, for a creature of a human's height. Larger ones take
/// longer, by the square root of their height (Froude's law).
const FADE: f64 = 0.35;

/// Where to go, and how.
pub(super) struct Way {
    goal: DVec3,
    /// Bearing that the goal should have in the end, radians; `None` if any will do.
    bearing: Option<f64>,
    /// Level distance at which it has arrived, metres.
    within: f64,
    /// Angle within which it has turned, radians.
    within_angle: f64,
    walks: bool,
}

/// Where a creature is, and how it moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    pub(super) position: DVec3,
    pub(super) yaw: f64,
    /// Along its heading, metres a second, and radians a second to the left.
    pub(super) speed: f64,
    pub(super) yaw_rate: f64,
    /// True while it turns on the spot, and while it stops abruptly.
    turning: bool,
    halts: bool,
}

impl Course {
    pub(super) fn of(state: &CreatureState) -> Self {
        Self {
            position: state.position,
            yaw: state.yaw,
            speed: state.speed,
            yaw_rate: state.yaw_rate,
            turning: matches!(state.playing, Playing::Turn(_)),
            halts: state.halts,
        }
    }
}

/// What a creature wants of its course.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wanted {
    speed: f64,
    turn: f64,
    /// How far its goal is aside of its heading, radians.
    aside: f64,
    arrived: bool,
    turns_on_spot: bool,
    /// True if it walks, and looks whether its way is free.
    is_free: bool,
}

impl Creature {
    /// Begins a walk or a turn: draws a place, if it goes on patrol.
    pub(super) fn begin_way(&mut self) {
        let reach = self.config.arena.min(4.0 * self.size.height);
        let mut lot = || (self.state.brain.draw() >> 11) as f64 / (1u64 << 53) as f64;
        let (angle, share) = (core::f64::consts::TAU * lot(), lot().sqrt());
        let aside = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        self.state.detour = Detour::None;
        self.state.patrol = self.state.home + aside * (0.9 * reach * share);
    }

    /// Lets clips and the creature's place move on by a tick, and says whether the act is done.
    pub(super) fn move_on(
        &mut self,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<(), ColossusError> {
        let state = self.state.brain.current();
        let way = self.way(state);
        let begun = self.state.acting == Some(state);
        let mut done = false;
        let kind = std::sync::Arc::clone(&self.kind);
        if let Some(gait) = kind.gait() {
            let way = way.filter(|_| begun);
            done = self.walk(gait, way.as_ref(), around, dt)?;
        }
        self.events.clear();
        let moved = self
            .state
            .animator
            .advance(kind.clips(), dt, &mut self.events)?;
        self.state.passed.clear();
        for event in &self.events {
            if let AnimationEvent::Marker {
                layer: 0,
                clip,
                marker,
            } = event
            {
                self.state.passed.push([clip.0, *marker as u32]);
                let name = kind.clips().clip(*clip)?.markers()[*marker].name.clone();
                self.report.events.push(CreatureEvent::Marker { name });
            }
        }
        let scale = self.size.scale;
        let rotation = self.state.world_from_model(scale).rotation;
        self.state.position += rotation * moved.translation * scale;
        self.state.yaw = nearest_turn(self.state.yaw + moved.yaw + self.state.yaw_rate * dt);
        self.state.position += self.state.heading() * (self.state.speed * dt);
        self.follow_ground(around, dt);
        let is_over = match kind.brain().act(state) {
            Some(Act::Walk(_) | Act::Turn(_)) => done,
            Some(Act::Once(_) | Act::Attack(_)) => begun && self.clip_is_over(),
            Some(Act::Play(_) | Act::Sleep) => false,
            None => true,
        };
        self.state
            .senses
            .set(Sense::Done, f64::from(u8::from(is_over)));
        Ok(())
    }

    fn clip_is_over(&self) -> bool {
        let layer = self.state.animator.layers().first();
        layer.is_none_or(|layer| {
            let clip = self.kind.clips().clip(layer.clip);
            clip.is_ok_and(|clip| layer.time >= clip.duration())
        })
    }

    pub(super) fn way(&self, state: crate::brain::StateId) -> Option<Way> {
        match self.kind.brain().act(state)? {
            Act::Walk(Walk { to, within, .. }) => {
                let goal = self.within_arena(self.place_of(*to));
                let Some(strike) = &self.kind.act(state).strike else {
                    return Some(Way {
                        goal,
                        bearing: None,
                        within: *within,
                        within_angle: 0.0,
                        walks: true,
                    });
                };
                let spot = strike.spot * self.size.scale;
                let reach = DVec3::new(spot.x, 0.0, spot.z).length();
                Some(Way {
                    goal,
                    bearing: Some(libm::atan2(spot.x, spot.z)),
                    within: reach + within,
                    within_angle: (within / reach.max(1e-3)).min(0.5),
                    walks: true,
                })
            }
            Act::Turn(turn) => Some(Way {
                goal: self.place_of(turn.to),
                bearing: Some(0.0),
                within: f64::INFINITY,
                within_angle: turn.within_deg.to_radians(),
                walks: false,
            }),
            _ => None,
        }
    }

    fn place_of(&self, place: Place) -> DVec3 {
        match place {
            Place::Prey => self.state.prey.map_or(self.state.home, |(_, place)| place),
            Place::Home => self.state.home,
            Place::Patrol => self.state.patrol,
            Place::Noise => self.state.noise,
            Place::Wall => self.wall(),
        }
    }

    /// Beside the nearest wall.
    fn wall(&self) -> DVec3 {
        let walls = self.state.walls.iter().enumerate();
        let Some((index, distance)) = walls.min_by(|a, b| a.1.total_cmp(b.1)) else {
            return self.state.position;
        };
        if *distance >= NO_WALL {
            return self.state.position;
        }
        let angle = self.state.yaw + index as f64 * core::f64::consts::TAU / WALLS as f64;
        let direction = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let room = self.size.girth;
        self.state.position + direction * (f64::from(*distance) - room).max(0.0)
    }

    fn within_arena(&self, place: DVec3) -> DVec3 {
        let way = place - self.state.home;
        let level = DVec3::new(way.x, 0.0, way.z).length();
        if level <= self.config.arena {
            return place;
        }
        self.state.home + way * (self.config.arena / level)
    }

    /// Walks or turns towards a goal, or comes to a stand without one. Returns true if it is there.
    fn walk(
        &mut self,
        gait: &Gait,
        way: Option<&Way>,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> Result<bool, ColossusError> {
        let course = Course::of(&self.state);
        let mut wanted = self.wanted(gait, way, &course);
        if wanted.is_free && self.state.ticks.is_multiple_of(LOOKS) {
            self.state.detour = match self.free_way(around, wanted.aside) {
                Some(way) if way == wanted.aside => Detour::None,
                Some(way) => Detour::By(way),
                None => Detour::Blocked,
            };
            wanted = self.wanted(gait, way, &course);
        }
        let Wanted {
            turn,
            arrived,
            turns_on_spot,
            ..
        } = wanted;
        let moved = self.moved(gait, &wanted, course, dt);
        (self.state.speed, self.state.yaw_rate) = (moved.speed, moved.yaw_rate);
        self.state.halts = moved.halts;
        let (rate, stride) = (self.size.rate, self.stride());
        let full = self.full_speed(gait);
        let moves = self.state.speed > 0.0 && !self.state.halts;
        let acts = matches!(self.state.playing, Playing::Act(_)) && way.is_none();
        let playing = if moves {
            Playing::Walk
        } else if turns_on_spot && gait.turn.is_some() {
            Playing::Turn(u8::from(turn < 0.0))
        } else if acts {
            self.state.playing
        } else {
            Playing::Idle
        };
        let clip_speed = match playing {
            Playing::Walk => self.state.speed / (full * stride),
            Playing::Turn(_) => (self.state.yaw_rate.abs() / (gait.turn_rate * rate)).min(1.0),
            Playing::Idle | Playing::Act(_) => 1.0,
        };
        let size = (self.size.height / HUMAN).max(1e-4).sqrt();
        self.play(playing, clip_speed, FADE * size)?;
        if let Some(layer) = self.state.animator.layers_mut().first_mut()
            && !matches!(playing, Playing::Act(_))
        {
            layer.speed = clip_speed;
        }
        let slow = 0.3 * self.size.pace * self.turns();
        let stands = self.state.speed == 0.0 && self.state.yaw_rate.abs() < slow;
        Ok(arrived && stands)
    }

    /// Its walking speed, metres a second.
    pub(super) fn full_speed(&self, gait: &Gait) -> f64 {
        gait.speed * self.size.scale * self.size.rate
    }

    /// How fast its turning changes, radians a second squared.
    fn turns(&self) -> f64 {
        TURNS / (self.size.pace * self.size.pace).max(1e-6)
    }

    /// How fast it wants to walk and turn, as far as it knows its way.
    pub(super) fn wanted(&self, gait: &Gait, way: Option<&Way>, course: &Course) -> Wanted {
        let mut wanted = Wanted::default();
        let Some(way) = way else { return wanted };
        let rate = self.size.rate;
        let full = self.full_speed(gait);
        let stride = self.stride();
        // Steps are shorter, and take longer.
        let careful = full * stride * stride;
        // Clips and their rates are slower in a larger creature already.
        let steers = STEERS / (self.size.pace * rate).max(1e-3);
        let to = (way.goal - course.position).with_y(0.0);
        let distance = to.length();
        let ahead = nearest_turn(libm::atan2(to.x, to.z) - course.yaw);
        let is_near = !way.walks || distance <= way.within;
        let bearing = way.bearing.filter(|_| is_near).unwrap_or(0.0);
        let aside = nearest_turn(ahead - bearing);
        wanted.aside = aside;
        let within = way.within_angle.max(LEAST_WITHIN);
        let is_turned = way.bearing.is_none() || aside.abs() <= within;
        if is_near {
            wanted.arrived = is_turned;
            wanted.turns_on_spot = !is_turned;
        } else {
            wanted.turns_on_spot = aside.abs() > if course.turning { WALK_ON } else { TURN_FIRST };
            wanted.is_free = !wanted.turns_on_spot;
        }
        if wanted.is_free {
            let braked = (2.0 * 0.7 * SLOWS_DOWN * (distance - way.within).max(0.0)).sqrt();
            wanted.speed = careful.min(braked).max(SLOWEST * careful);
            let steer =
                |aside: f64| (aside * steers).clamp(-gait.steer_rate, gait.steer_rate) * rate;
            wanted.turn = match self.state.detour {
                Detour::None => steer(aside),
                Detour::By(way) => steer(way),
                Detour::Blocked => 0.0,
            };
            if self.state.detour == Detour::Blocked {
                (wanted.speed, wanted.arrived) = (0.0, true);
            }
        }
        if wanted.turns_on_spot {
            let stoppable = |angle: f64| (2.0 * 0.7 * self.turns() * angle.max(0.0)).sqrt();
            // It gets there in the end, and no faster than it can stop there.
            let braked = stoppable(aside.abs() - 0.5 * within).max(0.5 * stoppable(0.5 * within));
            wanted.turn = aside.signum() * braked.min(self.most_turn(gait));
            // Not before it stands.
            if course.speed > SLOWEST * full {
                wanted.turn = 0.0;
            }
        }
        wanted
    }

    /// Its course `dt` seconds later, if it tries to do what is wanted. Speeds change; its place does not.
    pub(super) fn moved(&self, gait: &Gait, wanted: &Wanted, course: Course, dt: f64) -> Course {
        let mut moved = course;
        let change = wanted.speed - course.speed;
        let slows_down = if course.halts { HALTS } else { SLOWS_DOWN };
        moved.speed += change.clamp(-slows_down * dt, SPEEDS_UP * dt);
        moved.halts &= moved.speed > 0.0;
        if wanted.speed > 0.0 {
            // A foot that hardly moves is no walk: the first step already has some speed.
            moved.speed = moved.speed.max(0.02 * self.full_speed(gait));
        }
        let change = wanted.turn - course.yaw_rate;
        moved.yaw_rate += change.clamp(-self.turns() * dt, self.turns() * dt);
        moved
    }

    /// How fast the clip of its gait is played at a course.
    pub(super) fn clip_speed(&self, gait: &Gait, course: &Course) -> f64 {
        match self.state.playing {
            Playing::Walk => course.speed / (self.full_speed(gait) * self.stride()),
            Playing::Turn(_) => {
                (course.yaw_rate.abs() / (gait.turn_rate * self.size.rate)).min(1.0)
            }
            Playing::Idle | Playing::Act(_) => 1.0,
        }
    }

    /// How fast it turns on the spot, radians a second: as its file says, but without a clip for it no faster than its
    /// feet can follow by steps of their own.
    fn most_turn(&self, gait: &Gait) -> f64 {
        let most = gait.turn_rate * self.size.rate;
        let legs = self.kind.legs();
        if gait.turn.is_some() || legs.is_empty() {
            return most;
        }
        let rounds = legs.len().div_ceil(at_once(legs.len())) as f64;
        let by_steps = legs.iter().map(|leg| {
            let radius = leg.stands_at.with_y(0.0).length().max(0.1 * leg.length);
            let time = STEP_TIME * (leg.length * self.size.scale / GRAVITY).sqrt();
            TURNS_BY_STEP * leg.length / (radius * rounds * time)
        });
        by_steps.fold(most, f64::min)
    }

    /// The direction to walk in, radians from its heading, for one that it wants: that one if it is free, straight on
    /// while only that is, or else the free one that is nearest to it; `None` if there is none.
    fn free_way(&self, around: &Surroundings<'_>, wanted: f64) -> Option<f64> {
        if self.is_free(around, 0.0) {
            let is_free = wanted.abs() < STRAIGHT || self.is_free(around, wanted.clamp(-0.7, 0.7));
            return Some(if is_free { wanted } else { 0.0 });
        }
        let side = if wanted < 0.0 { -1.0 } else { 1.0 };
        [0.6, -0.6, 1.2, -1.2]
            .map(|angle| angle * side)
            .into_iter()
            .find(|angle| self.is_free(around, *angle))
    }

    /// False if in a direction from its heading the ground is too steep, or there is none, or a wall stands there.
    fn is_free(&self, around: &Surroundings<'_>, angle: f64) -> bool {
        let height = self.size.height;
        let girth = self.size.girth;
        let ground = Ground {
            terrain: around.terrain,
            reach: 0.5 * height,
        };
        let direction = rotation_from_axis_angle(DVec3::Y, angle) * self.state.heading();
        // As far ahead as it takes to come to a stand.
        let brake = self.state.speed * self.state.speed / (2.0 * SLOWS_DOWN);
        let ahead = self.state.position + direction * (girth + brake);
        let Some((level, normal)) = ground.below(ahead) else {
            return false;
        };
        let from = self.state.position + DVec3::Y * (0.3 * height);
        let reach = 1.2 * girth + brake;
        let is_wall = around
            .terrain
            .iter()
            .any(|obstacle| obstacle.cast_ray(from, direction, reach).is_some());
        // What it can step over is no slope.
        let rise = (level - self.state.position.y).abs();
        let is_steep = normal.y < libm::cos(self.config.most_slope) && rise > STEPS_OVER * height;
        !is_wall && !is_steep
    }

    /// How long its steps are, as a share of those of its clip.
    pub(super) fn stride(&self) -> f64 {
        1.0 / (1.0 + CAREFUL * self.state.steepness)
    }

    /// Lets the model's origin follow the ground below it, as softly as riders want it.
    fn follow_ground(&mut self, around: &Surroundings<'_>, dt: f64) {
        let height = self.size.height;
        let ground = Ground {
            terrain: around.terrain,
            reach: 0.5 * height,
        };
        let heading = self.state.heading();
        let spacing = 0.07 * height;
        let aside = DVec3::new(heading.z, 0.0, -heading.x) * spacing;
        // One place in each tick, and all of them in the first one.
        let is_first = self.state.ticks <= 1;
        let turn = (self.state.ticks % GROUND as u64) as usize;
        for index in (0..GROUND).filter(|index| is_first || *index == turn) {
            let place = match index {
                7 => aside,
                8 => -aside,
                step => heading * ((step as f64 - 3.0) * spacing),
            };
            let level = ground.below(self.state.position + place);
            self.state.ground[index] = level.map_or(NO_GROUND, |(level, _)| level);
        }
        // The mean over what it walks on within a step or two: a step in the ground becomes a ramp.
        let known =
            |index: usize| Some(self.state.ground[index]).filter(|level| *level < NO_GROUND);
        let (mut sum, mut count, mut steepest) = (0.0, 0.0, 0f64);
        for index in 0..7 {
            let Some(level) = known(index) else { continue };
            (sum, count) = (sum + level, count + 1.0);
            if let Some(before) = index.checked_sub(1).filter(|_| index >= 3).and_then(known) {
                steepest = steepest.max((level - before).abs() / spacing);
            }
        }
        if count == 0.0 {
            return;
        }
        if let [Some(left), Some(right)] = [7, 8].map(known) {
            steepest = steepest.max((left - right).abs() / (2.0 * spacing));
        }
        // Gradually, since a stride depends on it.
        let share = 1.0 - libm::exp(-dt / (LOOKS_AHEAD * self.size.pace.max(1e-3)));
        self.state.steepness += (steepest - self.state.steepness) * share;
        if is_first {
            // It has just been put there.
            self.state.position.y = sum / count;
            self.state.steepness = steepest;
        }
        let (height, climb) = approach(
            self.state.position.y,
            self.state.climb,
            sum / count,
            CLIMBS,
            dt,
        );
        (self.state.position.y, self.state.climb) = (height, climb);
    }
}
