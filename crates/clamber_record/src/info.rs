use std::collections::BTreeMap;
use std::str::FromStr;

use clamber_climber::ClimberConfig;

use crate::{RecordError, config};

/// The metadata of a recording: everything that a replay needs to make the scene again, as it was before the first
/// tick.
///
/// The file stores the metadata as two records. Floating-point numbers are stored as the shortest text that reads back
/// to the same bits.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingInfo {
    /// The creature's name, for people. The log calls the creature by it.
    pub creature: String,
    /// The creature's [`creature_fingerprint`](crate::creature_fingerprint), to find out whether the creature has
    /// changed since.
    pub creature_fingerprint: u64,
    /// Duration of a tick, seconds; positive and finite.
    pub tick_seconds: f64,
    /// The climber's configuration. Each number is an entry, named `climber.` and the path of its field. A group that
    /// is `None` has no entries.
    pub climber: ClimberConfig,
    /// The caller's own entries about what the scene was made from: seed, options, files.
    pub settings: BTreeMap<String, String>,
    /// The version of this crate that wrote the recording. A recorder always writes its own.
    pub version: String,
}

impl RecordingInfo {
    /// The version of this crate, as recorders write it.
    pub const VERSION: &str = env!("CARGO_PKG_VERSION");

    /// The name of the metadata record that holds everything but the settings.
    pub const METADATA: &str = "clamber";

    /// The name of the metadata record that holds the settings.
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

pub(crate) fn text<'a>(
    metadata: &'a BTreeMap<String, String>,
    key: &str,
) -> Result<&'a String, RecordError> {
    metadata
        .get(key)
        .ok_or_else(|| RecordError::NotARecording(format!("its metadata has no entry {key}")))
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

pub(crate) fn bad(key: &str, value: &str, reason: &str) -> RecordError {
    RecordError::NotARecording(format!("its metadata has {key} = {value:?}: {reason}"))
}
