//! The buttons of a fight, and a player's input in a few bytes.

use clamber_climber::ClimberInput;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Stab button, a bit of [`ClimberInput::actions`]. The first press raises the sword for a stab, if the climber stands,
/// falls, or grips a hold. The stab then charges, and the next press strikes. The charge grows faster while the button
/// stays down. After a stab was broken off, the button has to be released and pressed again. The upper 16 bits of the
/// actions are left to the game.
pub const STAB: u32 = 1;
/// Cut button, a bit of [`ClimberInput::actions`]. A press cuts with the sword, while the climber stands, slides or
/// falls.
pub const CUT: u32 = 1 << 1;
/// Bow button, a bit of [`ClimberInput::actions`]. The bow is drawn while the button is down and the climber stands,
/// slides or falls, and shoots when it is released, if it is drawn far enough
/// ([`BowConfig::least_draw`](crate::BowConfig::least_draw)).
pub const BOW: u32 = 1 << 2;
/// Throw button, a bit of [`ClimberInput::actions`]. A press throws a stone, while the climber stands, slides or falls.
pub const THROW: u32 = 1 << 3;

/// Bit of [`PlayerInput::buttons`] for [`ClimberInput::jump`]. It lies above the eight bits of the actions, like the
/// next three.
const JUMP_BIT: u16 = 1 << 8;
/// Bit of [`PlayerInput::buttons`] for [`ClimberInput::jump_held`].
const JUMP_HELD: u16 = 1 << 9;
/// Bit of [`PlayerInput::buttons`] for [`ClimberInput::grip`].
const GRIP_BIT: u16 = 1 << 10;
/// Bit of [`PlayerInput::buttons`] for [`ClimberInput::crouch`].
const CROUCH_BIT: u16 = 1 << 11;
/// Bits of [`PlayerInput::buttons`] for the lower eight bits of [`ClimberInput::actions`].
const ACTION_BITS: u16 = 0xff;

/// Rounding steps per unit of a vector's component: the largest `i8`, so that components from -1 to 1 fit.
const ROUNDING_STEPS: f64 = 127.0;

/// Vectors up to this length are not normalised. Rounding to 127ths makes a unit vector up to 0.7 % longer; normalising
/// it again would change its bits in a second round trip.
const LONGEST_UNIT_VECTOR: f64 = 1.01;

/// A player's input for one tick in thirteen bytes, to be sent over a network.
///
/// [`PlayerInput::from_input`] rounds directions to 1/127 and the aim to 0.006 degrees. It sets `order` to 0 (none): a
/// game that has requests of its own sets [`PlayerInput::order`] afterwards. All peers step with
/// [`PlayerInput::to_input`] and so get the same bits. Blows are not sent, since the arena deals them. Only the lower
/// eight bits of the actions are sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PlayerInput {
    /// Direction to walk in, along x and z, in 127ths.
    pub walk: [i8; 2],
    /// Direction to climb in, in 127ths; zero for none.
    pub climb: [i8; 3],
    /// Direction of the aim: the angle about Y from +Z, in 65,536ths of a turn, and the angle above the horizontal, in
    /// 65,536ths of half a turn.
    pub aim: [i16; 2],
    /// Buttons: the lower eight bits are the actions; the bits above them are jump, jump held, grip and crouch.
    pub buttons: u16,
    /// Request of the player to the game in this tick, as a number that the game defines; 0 for none. With rollback,
    /// all peers turn it into [`Order`](crate::Order)s in the same tick.
    pub order: u16,
}

impl PlayerInput {
    /// Rounds an input. A vector that is not finite counts as zero.
    pub fn from_input(input: &ClimberInput) -> Self {
        // A vector that was rounded before may be a little longer than 1. It is not normalised, so that its bits stay.
        let unit = |v: DVec3| {
            if !v.is_finite() {
                DVec3::ZERO
            } else if v.length() > LONGEST_UNIT_VECTOR {
                v.normalize_or_zero()
            } else {
                v
            }
        };
        let step = |x: f64| (x * ROUNDING_STEPS).round() as i8;
        let (walk, climb) = (unit(input.walk), unit(input.climb));
        let aim = if input.aim.is_finite() {
            input.aim
        } else {
            DVec3::ZERO
        };
        let level = libm::hypot(aim.x, aim.z);
        let turn = libm::atan2(aim.x, aim.z) / core::f64::consts::TAU * 65_536.0;
        let rise = libm::atan2(aim.y, level) / core::f64::consts::PI * 65_536.0;
        let flag = |is_down: bool, bit: u16| if is_down { bit } else { 0 };
        Self {
            walk: [step(walk.x), step(walk.z)],
            climb: climb.to_array().map(step),
            aim: [
                // Wraps around: half a turn to the left and half a turn to the right are the same angle.
                (turn.round() as i32 as u16).cast_signed(),
                (rise.round() as i32).clamp(-32_768, 32_767) as i16,
            ],
            buttons: (input.actions as u16 & ACTION_BITS)
                | flag(input.jump, JUMP_BIT)
                | flag(input.jump_held, JUMP_HELD)
                | flag(input.grip, GRIP_BIT)
                | flag(input.crouch, CROUCH_BIT),
            order: 0,
        }
    }

    /// Converts back to the input that [`Arena::step`](crate::Arena::step) takes. The rounding stays, and is the same
    /// on all machines. `order` is left out.
    pub fn to_input(self) -> ClimberInput {
        let part = |x: i8| (f64::from(x) / ROUNDING_STEPS).max(-1.0);
        let [turn, rise] = self.aim;
        let (sin, cos) = libm::sincos(f64::from(turn) / 65_536.0 * core::f64::consts::TAU);
        let (up, level) = libm::sincos(f64::from(rise) / 65_536.0 * core::f64::consts::PI);
        ClimberInput {
            walk: DVec3::new(part(self.walk[0]), 0.0, part(self.walk[1])),
            climb: DVec3::from_array(self.climb.map(part)),
            jump: self.buttons & JUMP_BIT != 0,
            jump_held: self.buttons & JUMP_HELD != 0,
            grip: self.buttons & GRIP_BIT != 0,
            crouch: self.buttons & CROUCH_BIT != 0,
            actions: u32::from(self.buttons & ACTION_BITS),
            aim: DVec3::new(level * sin, up, level * cos),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_comes_back_but_for_rounding_and_from_then_on_exactly() {
        let mut rng = fastrand::Rng::with_seed(3);
        for _ in 0..10_000 {
            let mut lot = || 2.0 * rng.f64() - 1.0;
            let mut vector = || DVec3::new(lot(), lot(), lot());
            let input = ClimberInput {
                walk: vector().with_y(0.0).clamp_length_max(1.0),
                climb: vector().clamp_length_max(1.0),
                aim: vector().normalize(),
                jump: lot() > 0.0,
                jump_held: lot() > 0.0,
                grip: lot() > 0.0,
                crouch: lot() > 0.0,
                actions: (lot().abs() * 255.0) as u32,
            };
            let sent = PlayerInput::from_input(&input);
            let back = sent.to_input();
            assert!(back.walk.distance(input.walk) < 0.006, "{input:?}");
            assert!(back.climb.distance(input.climb) < 0.008, "{input:?}");
            assert!(back.aim.distance(input.aim) < 1e-4, "{input:?}");
            let flags = |i: &ClimberInput| (i.jump, i.jump_held, i.grip, i.crouch, i.actions);
            assert_eq!(flags(&back), flags(&input));
            assert_eq!(PlayerInput::from_input(&back), sent);
        }
    }

    #[test]
    fn no_numbers_and_straight_aims_are_taken() {
        let wild = ClimberInput {
            walk: DVec3::NAN,
            climb: DVec3::splat(f64::INFINITY),
            aim: DVec3::NEG_INFINITY,
            ..ClimberInput::IDLE
        };
        let sent = PlayerInput::from_input(&wild);
        assert_eq!((sent.walk, sent.climb), ([0; 2], [0; 3]));
        assert!(sent.to_input().aim.is_finite());
        for aim in [DVec3::Y, DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X] {
            let back = PlayerInput::from_input(&ClimberInput { aim, ..wild }).to_input();
            assert!(back.aim.distance(aim) < 1e-4, "{aim} {}", back.aim);
        }
    }
}
