use clamber_climber::{ClimberEvent, ClimberInput, ClimberMode, ClimberState};
use clamber_world::{Obstacle, ObstacleId};
use glam::{DQuat, DVec3, Vec3};

use crate::scene::{
    DT, FUR, HOLD, STONE, assert_mode, climber, cuboid, cuboid_with, moved, placed, run, step,
};

/// A climber that hangs from the upper front edge of a block of stone.
fn hung(block: &clamber_surface::surface::SkinnedSurface) -> clamber_climber::Climber {
    let mut climber = climber(DVec3::new(0.3, 2.75, 3.5));
    let toward = ClimberInput {
        walk: -DVec3::Z * 0.1,
        ..HOLD
    };
    let events = run(&mut climber, &[block], &toward, 1);
    let caught = |event: &ClimberEvent| matches!(event, ClimberEvent::LedgeCaught { .. });
    assert!(
        events.iter().any(caught),
        "{events:?} {:?}",
        climber.state()
    );
    run(&mut climber, &[block], &HOLD, 60);
    assert_mode(&climber, ClimberMode::LedgeHanging);
    climber
}

fn block() -> clamber_surface::surface::SkinnedSurface {
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
    let up = ClimberInput {
        walk: -DVec3::Z,
        ..HOLD
    };
    let events = run(&mut climber, &[&block], &up, 60);
    assert!(events.contains(&ClimberEvent::Mantled), "{events:?}");
    assert_mode(&climber, ClimberMode::Standing);
    assert!(
        (climber.state().position.y - 3.4).abs() < 1e-3,
        "{:?}",
        climber.state()
    );
}

#[test]
fn goes_along_a_ledge_and_around_its_end() {
    let block = block();
    let mut climber = hung(&block);
    let aside = ClimberInput {
        walk: DVec3::X,
        ..HOLD
    };
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
    let events = run(&mut climber, &[&block], &ClimberInput::default(), 1);
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
            moved(&mut block, DVec3::ZERO, turn);
            step(&mut climber, &[&block], &HOLD);
            modes.push(climber.state().mode);
            if climber.state().mode != ClimberMode::LedgeHanging {
                break;
            }
        }
        assert_eq!(
            modes.last(),
            Some(&expected),
            "{sign}: {:?}",
            climber.state()
        );
    }
}

#[test]
fn rides_a_ledge_that_moves() {
    let mut block = block();
    let mut climber = hung(&block);
    let offset = climber.state().position;
    for tick in 1..=120 {
        let at = DVec3::new(0.0, 0.02, 0.05) * f64::from(tick);
        moved(&mut block, at, DQuat::IDENTITY);
        step(&mut climber, &[&block], &HOLD);
        let off = climber.state().position - at - offset;
        assert!(off.length() < 1e-3, "{tick}: {off}");
    }
}

fn caught(events: &[ClimberEvent]) -> bool {
    let is_catch = |event: &ClimberEvent| matches!(event, ClimberEvent::LedgeCaught { .. });
    events.iter().any(is_catch)
}

#[test]
fn a_standing_or_sliding_climber_catches_the_ledge_in_front() {
    let block = block();
    let mut step_below = cuboid(Vec3::new(4.0, 2.0, 2.0), STONE);
    placed(&mut step_below, DVec3::new(0.0, 0.0, 5.0), DQuat::IDENTITY);
    let surfaces = [&block, &step_below];
    let toward = ClimberInput {
        walk: -DVec3::Z,
        ..HOLD
    };
    let mut climber = climber(DVec3::new(0.3, 2.4, 3.45));
    run(&mut climber, &surfaces, &ClimberInput::default(), 5);
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
    let toward = |sign: f64| ClimberInput {
        walk: -DVec3::Z * sign,
        ..HOLD
    };
    let events = run(&mut climber, &[&block], &toward(1.0), 240);
    assert!(caught(&events), "{events:?} {:?}", climber.state());
    assert!(events.contains(&ClimberEvent::Mantled), "{events:?}");
    // From hanging again, down to the fur.
    let mut climber = hung(&block);
    let events = run(&mut climber, &[&block], &toward(-1.0), 60);
    let gripped = |event: &ClimberEvent| matches!(event, ClimberEvent::Grabbed { .. });
    assert!(
        events.iter().any(gripped),
        "{events:?} {:?}",
        climber.state()
    );
    assert_mode(&climber, ClimberMode::Holding);
    assert!(climber.state().position.y < 2.0, "{:?}", climber.state());
}

#[test]
fn a_standing_climber_ignores_ledges_that_would_not_lift_its_feet() {
    let ground = cuboid(Vec3::new(6.0, 1.0, 6.0), STONE);
    for (height, lifts) in [(0.9, false), (1.2, true)] {
        let mut block = cuboid(Vec3::new(4.0, 1.0, 1.0), STONE);
        placed(&mut block, DVec3::new(0.0, height, -1.5), DQuat::IDENTITY);
        let surfaces = [&ground, &block];
        let mut climber = climber(DVec3::new(0.3, 1.4, 0.0));
        run(&mut climber, &surfaces, &ClimberInput::default(), 5);
        assert_mode(&climber, ClimberMode::Standing);
        let toward = ClimberInput {
            walk: -DVec3::Z * 0.01,
            ..HOLD
        };
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
    placed(&mut block, DVec3::ZERO, lean);
    let edge = lean * DVec3::new(0.3, 3.0, 3.0);
    let mut climber = climber(edge + DVec3::new(0.0, -0.25, 0.5));
    let up = ClimberInput {
        walk: -DVec3::Z,
        ..HOLD
    };
    let events = run(&mut climber, &[&block], &up, 60);
    assert!(caught(&events), "{events:?} {:?}", climber.state());
    assert!(events.contains(&ClimberEvent::Mantled), "{events:?}");
}

/// A ledge that leans over presses a climber that pulls itself up against the ground and a wall behind it. The climber
/// lets go, and is not dragged into them.
#[test]
fn a_ledge_that_crushes_it_lets_go() {
    let ground = cuboid(Vec3::new(8.0, 1.0, 8.0), STONE);
    let mut behind = cuboid(Vec3::new(8.0, 4.0, 0.5), STONE);
    let mut block = block();
    let half = 10f64.to_radians();
    let lean = DQuat::from_xyzw(libm::sin(half), 0.0, 0.0, libm::cos(half));
    let middle = DVec3::Y * 3.0;
    placed(&mut block, middle, lean);
    let edge = middle + lean * DVec3::new(0.3, 3.0, 3.0);
    placed(
        &mut behind,
        DVec3::new(0.0, 3.0, edge.z + 1.15),
        DQuat::IDENTITY,
    );
    let mut climber = climber(edge + DVec3::new(0.0, -0.55, 0.24));
    run(&mut climber, &[&ground, &block, &behind], &HOLD, 30);
    let pull = ClimberInput {
        climb: DVec3::Y,
        ..HOLD
    };
    assert_mode(&climber, ClimberMode::LedgeHanging);
    let mut crushed: f64 = 0.0;
    for tick in 1..=240 {
        let down = 3.4 * (1.0 - (f64::from(tick) / 120.0 - 1.0).abs());
        moved(&mut block, middle - DVec3::Y * down, lean);
        let obstacles: [(ObstacleId, &dyn Obstacle); 3] = [
            (ObstacleId(0), &ground),
            (ObstacleId(1), &block),
            (ObstacleId(2), &behind),
        ];
        let report = climber.step(&pull, &obstacles, DT).unwrap();
        for event in report.events {
            if let ClimberEvent::Crushed { depth } = event {
                crushed = crushed.max(depth);
            }
        }
    }
    assert!(crushed > 0.01 && crushed < 0.1, "{crushed}");
    run(
        &mut climber,
        &[&ground, &block, &behind],
        &ClimberInput::default(),
        60,
    );
    assert_mode(&climber, ClimberMode::Standing);
    let height = climber.state().position.y;
    assert!((height - 1.4).abs() < 0.02, "{height}");
}

/// Around a corner, a held stick leads on along the ledge. After it is released, it is read anew: towards the wall is
/// up.
#[test]
fn a_released_stick_is_read_anew_after_a_corner() {
    for released in [1, 6, 60] {
        for (stick, rises) in [(-DVec3::X, true), (DVec3::X, false)] {
            let block = cuboid(Vec3::new(1.0, 1.0, 1.0), STONE);
            let mut climber = climber(DVec3::new(0.5, 0.9, 1.42));
            run(&mut climber, &[&block], &HOLD, 60);
            assert_mode(&climber, ClimberMode::LedgeHanging);
            let along = ClimberInput {
                walk: DVec3::X,
                ..HOLD
            };
            run(&mut climber, &[&block], &along, 180);
            let heading = climber.state().heading;
            assert!(heading.x < -0.99, "it is round the corner: {heading}");
            run(&mut climber, &[&block], &HOLD, released);
            let from = climber.state().position;
            let input = ClimberInput {
                walk: stick,
                ..HOLD
            };
            run(&mut climber, &[&block], &input, 50);
            let way = climber.state().position - from;
            let told = format!("released for {released}, {stick}: {way}");
            assert!((way.y > 0.5) == rises, "{told}");
            assert!(rises || way.z.abs() < 0.05, "{told}");
        }
    }
}
