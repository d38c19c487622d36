use std::collections::BTreeMap;

use clamber_climber::{Climber, ClimberConfig};
use glam::DVec3;

use crate::RecordError;
use crate::kind::Entries;

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
    /// The climber's configuration. The file has it as RON, because JSON has no text for infinite limits.
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

    /// Key of the entry of the climber's configuration.
    const CLIMBER: &str = "climber";

    pub(crate) fn to_metadata(&self) -> Result<Entries, RecordError> {
        let config = ron::to_string(&self.climber);
        let config = config.map_err(|error| RecordError::encode("metadata", error))?;
        let mut metadata = common(self.tick_seconds);
        let fingerprint = format!("{:016x}", self.creature_fingerprint);
        metadata.extend([
            ("creature".to_owned(), self.creature.clone()),
            ("creature_fingerprint".to_owned(), fingerprint),
            (Self::CLIMBER.to_owned(), config),
        ]);
        Ok(metadata)
    }

    pub(super) fn from_metadata(
        metadata: &Entries,
        settings: Entries,
    ) -> Result<Self, RecordError> {
        let config = text(metadata, Self::CLIMBER)?;
        let refused = |error: String| {
            RecordError::NotARecording(format!("its climber's configuration: {error}"))
        };
        let climber = ron::from_str(config).map_err(|error| refused(error.to_string()))?;
        // Creating a climber checks its configuration.
        Climber::new(climber, DVec3::ZERO).map_err(|error| refused(error.to_string()))?;
        Ok(Self {
            creature: text(metadata, "creature")?.clone(),
            creature_fingerprint: hash(metadata, "creature_fingerprint")?,
            tick_seconds: tick_seconds(metadata)?,
            climber,
            settings,
            version: text(metadata, VERSION)?.clone(),
        })
    }
}

/// Key of the entry of the version.
pub(crate) const VERSION: &str = "version";
/// Key of the entry of the duration of a tick.
const TICK_SECONDS: &str = "tick_seconds";

/// The metadata that both kinds of recordings have.
pub(crate) fn common(tick_seconds: f64) -> Entries {
    [
        (VERSION.to_owned(), RecordingInfo::VERSION.to_owned()),
        (TICK_SECONDS.to_owned(), format!("{tick_seconds:?}")),
    ]
    .into()
}

/// The duration of a tick. Refuses one that is not positive or not finite.
pub(crate) fn tick_seconds(metadata: &Entries) -> Result<f64, RecordError> {
    let value = text(metadata, TICK_SECONDS)?;
    let seconds = value.parse::<f64>();
    let seconds = seconds.map_err(|error| bad(TICK_SECONDS, value, &error.to_string()))?;
    if seconds > 0.0 && seconds.is_finite() {
        Ok(seconds)
    } else {
        Err(RecordError::TickSeconds(seconds))
    }
}

/// A hash, which is stored as hexadecimal digits.
pub(crate) fn hash(metadata: &Entries, key: &str) -> Result<u64, RecordError> {
    let value = text(metadata, key)?;
    u64::from_str_radix(value, 16).map_err(|error| bad(key, value, &error.to_string()))
}

pub(crate) fn text<'a>(metadata: &'a Entries, key: &str) -> Result<&'a String, RecordError> {
    let missing = || RecordError::NotARecording(format!("its metadata has no entry {key}"));
    metadata.get(key).ok_or_else(missing)
}

fn bad(key: &str, value: &str, reason: &str) -> RecordError {
    RecordError::NotARecording(format!("its metadata has {key} = {value:?}: {reason}"))
}

#[cfg(test)]
mod tests {
    use clamber_climber::Others;

    use super::*;

    /// The metadata of a recording of a climber, and the metadata read back.
    fn read_back(
        climber: ClimberConfig,
        change: impl Fn(&mut String),
    ) -> Result<ClimberConfig, RecordError> {
        let info = RecordingInfo {
            creature: "giant".to_owned(),
            creature_fingerprint: 7,
            tick_seconds: 1.0 / 60.0,
            climber,
            settings: BTreeMap::new(),
            version: RecordingInfo::VERSION.to_owned(),
        };
        let mut metadata = info.to_metadata()?;
        change(metadata.get_mut(RecordingInfo::CLIMBER).unwrap());
        let read = RecordingInfo::from_metadata(&metadata, BTreeMap::new())?;
        assert_eq!(read.creature_fingerprint, 7);
        assert_eq!(read.tick_seconds, 1.0 / 60.0);
        Ok(read.climber)
    }

    #[test]
    fn a_configuration_reads_back_with_the_groups_that_it_has() {
        let walker = ClimberConfig::walker();
        let climber = ClimberConfig::colossus_climber();
        let some = ClimberConfig {
            health: None,
            ledge: None,
            ..climber
        };
        for config in [walker, climber, some] {
            assert_eq!(read_back(config, |_| ()).unwrap(), config);
        }
    }

    #[test]
    fn numbers_with_long_texts_and_infinite_limits_read_back() {
        let mut config = ClimberConfig::colossus_climber();
        config.gravity = DVec3::new(0.1 + 0.2, -1.0 / 3.0, -0.0);
        config.shake_time = f64::MIN_POSITIVE;
        config.body.others = Others::Push;
        config.ground.throw_acceleration = f64::INFINITY;
        let back = read_back(config, |_| ()).unwrap();
        assert_eq!(back, config);
        assert_eq!(back.gravity.z.to_bits(), (-0.0_f64).to_bits());
    }

    #[test]
    fn a_group_that_lacks_a_number_is_refused_with_the_name_of_the_number() {
        let lacks = |text: &mut String| *text = text.replace("recover_time:", "unknown:");
        let error = read_back(ClimberConfig::colossus_climber(), lacks).unwrap_err();
        let error = error.to_string();
        assert!(
            error.contains("recover_time") && error.contains("TumbleConfig"),
            "{error}"
        );
    }

    #[test]
    fn what_is_no_configuration_is_refused_in_few_words() {
        let config = ClimberConfig::colossus_climber();
        let text = ron::to_string(&config).unwrap();
        let replaced = |from: &str, to: &str| {
            assert!(text.contains(from));
            text.replacen(from, to, 1)
        };
        let texts = [
            // A group with another name would be an ability that is off.
            replaced("grip:", "grips:"),
            replaced("shake_time:0.1", "shake_time:NaN"),
            replaced("shake_time:0.1", "shake_time:-1.0"),
            String::new(),
            "(".repeat(1 << 20),
            "Some(".repeat(1 << 16),
            format!("(gravity:\"{}\")", "x".repeat(1 << 20)),
            "#![enable(implicit_some)](".to_owned(),
        ];
        for text in texts {
            let error = read_back(config, |own| own.clone_from(&text)).unwrap_err();
            let error = error.to_string();
            assert!(
                error.contains("configuration") && error.len() < 300,
                "{error}"
            );
        }
    }
}
