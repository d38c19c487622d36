//! Climbing tours from foot to head, on creatures that idle, walk and shake gently.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber::mesh::VertexId;
use clamber::prelude::*;
use clamber_scenes::climbs::{Motion, RATE, Stage, Ways, long_climber};
use clamber_scenes::{Creature, giant, test_data};
use glam::DVec3;

/// Height of the creatures, metres.
const HEIGHT: f64 = 20.0;

/// A tour ends after this time, seconds.
const LIMIT: f64 = 120.0;

/// A waypoint counts as reached within this distance of the climber's centre, metres.
const REACHED: f64 = 0.9;

/// The climber gives up a waypoint after this time, seconds: it may lie in a crease that the climber does not enter.
const PATIENCE: f64 = 4.0;

/// The result of a tour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Outcome {
    /// Seconds until the climber arrived, or until the tour ended.
    seconds: f64,
    /// Number of waypoints that the climber gave up.
    skipped: u32,
    /// True if the climber reached the end of the route.
    arrived: bool,
    /// How often the climber lost its hold and fell, slid or tumbled, except when it was shaken off.
    falls: u32,
    /// Corners that the climber turned.
    corners: u32,
    /// The largest depth of skin in the climber's core (its body less the margin), metres. Ticks that crush it are left
    /// out.
    penetration: f64,
}

/// Climbs along a route. The climber may grip all of the creature, as if it were all fur.
fn tour(stage: &mut Stage<'_>, route: &[VertexId]) -> Outcome {
    let mut outcome = Outcome::default();
    let (mut next, mut climber) = on_the_route(stage, route);
    let mut since = 0.0;
    for tick in 1..=(LIMIT * RATE) as u32 {
        let time = f64::from(tick) / RATE;
        stage.advance(time).unwrap();
        let position = climber.state().position;
        let is_reached = |index: &usize| stage.vertex(route[*index]).0.distance(position) < REACHED;
        // Any of the next few counts, since the climber cuts corners.
        if let Some(reached) = (next..route.len()).take(6).filter(is_reached).max() {
            (next, since) = (reached + 1, time);
        } else if time - since > PATIENCE {
            (next, since) = (next + 1, time);
            outcome.skipped += 1;
        }
        outcome.seconds = time;
        outcome.arrived = next == route.len();
        if outcome.arrived {
            break;
        }
        let toward = stage.vertex(route[next]).0 - position;
        let input = ClimberInput {
            climb: toward.normalize_or(DVec3::Y),
            grip: true,
            ..ClimberInput::default()
        };
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), stage.surface())];
        let grips = |query: &ContactQuery<'_>| query.usual().with_grip(true);
        let report = climber.step_with(&input, &obstacles, &StepRules::by(&grips), 1.0 / RATE);
        let events = report.unwrap().events;
        outcome.count(&events);
        let is_crushed = |event: &ClimberEvent| matches!(event, ClimberEvent::Crushed { .. });
        if !events.iter().any(is_crushed) {
            let body = &climber.config().body;
            let core = climber.body().with_radius(body.radius - body.margin);
            let mut contacts = Vec::new();
            stage.surface().overlap_capsule(&core, &mut contacts);
            let depths = contacts
                .iter()
                .map(|contact| core.radius - contact.distance);
            outcome.penetration = depths.fold(outcome.penetration, f64::max);
        }
    }
    outcome
}

/// The first waypoint with room for a climber, and a climber there. The route may begin in a crease.
fn on_the_route(stage: &Stage<'_>, route: &[VertexId]) -> (usize, Climber) {
    let config = long_climber();
    let radius = config.body.radius;
    let places = route.iter().map(|vertex| {
        let (point, normal) = stage.vertex(*vertex);
        point + normal * (radius + 0.05)
    });
    let has_room = |place: &DVec3| stage.surface().closest_point(*place, radius).is_none();
    let (first, place) = places
        .enumerate()
        .find(|(_, place)| has_room(place))
        .unwrap();
    (first, Climber::new(config, place).unwrap())
}

impl Outcome {
    fn count(&mut self, events: &[ClimberEvent]) {
        let shaken_off = |event: &ClimberEvent| matches!(event, ClimberEvent::ShakenOff { .. });
        let shaken_off = events.iter().any(shaken_off);
        for event in events {
            if let ClimberEvent::Changed { from, to } = event {
                let fell = matches!(
                    to,
                    ClimberMode::Falling | ClimberMode::Sliding | ClimberMode::Tumbling
                );
                self.falls += u32::from(from.is_holding() && fell && !shaken_off);
            }
            self.corners += u32::from(matches!(event, ClimberEvent::TurnedCorner { .. }));
        }
    }
}

/// Makes tours with all motions, and checks them. `thrown` is the number of tours that may end early, thrown off a
/// swinging foot before the climber is on the leg.
fn tours(creature: &Creature, tempo: f64, seeds: u64, thrown: usize) {
    let ways = Ways::new(creature).unwrap();
    let mut failed = Vec::new();
    for (first, motion) in (0..).zip([Motion::Idle, Motion::Walk, Motion::Shake]) {
        for seed in (first..seeds).step_by(3) {
            let mut stage = Stage::new(creature, (HEIGHT, tempo), motion).unwrap();
            let outcome = tour(&mut stage, &ways.climb(seed).unwrap());
            println!("{} {motion:?} {seed}: {outcome:?}", creature.name);
            let good = outcome.arrived && outcome.falls == 0 && outcome.penetration <= 1e-3;
            if !good {
                failed.push((motion, seed, outcome));
            }
        }
    }
    let is_thrown = |(motion, _, outcome): &&(Motion, u64, Outcome)| {
        matches!(motion, Motion::Walk) && outcome.corners == 0
    };
    let early = failed.iter().filter(is_thrown).count();
    assert!(
        failed.len() == early && early <= thrown,
        "{}: {failed:#?}",
        creature.name
    );
}

#[test]
fn tours_reach_the_giants_head() {
    // The giant's soles do not slide, so its feet swing as fast as it walks: with 3 g.
    tours(&giant::giant().unwrap(), 1.0, 20, 1);
}

#[test]
fn tours_reach_the_heads_of_five_models() {
    for name in ["Trex", "Apatosaurus", "Triceratops", "Stag", "Bull"] {
        let Some(path) = test_data::file("tours", &format!("models/{name}.glb")) else {
            return;
        };
        // The clips were made for animals about two metres tall, or for robots, so they are slowed here.
        tours(&Creature::load(&path).unwrap(), 0.12, 20, 0);
    }
}
