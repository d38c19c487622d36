//! The copy of an arena's tick that is made on the game's thread, and the messages that are made from it.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::sync::Arc;

use clamber_climber::{ClimberInput, ClimberState};
use clamber_colossus::{ActiveBeam, ActiveShot, ActiveWave, Creature, CreatureEvent};
use clamber_fight::{Arena, Blade, CreatureId, FighterId, Order, ProjectilePlace};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::ColliderMesh;
use clamber_world::{Obstacle, ObstacleId};
use foxglove::messages::{ArrowPrimitive, PointCloud, SceneEntity, SceneUpdate, SpherePrimitive};
use glam::{DQuat, DVec3};

use super::ArenaInfo;
use super::recording::LARGEST_TICK;
use crate::messages::{ArenaTick, Brain, Mirror};
use crate::output::{Channel, Output};
use crate::views::{
    ATTACKS, BodyShape, FigureJoints, PROJECTILES, TakenFigure, brain, color, deletion, entity,
    frame_of_climber, from_z_to, left_out, no_skin, pose, vector, z_up,
};
use crate::{OfArena, RecordError, RecordingKind, topics};

/// Length of an arrow as it is drawn, metres.
const ARROW: f64 = 0.8;

/// Largest number of creatures whose brains and skins are written for people to look at: each takes two of a file's
/// 65,535 channels.
const MOST_SEEN: usize = 10_000;

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
    pub(crate) shape: BodyShape,
    pub(crate) state: ClimberState,
    pub(crate) blade: Option<Blade>,
}

impl TakenArena {
    /// Copies a tick without its views.
    pub(super) fn new(
        arena: &Arena,
        (inputs, orders): (&[ClimberInput], &[Order]),
    ) -> Result<Self, RecordError> {
        let orders = match orders {
            [] => Vec::new(),
            orders => Order::to_bytes(orders)?,
        };
        let fighters = arena.fighters().iter();
        let parts = arena.part_fingerprints().into_iter();
        Ok(Self {
            message: ArenaTick {
                tick: arena.tick(),
                inputs: inputs.iter().map(Mirror::of).collect(),
                parts: parts.map(|(_, part)| part).collect(),
                creatures: arena.creatures().map(|(id, _)| id.0).collect(),
                fighters: fighters.map(|fighter| fighter.id().0).collect(),
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
            shape: BodyShape::of(&fighter.config().climber),
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

/// Encodes ticks of an arena.
pub(super) struct ArenaEncoder {
    tick: Channel,
    /// Channels for brain and skin of each creature that was seen.
    creatures: BTreeMap<CreatureId, (Channel, Channel)>,
    /// Frame of each creature whose skin is drawn.
    drawn: BTreeMap<CreatureId, String>,
    /// Name of each fighter that was there in the last view.
    fighters: BTreeMap<FighterId, String>,
    info: ArenaInfo,
    /// True once the log has said that creatures are left out of the views.
    has_told: bool,
}

impl ArenaEncoder {
    pub(super) fn begin<W: Write>(
        out: W,
        info: &ArenaInfo,
        skin_points: usize,
    ) -> Result<(Self, Output<W>), RecordError> {
        let metadata = (&OfArena::TOPICS, info.to_metadata(), info.settings.clone());
        let mut output = Output::new(out, info.tick_seconds, metadata, skin_points)?;
        let encoder = Self {
            tick: output.channel::<ArenaTick>(topics::ARENA, None)?,
            creatures: BTreeMap::new(),
            drawn: BTreeMap::new(),
            fighters: BTreeMap::new(),
            info: info.clone(),
            has_told: false,
        };
        Ok((encoder, output))
    }

    /// Writes the transforms and the scene.
    fn scene<W: Write>(
        &mut self,
        view: &ArenaView,
        output: &mut Output<W>,
    ) -> Result<(), RecordError> {
        let now = output.now;
        let mut transforms = vec![z_up(now)];
        for creature in &view.creatures {
            transforms.extend(creature.figure.frames(now));
        }
        // Fighters that have left are no longer drawn.
        let here: BTreeSet<FighterId> = view.fighters.iter().map(|fighter| fighter.id).collect();
        let gone = self.fighters.extract_if(.., |id, _| !here.contains(id));
        let deletions = gone.map(|(_, name)| deletion(now, &name)).collect();
        let mut entities = Vec::new();
        for fighter in &view.fighters {
            let named = || self.info.fighter(fighter.id.0 as usize);
            let name = self.fighters.entry(fighter.id).or_insert_with(named);
            transforms.push(frame_of_climber(now, name, &fighter.state));
            entities.push(body(now, name, fighter));
        }
        output.transforms(transforms)?;
        entities.push(arrows(now, &view.projectiles));
        entities.push(attacks(now, &view.creatures));
        let scene = SceneUpdate {
            deletions,
            entities,
        };
        output.send(output.scene, &scene)
    }

    /// Writes the brains and the skins.
    fn creatures<W: Write>(
        &mut self,
        creatures: Vec<TakenCreature>,
        output: &mut Output<W>,
    ) -> Result<(), RecordError> {
        let here: BTreeSet<CreatureId> = creatures.iter().map(|creature| creature.id).collect();
        for (id, frame) in self.drawn.extract_if(.., |id, _| !here.contains(id)) {
            if let Some((_, skin)) = self.creatures.get(&id) {
                output.send(*skin, &no_skin(output.now, &frame))?;
            }
        }
        for creature in creatures {
            let Some((brain, skin)) = self.channels(creature.id, output)? else {
                continue;
            };
            output.send(brain, &creature.brain)?;
            if let Some((mesh, matrices)) = &creature.skin {
                let figure = &creature.figure;
                let name = &figure.joints.figure;
                let frame = (name.as_str(), figure.world_from_model.scale);
                let points = output.skin(frame, (mesh, matrices))?;
                self.drawn.insert(creature.id, name.clone());
                output.send(skin, &points)?;
            }
        }
        Ok(())
    }

    /// The channels of a creature, which are added when it is seen first; `None` for creatures beyond [`MOST_SEEN`].
    fn channels<W: Write>(
        &mut self,
        creature: CreatureId,
        output: &mut Output<W>,
    ) -> Result<Option<(Channel, Channel)>, RecordError> {
        if let Some(known) = self.creatures.get(&creature) {
            return Ok(Some(*known));
        }
        if self.creatures.len() >= MOST_SEEN {
            if !std::mem::replace(&mut self.has_told, true) {
                output.log(left_out("brain and skin of further creatures"))?;
            }
            return Ok(None);
        }
        let name = |topic: &str| format!("{topic}/{}", creature.0);
        let brain = output.channel::<Brain>(topics::BRAIN, Some(&name(topics::BRAIN)))?;
        let skin = output.channel::<PointCloud>(topics::SKIN, Some(&name(topics::SKIN)))?;
        self.creatures.insert(creature, (brain, skin));
        Ok(Some((brain, skin)))
    }

    /// Sends the messages of a tick.
    pub(super) fn tick<W: Write>(
        &mut self,
        data: TakenArena,
        output: &mut Output<W>,
    ) -> Result<(), RecordError> {
        if prost::Message::encoded_len(&data.message) > LARGEST_TICK {
            let reason = "a tick of more than 2 MiB, which no reader takes";
            return Err(RecordError::encode(topics::ARENA, reason));
        }
        output.send_exact(self.tick, &data.message)?;
        if let Some(view) = data.view {
            self.scene(&view, output)?;
            self.creatures(view.creatures, output)?;
        }
        Ok(())
    }
}

/// The entity of a climber's body and its sword.
fn body(now: u64, name: &str, fighter: &TakenFighter) -> SceneEntity {
    let mut entity = entity(now, name);
    fighter.shape.draw(&fighter.state, &mut entity);
    let sword = fighter
        .blade
        .map(|Blade { hilt, tip }| arrow(hilt, tip, [0.05, 0.1], [0.8, 0.85, 0.9]));
    entity.arrows.extend(sword);
    entity
}

/// The entity of arrows and stones.
fn arrows(now: u64, projectiles: &[ProjectilePlace]) -> SceneEntity {
    let mut entity = entity(now, PROJECTILES);
    let drawn = projectiles.iter().map(|place| {
        let tail = place.tip - place.direction * ARROW;
        arrow(tail, place.tip, [0.03, 0.08], [0.6, 0.4, 0.2])
    });
    entity.arrows = drawn.collect();
    entity
}

/// The entity of the creatures' attacks: shots, waves as far as they have spread, and beams.
fn attacks(now: u64, creatures: &[TakenCreature]) -> SceneEntity {
    let mut entity = entity(now, ATTACKS);
    for creature in creatures {
        let ball = |place: DVec3, radius: f64, opacity: f64| SpherePrimitive {
            pose: Some(pose(place, DQuat::IDENTITY)),
            size: Some(vector(DVec3::splat(2.0 * radius))),
            color: Some(color(0.9, 0.5, 0.1, opacity)),
        };
        let shots = creature.shots.iter();
        let shots = shots.map(|shot| ball(shot.place, shot.radius, 1.0));
        let waves = creature.waves.iter();
        let waves = waves.map(|wave| ball(wave.place, wave.reach, 0.25));
        entity.spheres.extend(shots.chain(waves));
        let beam = creature.beam;
        let beam = beam.map(|beam| {
            let thick = 2.0 * beam.radius;
            arrow(beam.from, beam.to, [thick, thick], [1.0, 0.9, 0.4])
        });
        entity.arrows.extend(beam);
    }
    entity
}

/// An arrow from a place to another one, with the diameters of its shaft and its head.
fn arrow(from: DVec3, to: DVec3, [shaft, head]: [f64; 2], [r, g, b]: [f64; 3]) -> ArrowPrimitive {
    let (along, length) = ((to - from).normalize_or(DVec3::Z), from.distance(to));
    // foxglove's arrows point along +X: the second factor turns +X to +Z, the first turns +Z to `along`.
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let turn = from_z_to(along) * DQuat::from_xyzw(0.0, -half, 0.0, half);
    let point = (0.25 * length).min(0.2);
    ArrowPrimitive {
        pose: Some(pose(from, turn)),
        shaft_length: length - point,
        shaft_diameter: shaft,
        head_length: point,
        head_diameter: head,
        color: Some(color(r, g, b, 1.0)),
    }
}
