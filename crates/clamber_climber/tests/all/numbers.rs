//! Every number of a configuration, with its unit.

use clamber_climber::{
    BodyConfig, ClimberConfig, GripConfig, GroundConfig, HangConfig, HealthConfig, LedgeConfig,
    StaminaConfig, TumbleConfig,
};

/// A number of a configuration. Kilograms are no part of the unit, since no size changes the mass.
pub(crate) struct Number<'a> {
    pub(crate) name: &'static str,
    pub(crate) value: &'a mut f64,
    pub(crate) unit: Unit,
}

/// Powers of the metre and of the second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Unit {
    pub(crate) metres: i32,
    pub(crate) seconds: i32,
}

const fn unit(metres: i32, seconds: i32) -> Unit {
    Unit { metres, seconds }
}

/// Unit of a length: metres.
const LENGTH: Unit = unit(1, 0);

/// Unit of a time: seconds.
const TIME: Unit = unit(0, 1);

/// Unit of a speed: metres a second.
const SPEED: Unit = unit(1, -1);

/// Unit of an acceleration: metres a second squared.
const ACCELERATION: Unit = unit(1, -2);

/// Unit of a rate: per second.
const RATE: Unit = unit(0, -1);

/// Unit of a cost for each metre a second.
const PER_SPEED: Unit = unit(-1, 1);

/// Unit of a share, an angle or a coefficient: 1.
const SHARE: Unit = unit(0, 0);

/// Lists the fields of a part of a configuration. A new field does not compile until it has a unit here.
macro_rules! list {
    ($all:ident, $part:expr, $kind:ident, { $($field:ident: $unit:expr),+ $(,)? } $(, $other:ident)?) => {
        let $kind { $($field,)+ $($other: _)? } = $part;
        $($all.push(Number {
            name: concat!(stringify!($kind), "::", stringify!($field)),
            value: $field,
            unit: $unit,
        });)+
    };
}

/// All numbers except gravity.
pub(crate) fn numbers(config: &mut ClimberConfig) -> Vec<Number<'_>> {
    let mut all = Vec::new();
    let ClimberConfig {
        gravity: _,
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
    all.push(Number {
        name: "ClimberConfig::shake_time",
        value: shake_time,
        unit: TIME,
    });
    list!(all, body, BodyConfig, {
        radius: LENGTH,
        height: LENGTH,
        margin: LENGTH,
        mass: SHARE,
        push_force: ACCELERATION,
    }, others);
    list!(all, ground, GroundConfig, {
        max_slope: SHARE,
        walk_speed: SPEED,
        jump_speed: SPEED,
        snap_distance: LENGTH,
        step_height: LENGTH,
        coyote_time: TIME,
        jump_buffer: TIME,
        acceleration: ACCELERATION,
        friction: ACCELERATION,
        air_acceleration: ACCELERATION,
        terminal_speed: SPEED,
        slide_friction: SHARE,
        jump_release_gravity: SHARE,
        throw_acceleration: ACCELERATION,
    });
    list!(all, hang, HangConfig, {
        arm_length: LENGTH,
        leg_length: LENGTH,
        damping: RATE,
    });
    if let Some(grip) = grip {
        list!(all, grip, GripConfig, {
            reach: LENGTH,
            climb_speed: SPEED,
            max_overhang: SHARE,
            hang_acceleration: ACCELERATION,
            calm_time: TIME,
            jump_speed: SPEED,
            catch_speed: SPEED,
        });
    }
    if let Some(ledge) = ledge {
        list!(all, ledge, LedgeConfig, {
            reach_up: LENGTH,
            reach: LENGTH,
            drop: LENGTH,
            shimmy_speed: SPEED,
            pull_up_time: TIME,
            catch_speed: SPEED,
        });
    }
    if let Some(stamina) = stamina {
        list!(all, stamina, StaminaConfig, {
            hold_drain: RATE,
            shake_threshold: ACCELERATION,
            shake_drain: PER_SPEED,
            refill: RATE,
            jump_cost: SHARE,
            catch_cost: PER_SPEED,
            mantle_cost: SHARE,
        });
    }
    if let Some(tumble) = tumble {
        list!(all, tumble, TumbleConfig, {
            knock_acceleration: ACCELERATION,
            knock_speed: SPEED,
            landing_speed: SPEED,
            friction: SHARE,
            restitution: SHARE,
            recover_time: TIME,
        });
    }
    if let Some(health) = health {
        list!(all, health, HealthConfig, {
            safe_speed: SPEED,
            fall_damage: PER_SPEED,
        });
    }
    all
}

/// The same climber in a world that is `size` times as large, gravity included: every motion takes as long as at the
/// usual size. [`ClimberConfig::scaled`] keeps gravity, and times change instead.
pub(crate) fn in_world_of_size(mut config: ClimberConfig, size: f64) -> ClimberConfig {
    config.gravity *= size;
    for number in numbers(&mut config) {
        match number.unit.metres {
            0 => {}
            1 => *number.value *= size,
            -1 => *number.value /= size,
            metres => unreachable!("{}: metres to the {metres}", number.name),
        }
    }
    config
}
