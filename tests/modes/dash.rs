use clamber::climber::ClimberMode;
use glam::{DQuat, DVec3};

use crate::scene::{DASH, Motion, Scene, act, walk};

/// A dash on the floor; its button is held for one tick.
pub(crate) fn play(frame: DVec3) -> Scene {
    let mut scene = Scene::new(frame, DVec3::Y * 0.4).settled();
    scene.step(&act(DVec3::X, 1));
    scene.steps(8, &walk(DVec3::X));
    scene
}

pub(crate) fn end(scene: &mut Scene) {
    scene.steps(40, &walk(DVec3::X));
}

#[test]
fn a_dash_is_a_quarter_of_a_second_at_12_metres_a_second() {
    let mut scene = Scene::new(DVec3::ZERO, DVec3::Y * 0.4).settled();
    let from = scene.position();
    scene.step(&act(DVec3::X, 1));
    assert_eq!(scene.mode(), DASH);
    assert!(
        (scene.velocity() - DVec3::X * 12.0).length() < 1e-9,
        "{}",
        scene.velocity()
    );
    scene.steps(14, &walk(DVec3::ZERO));
    assert_eq!(scene.mode(), ClimberMode::Standing);
    assert_eq!(scene.ticks_in(DASH), 14);
    let went = scene.position() - from;
    assert!((went - DVec3::X * 3.0).length() < 1e-6, "{went}");
    scene.steps(10, &walk(DVec3::ZERO));
    assert!(
        scene.position().distance(from + DVec3::X * 3.0) < 0.1,
        "it slides on"
    );
}

#[test]
fn a_held_dash_repeats_after_its_cooldown() {
    let mut scene = Scene::new(DVec3::ZERO, DVec3::new(-40.0, 0.4, 0.0)).settled();
    let mut begun = Vec::new();
    for tick in 0..200 {
        let was = scene.mode();
        scene.step(&act(DVec3::X, 1));
        if was != DASH && scene.mode() == DASH {
            begun.push(tick);
        }
    }
    // A dash of 0.25 s and a cooldown of 1 s.
    assert_eq!(begun.len(), 3, "{begun:?}");
    assert!(
        begun
            .windows(2)
            .all(|pair| (74..=76).contains(&(pair[1] - pair[0]))),
        "{begun:?}"
    );
}

#[test]
fn a_dash_does_not_go_through_a_wall() {
    let wall = Scene::new(DVec3::ZERO, DVec3::Y * 0.4).with_box([1.5, 0.0, -9.0], [1.52, 3.0, 9.0]);
    let mut scene = wall.settled();
    scene.step(&act(DVec3::X, 1));
    scene.steps(30, &walk(DVec3::X));
    let x = scene.position().x;
    assert!((1.08..1.11).contains(&x), "{x}");
}

#[test]
fn a_dash_in_the_air_is_level_and_falls_after_it() {
    let mut scene = Scene::new(DVec3::ZERO, DVec3::Y * 9.0);
    scene.steps(30, &walk(DVec3::ZERO));
    let from = scene.position();
    scene.step(&act(DVec3::X, 1));
    scene.steps(13, &walk(DVec3::ZERO));
    let went = scene.position() - from;
    assert_eq!(scene.mode(), DASH);
    assert!((went - DVec3::X * 2.8).length() < 1e-9, "{went}");
    scene.steps(10, &walk(DVec3::ZERO));
    assert_eq!(scene.mode(), ClimberMode::Falling);
    assert!(scene.position().y < from.y, "it hovers");
}

/// One platform moves at 4 m/s and rises; the other one turns by half a radian a second.
#[test]
fn on_a_moving_platform_a_dash_is_relative_to_it() {
    let went_over = |motion: Motion| {
        let scene = Scene::new(DVec3::ZERO, DVec3::new(1.0, 0.4, 0.0)).without_floor();
        let mut scene = scene
            .with_moving([-20.0, -1.0, -20.0], [20.0, 0.0, 20.0], motion)
            .settled();
        let on_platform = |scene: &Scene| {
            let (turn, by) = motion(scene.time());
            turn.conjugate() * (scene.position() - by)
        };
        let from = on_platform(&scene);
        scene.step(&act(DVec3::X, 1));
        // The platform has turned by then.
        let along = motion(scene.time()).0.conjugate() * DVec3::X;
        scene.steps(14, &walk(DVec3::ZERO));
        assert_eq!(scene.mode(), ClimberMode::Standing);
        on_platform(&scene) - from - along * 3.0
    };
    let off = went_over(|time| (DQuat::IDENTITY, DVec3::new(0.0, 1.0, 4.0) * time));
    assert!(off.length() < 1e-6, "{off}");
    let off = went_over(|time| {
        let half = 0.25 * time;
        let turn = DQuat::from_xyzw(0.0, libm::sin(half), 0.0, libm::cos(half));
        (turn, DVec3::ZERO)
    });
    assert!(off.length() < 1e-6, "{off}");
}
