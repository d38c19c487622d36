//! Recording a battle, and replaying a recorded one.

use std::io::Write;

use clamber_record::{
    Difference, FigureView, RecordError, RecordOptions, RecordedTick, Recorder, Recording,
    RecordingInfo, ReplayError, Replayed, SceneryView, TickView, creature_fingerprint,
    palette_fingerprint,
};
use clamber_surface::Fingerprint;
use clamber_surface::geometry::Similarity;
use clamber_world::rapier3d::dynamics::RigidBodyHandle;

use super::rockfall::Triangles;
use super::{Battle, BattleOptions, BattleSnapshot, CREATURE, SceneError, TERRAIN, TICK, outcrop};
use crate::hero::Hero;
use crate::valley;

/// Ticks from one snapshot to the next: one second.
const SNAPSHOT_EVERY: u64 = 60;

/// Distance between neighbouring corners of the ground, metres.
const CELL: f64 = 4.0;

/// Records a battle tick by tick.
pub struct BattleRecorder<W: Write> {
    recorder: Recorder<W>,
    hero: Option<Hero>,
    /// Ground, outcrop and rocks; filled at the first tick.
    scenery: Vec<Scenery>,
}

/// A mesh, and the rock that moves it.
struct Scenery {
    name: String,
    rock: Option<RigidBodyHandle>,
    mesh: Triangles,
    color: [f32; 3],
}

impl<W: Write + Send + 'static> BattleRecorder<W> {
    /// A recorder for a battle that was made from `options`. It writes to `out`.
    pub fn new(
        out: W,
        battle: &Battle<'_>,
        options: &BattleOptions,
        how: RecordOptions,
    ) -> Result<Self, SceneError> {
        let creature = battle.creature;
        let info = RecordingInfo {
            creature: creature.name.clone(),
            creature_fingerprint: fingerprint(battle),
            tick_seconds: TICK,
            climber: *battle.climber().config(),
            settings: options.to_settings(),
            version: RecordingInfo::VERSION.to_owned(),
        };
        let mut recorder = Recorder::new(out, &info, &creature.rig.skeleton, how)?;
        recorder.name(CREATURE, &creature.name);
        recorder.name(TERRAIN, "ground");
        Ok(Self {
            recorder,
            hero: None,
            scenery: Vec::new(),
        })
    }

    /// Records the joints of this hero too.
    #[must_use]
    pub fn with_hero(mut self, hero: Hero) -> Self {
        self.hero = Some(hero);
        self
    }

    /// Records the current state of the battle: call it before the first tick and after each tick. Adds a snapshot
    /// every second.
    pub fn tick(&mut self, battle: &Battle<'_>) -> Result<(), SceneError> {
        self.recorder.tick(&TickView {
            tick: battle.tick(),
            input: &battle.input,
            knockback: None,
            state: battle.climber().state(),
            report: battle.report(),
            surface: battle.surface(),
            palette: battle.palette(),
            scene_fingerprint: battle.scene_fingerprint(),
        })?;
        self.scenery(battle)?;
        if let Some(life) = battle.life() {
            self.recorder.brain(life)?;
        }
        if let Some(hero) = &mut self.hero {
            hero.watch(battle, TICK)?;
            self.recorder.figure(&FigureView {
                name: "hero",
                skeleton: hero.skeleton(),
                palette: hero.palette(),
                world_from_model: hero.world_from_model(),
            })?;
        }
        if battle.tick().is_multiple_of(SNAPSHOT_EVERY) {
            let snapshot = battle.snapshot();
            self.recorder
                .snapshot_with(move || serde_json::to_string(&snapshot))?;
        }
        Ok(())
    }

    /// Records all scenery at the first tick, and later the rocks.
    fn scenery(&mut self, battle: &Battle<'_>) -> Result<(), RecordError> {
        let is_first = self.scenery.is_empty();
        if is_first {
            self.scenery = scenery(battle);
        } else if !self.recorder.is_due()? {
            return Ok(());
        }
        let moving = |one: &&Scenery| is_first || one.rock.is_some();
        for one in self.scenery.iter().filter(moving) {
            let place = one.rock.map(|rock| battle.placed(rock));
            self.recorder.scenery(&SceneryView {
                name: &one.name,
                world_from_own: place.unwrap_or(Similarity::IDENTITY),
                points: &one.mesh.0,
                triangles: &one.mesh.1,
                color: one.color,
            })?;
        }
        Ok(())
    }

    /// Ends the recording and returns its writer.
    pub fn finish(self) -> Result<W, SceneError> {
        Ok(self.recorder.finish()?)
    }
}

/// Ground, outcrop and rocks of a battle.
fn scenery(battle: &Battle<'_>) -> Vec<Scenery> {
    let mut all = Vec::new();
    let mut add = |name: String, rock, mesh, color| {
        all.push(Scenery {
            name,
            rock,
            mesh,
            color,
        });
    };
    let ground = valley::mesh(CELL);
    add("ground".into(), None, ground, [0.42, 0.47, 0.33]);
    if battle.arena().is_some() {
        add("outcrop".into(), None, outcrop(), [0.4, 0.38, 0.35]);
    }
    for (number, (rock, mesh)) in (0..).zip(battle.rocks.meshes(&battle.world)) {
        let color = [0.36, 0.34, 0.31];
        add(format!("rock {number}"), Some(rock), mesh, color);
    }
    all
}

/// Fingerprint of the creature, and of its brain.
fn fingerprint(battle: &Battle<'_>) -> u64 {
    let rig = &battle.creature.rig;
    let body = creature_fingerprint(&rig.skeleton, &rig.clips, &rig.collider);
    let brain = battle.life().map(|life| life.kind().brain().file());
    // The brain as it is read, whatever the layout of its file.
    let text = brain.and_then(|file| serde_json::to_string(file).ok());
    text.map_or(body, |text| {
        let mut hash = Fingerprint::new(body);
        hash.text(&text);
        hash.value()
    })
}

/// The result of a replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay {
    /// The tick that the replay started from: the first one, or a snapshot's.
    pub from: u64,
    /// Number of ticks that agreed, including the one that the replay started from.
    pub agreed: u64,
    /// True if the rocks were compared; false for a replay from a snapshot, which holds no rocks.
    pub with_rocks: bool,
    /// The first tick that differs; `None` if all agree.
    pub difference: Option<Box<Difference>>,
}

/// Runs a recorded battle again with the recorded inputs, and compares every tick.
///
/// It stops at the end of the recording or at the first tick that differs. With a tick `from` it starts at the nearest
/// snapshot at or before that tick, otherwise at the first tick. After a gap it goes on from the snapshot there.
///
/// # Errors
/// [`SceneError`] if the battle cannot be made again, for example because the creature's file is missing or has
/// changed, or the recording has no such tick.
pub fn replay(recording: &Recording, from: Option<u64>) -> Result<Replay, SceneError> {
    let mut runs = recording
        .runs()
        .filter(|run| from.is_none_or(|from| *run.end() >= from));
    let last = runs.next().map_or(u64::MAX, |run| *run.end());
    let mut whole = replay_run(recording, from, last)?;
    for run in runs {
        if whole.difference.is_some() {
            break;
        }
        let played = replay_run(recording, Some(*run.start()), *run.end())?;
        whole.agreed += played.agreed;
        whole.with_rocks &= played.with_rocks;
        whole.difference = played.difference;
    }
    Ok(whole)
}

/// [`replay`] of ticks without a gap, up to `last`.
fn replay_run(recording: &Recording, from: Option<u64>, last: u64) -> Result<Replay, SceneError> {
    let info = recording.info();
    let options = BattleOptions::from_settings(&info.settings)?;
    let creature = options.load_creature()?;
    let rocks = if from.is_some() { 0 } else { options.rocks };
    let mut battle = Battle::new(&creature, &BattleOptions { rocks, ..options })?;
    if fingerprint(&battle) != info.creature_fingerprint {
        let what = "bring back the files that it and its brain were loaded from";
        let name = &creature.name;
        return Err(format!("{name} is not the creature that was recorded; {what}").into());
    }
    let start = match from {
        Some(from) => {
            let snapshot = recording.snapshot(from)?;
            let scene: BattleSnapshot = serde_json::from_str(&snapshot.scene)?;
            battle.restore(&scene, snapshot.tick.state)?;
            snapshot.tick.tick
        }
        None => battle.tick(),
    };
    let step = |recorded: &RecordedTick| {
        if recorded.tick > start {
            battle.step_with(recorded.input)?;
        }
        Ok::<_, SceneError>(Replayed {
            state: *battle.climber().state(),
            palette_fingerprint: palette_fingerprint(battle.palette()),
            scene_fingerprint: from.is_none().then(|| battle.scene_fingerprint()),
        })
    };
    let mut agreed = 0;
    let ticks = recording.ticks_from(start);
    let within = ticks.take_while(|tick| tick.as_ref().map_or(true, |tick| tick.tick <= last));
    let counted = within.inspect(|_| agreed += 1);
    let difference = match clamber_record::replay(counted, step) {
        Ok(_) => None,
        Err(ReplayError::Differs(difference)) => Some(difference),
        Err(ReplayError::Scene { error, .. }) => return Err(error),
        Err(error) => return Err(error.to_string().into()),
    };
    Ok(Replay {
        from: start,
        agreed: agreed - u64::from(difference.is_some()),
        with_rocks: from.is_none(),
        difference,
    })
}
