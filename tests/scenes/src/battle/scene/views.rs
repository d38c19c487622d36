use clamber_climber::{Climber, StepReport};
use clamber_fight::Arena;
use clamber_navigation::{Bot, Goal};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::rapier3d::dynamics::RigidBodyHandle;
use clamber_world::rapier3d::geometry::{Collider, ColliderHandle};
use clamber_world::{Obstacle, ObstacleId, RapierTerrain};

use super::super::bot::giant;
use super::{Battle, CREATURE, Part, TERRAIN, is_fixed};

impl Battle<'_> {
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
