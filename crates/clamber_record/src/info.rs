use std::collections::BTreeMap;
use std::str::FromStr;

use clamber_climber::ClimberConfig;
use glam::DVec3;

use crate::RecordError;

/// What a recording is of: all that is needed to make the scene again, before any tick.
///
/// Stored as two metadata records, numbers as the shortest text that reads back to the same bits.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingInfo {
    /// The creature's name, for people.
    pub creature: String,
    /// Its [`creature_fingerprint`](crate::creature_fingerprint): a file that has changed is noticed.
    pub creature_fingerprint: u64,
    /// Seconds of a tick.
    pub tick_seconds: f64,
    /// What the climber is made of.
    pub climber: ClimberConfig,
    /// What the scene was made from, in the caller's words: seed, options, files.
    pub settings: BTreeMap<String, String>,
    /// The version of this crate that wrote the recording. A recorder always writes its own.
    pub version: String,
}

impl RecordingInfo {
    /// The version that recorders write.
    pub const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// The name of the metadata record of everything but the settings.
    pub const METADATA: &str = "clamber";

    /// The name of the metadata record of the settings.
    pub const SETTINGS: &str = "settings";

    pub(crate) fn to_metadata(&self) -> BTreeMap<String, String> {
        let climber = &self.climber;
        let gravity = climber.gravity;
        let number = |x: f64| format!("{x:?}");
        let pairs = [
            ("version", Self::VERSION.to_owned()),
            ("creature", self.creature.clone()),
            (
                "creature_fingerprint",
                format!("{:016x}", self.creature_fingerprint),
            ),
            ("tick_seconds", number(self.tick_seconds)),
            ("climber.radius", number(climber.radius)),
            ("climber.max_slope", number(climber.max_slope)),
            ("climber.walk_speed", number(climber.walk_speed)),
            ("climber.jump_speed", number(climber.jump_speed)),
            ("climber.gravity.x", number(gravity.x)),
            ("climber.gravity.y", number(gravity.y)),
            ("climber.gravity.z", number(gravity.z)),
            ("climber.snap_distance", number(climber.snap_distance)),
        ];
        pairs.map(|(key, value)| (key.to_owned(), value)).into()
    }

    pub(crate) fn from_metadata(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<Self, RecordError> {
        let number = |key| parse::<f64>(metadata, key);
        let fingerprint = text(metadata, "creature_fingerprint")?;
        let tick_seconds = number("tick_seconds")?;
        if !(tick_seconds > 0.0 && tick_seconds.is_finite()) {
            return Err(RecordError::TickSeconds(tick_seconds));
        }
        Ok(Self {
            creature: text(metadata, "creature")?.clone(),
            creature_fingerprint: u64::from_str_radix(fingerprint, 16)
                .map_err(|error| bad("creature_fingerprint", fingerprint, &error.to_string()))?,
            tick_seconds,
            climber: ClimberConfig {
                radius: number("climber.radius")?,
                max_slope: number("climber.max_slope")?,
                walk_speed: number("climber.walk_speed")?,
                jump_speed: number("climber.jump_speed")?,
                gravity: DVec3::new(
                    number("climber.gravity.x")?,
                    number("climber.gravity.y")?,
                    number("climber.gravity.z")?,
                ),
                snap_distance: number("climber.snap_distance")?,
            },
            settings,
            version: text(metadata, "version")?.clone(),
        })
    }
}

fn text<'a>(metadata: &'a BTreeMap<String, String>, key: &str) -> Result<&'a String, RecordError> {
    metadata
        .get(key)
        .ok_or_else(|| RecordError::NotARecording(format!("its metadata says nothing about {key}")))
}

fn parse<T: FromStr>(metadata: &BTreeMap<String, String>, key: &str) -> Result<T, RecordError>
where
    T::Err: ToString,
{
    let value = text(metadata, key)?;
    value
        .parse()
        .map_err(|error: T::Err| bad(key, value, &error.to_string()))
}

fn bad(key: &str, value: &str, reason: &str) -> RecordError {
    RecordError::NotARecording(format!("its metadata has {key} = {value:?}: {reason}"))
}
