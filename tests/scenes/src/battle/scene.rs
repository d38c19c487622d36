use std::time::Instant;

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberState, ContactQuery, GripConfig,
    StepReport,
};
use clamber_fight::{Arena, ArenaEvent, CreatureId, creature_obstacle};
use clamber_navigation::{Bot, Goal};
use clamber_surface::rig::Palette;
use clamber_surface::surface::{Diagnostics, SkinnedSurface};
use clamber_world::rapier3d::dynamics::RigidBodySet;
use clamber_world::rapier3d::geometry::{Collider, ColliderHandle};
use clamber_world::rapier3d::pipeline::PhysicsWorld;
use clamber_world::{BodyPoses, Contact, MaterialPoint, Obstacle, ObstacleId, RapierTerrain};
use glam::DVec3;

use super::bot::{Intent, Rider, RiderScene};
use super::checks::{Watch, Watched};
use super::faults::Moment;
use super::grips::Grips;
use super::planner::Planner;
use super::rockfall::Rockfall;
use super::{
    BattleError, BattleOptions, BattleSnapshot, Performer, Recording, Sample, Story, Tally, outcrop,
};
use crate::{Creature, valley};

/// Length of a tick, seconds.
pub const TICK: f64 = 1.0 / 60.0;

/// The valley's obstacle id.
pub const TERRAIN: ObstacleId = ObstacleId(0);

/// The creature's obstacle id.
pub const CREATURE: ObstacleId = creature_obstacle(CreatureId(0));

/// Height above the perch from which the climber is first dropped, metres.
const DROP: f64 = 2.0;

/// Height above the skin from which the climber is dropped again, metres. Small, since a moving creature soon carries
/// its back away from under the climber.
const DROP_AGAIN: f64 = 0.1;

/// Height above the perch from which rocks fall, as a share of the creature's height.
const ROCKS_ABOVE: f64 = 0.5;

/// Ticks on the ground after which a rider is dropped on the creature again.
const GROUNDED_TICKS: u32 = 60;

/// Distance from the outcrop's wall at which a climb begins, and the largest offset to either side, metres.
const RUN_UP: f64 = 4.0;
const ASIDE: f64 = 1.5;

/// The running scene.
pub struct Battle<'a> {
    performer: Performer<'a>,
    world: PhysicsWorld,
    before: BodyPoses,
    rocks: Rockfall,
    grips: Grips,
    /// The point above which the climber is dropped to ride, and from above which rocks fall.
    perch: MaterialPoint,
    /// The script of a ride.
    rider: Rider,
    /// Who drives a climb; `None` in a ride.
    pilot: Option<Box<Planner>>,
    height: f64,
    tick: u64,
    grounded: u32,
    /// The climber began the tick faster than it walks, as after a landing: friction slows it down, and it leaves its
    /// material point.
    slides: bool,
    drops: u32,
    landings: u32,
    deaths: u32,
    seed: u64,
    input: ClimberInput,
    tally: Tally,
    recording: Recording,
    watch: Watch,
    rocks_fingerprint: u64,
}

impl<'a> Battle<'a> {
    /// A battle before its first tick: a creature in the valley, a climber in front of an outcrop or above the
    /// creature's back, and rocks above the back.
    ///
    /// # Errors
    /// [`BattleError::NoHeight`], [`BattleError::NoPerch`], [`BattleError::NoWay`] in a climb,
    /// [`BattleError::Outcrop`], and the errors of the creature, the climber and the debris.
    pub fn new(creature: &'a Creature, options: &BattleOptions) -> Result<Self, BattleError> {
        let (height, seed, story) = (options.height(), options.seed, options.story());
        let mut performer = Performer::new(creature, options)?;
        let perch =
            find_perch(performer.surface(), height, seed).ok_or_else(|| BattleError::NoPerch {
                creature: creature.name.clone(),
            })?;
        let life = performer.life();
        let living = life.map(|life| creature.as_it_lives(life.kind()));
        let living = living.as_ref().unwrap_or(creature);
        let mut world = valley::world();
        let (climber, pilot) = match story {
            Story::Climb => {
                outcrop::insert(&mut world)?;
                let climber = climber_before_the_outcrop(seed)?;
                let plates = performer.plates();
                let rate = performer.life().map_or(1.0, |life| life.rate());
                let graph = living.graph(climber.config(), height, rate, &plates)?;
                let planner = Planner::new(&performer, graph)?;
                (climber, Some(Box::new(planner)))
            }
            Story::Ride => (rider_above(perch.point, DROP)?, None),
        };
        performer.enter(*climber.config(), climber.state().position)?;
        let above = perch.point + DVec3::Y * (ROCKS_ABOVE * height);
        let rocks = Rockfall::new(&mut world, options.rocks as usize, seed, above, height)?;
        Ok(Self {
            rocks_fingerprint: rocks.fingerprint(&world.bodies),
            performer,
            world,
            before: BodyPoses::default(),
            rocks,
            grips: Grips::of(living),
            perch: perch.material,
            drops: u32::from(pilot.is_none()),
            rider: Rider::new(),
            pilot,
            height,
            tick: 0,
            grounded: 0,
            slides: false,
            landings: 0,
            deaths: 0,
            seed,
            input: ClimberInput::default(),
            tally: Tally::default(),
            recording: Recording::default(),
            watch: Watch::default(),
        })
    }

    /// Runs one tick, with the climber's input from the bot or the script of a ride.
    ///
    /// # Errors
    /// [`BattleError`] if a clip does not fit the creature.
    pub fn step(&mut self, intent: Intent) -> Result<(), BattleError> {
        let start = Instant::now();
        self.performer.advance()?;
        let seconds = self.tick as f64 * TICK;
        let climber = self.performer.climber();
        let input = match &mut self.pilot {
            Some(pilot) if intent == Intent::Climb => pilot.input(&self.performer, seconds),
            _ => {
                let scene = RiderScene {
                    surface: self.performer.surface(),
                    perch: &self.perch,
                    velocity: self.performer.velocity(),
                    seconds,
                    height: self.height,
                };
                self.rider.input(intent, climber, &scene)
            }
        };
        self.step_advanced(input, start)
    }

    /// Runs one tick with a given input, such as one from a recording.
    ///
    /// # Errors
    /// [`BattleError`] if a clip does not fit the creature, or the input is not finite.
    pub fn step_with(&mut self, input: ClimberInput) -> Result<(), BattleError> {
        let start = Instant::now();
        self.performer.advance()?;
        self.step_advanced(input, start)
    }

    /// The rest of a tick that began at `start`.
    fn step_advanced(&mut self, input: ClimberInput, start: Instant) -> Result<(), BattleError> {
        let bodies = &self.world.bodies;
        let fixed = |_: ColliderHandle, collider: &Collider| is_fixed(bodies, collider);
        let terrain = RapierTerrain::of_world(&self.world, &self.before).with_filter(&fixed);
        let grips = self.grips;
        let rule = |query: &ContactQuery<'_>| {
            let grip = query.id == CREATURE && grips.can(&query.tag());
            query.usual().with_grip(grip)
        };
        let climber = self.performer.climber();
        let state = climber.state();
        let own = state.velocity - state.base_velocity;
        self.slides = own.length() > climber.config().ground.walk_speed;
        self.performer.step(&input, &terrain, &rule)?;
        let microseconds = start.elapsed().as_secs_f64() * 1e6;
        let touched = self.performer.surface().diagnostics();

        self.tick += 1;
        let perch = self.performer.surface().motion(&self.perch, TICK);
        let perch = perch.map_or(DVec3::ZERO, |perch| perch.position);
        let above = perch + DVec3::Y * (ROCKS_ABOVE * self.height);
        let moment = moment(&self.performer, self.height, self.tick);
        let faults = &mut self.watch.faults;
        self.rocks.step(&moment, &mut self.world, above, faults)?;
        self.input = input;
        self.record(touched, microseconds);
        self.lift_if_grounded()
    }

    /// What the climber touches, as it is now: terrain and creature.
    pub fn touched<T>(&self, touch: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T) -> T {
        let bodies = &self.world.bodies;
        let fixed = |_: ColliderHandle, collider: &Collider| is_fixed(bodies, collider);
        let terrain = RapierTerrain::of_world(&self.world, &self.before).with_filter(&fixed);
        touch(&[(TERRAIN, &terrain), (CREATURE, self.performer.surface())])
    }

    fn record(&mut self, touched: Diagnostics, microseconds: f64) {
        let (input, report) = (self.input, self.performer.report());
        let state = *self.performer.climber().state();
        let landed = |event: &ClimberEvent| matches!(event, ClimberEvent::Landed { .. });
        self.tally.tick(self.performer.arena());
        self.landings += report.events.iter().filter(|event| landed(event)).count() as u32;
        let idle = input == ClimberInput::default() && !self.slides;
        let palette = self.performer.palette();
        let climbs = self.pilot.is_some();
        let moment = moment(&self.performer, self.height, self.tick);
        let watched = Watched {
            climber: self.performer.climber(),
            report,
            idle,
            climbs,
        };
        let drift = self.watch.tick(&moment, palette, &watched);
        let sample = Sample {
            seconds: self.tick as f64 * TICK,
            height: state.position.y,
            mode: state.mode,
            riding: state
                .support
                .is_some_and(|support| support.attachment.obstacle == CREATURE),
            drift,
            state: self.life().map(|life| life.state().current()),
            push_out: report.pushed_out.length(),
            skinned_share: touched.vertices_skinned as f64 / touched.vertices.max(1) as f64,
            stamina: state.stamina,
            microseconds,
        };
        self.rocks_fingerprint = self.rocks.fingerprint(&self.world.bodies);
        let rocks = self.rocks_fingerprint;
        let fight = self.performer.arena().map_or(0, Arena::fingerprint);
        self.recording
            .push(sample, state.fingerprint() ^ rocks ^ fight.rotate_left(1));
    }

    /// A climber that died or is out of the valley begins again.
    fn begin_again_if_dead(&mut self) -> Result<(), BattleError> {
        let state = self.performer.climber().state();
        let begins_again = match self.performer.arena() {
            Some(arena) => {
                let rose = |event: &ArenaEvent| matches!(event, ArenaEvent::Rose { .. });
                arena.events().iter().any(rose)
            }
            None => {
                let is_lost = !valley::contains(state.position.x, state.position.z);
                is_lost || state.hit_points <= 0.0
            }
        };
        if !begins_again {
            return Ok(());
        }
        let moment = moment(&self.performer, self.height, self.tick);
        self.watch.fell(&moment, state.position);
        if self.performer.arena().is_none() {
            self.performer
                .put(*climber_before_the_outcrop(self.seed)?.state())?;
        }
        if let Some(pilot) = &mut self.pilot {
            pilot.begin_again();
        }
        self.deaths += 1;
        Ok(())
    }

    /// Drops a rider on the creature's back again if it has been on the ground for a while or is out of the valley.
    fn lift_if_grounded(&mut self) -> Result<(), BattleError> {
        if self.pilot.is_some() {
            return self.begin_again_if_dead();
        }
        let state = self.performer.climber().state();
        let on_ground = state
            .support
            .is_some_and(|support| support.attachment.obstacle == TERRAIN);
        self.grounded = if on_ground { self.grounded + 1 } else { 0 };
        let is_lost = !valley::contains(state.position.x, state.position.z);
        if self.grounded < GROUNDED_TICKS && !is_lost {
            return Ok(());
        }
        let Some(perch) = self.performer.surface().motion(&self.perch, TICK) else {
            return Ok(());
        };
        let moment = moment(&self.performer, self.height, self.tick);
        self.watch.fell(&moment, state.position);
        // Onto the skin that is uppermost there now, and at rest relative to the creature as a whole: the perch itself
        // may be moving fast, and its velocity would throw the climber away.
        let sky = perch.position + DVec3::Y * (4.0 * self.height);
        let top = self
            .performer
            .surface()
            .cast_ray(sky, -DVec3::Y, 4.0 * self.height);
        let place = top.map_or(perch.position, |top| top.point);
        let dropped = ClimberState {
            velocity: self.performer.velocity(),
            ..*rider_above(place, DROP_AGAIN)?.state()
        };
        self.performer.put(dropped)?;
        self.watch.dropped();
        self.rider.dropped();
        self.grounded = 0;
        self.drops += 1;
        Ok(())
    }

    /// The state of the battle besides the climber's state, without the rocks and the script's memory.
    pub fn snapshot(&self) -> BattleSnapshot {
        BattleSnapshot {
            tick: self.tick,
            creature: self.performer.state(),
            grounded: self.grounded,
            drops: self.drops,
            landings: self.landings,
            deaths: self.deaths,
            tally: self.tally,
        }
    }

    /// Restores a snapshot of a battle that was made with the same options, and the climber's state.
    ///
    /// Given the same inputs, creature and climber then go on with the same bits. The rocks stay where they are. The
    /// script's memory is not restored.
    ///
    /// # Errors
    /// [`BattleError`] if the climber rejects the state, or a clip does not fit the creature.
    pub fn restore(
        &mut self,
        snapshot: &BattleSnapshot,
        state: ClimberState,
    ) -> Result<(), BattleError> {
        self.performer.restore(&snapshot.creature, state)?;
        self.tick = snapshot.tick;
        self.grounded = snapshot.grounded;
        self.drops = snapshot.drops;
        self.landings = snapshot.landings;
        self.deaths = snapshot.deaths;
        self.tally = snapshot.tally;
        Ok(())
    }

    /// Number of ticks so far.
    pub fn tick(&self) -> u64 {
        self.tick
    }

    /// The climber.
    pub fn climber(&self) -> &Climber {
        self.performer.climber()
    }

    /// The creature.
    pub fn creature(&self) -> &Creature {
        self.performer.creature()
    }

    /// The creature's skin.
    pub fn surface(&self) -> &SkinnedSurface {
        self.performer.surface()
    }

    /// The creature's palette in the last tick.
    pub fn palette(&self) -> &Palette {
        self.performer.palette()
    }

    /// The climber's input in the last tick.
    pub fn input(&self) -> &ClimberInput {
        &self.input
    }

    /// The climber's report of the last tick.
    pub fn report(&self) -> &StepReport {
        self.performer.report()
    }

    /// The physics world: the valley, the outcrop in a climb, and the rocks.
    pub fn world(&self) -> &PhysicsWorld {
        &self.world
    }

    /// The rocks.
    pub fn rocks(&self) -> &Rockfall {
        &self.rocks
    }

    /// A 64-bit hash of the rocks' positions and rotations after the last tick.
    pub fn rocks_fingerprint(&self) -> u64 {
        self.rocks_fingerprint
    }

    /// A 64-bit hash of all beside the climber and the creature's pose: the rocks, and all that changes in a fight.
    pub fn scene_fingerprint(&self) -> u64 {
        let fight = self.performer.arena().map_or(0, Arena::fingerprint);
        self.rocks_fingerprint ^ fight.rotate_left(1)
    }

    /// The ticks so far.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// True if there is an outcrop in the valley: in a climb.
    pub fn has_outcrop(&self) -> bool {
        self.pilot.is_some()
    }

    /// When the climber first came to the creature's top, seconds; `None` if it has not, or in a ride.
    pub fn arrived(&self) -> Option<f64> {
        self.pilot.as_ref().and_then(|pilot| pilot.arrived())
    }

    /// The bot that drives the climber, and its goal; `None` in a ride.
    pub fn bot(&self) -> Option<(&Bot, &Goal)> {
        self.pilot.as_ref().map(|pilot| pilot.bot())
    }

    /// How often the climber was dropped on the creature; 0 in a climb.
    pub fn drops(&self) -> u32 {
        self.drops
    }

    /// The creature that lives by its brain; `None` if it plays a timetable.
    pub fn life(&self) -> Option<&clamber_colossus::Creature> {
        self.performer.life()
    }

    /// How often a climber died or was thrown out of the valley, and began again; 0 in a ride.
    pub fn deaths(&self) -> u32 {
        self.deaths
    }

    /// How often the creature struck the climber.
    pub fn blows(&self) -> u32 {
        self.tally.blows
    }

    /// What was shot, struck and killed so far; nothing in a ride.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// The arena of a fight; `None` if the creature plays a timetable.
    pub fn arena(&self) -> Option<&Arena> {
        self.performer.arena()
    }

    /// How often the climber landed, on anything.
    pub fn landings(&self) -> u32 {
        self.landings
    }

    /// Names of the creature's clips that are not loops and are therefore played back and forth.
    pub fn turned_back(&self) -> Vec<String> {
        self.performer.turned_back()
    }

    /// The creature's part of the battle.
    pub fn performer(&self) -> &Performer<'a> {
        &self.performer
    }

    pub(super) fn watch(&self) -> &Watch {
        &self.watch
    }
}

/// True for terrain: the climber and the rocks pass through each other.
fn is_fixed(bodies: &RigidBodySet, collider: &Collider) -> bool {
    let body = collider.parent().and_then(|body| bodies.get(body));
    body.is_none_or(|body| body.is_fixed())
}

fn moment<'a>(performer: &'a Performer<'a>, height: f64, tick: u64) -> Moment<'a> {
    Moment {
        performer,
        height,
        tick,
    }
}

/// A climber with all abilities, in front of the outcrop; the seed shifts it aside.
fn climber_before_the_outcrop(seed: u64) -> Result<Climber, BattleError> {
    let mut config = ClimberConfig::colossus_climber();
    config.ground.jump_speed = 6.0;
    if let Some(stamina) = &mut config.stamina {
        // Strong enough for the walk of a creature this tall, which swings by metres high up.
        stamina.hold_drain = 1.0 / 150.0;
        stamina.shake_threshold = 10.0;
        stamina.shake_drain = 1.0 / 600.0;
    }
    if let Some(grip) = &mut config.grip {
        grip.climb_speed = 2.2;
    }
    let mut rng = fastrand::Rng::with_seed(seed);
    let aside = (2.0 * rng.f64() - 1.0) * ASIDE;
    let (x, z) = (outcrop::WALL - RUN_UP, aside);
    let feet = DVec3::new(x, valley::height(x, z), z);
    let position = feet + config.up() * (config.body.radius + 0.1);
    Ok(Climber::new(config, position)?)
}

/// A climber for a ride, in the air `drop` metres above a place. No acceleration of the creature throws it off or makes
/// it hang.
fn rider_above(place: DVec3, drop: f64) -> Result<Climber, BattleError> {
    let strong = ClimberConfig::colossus_climber().grip;
    let mut config = ClimberConfig::walker();
    config.ground.throw_acceleration = f64::INFINITY;
    config.grip = strong.map(|grip| GripConfig {
        hang_acceleration: f64::INFINITY,
        ..grip
    });
    let position = place + config.up() * (drop + config.body.radius);
    Ok(Climber::new(config, position)?)
}

/// The most level place near the middle of the creature's back; `None` if no ray hits the creature.
///
/// Casts rays from above on a grid around the middle of the skin. The seed shifts the grid by up to half a cell.
fn find_perch(surface: &SkinnedSurface, height: f64, seed: u64) -> Option<Contact> {
    let world = |p: &glam::Vec3| surface.world_from_model().transform_point_f32(*p);
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    let count = positions.len() as f64;
    let middle = positions.iter().map(world).sum::<DVec3>() / count;
    let mut rng = fastrand::Rng::with_seed(seed);
    let cell = height * 0.02;
    let shift = DVec3::new(rng.f64() - 0.5, 0.0, rng.f64() - 0.5) * cell;
    let mut best: Option<(f64, Contact)> = None;
    for i in -8..=8 {
        for j in -8..=8 {
            let aside = DVec3::new(f64::from(i), 0.0, f64::from(j)) * cell + shift;
            let from = middle + aside + DVec3::Y * (4.0 * height);
            let Some(hit) = surface.cast_ray(from, -DVec3::Y, 8.0 * height) else {
                continue;
            };
            // A level place is better, and of similar ones the nearer to the middle.
            let score = hit.normal.y - 0.5 * aside.length() / height;
            if best.is_none_or(|(other, _)| score > other) {
                best = Some((score, hit));
            }
        }
    }
    best.map(|(_, hit)| hit)
}

#[cfg(test)]
mod tests;
