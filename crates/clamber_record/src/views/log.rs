use clamber_climber::ClimberEvent;
use foxglove::messages::Log;
use foxglove::messages::log::Level;

use super::timestamp;

/// A line about an event.
pub(crate) fn line(nanoseconds: u64, event: &ClimberEvent) -> Log {
    let (level, message) = match event {
        ClimberEvent::Landed { obstacle, speed } => (
            Level::Info,
            format!("landed on obstacle {} at {speed:.2} m/s", obstacle.0),
        ),
        ClimberEvent::Jumped => (Level::Info, "jumped".to_owned()),
        ClimberEvent::Slipped => (Level::Warning, "slipped: too steep".to_owned()),
        ClimberEvent::LostFooting => (Level::Warning, "lost its footing".to_owned()),
    };
    Log {
        timestamp: Some(timestamp(nanoseconds)),
        level: level as i32,
        message,
        name: "climber".to_owned(),
        file: String::new(),
        line: 0,
    }
}
