use clamber_climber::{Climber, ClimberEvent, ClimberInput, ClimberMode, ClimberState};
use clamber_surface::surface::SkinnedSurface;
use glam::{DQuat, DVec3, Vec3};

use crate::cases::pairs;
use crate::events::{is_caught, is_grabbed};
use crate::input::{HOLD, IDLE, grip_climb, grip_walk};
use crate::scene::{
    DT, FUR, STONE, assert_mode, climber, cuboid, cuboid_at, cuboid_with, moved, moved_turned,
    placed_turned, run, step, tick_among,
};

/// A climber that hangs from the upper front edge of a block of stone.
fn hung(block: &SkinnedSurface) -> Climber {
    let mut climber = climber(DVec3::new(0.3, 2.75, 3.5));
    let toward = grip_walk(-DVec3::Z * 0.1);
    let events = run(&mut climber, &[block], &toward, 1);
    assert!(caught(&events), "{events:?} {:?}", climber.state());
    run(&mut climber, &[block], &HOLD, 60);
    assert_mode(&climber, ClimberMode::LedgeHanging);
    climber
}

fn block() -> SkinnedSurface {
    cuboid(Vec3::new(4.0, 3.0, 3.0), STONE)
}

#[test]
fn catches_a_ledge_in_flight_and_hangs_below_it() {
    let climber = hung(&block());
    let position = climber.state().position;
    assert!((position.y - 2.4).abs() < 0.05, "{position}");
    assert!(position.z > 3.39 && position.z < 3.7, "{position}");
}

#[test]
fn pulls_itself_up_and_stands_on_top() {
    let block = block();
    let mut climber = hung(&block);
    let up = grip_walk(-DVec3::Z);
    let events = run(&mut climber, &[&block], &up, 60);
    assert!(events.contains(&ClimberEvent::Mantled), "{events:?}");
    assert_mode(&climber, ClimberMode::Standing);
    let state = climber.state();
    assert!((state.position.y - 3.4).abs() < 1e-3, "{state:?}");
}

#[test]
fn goes_along_a_ledge_and_around_its_end() {
    let block = block();
    let mut climber = hung(&block);
    let aside = grip_walk(DVec3::X);
    run(&mut climber, &[&block], &aside, 60);
    let x = climber.state().position.x;
    assert!((x - 1.3).abs() < 0.02, "{x}");
    run(&mut climber, &[&block], &aside, 300);
    assert_mode(&climber, ClimberMode::LedgeHanging);
    let position = climber.state().position;
    assert!((position.x - 4.4).abs() < 0.02, "{position}");
    assert!(position.z < 2.0, "{position}");
}

#[test]
fn drops_or_jumps_off_a_ledge() {
    let block = block();
    let mut climber = hung(&block);
    let events = run(&mut climber, &[&block], &IDLE, 1);
    assert!(events.contains(&ClimberEvent::Released), "{events:?}");
    let mut climber = hung(&block);
    let jump = ClimberInput { jump: true, ..HOLD };
    let events = run(&mut climber, &[&block], &jump, 1);
    assert!(events.contains(&ClimberEvent::Jumped), "{events:?}");
    assert!(climber.state().velocity.z > 1.0, "{:?}", climber.state());
}

#[test]
fn a_ledge_that_tips_away_drops_and_one_that_tips_back_becomes_ground() {
    for (sign, expected) in [(1.0, ClimberMode::Falling), (-1.0, ClimberMode::Standing)] {
        let mut block = block();
        let mut climber = hung(&block);
        let mut modes = Vec::new();
        for tick in 0..240 {
            // The block turns about its far lower edge, so that the ledge tips over that edge, or the wall lies down.
            let angle = sign * 0.4 * f64::from(tick) * DT;
            let half = angle * 0.5;
            let turn = DQuat::from_xyzw(libm::sin(half), 0.0, 0.0, libm::cos(half));
            moved_turned(&mut block, DVec3::ZERO, turn);
            step(&mut climber, &[&block], &HOLD);
            modes.push(climber.state().mode);
            if climber.state().mode != ClimberMode::LedgeHanging {
                break;
            }
        }
        let state = climber.state();
        assert_eq!(modes.last(), Some(&expected), "{sign}: {state:?}");
    }
}

#[test]
fn rides_a_ledge_that_moves() {
    let mut block = block();
    let mut climber = hung(&block);
    let offset = climber.state().position;
    for tick in 1..=120 {
        let at = DVec3::new(0.0, 0.02, 0.05) * f64::from(tick);
        moved(&mut block, at);
        step(&mut climber, &[&block], &HOLD);
        let off = climber.state().position - at - offset;
        assert!(off.length() < 1e-3, "{tick}: {off}");
    }
}

fn caught(events: &[ClimberEvent]) -> bool {
    events.iter().any(is_caught)
}

#[test]
fn a_standing_or_sliding_climber_catches_the_ledge_in_front() {
    let block = block();
    let step_below = cuboid_at(Vec3::new(4.0, 2.0, 2.0), STONE, DVec3::new(0.0, 0.0, 5.0));
    let surfaces = [&block, &step_below];
    let toward = grip_walk(-DVec3::Z);
    let mut climber = climber(DVec3::new(0.3, 2.4, 3.45));
    run(&mut climber, &surfaces, &IDLE, 5);
    assert_mode(&climber, ClimberMode::Standing);
    let mut sliding = climber.clone();
    let events = run(&mut climber, &surfaces, &toward, 1);
    assert!(caught(&events), "{events:?} {:?}", climber.state());
    let state = ClimberState {
        mode: ClimberMode::Sliding,
        support: None,
        ..*sliding.state()
    };
    sliding.restore(state).unwrap();
    let events = run(&mut sliding, &surfaces, &toward, 1);
    assert!(caught(&events), "{events:?} {:?}", sliding.state());
}

#[test]
fn climbs_up_to_a_ledge_over_it_and_down_again() {
    let fur_below = |p: Vec3| if p.y > 2.1 { STONE } else { FUR };
    let block = cuboid_with(Vec3::new(4.0, 3.0, 3.0), fur_below);
    let mut climber = climber(DVec3::new(0.3, 0.0, 3.4));
    let toward = |sign: f64| grip_walk(-DVec3::Z * sign);
    let events = run(&mut climber, &[&block], &toward(1.0), 240);
    assert!(caught(&events), "{events:?} {:?}", climber.state());
    assert!(events.contains(&ClimberEvent::Mantled), "{events:?}");
    // From hanging again, down to the fur.
    let mut climber = hung(&block);
    let events = run(&mut climber, &[&block], &toward(-1.0), 60);
    let gripped = events.iter().any(is_grabbed);
    assert!(gripped, "{events:?} {:?}", climber.state());
    assert_mode(&climber, ClimberMode::Holding);
    assert!(climber.state().position.y < 2.0, "{:?}", climber.state());
}

#[test]
fn a_standing_climber_ignores_ledges_that_would_not_lift_its_feet() {
    let ground = cuboid(Vec3::new(6.0, 1.0, 6.0), STONE);
    for (height, lifts) in [(0.9, false), (1.2, true)] {
        let place = DVec3::new(0.0, height, -1.5);
        let block = cuboid_at(Vec3::new(4.0, 1.0, 1.0), STONE, place);
        let surfaces = [&ground, &block];
        let mut climber = climber(DVec3::new(0.3, 1.4, 0.0));
        run(&mut climber, &surfaces, &IDLE, 5);
        assert_mode(&climber, ClimberMode::Standing);
        let toward = grip_walk(-DVec3::Z * 0.01);
        let events = run(&mut climber, &surfaces, &toward, 20);
        assert_eq!(caught(&events), lifts, "{height}: {events:?}");
    }
}

#[test]
fn pulls_itself_up_out_from_under_an_overhang() {
    let mut block = block();
    // The wall leans over by 35 degrees, so that its upper edge is in front.
    let half = 17.5f64.to_radians();
    let lean = DQuat::from_xyzw(libm::sin(half), 0.0, 0.0, libm::cos(half));
    placed_turned(&mut block, DVec3::ZERO, lean);
    let edge = lean * DVec3::new(0.3, 3.0, 3.0);
    let mut climber = climber(edge + DVec3::new(0.0, -0.25, 0.5));
    let up = grip_walk(-DVec3::Z);
    let events = run(&mut climber, &[&block], &up, 60);
    assert!(caught(&events), "{events:?} {:?}", climber.state());
    assert!(events.contains(&ClimberEvent::Mantled), "{events:?}");
}

/// A ledge that leans over presses a climber that pulls itself up against the ground and a wall behind it. The climber
/// lets go, and is not dragged into them.
#[test]
fn a_ledge_that_crushes_it_lets_go() {
    let ground = cuboid(Vec3::new(8.0, 1.0, 8.0), STONE);
    let mut block = block();
    let half = 10f64.to_radians();
    let lean = DQuat::from_xyzw(libm::sin(half), 0.0, 0.0, libm::cos(half));
    let middle = DVec3::Y * 3.0;
    placed_turned(&mut block, middle, lean);
    let edge = middle + lean * DVec3::new(0.3, 3.0, 3.0);
    let behind = cuboid_at(
        Vec3::new(8.0, 4.0, 0.5),
        STONE,
        DVec3::new(0.0, 3.0, edge.z + 1.15),
    );
    let mut climber = climber(edge + DVec3::new(0.0, -0.55, 0.24));
    run(&mut climber, &[&ground, &block, &behind], &HOLD, 30);
    let pull = grip_climb(DVec3::Y);
    assert_mode(&climber, ClimberMode::LedgeHanging);
    let mut crushed: f64 = 0.0;
    for tick in 1..=240 {
        let down = 3.4 * (1.0 - (f64::from(tick) / 120.0 - 1.0).abs());
        moved_turned(&mut block, middle - DVec3::Y * down, lean);
        let report = tick_among(&mut climber, &[&ground, &block, &behind], &pull);
        for event in report.events {
            if let ClimberEvent::Crushed { depth } = event {
                crushed = crushed.max(depth);
            }
        }
    }
    assert!(crushed > 0.01 && crushed < 0.1, "{crushed}");
    run(&mut climber, &[&ground, &block, &behind], &IDLE, 60);
    assert_mode(&climber, ClimberMode::Standing);
    let height = climber.state().position.y;
    assert!((height - 1.4).abs() < 0.02, "{height}");
}

/// Around a corner, a held stick leads on along the ledge. After it is released, it is read anew: towards the wall is
/// up.
#[test]
fn a_released_stick_is_read_anew_after_a_corner() {
    for (released, (stick, rises)) in pairs([1, 6, 60], [(-DVec3::X, true), (DVec3::X, false)]) {
        let block = cuboid(Vec3::new(1.0, 1.0, 1.0), STONE);
        let mut climber = climber(DVec3::new(0.5, 0.9, 1.42));
        run(&mut climber, &[&block], &HOLD, 60);
        assert_mode(&climber, ClimberMode::LedgeHanging);
        let along = grip_walk(DVec3::X);
        run(&mut climber, &[&block], &along, 180);
        let heading = climber.state().heading;
        assert!(heading.x < -0.99, "it is round the corner: {heading}");
        run(&mut climber, &[&block], &HOLD, released);
        let from = climber.state().position;
        let input = grip_walk(stick);
        run(&mut climber, &[&block], &input, 50);
        let way = climber.state().position - from;
        let told = format!("released for {released}, {stick}: {way}");
        assert!((way.y > 0.5) == rises, "{told}");
        assert!(rises || way.z.abs() < 0.05, "{told}");
    }
}
