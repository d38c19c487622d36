//! Debris that is restored from a snapshot while bodies come out or are let through.

use glam::DVec3;
use rapier3d::prelude::*;

use super::{Does, Stage, shapes};
use crate::debris::{Debris, DebrisConfig, DebrisReport, DebrisSnapshot};

/// Ticks of the scene.
const TICKS: u32 = 240;

fn stage() -> Stage {
    let mut stage = Stage::new(60, DVec3::X * 30.0);
    stage.creature(9, DVec3::new(6.0, 2.0, 6.0), 1.0);
    stage.creature(4, DVec3::new(3.0, 1.0, 3.0), 0.5);
    stage.ground(-4.0);
    stage
}

/// Places of both creatures: one is placed where rocks are, the other is new there, later.
fn does(tick: u32) -> [Does; 2] {
    let swings = DVec3::Y * 0.3 * libm::sin(0.1 * f64::from(tick));
    let large = match tick {
        0 => Does::IsPlaced(DVec3::Y * 9.0),
        90 => Does::IsPlaced(DVec3::X),
        _ if tick < 90 => Does::Moves(DVec3::Y * 9.0 + swings),
        _ => Does::Moves(DVec3::X + swings * 0.2),
    };
    let small = match tick {
        0..40 => Does::IsAway,
        40 => Does::IsPlaced(DVec3::Y * -3.2),
        _ => Does::Moves(DVec3::Y * -3.2 + swings),
    };
    [large, small]
}

/// The game's part before a tick: rocks break off.
fn before(stage: &mut Stage, tick: u32) {
    let shapes = shapes(0.3);
    if tick.is_multiple_of(12) && tick < 120 {
        let number = f64::from(tick / 12);
        let place = DVec3::new(0.5 * number - 2.0, 10.8 - 0.03 * number, 0.8 - 0.2 * number);
        let lower = DVec3::new(0.4 * number - 2.0, -3.6, 0.7 - 0.1 * number);
        for place in [place, lower] {
            stage.rock(&shapes[tick as usize / 12 % 4].0, place);
        }
    }
}

fn go_on(stage: &mut Stage, ticks: std::ops::Range<u32>) -> Vec<(Vec<u32>, DebrisReport)> {
    let ticks = ticks.map(|tick| {
        before(stage, tick);
        let report = stage.tick("restored", &does(tick));
        (stage.bits(), report)
    });
    ticks.collect()
}

#[test]
fn a_fresh_value_that_restores_a_snapshot_goes_on_with_the_same_bits() {
    let mut whole = stage();
    let wanted = go_on(&mut whole, 0..TICKS);
    let sum = |count: fn(&DebrisReport) -> u32| wanted.iter().map(|(_, r)| count(r)).sum::<u32>();
    let counts = [
        sum(|report| report.put_out),
        sum(|report| report.caught),
        sum(|report| report.enclosed),
    ];
    assert!(
        counts[0] > 20 && counts[1] > 200 && counts[2] > 10,
        "{counts:?}"
    );
    let mut went_on = stage();
    for tick in 0..TICKS - 1 {
        assert_eq!(
            go_on(&mut went_on, tick..tick + 1),
            wanted[tick as usize..=tick as usize]
        );
        if tick % 3 != 0 && tick % 90 > 4 {
            continue;
        }
        let snapshot = DebrisSnapshot::save(&went_on.world, &went_on.debris);
        // Another session, which has only the snapshot and creatures at the same places.
        let mut fresh = stage();
        fresh.world = PhysicsWorld::default();
        fresh.world.integration_parameters = went_on.world.integration_parameters;
        fresh.debris = Debris::new(DebrisConfig::default());
        snapshot.restore(&mut fresh.world, &mut fresh.debris);
        fresh.rocks = went_on.rocks.clone();
        fresh.ticks = went_on.ticks;
        let stand = does(tick).map(|does| match does {
            Does::Moves(place) => Does::IsPlaced(place),
            other => other,
        });
        fresh.pose(&stand);
        let end = (tick + 40).min(TICKS);
        let found = go_on(&mut fresh, tick + 1..end);
        for (found, wanted) in found.iter().zip(&wanted[tick as usize + 1..]) {
            assert_eq!(found, wanted, "restored after tick {tick}");
        }
    }
}
