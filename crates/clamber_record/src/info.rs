use std::collections::BTreeMap;
use std::str::FromStr;

use clamber_climber::ClimberConfig;

use crate::{RecordError, config};

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
    /// What the climber is made of. As `climber.` and the field's path, a number each; of a group that it lacks nothing.
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
        let pairs = [
            ("version", Self::VERSION.to_owned()),
            ("creature", self.creature.clone()),
            (
                "creature_fingerprint",
                format!("{:016x}", self.creature_fingerprint),
            ),
            ("tick_seconds", format!("{:?}", self.tick_seconds)),
        ];
        let mut metadata = pairs.map(|(key, value)| (key.to_owned(), value)).into();
        config::write(&self.climber, &mut metadata);
        metadata
    }

    pub(crate) fn from_metadata(
        metadata: &BTreeMap<String, String>,
        settings: BTreeMap<String, String>,
    ) -> Result<Self, RecordError> {
        let fingerprint = text(metadata, "creature_fingerprint")?;
        let tick_seconds = parse::<f64>(metadata, "tick_seconds")?;
        if !(tick_seconds > 0.0 && tick_seconds.is_finite()) {
            return Err(RecordError::TickSeconds(tick_seconds));
        }
        Ok(Self {
            creature: text(metadata, "creature")?.clone(),
            creature_fingerprint: u64::from_str_radix(fingerprint, 16)
                .map_err(|error| bad("creature_fingerprint", fingerprint, &error.to_string()))?,
            tick_seconds,
            climber: config::read(metadata)?,
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

pub(crate) fn parse<T: FromStr>(
    metadata: &BTreeMap<String, String>,
    key: &str,
) -> Result<T, RecordError>
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
