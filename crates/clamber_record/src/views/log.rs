use clamber_climber::ClimberEvent as Event;
use clamber_world::ObstacleId;
use foxglove::messages::Log;
use foxglove::messages::log::Level;

/// The log line of an event of a climber. `named` gives the names of obstacles.
pub(crate) fn line(climber: &str, event: &Event, named: impl Fn(ObstacleId) -> String) -> Log {
    let on = |obstacle: &ObstacleId| named(*obstacle);
    let text = match event {
        Event::Landed { obstacle, speed } => {
            format!("landed on {} at {speed:.2} m/s", on(obstacle))
        }
        Event::Jumped => "jumped".to_owned(),
        Event::Slipped => "slipped: too steep".to_owned(),
        Event::LostFooting { from } => format!("lost its footing on {}", on(&from.obstacle)),
        Event::SkippedTicks { obstacle } => {
            format!("{} moved several times since the last step", on(obstacle))
        }
        Event::Thrown { acceleration, .. } => {
            format!("thrown: the ground was pulled away at {acceleration:.1} m/s^2")
        }
        Event::Grabbed { obstacle, point } => format!("grabbed {} at {point:.2}", on(obstacle)),
        Event::TurnedCorner { angle } => {
            let degrees = angle.to_degrees();
            format!("climbed around a corner of {degrees:.0} degrees")
        }
        Event::LedgeCaught { obstacle, point } => {
            format!("caught a ledge of {} at {point:.2}", on(obstacle))
        }
        Event::Mantled => "climbed over a ledge".to_owned(),
        Event::Released => "let go".to_owned(),
        Event::ShakenOff { shake, .. } => {
            format!("shaken off: out of stamina, at a shake of {shake:.1} m/s^2")
        }
        Event::Tumbled { .. } => "knocked down".to_owned(),
        Event::KnockedOff { from, .. } => format!("knocked off {}", on(&from.obstacle)),
        Event::Crushed { depth } => format!("crushed: overlapped by {:.1} mm", depth * 1e3),
        Event::Hurt { damage } => format!("hurt: lost {:.0} % of its hit points", damage * 100.0),
        Event::Changed { from, to } => format!("{from:?} to {to:?}"),
        Event::Custom { mode, what, value } => format!("mode {mode}: {what}, {value:.3}"),
        Event::HandsSlipped { obstacle, speed } => {
            format!("its hands slipped off {} at {speed:.1} m/s", on(obstacle))
        }
        Event::AlreadyInMode { mode } => format!("{mode:?} changed to itself, which does nothing"),
        Event::NotFinite => {
            "an obstacle gave numbers that are not finite: the step was skipped".to_owned()
        }
        // An event that is newer than this list.
        other => format!("{other:?}"),
    };
    log(level(event), climber, text)
}

fn level(event: &Event) -> Level {
    match event {
        Event::NotFinite => Level::Error,
        Event::Slipped
        | Event::LostFooting { .. }
        | Event::SkippedTicks { .. }
        | Event::Thrown { .. }
        | Event::ShakenOff { .. }
        | Event::Tumbled { .. }
        | Event::KnockedOff { .. }
        | Event::Crushed { .. }
        | Event::Hurt { .. }
        | Event::AlreadyInMode { .. } => Level::Warning,
        Event::TurnedCorner { .. } | Event::Changed { .. } => Level::Debug,
        _ => Level::Info,
    }
}

/// A log line. It gets its time when it is written.
pub(crate) fn log(level: Level, name: &str, message: String) -> Log {
    Log {
        timestamp: None,
        level: level as i32,
        message,
        name: name.to_owned(),
        file: String::new(),
        line: 0,
    }
}

/// The log line that says that views of `what` are left out from here on.
pub(crate) fn left_out(what: &str) -> Log {
    let what = format!("{what} are not drawn in this recording; a replay has them all");
    log(Level::Warning, "recorder", what)
}

/// The log line that says that ticks were left out here; `None` for 0 ticks.
pub(crate) fn gap_line(ticks: u64) -> Option<Log> {
    let what = format!("{ticks} ticks are not recorded here: the disk was too slow");
    (ticks > 0).then(|| log(Level::Warning, "recorder", what))
}
