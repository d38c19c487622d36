//! Known failures of other engines. Each scene is named after the issue or thread that reports it.
//!
//! Some are tested elsewhere. bevy#25605, picking hits in mid-air beside an animated body, is in
//! `bevy_clamber/tests/plugin/picking.rs`. avian#813 (eight overlapping moving meshes) and the cost in Unity's thread
//! 875257 (18 ms to bake 30,000 faces again) are measured for our skins by `clamber_benches`' benches `scene` and
//! `tick`. The other part of that thread, velocities of a posed mesh, is here.

use core::f64::consts::TAU;

use clamber_climber::ClimberMode::{Falling, Standing};
use clamber_surface::geometry::Similarity;
use glam::DVec3;

use crate::input::{IDLE, JUMP, walk};
use crate::scenarios::platforms::{chord, on};
use crate::stage::{
    Played, Run, Shape, Stage, TICK, every, jolt, kinds, shifted, turned, walker_at, within,
};

pub(crate) fn rapier_488_falling_through_a_rising_lift() {
    for (speed, thickness) in [(2.0, 0.2), (20.0, 0.2), (60.0, 0.05), (300.0, 0.01)] {
        every(0.0, |played| {
            let low = DVec3::new(-2.0, -thickness, -2.0);
            let plate = Shape::boxed(low, DVec3::new(2.0, 0.0, 2.0));
            let stage =
                Stage::new(played).with(&plate, move |time| shifted(DVec3::Y * (speed * time)));
            // The climber falls onto the rising lift.
            let mut run = Run::new(stage, jolt(), DVec3::Y * 1.0);
            for tick in 0..120 {
                run.step(&IDLE);
                let above = run.feet().y - speed * run.stage.time();
                assert!(
                    above >= -1e-3,
                    "{played:?} at {speed} m/s, tick {tick}: {above}"
                );
            }
            assert_eq!(run.mode(), Standing, "{played:?} at {speed} m/s");
            run.sound()
        });
    }
}

/// A climber on a floor, at a gap beside a wall that moves along its own plane.
fn beside_a_wall(played: Played, gap: f64) -> Run {
    let high = DVec3::new(40.0, 3.0, -0.32 - gap);
    let wall = Shape::boxed(DVec3::new(-40.0, -1.0, -2.0), high);
    let stage = Stage::new(played)
        .with_still(&Shape::floor(10.0))
        .with(&wall, |time| shifted(DVec3::X * (4.0 * time)));
    Run::new(stage, walker_at(2.0), DVec3::ZERO).settle()
}

pub(crate) fn shock2quest_666_dragged_along_a_brushed_wall() {
    // The wall is beside the climber, overlaps its margin, and is walked against.
    for (gap, direction) in [(0.0, DVec3::ZERO), (-0.005, DVec3::ZERO), (0.0, -DVec3::Z)] {
        every(0.0, |played| {
            let mut run = beside_a_wall(played, gap);
            run.steps(120, &walk(direction));
            let dragged = run.feet().x.abs();
            within!(dragged, 1e-3, "{played:?}, gap {gap}: by {dragged}");
            assert_eq!(run.mode(), Standing);
            run.sound()
        });
    }
    // Walking along the wall is neither slower nor faster than without it.
    every(0.0, |played| {
        let mut run = beside_a_wall(played, 0.0);
        run.steps(120, &walk(DVec3::X));
        let off = run.feet().distance(DVec3::X * 4.0);
        within!(off, 1e-3, "{played:?}: off by {off}");
        run.sound()
    });
}

pub(crate) fn godot_46604_drift_on_a_rotating_platform() {
    // A minute at one turn a second, 9 m from the axis.
    let motion = |time: f64| turned(DVec3::Y, TAU * time);
    every(chord(9.0, TAU), |played| {
        let mut run = on(played, 10.0, DVec3::X * 9.0, motion);
        let start = run.position();
        for tick in 0..3600 {
            run.step(&IDLE);
            let radius = DVec3::new(run.position().x, 0.0, run.position().z).length();
            assert!(
                (radius - 9.0).abs() <= 1e-4,
                "{played:?}, tick {tick}: {radius}"
            );
        }
        let expected = motion(run.stage.time()).transform_point(start);
        let off = run.position().distance(expected);
        within!(off, 1e-3, "{played:?}: {off}");
        run.sound()
    });
}

pub(crate) fn godot_101253_one_frame_behind_the_platform() {
    let motion = |time: f64| shifted(DVec3::new(20.0, 5.0, -10.0) * libm::sin(3.0 * time));
    every(0.0, |played| {
        let mut run = on(played, 5.0, DVec3::X, motion);
        for tick in 0..120 {
            run.step(&IDLE);
            // A lag of one frame would be up to 1.15 m.
            let local = motion(run.stage.time()).inverse_transform_point(run.feet());
            let off = local.distance(DVec3::X);
            within!(off, 1e-4, "{played:?}, tick {tick}: {off} behind");
        }
        run.sound()
    });
}

pub(crate) fn jolt_1988_a_jump_eaten_by_stick_to_floor_on_a_descending_lift() {
    for lift in [3.0, 8.0] {
        every(0.0, |played| {
            let mut config = jolt();
            config.ground.jump_speed = 3.0;
            let motion = move |time: f64| shifted(DVec3::Y * (-lift * time));
            let stage = Stage::new(played).with(&Shape::floor(5.0), motion);
            let mut run = Run::new(stage, config, DVec3::ZERO).settle();
            run.steps(20, &IDLE);
            run.step(&JUMP);
            for tick in 0..20 {
                assert_eq!(run.mode(), Falling, "{played:?}, {lift} m/s, tick {tick}");
                run.step(&IDLE);
            }
            let above = run.feet().y + lift * run.stage.time();
            assert!(above > 0.3, "{played:?}: {above} above the lift");
            run.sound()
        });
    }
}

pub(crate) fn jolt_1514_jitter_on_a_diagonally_descending_platform() {
    let motion = |time: f64| {
        // Back and forth, so that it also reverses.
        let phase = time.rem_euclid(4.0);
        shifted(DVec3::new(0.0, -3.0, -3.0) * phase.min(4.0 - phase))
    };
    every(0.0, |played| {
        let mut run = on(played, 4.0, DVec3::new(0.5, 0.0, 0.5), motion);
        let start = motion(0.0).inverse_transform_point(run.position());
        let mut before = start;
        for tick in 0..720 {
            run.step(&IDLE);
            let local = motion(run.stage.time()).inverse_transform_point(run.position());
            let jitter = local.distance(before);
            within!(jitter, 1e-5, "{played:?}, tick {tick}: {jitter}");
            before = local;
        }
        assert!(run.trace.always(Standing));
        run.sound()
    });
}

pub(crate) fn tnua_13_pushed_when_the_platform_reverses() {
    let motion = |time: f64| {
        let phase = (6.0 * time).rem_euclid(12.0);
        shifted(DVec3::X * phase.min(12.0 - phase))
    };
    every(0.0, |played| {
        let mut run = on(played, 4.0, DVec3::Z, motion);
        for tick in 0..600 {
            run.step(&IDLE);
            let local = motion(run.stage.time()).inverse_transform_point(run.feet());
            let off = local.distance(DVec3::Z);
            within!(off, 1e-5, "{played:?}, tick {tick}: {off}");
        }
        assert!(run.trace.always(Standing));
        run.sound()
    });
}

pub(crate) fn unity_875257_no_velocities_of_a_mesh_that_is_posed() {
    let velocity = DVec3::new(3.0, -2.0, 1.0);
    for &played in kinds() {
        let motion = move |time: f64| Similarity::from_translation(velocity * time);
        let mut stage = Stage::new(played).with(&Shape::floor(5.0), motion);
        stage.advance();
        stage.advance();
        let found = stage.obstacles(|obstacles| {
            let (_, obstacle) = obstacles[0];
            let near = velocity * stage.time() + DVec3::Y;
            let contact = obstacle.closest_point(near, 2.0).unwrap();
            obstacle.motion(&contact.material, TICK).unwrap().velocity
        });
        assert!(found.distance(velocity) <= 1e-3, "{played:?}: {found}");
    }
}
