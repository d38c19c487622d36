use std::time::Instant;

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberState, ContactQuery, StepReport,
    StepRules,
};
use clamber_fight::{Arena, ArenaEvent, ArenaState, CreatureId, FighterConfig, creature_obstacle};
use clamber_navigation::{Bot, Goal};
use clamber_surface::Fingerprint;
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::SurfaceKind;
use clamber_surface::rig::Palette;
use clamber_surface::surface::{Diagnostics, SkinnedSurface};
use clamber_world::rapier3d::dynamics::{RigidBodyHandle, RigidBodySet};
use clamber_world::rapier3d::geometry::{Collider, ColliderHandle};
use clamber_world::rapier3d::pipeline::PhysicsWorld;
use clamber_world::{BodyPoses, Contact, MaterialPoint, Obstacle, ObstacleId, RapierTerrain};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::bot::{Planner, arena, giant};
use super::ride::{Ride, rider_above};
use super::{BattleOptions, Counts, Intent, Rockfall, SceneError, outcrop};
use crate::{Creature, valley};

/// Length of a tick, seconds.
pub const TICK: f64 = 1.0 / 60.0;

/// The valley's obstacle id.
pub const TERRAIN: ObstacleId = ObstacleId(0);

/// The creature's obstacle id.
pub const CREATURE: ObstacleId = creature_obstacle(CreatureId(0));

/// Height above the perch from which the climber is first dropped, metres.
const DROP: f64 = 2.0;

/// Height above the perch from which rocks fall, as a share of the creature's height.
const ROCKS_ABOVE: f64 = 0.5;

/// Ticks on the ground after which a rider is dropped on the creature again.
const GROUNDED_TICKS: u32 = 60;

/// Distance from the outcrop's wall at which a climb begins, metres.
const RUN_UP: f64 = 4.0;
/// Largest offset of the start of a climb to either side, metres.
const ASIDE: f64 = 1.5;

/// The running scene.
pub struct Battle<'a> {
    /// The creature as it was loaded.
    pub creature: &'a Creature,
    part: Part<'a>,
    /// The physics world: the valley, the outcrop in a climb, and the rocks.
    pub world: PhysicsWorld,
    before: BodyPoses,
    /// The rocks.
    pub rocks: Rockfall,
    /// A 64-bit hash of the rocks' positions and rotations after the last tick.
    pub rocks_fingerprint: u64,
    /// Fur and stone can be gripped, rather than all skin.
    has_fur: bool,
    /// The point above which the climber is dropped to ride, and from above which rocks fall.
    perch: MaterialPoint,
    /// Height that the creature is scaled to, metres.
    pub height: f64,
    /// What happened so far, in numbers.
    pub counts: Counts,
    /// The climber's input in the last tick.
    pub input: ClimberInput,
    hash: Fingerprint,
    /// What the last tick skinned for the climber, without the rocks' queries.
    pub skinned: Diagnostics,
    /// Times of the ticks, microseconds: of pose, script and climber, and of the rocks with physics.
    pub times: Vec<[f64; 2]>,
}

/// The climber's opponent: a creature that lives in an arena, or one that plays a timetable.
enum Part<'a> {
    Fights {
        arena: Box<Arena>,
        bot: Box<Planner>,
    },
    Rides(Box<Ride<'a>>),
}

/// The state of a battle at a tick, besides the climber's state in a ride. It does not include the rocks and the memory
/// of bot and script.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BattleSnapshot {
    /// What happened so far.
    pub counts: Counts,
    /// In a climb: the state of the arena, which includes the climber's.
    pub arena: Option<Box<ArenaState>>,
    /// In a ride: time of the creature's clips, seconds, which is the sum of the ticks' lengths, and the distance that
    /// the creature has walked, metres.
    pub played: [f64; 2],
}

impl<'a> Battle<'a> {
    /// A battle before its first tick: a creature in the valley, a climber in front of an outcrop or above the
    /// creature's back, and rocks above the back.
    ///
    /// # Errors
    /// [`SceneError`] if the creature has no skin to be dropped on, is flat, or cannot be climbed up to a weak point;
    /// or if a file cannot be read.
    pub fn new(creature: &'a Creature, options: &BattleOptions) -> Result<Self, SceneError> {
        let (height, seed) = (options.height(), options.seed);
        let perch = |surface: &SkinnedSurface| {
            let (name, reason) = (&creature.name, "no ray from above meets its skin");
            let none = || format!("found no place to drop a climber on {name}: {reason}");
            find_perch(surface, height, seed).ok_or_else(none)
        };
        let mut world = valley::world();
        let mut counts = Counts::default();
        let (part, perch) = if let Some(brain) = options.load_brain()? {
            let mut arena = arena(creature, brain, options)?;
            let life = giant(&arena);
            let perch = perch(life.surface())?;
            let living = Creature {
                rig: life.kind().rig(),
                ..creature.clone()
            };
            outcrop::insert(&mut world)?;
            let (climber, position) = climber_before_the_outcrop(seed);
            let plates = life.kind().plates().iter();
            let plates: Vec<_> = plates.map(|plate| plate.triangles.clone()).collect();
            let graph = living.graph(&climber, height, life.rate(), &plates)?;
            let bot = Box::new(Planner::new(&arena, graph, creature)?);
            let fighter = FighterConfig {
                climber,
                respawn: Some(3.0),
                ..FighterConfig::hero()
            };
            arena.add_fighter(fighter, position)?;
            let arena = Box::new(arena);
            (Part::Fights { arena, bot }, perch)
        } else {
            let mut ride = Ride::new(creature, height)?;
            let perch = perch(&ride.surface)?;
            ride.climber = rider_above(perch.point, DROP)?;
            counts.drops = 1;
            (Part::Rides(Box::new(ride)), perch)
        };
        let tags = part.surface().mesh().tags();
        let has_fur = tags.iter().any(|tag| tag.kind == SurfaceKind::Fur);
        let above = perch.point + DVec3::Y * (ROCKS_ABOVE * height);
        let rocks = Rockfall::new(&mut world, options.rocks as usize, seed, above, height)?;
        Ok(Self {
            rocks_fingerprint: rocks.fingerprint(&world.bodies),
            creature,
            part,
            world,
            before: BodyPoses::default(),
            rocks,
            has_fur,
            perch: perch.material,
            height,
            counts,
            input: ClimberInput::default(),
            hash: Fingerprint::default(),
            skinned: Diagnostics::default(),
            times: Vec::new(),
        })
    }

    /// Runs one tick: in a climb with the bot's input, in a ride with the input that carries out an intent.
    pub fn step(&mut self, intent: Intent) -> Result<(), SceneError> {
        let start = Instant::now();
        let seconds = self.counts.tick as f64 * TICK;
        let input = match &mut self.part {
            Part::Fights { arena, bot } => bot.input(arena, seconds),
            Part::Rides(ride) => {
                ride.advance()?;
                ride.input(intent, &self.perch, seconds)
            }
        };
        self.step_advanced(input, start)
    }

    /// Runs one tick with a given input, such as one from a recording.
    pub fn step_with(&mut self, input: ClimberInput) -> Result<(), SceneError> {
        let start = Instant::now();
        if let Part::Rides(ride) = &mut self.part {
            ride.advance()?;
        }
        self.step_advanced(input, start)
    }

    /// The rest of a tick that began at `start`.
    fn step_advanced(&mut self, input: ClimberInput, start: Instant) -> Result<(), SceneError> {
        let bodies = &self.world.bodies;
        let fixed = |_: ColliderHandle, collider: &Collider| is_fixed(bodies, collider);
        let terrain = RapierTerrain::of_world(&self.world, &self.before).with_filter(&fixed);
        let has_fur = self.has_fur;
        let rule = |query: &ContactQuery<'_>| {
            let holds = |kind| matches!(kind, SurfaceKind::Fur | SurfaceKind::Stone);
            let grip = query.id == CREATURE && (!has_fur || holds(query.tag().kind));
            query.usual().with_grip(grip)
        };
        let rules = StepRules::by(&rule);
        match &mut self.part {
            Part::Fights { arena, .. } => {
                arena.step_with(&[input], &[], &[(TERRAIN, &terrain)], &rules)?;
            }
            Part::Rides(ride) => {
                let obstacles: [(ObstacleId, &dyn Obstacle); 2] =
                    [(TERRAIN, &terrain), (CREATURE, &ride.surface)];
                let report = ride.climber.step_with(&input, &obstacles, &rules, TICK);
                ride.report = report?;
            }
        }
        let own = start.elapsed().as_secs_f64() * 1e6;
        let surface = self.part.surface();
        self.skinned = surface.diagnostics();
        self.counts.tick += 1;
        let perch = surface.motion(&self.perch, TICK);
        let perch = perch.map_or(DVec3::ZERO, |perch| perch.position);
        let above = perch + DVec3::Y * (ROCKS_ABOVE * self.height);
        let (tick, world) = (self.counts.tick, &mut self.world);
        let rocks = self.rocks.step(surface, tick, world, above)?;
        self.times.push([own, rocks]);
        self.rocks_fingerprint = self.rocks.fingerprint(&self.world.bodies);
        self.input = input;
        self.count();
        self.lift_if_grounded()
    }

    /// Counts the tick's events, and adds the tick to the hash.
    fn count(&mut self) {
        let landed = |event: &&ClimberEvent| matches!(event, ClimberEvent::Landed { .. });
        let landings = self.report().events.iter().filter(landed).count() as u32;
        self.counts.landings += landings;
        if let Part::Fights { arena, bot } = &mut self.part {
            for event in arena.events() {
                self.counts.add(event);
                if let ArenaEvent::Rose { .. } = event {
                    bot.begin_again();
                }
            }
        }
        let climber = self.climber().state().fingerprint();
        self.hash.word(climber ^ self.scene_fingerprint());
    }

    /// Drops a rider on the creature's back again if it has been on the ground for a while or is out of the valley.
    fn lift_if_grounded(&mut self) -> Result<(), SceneError> {
        let Part::Rides(ride) = &mut self.part else {
            return Ok(());
        };
        let state = ride.climber.state();
        let support = state.support.map(|support| support.attachment.obstacle);
        let (is_down, grounded) = (support == Some(TERRAIN), self.counts.grounded + 1);
        self.counts.grounded = if is_down { grounded } else { 0 };
        let is_lost = !valley::contains(state.position.x, state.position.z);
        if self.counts.grounded < GROUNDED_TICKS && !is_lost {
            return Ok(());
        }
        let Some(perch) = ride.surface.motion(&self.perch, TICK) else {
            return Ok(());
        };
        // Onto the skin that is uppermost there now.
        let sky = perch.position + DVec3::Y * (4.0 * self.height);
        let top = ride.surface.cast_ray(sky, -DVec3::Y, 4.0 * self.height);
        let place = top.map_or(perch.position, |top| top.point);
        ride.drop_again(place)?;
        self.counts.grounded = 0;
        self.counts.drops += 1;
        Ok(())
    }

    /// The state of the battle, without the rocks.
    pub fn snapshot(&self) -> BattleSnapshot {
        let (arena, played) = match &self.part {
            Part::Fights { arena, .. } => (Some(Box::new(arena.save())), [0.0; 2]),
            Part::Rides(ride) => {
                let creature = &ride.choreography;
                (None, [creature.time, creature.walked])
            }
        };
        BattleSnapshot {
            counts: self.counts,
            arena,
            played,
        }
    }

    /// Restores a snapshot of a battle that was made with the same options, and in a ride the climber's state.
    ///
    /// Given the same inputs, creature and climber then go on with the same bits. The rocks stay where they are.
    ///
    /// # Errors
    /// [`SceneError`] if the climber rejects the state, or the snapshot is of the other story.
    pub fn restore(
        &mut self,
        snapshot: &BattleSnapshot,
        state: ClimberState,
    ) -> Result<(), SceneError> {
        match (&mut self.part, &snapshot.arena) {
            (Part::Fights { arena, .. }, Some(state)) => arena.restore(state)?,
            (Part::Rides(ride), None) => {
                ride.climber.restore(state)?;
                ride.go_to(snapshot.played)?;
            }
            _ => Err("the snapshot is of a climb and the battle a ride, or the other way round")?,
        }
        self.counts = snapshot.counts;
        Ok(())
    }

    /// Calls `touch` with the climber's obstacles as they are now: terrain and creature.
    pub fn touched<T>(&self, touch: impl FnOnce(&[(ObstacleId, &dyn Obstacle)]) -> T) -> T {
        let bodies = &self.world.bodies;
        let fixed = |_: ColliderHandle, collider: &Collider| is_fixed(bodies, collider);
        let terrain = RapierTerrain::of_world(&self.world, &self.before).with_filter(&fixed);
        touch(&[(TERRAIN, &terrain), (CREATURE, self.surface())])
    }

    /// Number of ticks so far.
    pub fn tick(&self) -> u64 {
        self.counts.tick
    }

    /// A 64-bit hash of the climber's states, the rocks' poses and all that changes in a fight, in all ticks.
    pub fn hash(&self) -> u64 {
        self.hash.value()
    }

    /// The climber.
    pub fn climber(&self) -> &Climber {
        match &self.part {
            Part::Fights { arena, .. } => arena.fighters()[0].climber(),
            Part::Rides(ride) => &ride.climber,
        }
    }

    /// The climber's report of the last tick.
    pub fn report(&self) -> &StepReport {
        match &self.part {
            Part::Fights { arena, .. } => arena.fighters()[0].report(),
            Part::Rides(ride) => &ride.report,
        }
    }

    /// The creature's skin, as posed by the last tick.
    pub fn surface(&self) -> &SkinnedSurface {
        self.part.surface()
    }

    /// The creature's palette in the last tick.
    pub fn palette(&self) -> &Palette {
        match &self.part {
            Part::Fights { arena, .. } => giant(arena).palette(),
            Part::Rides(ride) => &ride.choreography.palette,
        }
    }

    /// The state of the creature's brain, or the clip that it plays, as text for messages.
    pub fn playing(&self) -> String {
        match &self.part {
            Part::Fights { arena, .. } => {
                let life = giant(arena);
                life.kind().brain().path(life.state().current()).to_owned()
            }
            Part::Rides(ride) => ride.choreography.playing(),
        }
    }

    /// The arena of a climb.
    pub fn arena(&self) -> Option<&Arena> {
        match &self.part {
            Part::Fights { arena, .. } => Some(arena),
            Part::Rides(_) => None,
        }
    }

    /// The creature of a climb, which lives by its brain.
    pub fn life(&self) -> Option<&clamber_colossus::Creature> {
        self.arena().map(giant)
    }

    /// The bot that plays a climb, its goal, and when it first came to the highest weak point, seconds.
    pub fn bot(&self) -> Option<(&Bot, &Goal, Option<f64>)> {
        match &self.part {
            Part::Fights { bot, .. } => Some(bot.bot()),
            Part::Rides(_) => None,
        }
    }

    /// The place of a body of the physics world.
    pub fn placed(&self, body: RigidBodyHandle) -> Similarity {
        let body = &self.world.bodies[body];
        Similarity {
            rotation: body.rotation().as_dquat().normalize(),
            scale: 1.0,
            translation: body.translation().as_dvec3(),
        }
    }

    /// A 64-bit hash of all beside the climber and the creature's pose: the rocks, and all that changes in a fight.
    pub fn scene_fingerprint(&self) -> u64 {
        let fight = self.arena().map_or(0, Arena::fingerprint);
        self.rocks_fingerprint ^ fight.rotate_left(1)
    }
}

impl Part<'_> {
    fn surface(&self) -> &SkinnedSurface {
        match self {
            Part::Fights { arena, .. } => giant(arena).surface(),
            Part::Rides(ride) => &ride.surface,
        }
    }
}

/// True for terrain: the climber and the rocks pass through each other.
fn is_fixed(bodies: &RigidBodySet, collider: &Collider) -> bool {
    let body = collider.parent().and_then(|body| bodies.get(body));
    body.is_none_or(|body| body.is_fixed())
}

/// A climber with all abilities, and its place in front of the outcrop; the seed shifts it aside.
fn climber_before_the_outcrop(seed: u64) -> (ClimberConfig, DVec3) {
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
    (config, feet + config.up() * (config.body.radius + 0.1))
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
