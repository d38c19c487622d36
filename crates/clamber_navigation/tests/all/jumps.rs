//! Catches at the end of jumps from the ground: climbers fare as `starts_on_ground` says.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use crate::support::{Body, climber};
use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberState};
use clamber_navigation::{ClimbGraph, Footing, GraphConfig, Start};
use clamber_surface::mesh::SurfaceKind::{Fur, Skin};
use clamber_world::{HalfSpace, Obstacle, ObstacleId};
use glam::{DVec3, Vec3};

/// A wall above the ground, with fur from a height upwards.
fn wall(fur_from: f32) -> Body {
    let place = |u: f32, v: f32| Vec3::new(8.0 * (u - 0.5), 12.0 * v, 0.0);
    Body::grid([16, 48], place, move |_, v| {
        if 12.0 * v >= fur_from { Fur } else { Skin }
    })
}

/// The starts at which a climber from the ground holds on.
fn holds(graph: &ClimbGraph, stamina: f64) -> Vec<Start> {
    let starts = graph.starts_on_ground(stamina);
    starts
        .filter(|start| start.footing == Footing::Holds)
        .collect()
}

/// The result of a gripping climber's jump at the wall.
#[derive(Debug, PartialEq)]
enum Jumped {
    /// The climber holds on, with this much stamina left.
    Holds(f64),
    /// The climber's hands slipped.
    Slips,
    /// The climber came down again.
    Misses,
}

/// A jump from a distance in radii before the wall, at a share of the walking speed.
fn jump(body: &Body, climber: &ClimberConfig, stamina: f64, (away, share): (f64, f64)) -> Jumped {
    let surface = body.surface();
    let ground = HalfSpace::below(0.0);
    let around: [(ObstacleId, &dyn Obstacle); 2] =
        [(ObstacleId(0), &ground), (ObstacleId(1), &surface)];
    let radius = climber.body.radius;
    let mut jumps = Climber::new(*climber, DVec3::new(0.1, radius, -away * radius)).unwrap();
    let rested = *jumps.state();
    jumps.restore(ClimberState { stamina, ..rested }).unwrap();
    for tick in 0..180 {
        let input = ClimberInput {
            walk: DVec3::Z * share,
            // The climber is up to speed by then.
            jump: tick == 12,
            grip: true,
            ..ClimberInput::IDLE
        };
        let report = jumps.step(&input, &around, 1.0 / 60.0).unwrap();
        for event in report.events {
            match event {
                ClimberEvent::Grabbed { .. } => return Jumped::Holds(jumps.state().stamina),
                ClimberEvent::HandsSlipped { .. } => return Jumped::Slips,
                _ => {}
            }
        }
    }
    Jumped::Misses
}

/// The results of jumps from several places at several speeds.
fn jumps(body: &Body, climber: &ClimberConfig, stamina: f64) -> Vec<Jumped> {
    let places = (0..8).flat_map(|k| [(k, 0.0), (k, 0.5), (k, 1.0)]);
    let places = places.map(|(k, share)| (1.1 + 0.3 * f64::from(k) + 2.0 * share, share));
    places
        .map(|place| jump(body, climber, stamina, place))
        .collect()
}

/// The climber of the presets with this cost of a catch.
fn config(catch_cost: f64) -> GraphConfig {
    let mut config = climber();
    if let Some(stamina) = &mut config.climber.stamina {
        // Standing would refill stamina before the jump, and holding on would drain it.
        (stamina.catch_cost, stamina.refill, stamina.hold_drain) = (catch_cost, 0.0, 0.0);
    }
    config
}

#[test]
fn a_catch_leaves_at_least_what_the_graph_says() {
    let mut dearest: f64 = 0.0;
    for fur_from in [0.0, 0.8, 1.2, 1.6, 2.0] {
        let (body, config) = (wall(fur_from), config(0.05));
        let (graph, _) = body.report(&config);
        for stamina in [1.0, 0.6] {
            let starts = holds(&graph, stamina);
            let least = starts.iter().map(|start| start.stamina).fold(1.0, f64::min);
            for jumped in jumps(&body, &config.climber, stamina) {
                if let Jumped::Holds(left) = jumped {
                    assert!(
                        left >= least,
                        "{fur_from}: {left} of {stamina}, not {least}"
                    );
                    dearest = dearest.max((stamina - left) / (stamina - least));
                }
            }
        }
    }
    // The bound is not much too low either.
    assert!(dearest > 0.9, "{dearest}");
}

#[test]
fn holds_that_hands_do_not_catch_are_no_starts() {
    let body = wall(1.6);
    // A climber with less stamina than a catch costs.
    let config = config(0.05);
    let (graph, _) = body.report(&config);
    assert!(!holds(&graph, 1.0).is_empty());
    let rests = |starts: Vec<Start>| starts.iter().all(|start| start.stamina >= 0.0);
    assert!(rests(holds(&graph, 0.02)));
    assert!(holds(&graph, 0.02).len() < holds(&graph, 1.0).len());
    // A climber whose hands catch only slow holds.
    let mut slow = config.clone();
    if let Some(grip) = &mut slow.climber.grip {
        grip.catch_speed = 2.0;
    }
    let (graph, report) = body.report(&slow);
    assert!(holds(&graph, 1.0).is_empty() && report.reachable_area == 0.0);
    let jumped = jumps(&body, &slow.climber, 1.0);
    assert!(jumped.contains(&Jumped::Slips), "{jumped:?}");
}
