use super::*;
use clamber_climber::{
    Climber, ClimberConfig, ClimberInput, ClimberMode, ClimberState, Knockback, Support,
};
use clamber_world::{Attachment, MaterialPoint, ObstacleId, SurfaceKind, SurfaceTag};
use prost::Message;
use serde_json::Value;

/// What a message holds bit for bit.
type Exact = (ClimberState, ClimberInput, Option<Knockback>);

/// A state, an input and a knockback with all optional fields, in which every number has a different value and every
/// flag is set.
fn everything() -> Exact {
    let climber = Climber::new(ClimberConfig::default(), DVec3::ZERO).unwrap();
    let state = ClimberState {
        mode: ClimberMode::LedgeHanging,
        support: Some(Support {
            attachment: Attachment {
                obstacle: ObstacleId(u64::MAX - 7),
                material: MaterialPoint {
                    key: 1 << 60,
                    coordinates: [0.0; 3],
                },
                point: DVec3::ZERO,
                offset: DVec3::ZERO,
                frame: DQuat::IDENTITY,
            },
            normal: DVec3::ZERO,
            face: DVec3::ZERO,
            tag: SurfaceTag::new(SurfaceKind::Stone).with_user(u32::MAX),
        }),
        support_velocity: Some(DVec3::ZERO),
        ..*climber.state()
    };
    let knockback = Knockback {
        by: Some(ObstacleId(0)),
        ..Knockback::default()
    };
    let input = ClimberInput {
        actions: u32::MAX,
        ..ClimberInput::IDLE
    };
    let mut all = serde_json::to_value((state, input, Some(knockback))).unwrap();
    for leaf in leaves(&mut all) {
        assert!(
            !leaf.is_null(),
            "an optional field is empty: {state:?} {input:?}"
        );
        if leaf.is_boolean() {
            *leaf = true.into();
        }
    }
    for (index, number) in numbers(&mut all).into_iter().enumerate() {
        *number = (1.0 / (index as f64 + 2.0)).into();
    }
    serde_json::from_value(all).unwrap()
}

/// All values that contain no others.
fn leaves(value: &mut Value) -> Vec<&mut Value> {
    match value {
        Value::Array(values) => values.iter_mut().flat_map(leaves).collect(),
        Value::Object(fields) => fields.values_mut().flat_map(leaves).collect(),
        leaf => vec![leaf],
    }
}

/// All floating-point numbers of a value. Keys and ids are integers.
fn numbers(value: &mut Value) -> Vec<&mut Value> {
    let leaves = leaves(value).into_iter();
    leaves.filter(|leaf| leaf.is_f64()).collect()
}

/// Writes a message, and reads it back.
fn read_back((state, input, knockback): &Exact) -> Exact {
    let message = Tick {
        input: Mirror::of(input),
        state: Mirror::of(state),
        knockback: Mirror::of(knockback),
        ..Tick::default()
    };
    let read = Tick::decode(&message.encode_to_vec()[..]).unwrap();
    let (state, input) = (read.state.own().unwrap(), read.input.own().unwrap());
    (state, input, read.knockback.own().unwrap())
}

#[test]
fn every_field_reads_back_in_every_mode() {
    let (state, input, knockback) = everything();
    let custom = [0, 1, u16::MAX].map(ClimberMode::Custom);
    for mode in ClimberMode::ALL.into_iter().chain(custom) {
        let state = ClimberState { mode, ..state };
        let all = (state, input, knockback);
        assert_eq!(read_back(&all), all, "{mode:?}");
    }
    let state = ClimberState {
        support: None,
        support_velocity: None,
        crouched: false,
        crushed: false,
        ..state
    };
    let all = (state, ClimberInput::default(), None);
    assert_eq!(read_back(&all), all);
}

#[test]
fn every_number_reads_back_bit_for_bit_negative_zeros_and_denormals_too() {
    let mut everything = serde_json::to_value(everything()).unwrap();
    let count = numbers(&mut everything).len();
    // Twenty vectors and the coordinates, a rotation, the damage, thirteen numbers, and the memory of the game's modes.
    assert_eq!(count, 3 * 21 + 4 + 1 + 13 + 8);
    for index in 0..count {
        for value in [-0.0, 0.0, f64::from_bits(1), -f64::MAX, -f64::MIN_POSITIVE] {
            let mut changed = everything.clone();
            *numbers(&mut changed)[index] = value.into();
            let written: Exact = serde_json::from_value(changed).unwrap();
            let read = read_back(&written);
            // Texts differ if any bit differs: the text of a negative zero has its sign.
            let [found, due] = [&read, &written].map(|all| format!("{all:?}"));
            assert_eq!(found, due, "number {index} as {value:e}");
            assert_eq!(read.0.fingerprint(), written.0.fingerprint());
        }
    }
}

#[test]
fn an_unknown_mode_is_refused_with_its_number() {
    let climber = Climber::new(ClimberConfig::default(), DVec3::ZERO).unwrap();
    let mut message = State::of(climber.state());
    message.mode = 7;
    assert_eq!(message.own(), Err("unknown climber mode 7".to_owned()));
}
