use clamber::climber::{ClimberInput, ClimberMode};
use glam::DVec3;

use crate::scene::{Scene, WALL_RUN, act, walk};

/// A climber in the air beside a wall along X, with a velocity of 4 m/s along the wall.
fn beside_wall(frame: DVec3, length: f64) -> Scene {
    let mut scene = Scene::new(frame, DVec3::new(0.0, 9.0, 0.45));
    scene = scene.with_box([-1.0, 0.0, -0.5], [length, 20.0, 0.0]);
    let mut state = *scene.climber.state();
    state.velocity += DVec3::X * 4.0;
    scene.climber.restore(state).unwrap();
    scene
}

pub(crate) fn play(frame: DVec3) -> Scene {
    let mut scene = beside_wall(frame, 40.0);
    scene.steps(30, &act(DVec3::X, 4));
    scene
}

pub(crate) fn end(scene: &mut Scene) {
    scene.steps(90, &act(DVec3::X, 4));
}

#[test]
fn a_wall_run_lasts_one_and_a_half_seconds_and_falls() {
    let mut scene = beside_wall(DVec3::ZERO, 40.0);
    scene.steps(120, &act(DVec3::X, 4));
    let ticks = scene.ticks_in(WALL_RUN);
    assert!((89..=91).contains(&ticks), "{ticks}");
    assert_eq!(scene.mode(), ClimberMode::Falling);
    let (first, last) = (scene.trace[0].0, scene.trace[88].0);
    assert!(
        (last.x - first.x - 88.0 / 60.0 * 5.0).abs() < 1e-3,
        "{first} {last}"
    );
    assert!((last.y - first.y).abs() < 1e-6, "{first} {last}");
    assert!(last.z < 0.401, "it must stay at the wall: {last}");
    assert!(scene.position().y < last.y);
}

#[test]
fn a_wall_run_ends_where_the_wall_does() {
    let mut scene = beside_wall(DVec3::ZERO, 2.0);
    scene.steps(60, &act(DVec3::X, 4));
    let ticks = scene.ticks_in(WALL_RUN);
    assert_eq!(scene.mode(), ClimberMode::Falling);
    // The run is 2 m long, plus the distance on which the ball still touches the edge.
    assert!((22..30).contains(&ticks), "{ticks}");
    assert!(scene.position().x > 3.0, "{}", scene.position());
}

#[test]
fn a_wall_run_ends_when_its_button_is_released_and_by_a_jump_off_the_wall() {
    let mut scene = play(DVec3::ZERO);
    assert_eq!(scene.mode(), WALL_RUN);
    scene.step(&walk(DVec3::X));
    assert_eq!(scene.mode(), ClimberMode::Falling);

    let mut scene = play(DVec3::ZERO);
    let jump = ClimberInput {
        jump: true,
        ..act(DVec3::X, 4)
    };
    scene.step(&jump);
    let velocity = scene.velocity();
    assert_eq!(scene.mode(), ClimberMode::Falling);
    assert!(
        velocity.z > 4.9 && velocity.y > 4.5 && velocity.x > 4.9,
        "{velocity}"
    );
}

#[test]
fn a_second_run_needs_feet_on_the_ground_between() {
    let mut scene = beside_wall(DVec3::ZERO, 40.0);
    scene.steps(240, &act(DVec3::X, 4));
    assert_eq!(
        scene.mode(),
        ClimberMode::Standing,
        "{:?}",
        scene.climber.state()
    );
    let ticks = scene.ticks_in(WALL_RUN);
    assert!((89..=91).contains(&ticks), "{ticks}");
    let along = DVec3::new(1.0, 0.0, -0.1);
    scene.steps(30, &act(along, 4));
    scene.step(&ClimberInput {
        jump: true,
        ..act(along, 4)
    });
    scene.steps(30, &act(along, 4));
    assert_eq!(scene.mode(), WALL_RUN, "{:?}", scene.climber.state());
}

#[test]
fn a_wall_across_the_way_ends_a_run() {
    let mut scene = beside_wall(DVec3::ZERO, 40.0).with_box([3.0, 0.0, 0.0], [3.5, 20.0, 9.0]);
    scene.steps(60, &act(DVec3::X, 4));
    assert_eq!(scene.mode(), ClimberMode::Falling);
    assert!(scene.position().x < 2.61, "{}", scene.position());
}
