use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;

use clamber_fight::{Blade, CreatureId, FighterId, ProjectilePlace};
use foxglove::messages::{ArrowPrimitive, PointCloud, SceneEntity, SceneUpdate, SpherePrimitive};
use glam::{DQuat, DVec3};

use super::ArenaInfo;
use super::recording::LARGEST_TICK;
use super::taken::{ArenaView, TakenArena, TakenCreature, TakenFighter};
use crate::messages::{ArenaTick, Brain};
use crate::output::Channel;
use crate::views::{
    ATTACKS, PROJECTILES, Scene, color, deletion, entity, frame_of_climber, from_z_to, left_out,
    no_skin, pose, vector, z_up,
};
use crate::writing::{EncodeTick, Sheet, Writing};
use crate::{OfArena, RecordError, RecordingKind, topics};

/// Length of an arrow as it is drawn, metres.
const ARROW: f64 = 0.8;

/// Largest number of creatures whose brains and skins are written for people to look at: each takes two of a file's
/// 65,535 channels.
const MOST_SEEN: usize = 10_000;

/// Encodes ticks of an arena.
pub(super) struct ArenaEncoder {
    tick: Channel,
    /// Channels for brain and skin of each creature that was seen.
    creatures: BTreeMap<CreatureId, (Channel, Channel)>,
    /// Frame of each creature whose skin is drawn.
    drawn: BTreeMap<CreatureId, String>,
    /// Name of each fighter that was there in the last view, and the drawing of its body.
    fighters: BTreeMap<FighterId, (String, Scene)>,
    info: ArenaInfo,
    /// True once the log has said that creatures are left out of the views.
    has_told: bool,
}

impl ArenaEncoder {
    pub(super) fn begin<W: Write>(
        out: W,
        info: &ArenaInfo,
        skin_points: usize,
    ) -> Result<Writing<Self, W>, RecordError> {
        let metadata = (&OfArena::TOPICS, info.to_metadata(), info.settings.clone());
        let mut sheet = Sheet::new(out, info.tick_seconds, metadata, skin_points)?;
        let encoder = Self {
            tick: sheet.output.channel::<ArenaTick>(topics::ARENA)?,
            creatures: BTreeMap::new(),
            drawn: BTreeMap::new(),
            fighters: BTreeMap::new(),
            info: info.clone(),
            has_told: false,
        };
        Ok(Writing::new(encoder, sheet))
    }

    /// Writes the transforms and the scene.
    fn scene<W: Write>(
        &mut self,
        now: u64,
        view: &ArenaView,
        sheet: &mut Sheet<W>,
    ) -> Result<(), RecordError> {
        let mut transforms = vec![z_up(now)];
        for creature in &view.creatures {
            transforms.extend(creature.figure.frames(now));
        }
        // Fighters that have left are no longer drawn.
        let here: BTreeSet<FighterId> = view.fighters.iter().map(|fighter| fighter.id).collect();
        let gone = self.fighters.extract_if(.., |id, _| !here.contains(id));
        let deletions = gone.map(|(_, (name, _))| deletion(now, &name)).collect();
        let mut entities = Vec::new();
        for fighter in &view.fighters {
            let (name, scene) = self.fighters.entry(fighter.id).or_insert_with(|| {
                let name = self.info.fighter(fighter.id.0 as usize);
                (name, Scene::new(&fighter.config, self.info.tick_seconds))
            });
            transforms.push(frame_of_climber(now, name, &fighter.state));
            entities.push(body(now, name, scene, fighter));
        }
        sheet.transforms(transforms)?;
        entities.push(arrows(now, &view.projectiles));
        entities.push(attacks(now, &view.creatures));
        let scene = SceneUpdate {
            deletions,
            entities,
        };
        sheet.output.send(sheet.scene, &scene)
    }

    /// Writes the brains and the skins.
    fn creatures<W: Write>(
        &mut self,
        now: u64,
        creatures: Vec<TakenCreature>,
        sheet: &mut Sheet<W>,
    ) -> Result<(), RecordError> {
        let here: BTreeSet<CreatureId> = creatures.iter().map(|creature| creature.id).collect();
        for (id, frame) in self.drawn.extract_if(.., |id, _| !here.contains(id)) {
            if let Some((_, skin)) = self.creatures.get(&id) {
                sheet.output.send(*skin, &no_skin(now, &frame))?;
            }
        }
        for creature in creatures {
            let Some((brain, skin)) = self.channels(creature.id, sheet)? else {
                continue;
            };
            sheet.output.send(brain, &creature.brain)?;
            if let Some((mesh, matrices)) = &creature.skin {
                let figure = &creature.figure;
                let name = &figure.joints.figure;
                let frame = (name.as_str(), figure.world_from_model.scale);
                let points = sheet.skin(now, frame, (mesh, matrices))?;
                self.drawn.insert(creature.id, name.clone());
                sheet.output.send(skin, &points)?;
            }
        }
        Ok(())
    }

    /// The channels of a creature, which are added when it is seen first; `None` for creatures beyond [`MOST_SEEN`].
    fn channels<W: Write>(
        &mut self,
        creature: CreatureId,
        sheet: &mut Sheet<W>,
    ) -> Result<Option<(Channel, Channel)>, RecordError> {
        if let Some(known) = self.creatures.get(&creature) {
            return Ok(Some(*known));
        }
        if self.creatures.len() >= MOST_SEEN {
            if !std::mem::replace(&mut self.has_told, true) {
                sheet.log(left_out("brain and skin of further creatures"))?;
            }
            return Ok(None);
        }
        let [brain, skin] =
            [topics::BRAIN, topics::SKIN].map(|topic| format!("{topic}/{}", creature.0));
        let output = &mut sheet.output;
        let brain = output.channel_named::<Brain>(topics::BRAIN, &brain)?;
        let skin = output.channel_named::<PointCloud>(topics::SKIN, &skin)?;
        self.creatures.insert(creature, (brain, skin));
        Ok(Some((brain, skin)))
    }
}

impl EncodeTick for ArenaEncoder {
    type Data = TakenArena;

    fn tick<W: Write>(
        &mut self,
        (_, now): (u64, u64),
        data: TakenArena,
        sheet: &mut Sheet<W>,
    ) -> Result<(), RecordError> {
        if prost::Message::encoded_len(&data.message) > LARGEST_TICK {
            let reason = "a tick of more than 2 MiB, which no reader takes";
            return Err(RecordError::encode(topics::ARENA, reason));
        }
        sheet.output.send_exact(self.tick, &data.message)?;
        if let Some(view) = data.view {
            self.scene(now, &view, sheet)?;
            self.creatures(now, view.creatures, sheet)?;
        }
        Ok(())
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
    let turn = from_z_to(along)
        * glam::DQuat::from_xyzw(
            0.0,
            -core::f64::consts::FRAC_1_SQRT_2,
            0.0,
            core::f64::consts::FRAC_1_SQRT_2,
        );
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
