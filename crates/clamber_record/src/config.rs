//! A climber's configuration as metadata: one entry for each number, named by the path of its field. A group that is
//! `None` has no entries.
//!
//! A number is stored as the shortest text that reads back to the same bits. JSON has no such text for infinite limits.

use std::collections::BTreeMap;

use clamber_climber::{
    BodyConfig, ClimberConfig, GripConfig, GroundConfig, HangConfig, HealthConfig, LedgeConfig,
    Others, StaminaConfig, TumbleConfig,
};
use glam::DVec3;

use crate::RecordError;
use crate::info::parse;

type Metadata = BTreeMap<String, String>;

/// A group of numbers, each stored under the name of its field.
trait Group: Sized {
    /// The prefix of the names, with a dot at its end.
    const PREFIX: &str;

    fn write(&self, metadata: &mut Metadata);

    fn read(metadata: &Metadata) -> Result<Self, RecordError>;
}

/// The text of a value, which reads back to the same value.
trait AsText {
    fn as_text(&self) -> String;
}

impl AsText for f64 {
    fn as_text(&self) -> String {
        format!("{self:?}")
    }
}

impl AsText for Others {
    fn as_text(&self) -> String {
        self.to_string()
    }
}

/// Implements [`Group`] for a struct. Every field must be listed: a missing or unknown field does not compile.
macro_rules! group {
    ($group:ident, $prefix:literal, $($field:ident),+) => {
        impl Group for $group {
            const PREFIX: &str = concat!($prefix, ".");

            fn write(&self, metadata: &mut Metadata) {
                let Self { $($field),+ } = self;
                $(metadata.insert(
                    concat!($prefix, ".", stringify!($field)).to_owned(),
                    $field.as_text(),
                );)+
            }

            fn read(metadata: &Metadata) -> Result<Self, RecordError> {
                Ok(Self {
                    $($field: parse(metadata, concat!($prefix, ".", stringify!($field)))?),+
                })
            }
        }
    };
}

group!(DVec3, "climber.gravity", x, y, z);
group!(
    BodyConfig,
    "climber.body",
    radius,
    height,
    margin,
    mass,
    push_force,
    others
);
group!(
    GroundConfig,
    "climber.ground",
    max_slope,
    walk_speed,
    jump_speed,
    snap_distance,
    step_height,
    coyote_time,
    jump_buffer,
    acceleration,
    friction,
    air_acceleration,
    jump_release_gravity,
    throw_acceleration,
    terminal_speed,
    slide_friction
);
group!(
    GripConfig,
    "climber.grip",
    reach,
    climb_speed,
    max_overhang,
    hang_acceleration,
    calm_time,
    jump_speed,
    catch_speed
);
group!(HangConfig, "climber.hang", arm_length, leg_length, damping);
group!(
    LedgeConfig,
    "climber.ledge",
    reach_up,
    reach,
    drop,
    shimmy_speed,
    pull_up_time,
    catch_speed
);
group!(
    StaminaConfig,
    "climber.stamina",
    hold_drain,
    shake_threshold,
    shake_drain,
    refill,
    jump_cost,
    catch_cost,
    mantle_cost
);
group!(
    TumbleConfig,
    "climber.tumble",
    knock_acceleration,
    knock_speed,
    landing_speed,
    friction,
    restitution,
    recover_time
);
group!(HealthConfig, "climber.health", safe_speed, fall_damage);

/// Key of the entry of `ClimberConfig::shake_time`, which is in no group.
const SHAKE_TIME: &str = "climber.shake_time";

pub(crate) fn write(config: &ClimberConfig, metadata: &mut Metadata) {
    let ClimberConfig {
        gravity,
        shake_time,
        body,
        ground,
        grip,
        hang,
        ledge,
        stamina,
        tumble,
        health,
    } = config;
    metadata.insert(SHAKE_TIME.to_owned(), format!("{shake_time:?}"));
    gravity.write(metadata);
    body.write(metadata);
    ground.write(metadata);
    hang.write(metadata);
    write_optional(grip.as_ref(), metadata);
    write_optional(ledge.as_ref(), metadata);
    write_optional(stamina.as_ref(), metadata);
    write_optional(tumble.as_ref(), metadata);
    write_optional(health.as_ref(), metadata);
}

pub(crate) fn read(metadata: &Metadata) -> Result<ClimberConfig, RecordError> {
    Ok(ClimberConfig {
        gravity: DVec3::read(metadata)?,
        shake_time: parse(metadata, SHAKE_TIME)?,
        body: BodyConfig::read(metadata)?,
        ground: GroundConfig::read(metadata)?,
        grip: read_optional(metadata)?,
        hang: HangConfig::read(metadata)?,
        ledge: read_optional(metadata)?,
        stamina: read_optional(metadata)?,
        tumble: read_optional(metadata)?,
        health: read_optional(metadata)?,
    })
}

fn write_optional<G: Group>(group: Option<&G>, metadata: &mut Metadata) {
    if let Some(group) = group {
        group.write(metadata);
    }
}

/// Reads a group; `None` if the metadata has no entry of it. If it has one, all entries of the group are required.
fn read_optional<G: Group>(metadata: &Metadata) -> Result<Option<G>, RecordError> {
    let is_there = metadata.keys().any(|key| key.starts_with(G::PREFIX));
    is_there.then(|| G::read(metadata)).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_back(config: &ClimberConfig) -> ClimberConfig {
        let mut metadata = Metadata::new();
        write(config, &mut metadata);
        read(&metadata).unwrap()
    }

    #[test]
    fn a_configuration_reads_back_with_the_groups_that_it_has() {
        let walker = ClimberConfig::walker();
        let climber = ClimberConfig::colossus_climber();
        assert_eq!(read_back(&walker), walker);
        assert_eq!(read_back(&climber), climber);
        let some = ClimberConfig {
            health: None,
            ledge: None,
            ..climber
        };
        assert_eq!(read_back(&some), some);
    }

    #[test]
    fn numbers_with_long_texts_and_infinite_limits_read_back() {
        let mut config = ClimberConfig::colossus_climber();
        config.gravity = DVec3::new(0.1 + 0.2, -1.0 / 3.0, -0.0);
        config.shake_time = f64::MIN_POSITIVE;
        config.body.others = Others::Push;
        config.ground.throw_acceleration = f64::INFINITY;
        let back = read_back(&config);
        assert_eq!(back, config);
        assert_eq!(back.gravity.z.to_bits(), (-0.0_f64).to_bits());
    }

    #[test]
    fn no_two_numbers_share_an_entry() {
        let mut metadata = Metadata::new();
        write(&ClimberConfig::colossus_climber(), &mut metadata);
        // 3 for gravity, 1 for `shake_time`, and 6, 14, 7, 3, 6, 7, 6, 2 for the groups.
        assert_eq!(metadata.len(), 55, "{metadata:?}");
    }

    #[test]
    fn a_group_that_lacks_a_number_is_refused_with_the_name_of_the_number() {
        let mut metadata = Metadata::new();
        write(&ClimberConfig::colossus_climber(), &mut metadata);
        metadata.remove("climber.tumble.friction");
        let error = read(&metadata).unwrap_err().to_string();
        assert!(error.contains("climber.tumble.friction"), "{error}");
    }
}
