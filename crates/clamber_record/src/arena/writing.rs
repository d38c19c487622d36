use std::collections::BTreeMap;
use std::io::Write;

use clamber_fight::{Blade, CreatureId, FighterId, ProjectilePlace};
use clamber_surface::skin::skin_into;
use foxglove::messages::{
    ArrowPrimitive, FrameTransforms, Log, PointCloud, Pose, SceneEntity, SceneUpdate,
    SpherePrimitive,
};
use glam::{DVec3, Vec3};

use super::ArenaInfo;
use super::recording::LARGEST_TICK;
use super::taken::{TakenArena, TakenCreature, TakenFighter};
use crate::chunks::WriteTicks;
use crate::messages::{ArenaSnapshot, ArenaTick, Brain};
use crate::output::{Channel, Output};
use crate::views::{
    ATTACKS, PROJECTILES, Scene, Sceneries, Skin, color, deletion, entity, frame_of_climber,
    from_z_to, gap_line, left_out, no_skin, rotation, vector, z_up,
};
use crate::{RecordError, RecordingInfo, topics};

/// Length of an arrow as it is drawn, metres.
const ARROW: f64 = 0.8;

/// Largest number of creatures whose brains and skins are written for people to look at: each takes two of a file's
/// 65,535 channels.
const MOST_SEEN: usize = 10_000;

/// Encodes ticks of an arena and writes them.
pub(super) struct ArenaWriting<W: Write> {
    output: Output<W>,
    tick: Channel,
    snapshot: Channel,
    transforms: Channel,
    scene: Channel,
    scenery: Channel,
    log: Channel,
    /// Channels for brain and skin of each creature that was seen.
    creatures: BTreeMap<CreatureId, (Channel, Channel)>,
    /// Frame of each creature whose skin is drawn.
    drawn: BTreeMap<CreatureId, String>,
    /// Name of each fighter that was there in the last view, and the drawing of its body.
    fighters: BTreeMap<FighterId, (String, Scene)>,
    info: ArenaInfo,
    skin: Skin,
    meshes: Sceneries,
    /// Posed positions of a creature's vertices, kept so that their memory is reused.
    positions: Vec<Vec3>,
    /// True once the log has said that creatures are left out of the views.
    has_told: bool,
}

impl<W: Write> ArenaWriting<W> {
    pub(super) fn new(out: W, info: &ArenaInfo, skin_points: usize) -> Result<Self, RecordError> {
        let metadata = [
            (ArenaInfo::METADATA, info.to_metadata()),
            (RecordingInfo::SETTINGS, info.settings.clone()),
        ];
        let mut output = Output::new(out, info.tick_seconds, metadata)?;
        Ok(Self {
            tick: output.channel::<ArenaTick>(topics::ARENA)?,
            snapshot: output.channel::<ArenaSnapshot>(topics::ARENA_SNAPSHOT)?,
            transforms: output.channel::<FrameTransforms>(topics::TRANSFORMS)?,
            scene: output.channel::<SceneUpdate>(topics::SCENE)?,
            scenery: output.channel::<SceneUpdate>(topics::SCENERY)?,
            log: output.channel::<Log>(topics::LOG)?,
            output,
            creatures: BTreeMap::new(),
            drawn: BTreeMap::new(),
            fighters: BTreeMap::new(),
            info: info.clone(),
            skin: Skin::new(skin_points),
            meshes: Sceneries::default(),
            positions: Vec::new(),
            has_told: false,
        })
    }

    fn write(&mut self, taken: &mut TakenArena) -> Result<(), RecordError> {
        let tick = taken.message.tick;
        let now = self.output.begin(tick);
        if let Some(line) = gap_line(now, taken.gap) {
            self.output.send(self.log, now, &line)?;
        }
        let message = &taken.message;
        self.output.send_as(self.tick, now, |buffer| {
            message.write(buffer)?;
            if buffer.len() > LARGEST_TICK {
                return Err("a tick of more than 2 MiB, which no reader takes".to_owned());
            }
            Ok(())
        })?;
        if let Some(state) = taken.saved.take() {
            let state = state.into();
            let message = ArenaSnapshot { tick, state };
            self.output.send(self.snapshot, now, &message)?;
        }
        for line in taken.lines.drain(..) {
            self.output.send(self.log, now, &line)?;
        }
        if taken.is_due {
            self.look(taken, now)?;
        }
        if let Some(frames) = self.meshes.frames(now, &taken.scenery) {
            self.output.send(self.transforms, now, &frames)?;
        }
        if let Some(shapes) = self.meshes.shapes(now, taken.scenery.drain(..)) {
            self.output.send(self.scenery, now, &shapes)?;
        }
        if let Some(line) = self.meshes.take_line(now) {
            self.output.send(self.log, now, &line)?;
        }
        Ok(())
    }

    /// Writes the views.
    fn look(&mut self, taken: &mut TakenArena, now: u64) -> Result<(), RecordError> {
        let mut transforms = vec![z_up(now)];
        for creature in &taken.creatures {
            transforms.extend(creature.figure.message(now).transforms);
        }
        let mut entities: Vec<SceneEntity> = Vec::new();
        // Fighters that have left are no longer drawn.
        let is_here = |id: &FighterId| {
            let found = taken
                .fighters
                .binary_search_by_key(id, |fighter| fighter.id);
            found.is_ok()
        };
        let gone = self.fighters.extract_if(.., |id, _| !is_here(id));
        let deletions = gone.map(|(_, (name, _))| deletion(now, &name)).collect();
        for fighter in &taken.fighters {
            let (name, scene) = self.fighters.entry(fighter.id).or_insert_with(|| {
                let name = self.info.fighter(fighter.id.0 as usize);
                (name, Scene::new(&fighter.config, self.info.tick_seconds))
            });
            transforms.push(frame_of_climber(now, name, &fighter.state));
            entities.push(body(now, name, scene, fighter));
        }
        self.output
            .send(self.transforms, now, &FrameTransforms { transforms })?;
        entities.push(arrows(now, &taken.projectiles));
        entities.push(attacks(now, &taken.creatures));
        let scene = SceneUpdate {
            deletions,
            entities,
        };
        self.output.send(self.scene, now, &scene)?;
        let is_here = |id: &CreatureId| {
            let found = taken
                .creatures
                .binary_search_by_key(id, |creature| creature.id);
            found.is_ok()
        };
        for (id, frame) in self.drawn.extract_if(.., |id, _| !is_here(id)) {
            if let Some((_, skin)) = self.creatures.get(&id) {
                self.output.send(*skin, now, &no_skin(now, &frame))?;
            }
        }
        for creature in taken.creatures.drain(..) {
            if let Some(channels) = self.channels(creature.id, now)? {
                self.creature(&creature, channels, now)?;
            }
        }
        Ok(())
    }

    /// The channels of a creature, which are added when it is seen first; `None` for creatures beyond [`MOST_SEEN`].
    fn channels(
        &mut self,
        creature: CreatureId,
        now: u64,
    ) -> Result<Option<(Channel, Channel)>, RecordError> {
        if let Some(known) = self.creatures.get(&creature) {
            return Ok(Some(*known));
        }
        if self.creatures.len() >= MOST_SEEN {
            if !std::mem::replace(&mut self.has_told, true) {
                let line = left_out(now, "brain and skin of further creatures");
                self.output.send(self.log, now, &line)?;
            }
            return Ok(None);
        }
        let [brain, skin] =
            [topics::BRAIN, topics::SKIN].map(|topic| format!("{topic}/{}", creature.0));
        let brain = self.output.channel_named::<Brain>(topics::BRAIN, &brain)?;
        let skin = self
            .output
            .channel_named::<PointCloud>(topics::SKIN, &skin)?;
        self.creatures.insert(creature, (brain, skin));
        Ok(Some((brain, skin)))
    }

    fn creature(
        &mut self,
        creature: &TakenCreature,
        (brain, skin): (Channel, Channel),
        now: u64,
    ) -> Result<(), RecordError> {
        self.output.send(brain, now, &creature.brain)?;
        let Some((mesh, matrices)) = &creature.skin else {
            return Ok(());
        };
        skin_into(mesh, matrices, &mut self.positions).map_err(|error| RecordError::Encode {
            topic: topics::SKIN,
            reason: error.to_string(),
        })?;
        let scale = creature.figure.world_from_model.scale;
        let mut points = self.skin.message(now, mesh, &self.positions, scale);
        let frame = &creature.figure.joints.figure;
        points.frame_id.clone_from(frame);
        self.drawn
            .entry(creature.id)
            .or_insert_with(|| frame.clone());
        self.output.send(skin, now, &points)
    }
}

impl<W: Write + Send + 'static> WriteTicks<TakenArena, W> for ArenaWriting<W> {
    fn chunk(&mut self, ticks: &mut [TakenArena]) -> Result<(), RecordError> {
        for taken in ticks {
            self.write(taken)?;
            self.output.flush_if_large()?;
        }
        self.output.flush()
    }

    fn ends_in_gap(&mut self, ticks: u64) -> Result<(), RecordError> {
        let now = self.output.now();
        if let Some(line) = gap_line(now, ticks) {
            self.output.send(self.log, now, &line)?;
        }
        self.output.ends_in_gap(ticks)
    }

    fn finish(self) -> Result<W, RecordError> {
        self.output.finish()
    }
}

/// The entity of a climber's body and its sword.
fn body(now: u64, name: &str, scene: &Scene, fighter: &TakenFighter) -> SceneEntity {
    let mut entity = entity(now, name);
    scene.body(&fighter.state, &mut entity);
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
            pose: Some(Pose {
                position: Some(vector(place)),
                orientation: Some(rotation(glam::DQuat::IDENTITY)),
            }),
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
    let turn = from_z_to(along)
        * glam::DQuat::from_xyzw(
            0.0,
            -core::f64::consts::FRAC_1_SQRT_2,
            0.0,
            core::f64::consts::FRAC_1_SQRT_2,
        );
    let point = (0.25 * length).min(0.2);
    ArrowPrimitive {
        pose: Some(Pose {
            position: Some(vector(from)),
            orientation: Some(rotation(turn)),
        }),
        shaft_length: length - point,
        shaft_diameter: shaft,
        head_length: point,
        head_diameter: head,
        color: Some(color(r, g, b, 1.0)),
    }
}
