//! A bot grips a creature's foot and climbs to its head, while the creature moves.

mod ascent;
mod route;
mod stage;

pub use ascent::Ascent;
pub use route::{Route, Ways};
pub use stage::{Motion, Stage};

use clamber_climber::{Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, StepRules};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

/// Ticks a second.
pub const RATE: f64 = 60.0;

/// How near to a waypoint, metres from the climber's centre, it counts as reached.
const REACHED: f64 = 0.9;

/// Seconds for which it tries to reach a waypoint.
const PATIENCE: f64 = 4.0;

/// What became of a tour.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outcome {
    /// Seconds until the head was reached, or the end.
    pub seconds: f64,
    /// Share of the way.
    pub progress: f64,
    /// It arrived.
    pub arrived: bool,
    /// Times that it lost its hold for any reason but stamina.
    pub falls: u32,
    /// Times that it hung.
    pub hung: u32,
    /// Waypoints that it gave up.
    pub skipped: u32,
    /// Corners that it turned.
    pub corners: u32,
    /// How deep anything was in its core, metres, worst.
    pub penetration: f64,
    /// Ticks in which it was crushed, or its movement was not clear.
    pub trouble: u32,
    /// Mode at the end.
    pub mode: Option<ClimberMode>,
}

/// A climber that never tires soon, for long ways.
pub fn config() -> ClimberConfig {
    let mut config = ClimberConfig::colossus_climber();
    if let Some(stamina) = &mut config.stamina {
        stamina.hold_drain = 1.0 / 600.0;
    }
    config
}

/// Climbs along a route for so many seconds at most, all of the creature being fur.
///
/// # Errors
/// If the creature cannot be posed or the climber not be made.
pub fn climb(
    stage: &mut Stage<'_>,
    route: &Route,
    config: ClimberConfig,
    limit: f64,
) -> Result<Outcome, Box<dyn std::error::Error>> {
    let mut outcome = Outcome::default();
    stage.place(0.0)?;
    let (first, start) = free_place(stage, route, &config).ok_or("no room for it at the foot")?;
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
            // In a crease that its ball does not enter.
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
            &StepRules::gripping(&|_, _| true),
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

/// The first waypoint at which there is room for a climber, and where it is then: the very first may lie in a crease.
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
