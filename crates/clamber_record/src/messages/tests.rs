use super::*;
use clamber_climber::{
    Blow, Climber, ClimberConfig, ClimberInput, ClimberMode, ClimberState, FlyingMemory,
    HangingMemory, HoldingMemory, LedgeHangingMemory, StandingMemory, Support, TumblingMemory,
};
use clamber_world::{Attachment, MaterialPoint, ObstacleId, SurfaceKind, SurfaceTag};
use prost::Message;

/// A state and an input in which every field has a different value.
fn everything() -> (ClimberState, ClimberInput) {
    let mut number = 0.0;
    let mut next = || {
        number += 1.0;
        1.0 / (number + 1.0)
    };
    let mut vector = || DVec3::new(next(), next(), next());
    let [position, velocity, heading, shake] = [vector(), vector(), vector(), vector()];
    let [contact, offset, normal, face] = [vector(), vector(), vector(), vector()];
    let coordinates = vector();
    let [support_velocity, walk, climb, struck] = [vector(), vector(), vector(), vector()];
    let [base_velocity, aim, legs, right] = [vector(), vector(), vector(), vector()];
    let [stick, along, held_normal, own_way] = [vector(), vector(), vector(), vector()];
    let state = ClimberState {
        position,
        velocity,
        base_velocity,
        own_way,
        heading,
        mode: ClimberMode::LedgeHanging,
        support: Some(Support {
            attachment: Attachment {
                obstacle: ObstacleId(u64::MAX - 7),
                material: MaterialPoint {
                    key: 1 << 60,
                    coordinates: coordinates.to_array(),
                },
                point: contact,
                offset,
                frame: DQuat::from_xyzw(next(), next(), next(), next()),
            },
            normal,
            face,
            tag: SurfaceTag::new(SurfaceKind::Stone).with_user(u32::MAX),
        }),
        support_velocity: Some(support_velocity),
        shake,
        stamina: next(),
        hit_points: next(),
        hanging: HangingMemory {
            arm: next(),
            calm: next(),
            legs,
        },
        ledge_hanging: LedgeHangingMemory {
            pull_up: next(),
            blocked: next(),
            gave_up: true,
            returns: true,
            right,
        },
        tumbling: TumblingMemory {
            still: next(),
            down: next(),
        },
        coyote: next(),
        jump_buffer: next(),
        open_handed: next(),
        untouched: next(),
        load: next(),
        holding: HoldingMemory {
            stick,
            along,
            normal: held_normal,
        },
        crouched: true,
        crushed: true,
        flying: FlyingMemory { jumping: true },
        standing: StandingMemory { shoved: true },
        memory: core::array::from_fn(|_| next()),
    };
    let input = ClimberInput {
        walk,
        climb,
        jump: true,
        jump_held: true,
        grip: true,
        crouch: true,
        blow: Some(Blow {
            velocity: struck,
            damage: next(),
            by: Some(ObstacleId(0)),
        }),
        actions: u32::MAX,
        aim,
    };
    (state, input)
}

/// Writes a state and an input, and reads them back.
fn read_back(state: &ClimberState, input: &ClimberInput) -> (ClimberState, ClimberInput) {
    let message = Tick {
        input: Mirror::of(input),
        state: Mirror::of(state),
        ..Tick::default()
    };
    let read = Tick::decode(&message.encode_to_vec()[..]).unwrap();
    (read.state.own().unwrap(), read.input.own().unwrap())
}

/// A state and an input as text. Texts differ if any bit differs: the text of a negative zero has its sign.
fn words(state: &ClimberState, input: &ClimberInput) -> String {
    format!("{state:?} {input:?}")
}

#[test]
fn every_field_reads_back_in_every_mode() {
    let (state, input) = everything();
    let custom = [0, 1, u16::MAX].map(ClimberMode::Custom);
    for mode in ClimberMode::ALL.into_iter().chain(custom) {
        let state = ClimberState { mode, ..state };
        assert_eq!(read_back(&state, &input), (state, input), "{mode:?}");
    }
    let state = ClimberState {
        support: None,
        support_velocity: None,
        crouched: false,
        crushed: false,
        ..state
    };
    let input = ClimberInput::default();
    assert_eq!(read_back(&state, &input), (state, input));
}

/// All numbers of a state and an input, as mutable references.
fn numbers<'a>(state: &'a mut ClimberState, input: &'a mut ClimberInput) -> Vec<&'a mut f64> {
    fn all(v: &mut DVec3) -> [&mut f64; 3] {
        [&mut v.x, &mut v.y, &mut v.z]
    }
    let mut list: Vec<&mut f64> = Vec::new();
    for v in [
        &mut state.position,
        &mut state.velocity,
        &mut state.base_velocity,
        &mut state.own_way,
        &mut state.heading,
        &mut state.shake,
        &mut state.hanging.legs,
        &mut state.holding.stick,
        &mut state.holding.along,
        &mut state.holding.normal,
        &mut state.ledge_hanging.right,
        &mut input.walk,
        &mut input.climb,
        &mut input.aim,
    ] {
        list.extend(all(v));
    }
    if let Some(support) = &mut state.support {
        list.extend(&mut support.attachment.material.coordinates);
        for v in [
            &mut support.attachment.point,
            &mut support.attachment.offset,
            &mut support.normal,
            &mut support.face,
        ] {
            list.extend(all(v));
        }
        let DQuat { x, y, z, w } = &mut support.attachment.frame;
        list.extend([x, y, z, w]);
    }
    list.extend(state.support_velocity.iter_mut().flat_map(all));
    if let Some(blow) = &mut input.blow {
        list.extend(all(&mut blow.velocity));
        list.push(&mut blow.damage);
    }
    list.extend([
        &mut state.stamina,
        &mut state.hit_points,
        &mut state.hanging.arm,
        &mut state.hanging.calm,
        &mut state.ledge_hanging.pull_up,
        &mut state.ledge_hanging.blocked,
        &mut state.tumbling.still,
        &mut state.tumbling.down,
        &mut state.coyote,
        &mut state.jump_buffer,
        &mut state.open_handed,
        &mut state.untouched,
        &mut state.load,
    ]);
    list.extend(&mut state.memory);
    list
}

#[test]
fn every_number_reads_back_bit_for_bit_negative_zeros_and_denormals_too() {
    let (mut state, mut input) = everything();
    let count = numbers(&mut state, &mut input).len();
    // Twenty vectors and the coordinates, a rotation, the damage, thirteen numbers, and the memory of the game's modes.
    assert_eq!(count, 3 * 21 + 4 + 1 + 13 + 8);
    for index in 0..count {
        for value in [-0.0, 0.0, f64::from_bits(1), -f64::MAX, -f64::MIN_POSITIVE] {
            let (mut state, mut input) = everything();
            *numbers(&mut state, &mut input)[index] = value;
            let (read_state, read_input) = read_back(&state, &input);
            let found = words(&read_state, &read_input);
            assert_eq!(found, words(&state, &input), "number {index} as {value:e}");
            assert_eq!(read_state.fingerprint(), state.fingerprint());
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
