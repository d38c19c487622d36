use clamber::climber::{ClimberInput, ClimberMode};
use glam::DVec3;

use crate::scene::{SWIM, Scene, act, walk};

/// Four metres of water over the floor. From x = 6 on, steps lead ashore.
fn pool(frame: DVec3, position: DVec3) -> Scene {
    let scene = Scene::new(frame, position).with_water([-20.0, 0.0, -9.0], [20.0, 4.0, 9.0]);
    let steps = (0..8_u8).map(|step| (6.0 + 0.6 * f64::from(step), 3.25 + 0.2 * f64::from(step)));
    steps.fold(scene, |scene, (x, height)| {
        scene.with_box([x, 0.0, -9.0], [20.0, height, 9.0])
    })
}

pub(crate) fn play(frame: DVec3) -> Scene {
    let mut scene = pool(frame, DVec3::new(0.0, 5.5, 0.0));
    scene.steps(60, &act(DVec3::new(0.5, 0.0, 0.5), 8));
    scene
}

pub(crate) fn end(scene: &mut Scene) {
    scene.steps(180, &rise(DVec3::X));
}

fn rise(direction: DVec3) -> ClimberInput {
    ClimberInput {
        jump_held: true,
        ..walk(direction)
    }
}

#[test]
fn a_swimmer_sinks_and_rises_by_input_and_else_hovers() {
    let mut scene = pool(DVec3::ZERO, DVec3::new(0.0, 3.0, 0.0));
    scene.steps(30, &ClimberInput::IDLE);
    assert_eq!(scene.mode(), SWIM);
    let from = scene.position();
    scene.steps(30, &ClimberInput::IDLE);
    assert!(scene.position().distance(from) < 1e-9);
    scene.steps(60, &act(DVec3::ZERO, 8));
    assert!((scene.velocity().y + 2.0).abs() < 1e-9 || scene.position().y < 0.41);
    assert!(scene.position().y < from.y - 1.5, "{}", scene.position());
    scene.steps(120, &act(DVec3::ZERO, 8));
    assert!(
        (scene.position().y - 0.4).abs() < 1e-3,
        "not through the bottom"
    );
    assert_eq!(scene.mode(), SWIM);
    scene.steps(60, &rise(DVec3::ZERO));
    assert!(
        (scene.velocity().y - 2.0).abs() < 1e-9,
        "{}",
        scene.velocity()
    );
    scene.steps(120, &rise(DVec3::ZERO));
    // At the surface, the swimmer floats.
    assert_eq!(scene.mode(), SWIM);
    assert!(
        (scene.position().y - 3.8).abs() < 1e-9,
        "{}",
        scene.position()
    );
}

#[test]
fn a_swimmer_leaves_at_the_surface_by_a_jump() {
    let jump = ClimberInput {
        jump: true,
        ..ClimberInput::IDLE
    };
    let mut scene = pool(DVec3::ZERO, DVec3::new(0.0, 2.0, 0.0));
    scene.steps(30, &ClimberInput::IDLE);
    scene.step(&jump);
    assert_eq!(scene.mode(), SWIM, "below the surface it does not jump");
    scene.steps(120, &rise(DVec3::ZERO));
    scene.step(&jump);
    assert_eq!(scene.mode(), ClimberMode::Falling);
    let mut highest = 0.0f64;
    for _ in 0..80 {
        scene.step(&ClimberInput::IDLE);
        highest = highest.max(scene.position().y);
    }
    assert!((highest - 3.8 - 25.0 / 19.62).abs() < 1e-2, "{highest}");
    assert_eq!(scene.mode(), SWIM, "it came back");
}

#[test]
fn a_swimmer_comes_ashore_and_goes_in_again() {
    let mut scene = pool(DVec3::ZERO, DVec3::new(3.0, 3.5, 0.0));
    scene.steps(300, &walk(DVec3::X));
    assert_eq!(
        scene.mode(),
        ClimberMode::Standing,
        "{:?}",
        scene.climber.state()
    );
    assert!(scene.position().y > 4.9, "{}", scene.position());
    scene.steps(300, &walk(-DVec3::X));
    assert_eq!(scene.mode(), SWIM, "{:?}", scene.climber.state());
    assert!(scene.position().x < 5.0, "{}", scene.position());
    // The climber enters the water at most twice, so the mode does not flicker at the shore.
    let modes = scene
        .trace
        .windows(2)
        .filter(|pair| pair[0].2 != SWIM && pair[1].2 == SWIM);
    assert!(modes.count() <= 2);
}

#[test]
fn a_swimmer_leaves_at_the_side_of_the_water() {
    let scene = Scene::new(DVec3::ZERO, DVec3::new(0.0, 3.0, 0.0));
    let mut scene = scene.with_water([-1.0, 0.0, -1.0], [1.0, 4.0, 1.0]);
    scene.steps(90, &walk(DVec3::X));
    assert_ne!(scene.mode(), SWIM);
    assert!(scene.ticks_in(SWIM) > 20);
}
