//! Tests of all modes. [`Scene::step`] also checks that a mode's state can be restored in any tick.

use clamber::climber::{
    ClimberError, ClimberInput, ClimberMode, CustomMode, Knockback, ModeContext, NextMode,
    StepRules,
};
use clamber::prelude::Climber;
use glam::DVec3;

use crate::modes::dash::Dash;
use crate::scene::{DASH, SWIM, Scene, VAULT, WALL_RUN};
use crate::{dash, swim, vault, wall_run};

/// A mode, a function that makes a scene in that mode, and a function that continues the scene until the mode ends.
type Play = (ClimberMode, fn(DVec3) -> Scene, fn(&mut Scene));

/// The modes of the example.
const PLAYS: [Play; 4] = [
    (DASH, dash::play, dash::end),
    (VAULT, vault::play, vault::end),
    (WALL_RUN, wall_run::play, wall_run::end),
    (SWIM, swim::play, swim::end),
];

/// Velocity of a moving frame, metres a second.
const FRAME: DVec3 = DVec3::new(25.0, -10.0, 13.0);

#[test]
fn every_mode_is_the_same_in_a_moving_frame() {
    for (mode, play, end) in PLAYS {
        let run = |frame| {
            let mut scene = play(frame);
            assert_eq!(scene.mode(), mode, "{frame}");
            end(&mut scene);
            assert_ne!(scene.mode(), mode, "{frame}");
            scene
        };
        let (still, moving) = (run(DVec3::ZERO), run(FRAME));
        for (tick, (a, b)) in still.trace.iter().zip(&moving.trace).enumerate() {
            let apart = [a.0.distance(b.0), a.1.distance(b.1)];
            assert!(
                apart[0] < 1e-6 && a.2 == b.2,
                "{mode:?} tick {tick}: {a:?} {b:?}"
            );
            assert!(apart[1] < 1e-5, "{mode:?} tick {tick}: {a:?} {b:?}");
        }
    }
}

#[test]
fn a_blow_ends_every_mode_and_adds_its_velocity() {
    for (mode, play, _) in PLAYS {
        let mut scene = play(DVec3::ZERO);
        assert_eq!(scene.mode(), mode);
        let before = scene.velocity();
        let blow = Knockback {
            velocity: DVec3::new(0.0, 2.0, 3.0),
            ..Knockback::default()
        };
        scene.knockback = Some(blow);
        scene.step(&ClimberInput::IDLE);
        let state = scene.climber.state();
        assert_eq!(state.mode, ClimberMode::Falling, "{mode:?}");
        assert!(state.support.is_none(), "{mode:?}");
        let change = state.velocity - before - blow.velocity + DVec3::Y * 9.81 / 60.0;
        assert!(change.length() < 1e-6, "{mode:?}: {change}");
    }
}

#[test]
fn without_its_handler_every_mode_ends_in_a_fall_with_the_same_velocity() {
    for (mode, play, _) in PLAYS {
        for frame in [DVec3::ZERO, FRAME] {
            let mut scene = play(frame);
            let before = scene.velocity();
            scene.step_without(&ClimberInput::IDLE, Some(mode));
            let state = *scene.climber.state();
            assert!(!state.mode.is_custom(), "{mode:?}: {:?}", state.mode);
            let mut change = scene.velocity() - before;
            // During the dash the climber is on the ground, and lands at once.
            change.y = 0.0;
            assert!(change.length() < 1e-6, "{mode:?} {frame}: {change}");
        }
    }
}

#[test]
fn two_modes_with_one_id_are_an_error_and_change_nothing() {
    let scene = Scene::new(DVec3::ZERO, DVec3::Y);
    let mut climber: Climber = scene.climber;
    let before = *climber.state();
    let (one, other) = (
        Dash::default(),
        Dash {
            speed: 3.0,
            ..Dash::default()
        },
    );
    let modes: [&dyn CustomMode; 2] = [&one, &other];
    let rules = StepRules::with_modes(&modes);
    let refused = climber.step_with(&ClimberInput::IDLE, &[], &rules, 0.1);
    assert_eq!(refused, Err(ClimberError::SameMode(1)));
    assert_eq!(*climber.state(), before);
}

/// A mode that never begins, and stores the distance to the ground below the climber.
struct Feel;

impl CustomMode for Feel {
    fn id(&self) -> u16 {
        9
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        let ground = context.ground_below(3.0);
        let gap = ground.map_or(-1.0, |ground| ground.position.distance(context.position()));
        context.custom_slots()[7] = gap;
        false
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        context.let_go()
    }
}

/// The post is 0.2 m wide. At 30 m/s, a probe from the climber's position a tick ago would miss the post.
#[test]
fn before_its_movement_a_mode_finds_the_ground_where_it_is_at_that_time() {
    for frame in [DVec3::ZERO, FRAME] {
        let scene = Scene::new(frame, DVec3::Y * 2.4).without_floor();
        let mut scene = scene.with_box([-0.1, -9.0, -0.1], [0.1, 0.0, 0.1]);
        scene.extra = Some(Box::new(Feel));
        for tick in 0..90 {
            let height = scene.position().y - 0.4;
            scene.step(&ClimberInput::IDLE);
            let felt = scene.climber.state().custom_slots[7];
            assert!(
                (felt - height).abs() < 1e-6,
                "{frame}, tick {tick}: {felt} {height}"
            );
        }
        assert_eq!(scene.mode(), ClimberMode::Standing);
    }
}
