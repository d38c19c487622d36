use clamber_climber::ClimberEvent;
use clamber_world::ObstacleId;
use foxglove::messages::Log;
use foxglove::messages::log::Level;

/// The log line of an event of a climber. `named` gives the names of obstacles.
pub(crate) fn line(
    climber: &str,
    event: &ClimberEvent,
    named: impl Fn(ObstacleId) -> String,
) -> Log {
    let (level, message) = match event {
        ClimberEvent::Landed { obstacle, speed } => (
            Level::Info,
            format!("landed on {} at {speed:.2} m/s", named(*obstacle)),
        ),
        ClimberEvent::Jumped => (Level::Info, "jumped".to_owned()),
        ClimberEvent::Slipped => (Level::Warning, "slipped: too steep".to_owned()),
        ClimberEvent::LostFooting { from } => (
            Level::Warning,
            format!("lost its footing on {}", named(from.obstacle)),
        ),
        ClimberEvent::MovedRepeatedly { obstacle } => (
            Level::Warning,
            format!(
                "{} moved several times since the last step",
                named(*obstacle)
            ),
        ),
        ClimberEvent::Thrown { acceleration, .. } => (
            Level::Warning,
            format!("thrown: the ground was pulled away at {acceleration:.1} m/s^2"),
        ),
        ClimberEvent::Grabbed { obstacle, point } => (
            Level::Info,
            format!("grabbed {} at {point:.2}", named(*obstacle)),
        ),
        ClimberEvent::TurnedCorner { angle } => (
            Level::Debug,
            format!(
                "climbed around a corner of {:.0} degrees",
                angle.to_degrees()
            ),
        ),
        ClimberEvent::LedgeCaught { obstacle, point } => (
            Level::Info,
            format!("caught a ledge of {} at {point:.2}", named(*obstacle)),
        ),
        ClimberEvent::Mantled => (Level::Info, "climbed over a ledge".to_owned()),
        ClimberEvent::Released => (Level::Info, "let go".to_owned()),
        ClimberEvent::ShakenOff { shake, .. } => (
            Level::Warning,
            format!("shaken off: out of stamina, at a shake of {shake:.1} m/s^2"),
        ),
        ClimberEvent::Tumbled { .. } => (Level::Warning, "knocked down".to_owned()),
        ClimberEvent::KnockedOff { from, .. } => (
            Level::Warning,
            format!("knocked off {}", named(from.obstacle)),
        ),
        ClimberEvent::Crushed { depth } => (
            Level::Warning,
            format!("crushed: overlapped by {:.1} mm", depth * 1e3),
        ),
        ClimberEvent::Hurt { damage } => (
            Level::Warning,
            format!("hurt: lost {:.0} % of its hit points", damage * 100.0),
        ),
        ClimberEvent::Changed { from, to } => (Level::Debug, format!("{from:?} to {to:?}")),
        ClimberEvent::Custom { mode, what, value } => {
            (Level::Info, format!("mode {mode}: {what}, {value:.3}"))
        }
        ClimberEvent::HandsSlipped { obstacle, speed } => (
            Level::Info,
            format!(
                "its hands slipped off {} at {speed:.1} m/s",
                named(*obstacle)
            ),
        ),
        ClimberEvent::AlreadyInMode { mode } => (
            Level::Warning,
            format!("{mode:?} changed to itself, which does nothing"),
        ),
        ClimberEvent::NotFinite => (
            Level::Error,
            "an obstacle gave numbers that are not finite: the step was skipped".to_owned(),
        ),
        // An event that is newer than this list.
        other => (Level::Info, format!("{other:?}")),
    };
    log(level, climber, message)
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
