//! A bot grips a creature's foot and climbs to its head while the creature moves.

mod route;
mod stage;

pub use route::{Route, Ways};
pub use stage::{Motion, Stage};

use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, StepRules};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

/// Ticks per second.
pub const RATE: f64 = 60.0;

/// A waypoint counts as reached within this distance of the climber's centre, metres.
const REACHED: f64 = 0.9;

/// Seconds after which the climber gives up a waypoint.
const PATIENCE: f64 = 4.0;

/// The result of a tour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Seconds until the climber arrived, or until the tour ended.
    pub seconds: f64,
    /// Share of the waypoints that the climber reached or gave up.
    pub progress: f64,
    /// True if the climber reached the end of the route.
    pub arrived: bool,
    /// How often the climber lost its hold and fell, slid or tumbled, except when it was shaken off.
    pub falls: u32,
    /// How often the climber began to hang by its hands ([`ClimberMode::Hanging`]).
    pub hung: u32,
    /// Waypoints that the climber gave up.
    pub skipped: u32,
    /// Corners that the climber turned.
    pub corners: u32,
    /// The largest depth of skin in the climber's core (its body less the margin), metres. Ticks that crush it are left
    /// out.
    pub penetration: f64,
    /// Ticks in which the climber's movement was not clear, plus the events that it was crushed.
    pub trouble: u32,
    /// The climber's mode at the end.
    pub mode: Option<ClimberMode>,
}

/// The settings of a climber for long ways: [`ClimberConfig::colossus_climber`], with stamina to hold on for 600 s to a
/// creature that keeps still.
pub fn config() -> ClimberConfig {
    let mut config = ClimberConfig::colossus_climber();
    if let Some(stamina) = &mut config.stamina {
        stamina.hold_drain = 1.0 / 600.0;
    }
    config
}

/// Climbs along a route for at most `limit` seconds. The climber may grip all of the creature, as if it were all fur.
///
/// # Errors
/// If the creature cannot be posed, the climber cannot be made, or there is no room for it anywhere on the route.
pub fn climb(
    stage: &mut Stage<'_>,
    route: &Route,
    config: ClimberConfig,
    limit: f64,
) -> Result<Outcome, Box<dyn std::error::Error>> {
    let mut outcome = Outcome::default();
    stage.place(0.0)?;
    let (first, start) =
        free_place(stage, route, &config).ok_or("there is no room for the climber on the route")?;
    let mut climber = Climber::new(config, start)?;
    let (mut next, mut since) = (first, 0.0);
    let ticks = (limit * RATE) as u32;
    for tick in 1..=ticks {
        let time = f64::from(tick) / RATE;
        stage.advance(time)?;
        let position = climber.state().position;
        let distance = |waypoint| stage.vertex(waypoint).0.distance(position);
        // Any of the next few that has been reached counts, since the climber cuts corners.
        let ahead = (next..route.waypoints.len()).take(6);
        if let Some(reached) = ahead
            .filter(|index| distance(route.waypoints[*index]) < REACHED)
            .max()
        {
            (next, since) = (reached + 1, time);
        } else if time - since > PATIENCE {
            // The waypoint lies in a crease that the climber's ball does not enter.
            (next, since) = (next + 1, time);
            outcome.skipped += 1;
        }
        outcome.seconds = time;
        outcome.progress = next as f64 / route.waypoints.len() as f64;
        if next == route.waypoints.len() {
            outcome.arrived = true;
            break;
        }
        let toward = stage.vertex(route.waypoints[next]).0 - position;
        let input = ClimberInput {
            climb: toward.normalize_or(DVec3::Y),
            grip: true,
            ..ClimberInput::default()
        };
        let surface = stage.surface();
        let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), surface)];
        let report = climber.step_with(
            &input,
            &obstacles,
            &StepRules::by(&|query| query.usual().with_grip(true)),
            1.0 / RATE,
        )?;
        outcome.count(&report.events);
        outcome.trouble += u32::from(!report.is_clear);
        let body = &climber.config().body;
        let core = climber.body().with_radius(body.radius - body.margin);
        let mut contacts = Vec::new();
        surface.overlap_capsule(&core, &mut contacts);
        let is_crushed = report
            .events
            .iter()
            .any(|event| matches!(event, ClimberEvent::Crushed { .. }));
        for contact in contacts.iter().filter(|_| !is_crushed) {
            outcome.penetration = outcome.penetration.max(core.radius - contact.distance);
        }
    }
    outcome.mode = Some(climber.state().mode);
    Ok(outcome)
}

/// The first waypoint with room for a climber, and the climber's position there. The route may begin in a crease.
fn free_place(stage: &Stage<'_>, route: &Route, config: &ClimberConfig) -> Option<(usize, DVec3)> {
    let radius = config.body.radius;
    let mut places = route.waypoints.iter().enumerate().map(|(index, vertex)| {
        let (point, normal) = stage.vertex(*vertex);
        (index, point + normal * (radius + 0.05))
    });
    places.find(|(_, place)| stage.surface().closest_point(*place, radius).is_none())
}

impl Outcome {
    fn count(&mut self, events: &[ClimberEvent]) {
        let shaken_off = events
            .iter()
            .any(|event| matches!(event, ClimberEvent::ShakenOff { .. }));
        for event in events {
            match event {
                ClimberEvent::Changed { from, to } => {
                    let fell = matches!(
                        to,
                        ClimberMode::Falling | ClimberMode::Sliding | ClimberMode::Tumbling
                    );
                    self.falls += u32::from(from.is_holding() && fell && !shaken_off);
                    self.hung += u32::from(*to == ClimberMode::Hanging);
                }
                ClimberEvent::TurnedCorner { .. } => self.corners += 1,
                ClimberEvent::Crushed { .. } => self.trouble += 1,
                _ => {}
            }
        }
    }
}
