//! The copy of an arena's tick that is made on the game's thread.

use std::collections::BTreeMap;
use std::sync::Arc;

use clamber_climber::{ClimberConfig, ClimberInput, ClimberState};
use clamber_colossus::{ActiveBeam, ActiveShot, ActiveWave, Creature, CreatureEvent};
use clamber_fight::{Arena, ArenaPart, Blade, CreatureId, FighterId, Order, ProjectilePlace};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::ColliderMesh;
use clamber_world::{Obstacle, ObstacleId};

use crate::RecordError;
use crate::messages::{ArenaTick, Brain, Mirror};
use crate::views::{FigureJoints, TakenFigure, brain};

/// A copy of an arena's tick.
#[derive(Debug)]
pub struct TakenArena {
    pub(crate) message: ArenaTick,
    /// Creatures, fighters and projectiles; `None` if views are not due.
    pub(crate) view: Option<ArenaView>,
}

/// Everything in an arena that viewers draw.
#[derive(Debug)]
pub(crate) struct ArenaView {
    pub(crate) creatures: Vec<TakenCreature>,
    pub(crate) fighters: Vec<TakenFighter>,
    pub(crate) projectiles: Vec<ProjectilePlace>,
}

#[derive(Debug)]
pub(crate) struct TakenCreature {
    pub(crate) id: CreatureId,
    pub(crate) figure: TakenFigure,
    pub(crate) brain: Brain,
    pub(crate) skin: Option<(Arc<ColliderMesh>, Vec<Affine>)>,
    pub(crate) shots: Vec<ActiveShot>,
    pub(crate) waves: Vec<ActiveWave>,
    pub(crate) beam: Option<ActiveBeam>,
}

#[derive(Clone, Debug)]
pub(crate) struct TakenFighter {
    pub(crate) id: FighterId,
    pub(crate) config: ClimberConfig,
    pub(crate) state: ClimberState,
    pub(crate) blade: Option<Blade>,
}

impl TakenArena {
    /// Copies a tick without its views.
    pub(super) fn new(
        arena: &Arena,
        (inputs, orders): (&[ClimberInput], &[Order]),
    ) -> Result<Self, RecordError> {
        let parts = arena.part_fingerprints();
        let orders = match orders {
            [] => Vec::new(),
            orders => Order::to_bytes(orders)?,
        };
        let mut creatures = Vec::new();
        let mut fighters = Vec::new();
        for (part, _) in &parts {
            match part {
                ArenaPart::Creature(id) => creatures.push(id.0),
                ArenaPart::Fighter(id) => fighters.push(id.0),
                _ => {}
            }
        }
        Ok(Self {
            message: ArenaTick {
                tick: arena.tick(),
                inputs: inputs.iter().map(Mirror::of).collect(),
                fingerprint: arena.fingerprint(),
                parts: parts.into_iter().map(|(_, part)| part).collect(),
                creatures,
                fighters,
                orders: orders.into(),
            },
            view: None,
        })
    }
}

impl ArenaView {
    pub(super) fn new(
        arena: &Arena,
        terrain: &[(ObstacleId, &dyn Obstacle)],
        joints: &BTreeMap<CreatureId, Arc<FigureJoints>>,
        has_skin: bool,
    ) -> Self {
        let creatures = arena.creatures().filter_map(|(id, creature)| {
            let joints = joints.get(&id)?;
            Some(TakenCreature::new((id, creature), joints, has_skin))
        });
        let fighters = arena.fighters().iter().map(|fighter| TakenFighter {
            id: fighter.id(),
            config: fighter.config().climber,
            state: *fighter.climber().state(),
            blade: fighter.blade(),
        });
        let projectiles = arena.projectiles().iter();
        Self {
            creatures: creatures.collect(),
            fighters: fighters.collect(),
            projectiles: projectiles
                .filter_map(|projectile| arena.place(projectile, terrain))
                .collect(),
        }
    }
}

impl TakenCreature {
    fn new(
        (id, creature): (CreatureId, &Creature),
        joints: &Arc<FigureJoints>,
        with_skin: bool,
    ) -> Self {
        let (surface, palette) = (creature.surface(), creature.palette());
        Self {
            id,
            figure: TakenFigure::new(Arc::clone(joints), palette, *surface.world_from_model()),
            brain: brain(creature),
            shots: creature.shots().collect(),
            waves: creature.waves().chain(sudden_waves(creature)).collect(),
            beam: creature.report().beam,
            skin: with_skin.then(|| (Arc::clone(surface.mesh()), palette.matrices().to_vec())),
        }
    }
}

/// Waves that began in this tick and reached their whole radius at once: they are not among [`Creature::waves`].
fn sudden_waves(creature: &Creature) -> impl Iterator<Item = ActiveWave> + '_ {
    let begun = creature.report().events.iter();
    let begun = begun.filter_map(|event| match event {
        CreatureEvent::Wave {
            state,
            place,
            radius,
        } => Some(ActiveWave {
            state: *state,
            place: *place,
            reach: *radius,
            radius: *radius,
        }),
        _ => None,
    });
    begun.filter(|wave| !creature.waves().any(|one| one.place == wave.place))
}
