use clamber::climber::{ClimberInput, ClimberMode};
use glam::DVec3;

use crate::scene::{Scene, VAULT, act, walk};

fn at_wall(frame: DVec3, height: f64, thickness: f64) -> Scene {
    Scene::new(frame, DVec3::Y * 0.4).with_box([1.0, 0.0, -9.0], [1.0 + thickness, height, 9.0])
}

fn run(scene: Scene) -> Scene {
    let mut scene = scene.settled();
    scene.steps(90, &act(DVec3::X, 2));
    scene
}

pub(crate) fn play(frame: DVec3) -> Scene {
    let mut scene = at_wall(frame, 1.0, 0.3).settled();
    scene.steps(15, &act(DVec3::X, 2));
    scene
}

pub(crate) fn end(scene: &mut Scene) {
    scene.steps(60, &walk(DVec3::X));
}

#[test]
fn a_wall_of_a_metre_is_vaulted() {
    let scene = run(at_wall(DVec3::ZERO, 1.0, 0.3));
    assert!(scene.ticks_in(VAULT) > 10);
    assert_eq!(scene.mode(), ClimberMode::Standing);
    let at = scene.position();
    assert!(at.x > 1.7 && (at.y - 0.4).abs() < 1e-3, "{at}");
}

#[test]
fn a_block_of_a_metre_is_stood_on() {
    let scene = run(at_wall(DVec3::ZERO, 1.0, 20.0));
    let at = scene.position();
    assert_eq!(scene.mode(), ClimberMode::Standing);
    assert!(at.x > 1.7 && (at.y - 1.4).abs() < 1e-3, "{at}");
}

#[test]
fn a_wall_of_two_metres_is_not_vaulted() {
    let scene = run(at_wall(DVec3::ZERO, 2.0, 0.3));
    assert_eq!(scene.ticks_in(VAULT), 0);
    assert!(
        (scene.position().x - 0.6).abs() < 1e-3,
        "{}",
        scene.position()
    );
}

#[test]
fn a_wall_is_not_vaulted_without_the_button() {
    let mut scene = at_wall(DVec3::ZERO, 1.0, 0.3).settled();
    scene.steps(60, &walk(DVec3::X));
    assert_eq!(scene.ticks_in(VAULT), 0);
}

/// One ceiling leaves no room above the climber, the other one leaves none above the wall.
#[test]
fn no_one_vaults_into_a_ceiling() {
    for from in [-9.0, 1.0] {
        let ceiling = at_wall(DVec3::ZERO, 1.0, 0.3).with_box([from, 1.6, -9.0], [9.0, 2.0, 9.0]);
        let scene = run(ceiling);
        assert_eq!(scene.ticks_in(VAULT), 0, "ceiling from {from}");
    }
}

/// The climber gives up, and falls.
#[test]
fn an_obstacle_in_the_way_ends_a_vault() {
    let wall = at_wall(DVec3::ZERO, 1.0, 0.3);
    let gate = |time: f64| {
        let shut = (time - 1.1).clamp(0.0, 0.2) * -20.0;
        (glam::DQuat::IDENTITY, DVec3::Y * shut)
    };
    let mut scene = wall
        .with_moving([1.0, 5.2, -9.0], [1.3, 9.0, 9.0], gate)
        .settled();
    scene.steps(20, &act(DVec3::X, 2));
    assert_eq!(scene.mode(), VAULT);
    scene.steps(160, &ClimberInput::IDLE);
    assert_eq!(scene.mode(), ClimberMode::Standing);
    assert!(scene.position().x < 1.0, "{}", scene.position());
}
