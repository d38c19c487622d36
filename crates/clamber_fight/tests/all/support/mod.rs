//! Creatures, arenas and inputs that the tests share.

#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::panic,
    reason = "helpers of tests, of which each file uses some"
)]

use std::sync::{Arc, LazyLock};

use clamber_climber::{ClimberInput, ClimberMode, StepRules};
use clamber_colossus::{Brain, CreatureConfig, CreatureKind};
use clamber_fight::{Arena, ArenaConfig, ArenaEvent, CreatureId, FighterConfig, FighterId, Order};
use clamber_surface::geometry::Affine;
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, Influence, MeshSource, Rig, SurfaceKind, SurfaceTag,
};
use clamber_surface::rig::{
    Channel, Clip, Interpolation, Joint, JointId, Keyframes, Skeleton, Transform, WeakPoint,
};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

/// Number of the slab's cells along each side.
const CELLS: u32 = 16;

/// Half the length of the slab's sides, metres.
pub(crate) const HALF: f32 = 6.0;

/// Height of the stone plate above the fur, metres.
pub(crate) const PLATE: f64 = 0.5;

/// Id of the ground.
pub(crate) const GROUND: ObstacleId = ObstacleId(0);

/// A slab: a horizontal square of fur on one joint, with a clip, weak points, and a stone plate over a quarter of it.
#[derive(Clone, Debug)]
pub(crate) struct Slab {
    /// Ticks a second.
    pub(crate) rate: f64,
    /// Keyframes of the joint: time in seconds, translation, scale.
    pub(crate) keys: Vec<(f32, Vec3, Vec3)>,
    pub(crate) weak_points: Vec<WeakPoint>,
    /// Whether there is a stone plate over a quarter of the fur.
    pub(crate) plate: bool,
}

impl Default for Slab {
    fn default() -> Self {
        Self {
            rate: 60.0,
            keys: vec![(0.0, Vec3::ZERO, Vec3::ONE)],
            weak_points: Vec::new(),
            plate: false,
        }
    }
}

/// A weak point of radius 2 at a position of the first joint.
pub(crate) fn weak_point(name: &str, at: Vec3, hit_points: f64, order: u32) -> WeakPoint {
    let mut point = WeakPoint::new(name, JointId(0), at);
    (point.radius, point.hit_points, point.order) = (2.0, hit_points, order);
    point
}

/// Keyframes of a joint that moves at a constant velocity.
pub(crate) fn moves(velocity: Vec3, seconds: f32) -> Vec<(f32, Vec3, Vec3)> {
    vec![
        (0.0, Vec3::ZERO, Vec3::ONE),
        (seconds, velocity * seconds, Vec3::ONE),
    ]
}

impl Slab {
    /// A slab at rest with a weak point in its middle.
    pub(crate) fn with_heart(hit_points: f64) -> Self {
        Self {
            weak_points: vec![weak_point("heart", Vec3::ZERO, hit_points, 0)],
            ..Self::default()
        }
    }

    pub(crate) fn kind(&self) -> Arc<CreatureKind> {
        let (mut positions, mut triangles, mut tags) = (Vec::new(), Vec::new(), Vec::new());
        let fur = (0.0, SurfaceKind::Fur, 0, -HALF);
        let plate = (PLATE as f32, SurfaceKind::Stone, 7, 0.0);
        for (height, kind, user, from) in [fur, plate].into_iter().take(1 + usize::from(self.plate))
        {
            let first = positions.len() as u32;
            let place = |index: u32| from + (HALF - from) * index as f32 / CELLS as f32;
            for row in 0..=CELLS {
                for column in 0..=CELLS {
                    positions.push(Vec3::new(place(column), height, place(row)));
                }
            }
            for row in 0..CELLS {
                for column in 0..CELLS {
                    let a = first + row * (CELLS + 1) + column;
                    let (b, c, d) = (a + 1, a + CELLS + 1, a + CELLS + 2);
                    triangles.extend([[a, c, d], [a, d, b]]);
                    tags.extend([SurfaceTag::new(kind).with_user(user); 2]);
                }
            }
        }
        let source = MeshSource {
            tags: &tags,
            ..MeshSource::rigid(&positions, &triangles)
        };
        let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default())
            .unwrap()
            .0;
        let root = Joint {
            name: "root".into(),
            parent: None,
            rest: Transform::IDENTITY,
            inverse_bind: Affine::IDENTITY,
        };
        let times: Vec<f32> = self.keys.iter().map(|key| key.0).collect();
        let channel = |values: Keyframes| {
            Channel::new(JointId(0), Interpolation::Linear, times.clone(), values).unwrap()
        };
        let moves = channel(Keyframes::Translation(
            self.keys.iter().map(|key| key.1).collect(),
        ));
        let scales = channel(Keyframes::Scale(
            self.keys.iter().map(|key| key.2).collect(),
        ));
        let mut rig = Rig::new(Skeleton::new(vec![root]).unwrap(), Arc::new(mesh));
        rig.clips = vec![Clip::new("lie", vec![moves, scales])];
        rig.weak_points.clone_from(&self.weak_points);
        let plates = if self.plate {
            r#""plates": [{ "name": "shell", "user": 7, "stagger": 2, "count": 1 }]"#
        } else {
            ""
        };
        let brain = format!(
            r#"{{ "body": {{ {plates} }}, "start": "lies", "states": {{ "lies": {{ "act": {{ "play": "lie" }} }} }} }}"#
        );
        let brain = Brain::from_json(&brain, 1.0 / self.rate).unwrap();
        Arc::new(CreatureKind::new(&rig, brain).unwrap())
    }

    /// An arena with the slab, and fighters at the given places.
    pub(crate) fn arena(&self, config: FighterConfig, places: &[DVec3]) -> Arena {
        let arena = ArenaConfig {
            tick: 1.0 / self.rate,
            ..ArenaConfig::default()
        };
        let mut arena = Arena::new(arena).unwrap();
        arena
            .add_creature(self.kind(), CreatureConfig::default())
            .unwrap();
        for place in places {
            arena.add_fighter(config, *place).unwrap();
        }
        arena
    }
}

/// A wall at z = 0 that faces +Z, 3.2 m wide and high. One weak point covers all of it.
#[derive(Clone, Debug)]
pub(crate) struct Wall {
    /// Number of joints, side by side.
    pub(crate) joints: u32,
    /// Ticks a second.
    pub(crate) rate: f64,
    /// Damage that breaks the plate; `None` for a wall without a plate. The plate covers the whole wall, 5 cm in front
    /// of it.
    pub(crate) plate: Option<f64>,
}

impl Wall {
    /// A wall with this many joints, at rest.
    pub(crate) fn of(joints: u32) -> Self {
        Self {
            joints,
            rate: 60.0,
            plate: None,
        }
    }

    pub(crate) fn kind(&self) -> Arc<CreatureKind> {
        /// Number of the wall's cells along each side.
        const CELLS: u32 = 32;
        let joints = self.joints;
        let place = |index: u32| 3.2 * (index as f32 / CELLS as f32 - 0.5);
        let (mut positions, mut influences) = (Vec::new(), Vec::new());
        let (mut triangles, mut tags) = (Vec::new(), Vec::new());
        let flesh = (0.0, 0);
        let plate = (0.05, 7);
        for (before, user) in [flesh, plate]
            .into_iter()
            .take(1 + usize::from(self.plate.is_some()))
        {
            let first = positions.len() as u32;
            for row in 0..=CELLS {
                for column in 0..=CELLS {
                    positions.push(Vec3::new(place(column), place(row), before));
                    let joint = JointId(column * joints / (CELLS + 1));
                    influences.push(Influence { joint, weight: 1.0 });
                }
            }
            for row in 0..CELLS {
                for column in 0..CELLS {
                    let a = first + row * (CELLS + 1) + column;
                    let (b, c, d) = (a + 1, a + CELLS + 1, a + CELLS + 2);
                    triangles.extend([[a, b, d], [a, d, c]]);
                    tags.extend([SurfaceTag::new(SurfaceKind::Skin).with_user(user); 2]);
                }
            }
        }
        let source = MeshSource {
            positions: &positions,
            triangles: &triangles,
            influences: &influences,
            tags: &tags,
            joint_count: joints as usize,
            ..MeshSource::default()
        };
        let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default())
            .unwrap()
            .0;
        let all = (0..joints).map(|index| Joint {
            name: format!("strip {index}"),
            parent: (index > 0).then_some(JointId(0)),
            rest: Transform::IDENTITY,
            inverse_bind: Affine::IDENTITY,
        });
        let mut heart = weak_point("heart", Vec3::ZERO, 100.0, 0);
        heart.radius = 3.0;
        let mut rig = Rig::new(Skeleton::new(all.collect()).unwrap(), Arc::new(mesh));
        rig.weak_points = vec![heart];
        let plates = self.plate.map_or_else(String::new, |stagger| {
            format!(
                r#""plates": [{{ "name": "shell", "user": 7, "stagger": {stagger}, "count": 1 }}]"#
            )
        });
        let brain = format!(
            r#"{{ "body": {{ {plates} }}, "start": "stands", "states": {{ "stands": {{}} }} }}"#
        );
        let brain = Brain::from_json(&brain, 1.0 / self.rate).unwrap();
        Arc::new(CreatureKind::new(&rig, brain).unwrap())
    }
}

/// The first fighter of each arena.
pub(crate) const HERO: FighterId = FighterId(0);
/// The first creature of each arena.
pub(crate) const GIANT: CreatureId = CreatureId(0);

/// Level ground at a height of 0.
pub(crate) fn level_ground() -> [(ObstacleId, &'static dyn Obstacle); 1] {
    static LEVEL: LazyLock<HalfSpace> = LazyLock::new(|| HalfSpace::below(0.0));
    [(GROUND, &*LEVEL)]
}

/// Level ground far below, at a height of -100 m.
pub(crate) fn low_ground() -> [(ObstacleId, &'static dyn Obstacle); 1] {
    static LOW: LazyLock<HalfSpace> = LazyLock::new(|| HalfSpace::below(-100.0));
    [(GROUND, &*LOW)]
}

/// Steps an arena over terrain while all fighters are idle.
pub(crate) fn rest(arena: &mut Arena, terrain: &[(ObstacleId, &dyn Obstacle)], ticks: u32) {
    let inputs = vec![ClimberInput::IDLE; arena.fighters().len()];
    for _ in 0..ticks {
        arena.step(&inputs, terrain).unwrap();
    }
}

/// Takes all hit points of an arena's first fighter.
pub(crate) fn kill(arena: &mut Arena) {
    let mut state = arena.save();
    state.fighters[0].state.climber.hit_points = 0.0;
    arena.restore(&state).unwrap();
}

/// Whether a fighter rises in one of the events.
pub(crate) fn rises(events: &[ArenaEvent]) -> bool {
    let is_rise = |event: &ArenaEvent| matches!(event, ArenaEvent::Rose { .. });
    events.iter().any(is_rise)
}

/// An arena with a creature, and no fighters yet.
pub(crate) fn arena_with(kind: Arc<CreatureKind>) -> Arena {
    let mut arena = Arena::new(ArenaConfig::default()).unwrap();
    arena.add_creature(kind, CreatureConfig::default()).unwrap();
    arena
}

/// An input with buttons, but without a direction.
pub(crate) fn pressing(actions: u32) -> ClimberInput {
    ClimberInput {
        actions,
        ..ClimberInput::IDLE
    }
}

/// Steps an arena over horizontal ground at y = -100 m, with the same input for all fighters.
pub(crate) fn step(arena: &mut Arena, input: &ClimberInput) -> Vec<ArenaEvent> {
    let inputs = vec![*input; arena.fighters().len()];
    arena.step(&inputs, &low_ground()).unwrap().to_vec()
}

/// Steps an arena with orders over the same ground.
pub(crate) fn step_with(
    arena: &mut Arena,
    inputs: &[ClimberInput],
    orders: &[Order],
) -> Vec<ArenaEvent> {
    let events = arena.step_with(inputs, orders, &low_ground(), &StepRules::default());
    events.unwrap().to_vec()
}

pub(crate) fn mode(arena: &Arena) -> ClimberMode {
    arena.fighter(HERO).unwrap().climber().state().mode
}

/// Steps until the first fighter stands; panics after 600 ticks.
pub(crate) fn land(arena: &mut Arena) {
    for _ in 0..600 {
        step(arena, &ClimberInput::IDLE);
        if mode(arena) == ClimberMode::Standing {
            return;
        }
    }
    panic!(
        "it did not land: {:?}",
        arena.fighter(HERO).unwrap().climber().state()
    );
}

/// The damages of all hits among the events.
pub(crate) fn hits(events: &[ArenaEvent]) -> Vec<f64> {
    let hits = events.iter().filter_map(|event| match event {
        ArenaEvent::Hit { damage, .. } => Some(*damage),
        _ => None,
    });
    hits.collect()
}

/// The giant of `assets/`, with its brain.
pub(crate) fn giant() -> Arc<CreatureKind> {
    giant_with(|_| ())
}

/// The giant with a changed brain file.
pub(crate) fn giant_with(change: impl Fn(&mut serde_json::Value)) -> Arc<CreatureKind> {
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/");
    let rig = clamber_gltf::load(format!("{assets}colossus.glb"))
        .unwrap()
        .rig;
    let brain = std::fs::read_to_string(format!("{assets}colossus.brain.json")).unwrap();
    let mut brain = serde_json::from_str(&brain).unwrap();
    change(&mut brain);
    let brain = Brain::from_json(&brain.to_string(), 1.0 / 60.0).unwrap();
    Arc::new(CreatureKind::new(&rig, brain).unwrap())
}

/// A fight with many events. One fighter rides the giant, stabs it and hangs on. Another one runs about in front of the
/// giant, shoots and throws. The third one stands on a slab and breaks its plate.
pub(crate) struct Melee {
    pub(crate) arena: Arena,
    /// Number of ticks by which the inputs are shifted against the first fight.
    shift: u64,
}

/// Position of the slab, metres.
const SLAB: DVec3 = DVec3::new(60.0, 1.0, 60.0);

impl Melee {
    pub(crate) fn new(giant: &Arc<CreatureKind>) -> Self {
        Self::another(giant, 0)
    }

    /// The same fight with other seeds and other inputs.
    pub(crate) fn another(giant: &Arc<CreatureKind>, number: u64) -> Self {
        let mut arena = Arena::new(ArenaConfig {
            seed: 5 + number,
            ..ArenaConfig::default()
        })
        .unwrap();
        arena
            .add_creature(
                Arc::clone(giant),
                CreatureConfig {
                    seed: 3 + number,
                    ..CreatureConfig::default()
                },
            )
            .unwrap();
        let way = Vec3::new(0.5, 0.1, -0.3);
        let slab = Slab {
            keys: moves(way, 600.0),
            weak_points: vec![weak_point("heart", Vec3::new(3.0, 0.0, 3.0), 9.0, 0)],
            plate: true,
            ..Slab::default()
        };
        let lies = CreatureConfig {
            position: SLAB,
            ..CreatureConfig::default()
        };
        arena.add_creature(slab.kind(), lies).unwrap();
        let mut config = FighterConfig::hero();
        if let Some(stamina) = &mut config.climber.stamina {
            stamina.shake_drain = 1.0 / 200.0;
        }
        // Stabs charge fast and cuts are strong, so that much happens in little time.
        if let Some(sword) = &mut config.sword {
            (sword.charge, sword.cut_damage) = (0.7, 1.0);
        }
        let places = [
            DVec3::new(4.2, 35.5, -2.0),
            DVec3::new(3.0, 1.0, 24.0),
            SLAB + DVec3::new(3.0, 1.5, 3.0),
        ];
        for place in places {
            arena.add_fighter(config, place).unwrap();
        }
        Self {
            arena,
            shift: 61 * number,
        }
    }

    /// Inputs of the three fighters after `tick` ticks.
    pub(crate) fn inputs(tick: u64) -> [ClimberInput; 3] {
        use clamber_fight::actions::{BOW, CUT, STAB, THROW};
        let second = tick / 60;
        let wave = |period: f64| libm::sin(tick as f64 / 60.0 / period * core::f64::consts::TAU);
        let rides = ClimberInput {
            // The rider lets go after a while, so that the giant turns to the others.
            grip: tick > 20 && tick < 1500,
            climb: if second % 7 < 2 {
                DVec3::new(wave(3.0), wave(5.0), wave(4.0))
            } else {
                DVec3::ZERO
            },
            jump: tick % 700 == 650,
            actions: if tick % 97 < 20 { STAB } else { 0 },
            ..ClimberInput::IDLE
        };
        // Later the runner stands still and waits for the giant.
        let runs = ClimberInput {
            walk: DVec3::new(wave(6.0), 0.0, wave(7.0))
                * f64::from(u8::from(second % 5 < 3 && tick < 2000)),
            grip: true,
            aim: DVec3::new(-0.1 + 0.1 * wave(3.0), 0.5, -1.0),
            jump: tick.is_multiple_of(130) && tick < 2000,
            actions: match tick % 150 {
                10..70 => BOW,
                100 => THROW,
                _ => 0,
            },
            ..ClimberInput::IDLE
        };
        let breaks = ClimberInput {
            walk: DVec3::new(wave(2.0), 0.0, wave(3.0)) * 0.2,
            aim: DVec3::new(0.3, -1.0, 0.2 * wave(5.0)),
            actions: match tick % 240 {
                20..80 => BOW,
                120 => CUT,
                180 | 230 => STAB,
                _ => 0,
            },
            ..ClimberInput::IDLE
        };
        [rides, runs, breaks]
    }

    pub(crate) fn step(&mut self) -> Vec<ArenaEvent> {
        let inputs = Self::inputs(self.arena.tick() + self.shift);
        self.arena.step(&inputs, &level_ground()).unwrap().to_vec()
    }
}
