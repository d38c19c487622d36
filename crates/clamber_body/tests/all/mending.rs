//! Lost holds, stretching skin, overlay clips, refused frames, missing obstacles, and allocations.

use clamber_animation::{Layer, LayerKind};
use clamber_body::{Body, BodyError, BodyInput, Extremity, OverlayClip, Side};
use clamber_climber::{Climber, ClimberConfig, ClimberInput, StepRules};
use clamber_scenes::bodies::{self, Stage};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, Influence, MeshSource, TriangleId,
};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DAffine3, DVec3};

use crate::figures;

/// Length of a tick and of a frame, seconds.
const DT: f64 = 1.0 / 60.0;

/// A wall at z = 0, 8 m wide and high, of squares of 5 cm. Its upper half follows joint 1, its lower half joint 0. The
/// weights change between heights of 3.8 and 4.2 m.
fn wall() -> SkinnedSurface {
    let cells = 160u32;
    let place = |k: u32| f64::from(k) * 0.05;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for row in 0..=cells {
        for column in 0..=cells {
            positions.push(DVec3::new(place(column) - 4.0, place(row), 0.0).as_vec3());
            if row < cells && column < cells {
                let [a, b] = [row, row + 1].map(|row| row * (cells + 1) + column);
                triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
            }
        }
    }
    let mut influences = Vec::new();
    let mut ends = Vec::new();
    for p in &positions {
        let upper = ((p.y - 3.8) / 0.4).clamp(0.0, 1.0);
        for (joint, weight) in [(0, 1.0 - upper), (1, upper)] {
            if weight > 0.0 {
                let joint = JointId(joint);
                influences.push(Influence { joint, weight });
            }
        }
        ends.push(influences.len() as u32);
    }
    let source = MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        influence_ends: &ends,
        joint_count: 2,
        ..MeshSource::default()
    };
    let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default())
        .unwrap()
        .0;
    let mut surface = SkinnedSurface::new(mesh.into());
    surface
        .teleport(&palette(0.0), Similarity::IDENTITY)
        .unwrap();
    surface
}

/// The palette that moves the upper half up by `up` metres.
fn palette(up: f32) -> Palette {
    let upper = Affine::from_f64(&DAffine3::from_translation(DVec3::Y * f64::from(up)));
    Palette::from_matrices([Affine::IDENTITY, upper])
}

struct Cling {
    surface: SkinnedSurface,
    climber: Climber,
    body: Body,
}

impl Cling {
    /// A climber that holds on with its shoulders at the border between the halves.
    fn new(figure: &clamber_body::Figure) -> Self {
        let mut config = ClimberConfig::colossus_climber();
        config.stamina = None;
        if let Some(grip) = &mut config.grip {
            grip.hang_acceleration = 1e6;
        }
        let start = DVec3::new(0.0, 3.7, -0.41);
        let mut cling = Self {
            surface: wall(),
            climber: Climber::new(config, start).unwrap(),
            body: Body::new(figure),
        };
        for _ in 0..90 {
            cling.step(figure, 0.0);
        }
        for extremity in Extremity::ALL {
            assert!(cling.body.hold(extremity).is_some(), "{extremity:?}");
        }
        cling
    }

    fn step(&mut self, figure: &clamber_body::Figure, up: f32) {
        self.surface
            .advance(&palette(up), Similarity::IDENTITY)
            .unwrap();
        let obstacles = [(ObstacleId(0), &self.surface as &dyn Obstacle)];
        let input = ClimberInput {
            grip: true,
            ..ClimberInput::IDLE
        };
        let rules = StepRules::by(&|query| query.usual().with_grip(true));
        self.climber
            .step_with(&input, &obstacles, &rules, DT)
            .unwrap();
        let frame = BodyInput::new(&self.climber, &obstacles);
        self.body.update(figure, &frame, DT).unwrap();
    }

    fn palm(&self, figure: &clamber_body::Figure, side: Side) -> DVec3 {
        self.body
            .touching_point(figure, Extremity::Hand(side))
            .unwrap()
    }
}

/// Scene B15: a hand takes hold beside the triangle under it when the triangle is removed.
#[test]
fn a_hand_whose_skin_is_gone_takes_hold_beside_it() {
    for (name, figure) in figures::all() {
        let mut cling = Cling::new(&figure);
        let hand = Extremity::Hand(Side::Left);
        let hold = *cling.body.hold(hand).unwrap();
        let triangle = TriangleId(hold.material.key as u32);
        cling.surface.disable_triangle(triangle).unwrap();
        for frame in 0..30 {
            cling.step(&figure, 0.0);
            let palm = cling.palm(&figure, Side::Left);
            let skin = cling.surface.closest_point(palm, 1.0).unwrap();
            assert!(
                skin.distance <= 0.02,
                "{name}, frame {frame}: {} m off",
                skin.distance
            );
            let is_lost = cling
                .body
                .hold(hand)
                .is_some_and(|now| now.material.key == hold.material.key);
            assert!(!is_lost, "{name}, frame {frame}: holds what is gone");
        }
        assert!(cling.body.hold(hand).is_some(), "{name}: no new hold");
    }
}

/// Scene B16: hands and feet let go of skin that stretches between them, and no bone stretches.
#[test]
fn skin_that_stretches_is_let_go() {
    for (name, figure) in figures::all() {
        let mut cling = Cling::new(&figure);
        let skeleton = figure.skeleton();
        let lengths = |body: &Body| {
            let limbs = figure.humanoid().arms.iter().chain(&figure.humanoid().legs);
            let lengths = limbs.map(|limb| limb.ik.lengths(skeleton, body.pose()).unwrap());
            lengths.collect::<Vec<_>>().concat()
        };
        let before = lengths(&cling.body);
        let mut moved = false;
        for frame in 0..60 {
            cling.step(&figure, 1.2 * frame as f32 / 60.0);
            for (was, is) in before.iter().zip(lengths(&cling.body)) {
                assert!(
                    (is / was - 1.0).abs() < 1e-3,
                    "{name}: bones stretch from {was} to {is}"
                );
            }
            moved |= !cling.body.plants().is_empty();
            for side in Side::BOTH {
                let Some(hold) = cling.body.hold(Extremity::Hand(side)) else {
                    continue;
                };
                let off = cling.palm(&figure, side).distance(hold.point);
                assert!(off <= 0.01, "{name}, frame {frame}: {off} m off its hold");
            }
        }
        assert!(moved, "{name}: nothing was let go");
    }
}

/// A weapon's clip takes one hand; the other limbs keep their holds.
#[test]
fn a_hand_with_a_weapon_leaves_its_hold() {
    let figure = figures::hero();
    let mut cling = Cling::new(&figure);
    let clip = figure.animations().find("swing").unwrap();
    let act = OverlayClip {
        layer: Layer {
            mask: Some(figure.upper_body()),
            ..Layer::once(clip)
        },
        hands: [false, true],
    };
    cling.body.set_overlay(&figure, Some(act), 0.2).unwrap();
    assert_eq!(cling.body.overlay_mut().unwrap().kind, LayerKind::Override);
    for _ in 0..20 {
        cling.step(&figure, 0.0);
    }
    assert!(cling.body.hold(Extremity::Hand(Side::Right)).is_none());
    assert!(cling.body.hold(Extremity::Hand(Side::Left)).is_some());
    cling.body.set_overlay(&figure, None, 0.2).unwrap();
    assert!(cling.body.overlay_mut().is_none());
    for _ in 0..40 {
        cling.step(&figure, 0.0);
    }
    assert!(cling.body.hold(Extremity::Hand(Side::Right)).is_some());
    let mut wrong = act;
    wrong.layer.clip.0 = 1000;
    assert!(cling.body.set_overlay(&figure, Some(wrong), 0.2).is_err());
}

/// An overlay clip may begin at any moment of a climb: it takes its hand only when the other hand holds, and that hand
/// goes on holding.
#[test]
fn an_act_never_takes_both_hands() {
    let figure = figures::hero();
    let clip = figure.animations().find("aim").unwrap();
    for speed in [0.0, 0.3, 0.75, 1.5] {
        let scene = bodies::wall(DVec3::Y * (speed / 1.5)).unwrap();
        for begin in 0..24 {
            let mut stage = Stage::new(&scene).unwrap();
            let mut body = Body::new(&figure);
            let (mut lost, mut acts) = (0, 0);
            for tick in 0..240 {
                if tick == 120 + begin {
                    let act = OverlayClip {
                        layer: Layer {
                            mask: Some(figure.upper_body()),
                            ..Layer::new(clip)
                        },
                        hands: [true, false],
                    };
                    body.set_overlay(&figure, Some(act), 0.2).unwrap();
                }
                stage.tick(DT).unwrap();
                let obstacles = stage.obstacles();
                let frame = BodyInput::new(&stage.climber, &obstacles);
                body.update(&figure, &frame, DT).unwrap();
                let holds = Side::BOTH.map(|side| body.hold(Extremity::Hand(side)).is_some());
                lost += u32::from(tick >= 120 && holds == [false; 2]);
                acts += u32::from(tick >= 120 && holds == [false, true]);
            }
            let what =
                format!("{speed} m/s, from tick {begin}: {lost} without hands, {acts} with one");
            // At higher speeds the remaining hand has to move.
            let most = if speed < 0.5 { 0 } else { 60 };
            assert!(lost <= most && acts > 60, "{what}");
        }
    }
}

/// Frames with bad numbers are refused, and the body does not change.
#[test]
fn bad_frames_are_refused() {
    let figure = figures::hero();
    let scene = bodies::flat(1.4).unwrap();
    let mut stage = Stage::new(&scene).unwrap();
    stage.tick(DT).unwrap();
    let mut body = Body::new(&figure);
    let obstacles = stage.obstacles();
    let good = BodyInput::new(&stage.climber, &obstacles);
    body.update(&figure, &good, DT).unwrap();
    let (pose, place) = (body.pose().clone(), body.world_from_model());
    for dt in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            body.update(&figure, &good, dt),
            Err(BodyError::Time(_))
        ));
    }
    let mut state = *stage.climber.state();
    state.position.x = f64::NAN;
    let bad = BodyInput {
        state: &state,
        ..good
    };
    assert!(matches!(
        body.update(&figure, &bad, DT),
        Err(BodyError::NotFinite(_))
    ));
    let look = BodyInput {
        look_at: Some(DVec3::INFINITY),
        ..good
    };
    assert!(matches!(
        body.update(&figure, &look, DT),
        Err(BodyError::NotFinite(_))
    ));
    assert_eq!(body.pose(), &pose);
    assert_eq!(body.world_from_model(), place);
    // A frame of 0 s changes nothing, and a frame of a minute is valid.
    body.update(&figure, &good, 0.0).unwrap();
    body.update(&figure, &good, 60.0).unwrap();
    assert!(
        body.pose()
            .transforms
            .iter()
            .all(|transform| transform.is_valid())
    );
}

/// A body without obstacles is updated, for climbers of several sizes.
#[test]
fn a_body_needs_no_obstacles() {
    let figure = figures::hero();
    for radius in [0.1, 0.4, 4.0] {
        let mut config = ClimberConfig::colossus_climber();
        config.body.radius = radius;
        let mut climber = Climber::new(config, DVec3::Y * 50.0).unwrap();
        let mut body = Body::new(&figure);
        for _ in 0..60 {
            climber.step(&ClimberInput::IDLE, &[], DT).unwrap();
            body.update(&figure, &BodyInput::new(&climber, &[]), DT)
                .unwrap();
            let off = body
                .world_from_model()
                .translation
                .distance(climber.state().position);
            assert!(off < 1.5 * radius + 0.5, "{off}");
        }
    }
}

/// Scene B25: a steady frame allocates nothing.
#[test]
fn steady_frames_allocate_nothing() {
    let figure = figures::hero();
    for scene in [
        bodies::flat(1.4).unwrap(),
        bodies::flat(0.0).unwrap(),
        bodies::wall(DVec3::Y * 0.5).unwrap(),
    ] {
        let mut stage = Stage::new(&scene).unwrap();
        let mut body = Body::new(&figure);
        for tick in 0..200 {
            stage.tick(DT).unwrap();
            let obstacles = stage.obstacles();
            let frame = BodyInput::new(&stage.climber, &obstacles);
            let used = allocation_counter::measure(|| body.update(&figure, &frame, DT).unwrap());
            assert!(
                tick < 100 || used.count_total == 0,
                "{}, tick {tick}: {used:?}",
                scene.name
            );
        }
    }
}
