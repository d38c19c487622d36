//! The buttons of a fight, and a player's input in a few bytes.

use clamber_climber::ClimberInput;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A press raises the sword for a stab, which then charges, and the next press strikes; bits of
/// [`ClimberInput::actions`]. While it stays down, the charge grows faster. After a stab that was broken off it has to
/// be let go and pressed anew. The upper 16 bits of the actions are the game's.
pub const STAB: u32 = 1;
/// A press cuts with the sword.
pub const CUT: u32 = 1 << 1;
/// Draws the bow as long as it is down, and shoots when it is let go.
pub const BOW: u32 = 1 << 2;
/// A press throws a stone.
pub const THROW: u32 = 1 << 3;

/// Bits of [`PlayerInput::buttons`] beside the actions.
const JUMP: u16 = 1 << 8;
const JUMP_HELD: u16 = 1 << 9;
const GRIP: u16 = 1 << 10;
const CROUCH: u16 = 1 << 11;
const ACTIONS: u16 = 0xff;

/// Steps of a unit vector's component.
const STEPS: f64 = 127.0;

/// Length up to which a vector may be longer than 1 by rounding.
const LONGEST: f64 = 1.01;

/// A player's input for one tick in thirteen bytes, to be sent over a network.
///
/// [`PlayerInput::from_input`] rounds: directions to 1/127 of their length, the aim to 0.006 degrees. All peers step their
/// arenas with [`PlayerInput::to_input`], which gives all of them the same bits. Its order is 0. It holds no blow: blows come out of
/// the arena itself. Of the actions it holds the lower eight bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct PlayerInput {
    /// The direction to walk in, along x and z, in 127ths.
    pub walk: [i8; 2],
    /// The direction to climb in, in 127ths; zero for none.
    pub climb: [i8; 3],
    /// Where it aims: the angle about Y from +Z, in 65,536ths of a turn, and the angle above the level, in 65,536ths of
    /// half a turn.
    pub aim: [i16; 2],
    /// Buttons.
    pub buttons: u16,
    /// What the player asks the game to do in this tick, in numbers of the game's own; 0 for nothing. With rollback the
    /// peers turn it into [`Order`](crate::Order)s, all of them in the same tick.
    pub order: u16,
}

impl PlayerInput {
    /// Rounds an input. A vector that is not finite counts as zero.
    pub fn from_input(input: &ClimberInput) -> Self {
        // What was rounded once may be a little longer than 1, and stays as it is.
        let unit = |v: DVec3| {
            if !v.is_finite() {
                DVec3::ZERO
            } else if v.length() > LONGEST {
                v.normalize_or_zero()
            } else {
                v
            }
        };
        let step = |x: f64| (x * STEPS).round() as i8;
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
                // Half a turn is the same to both sides.
                (turn.round() as i32 as u16).cast_signed(),
                (rise.round() as i32).clamp(-32_768, 32_767) as i16,
            ],
            buttons: (input.actions as u16 & ACTIONS)
                | flag(input.jump, JUMP)
                | flag(input.jump_held, JUMP_HELD)
                | flag(input.grip, GRIP)
                | flag(input.crouch, CROUCH),
            order: 0,
        }
    }

    /// The input that an arena takes.
    pub fn to_input(self) -> ClimberInput {
        let part = |x: i8| (f64::from(x) / STEPS).max(-1.0);
        let [turn, rise] = self.aim;
        let (sin, cos) = libm::sincos(f64::from(turn) / 65_536.0 * core::f64::consts::TAU);
        let (up, level) = libm::sincos(f64::from(rise) / 65_536.0 * core::f64::consts::PI);
        ClimberInput {
            walk: DVec3::new(part(self.walk[0]), 0.0, part(self.walk[1])),
            climb: DVec3::from_array(self.climb.map(part)),
            jump: self.buttons & JUMP != 0,
            jump_held: self.buttons & JUMP_HELD != 0,
            grip: self.buttons & GRIP != 0,
            crouch: self.buttons & CROUCH != 0,
            blow: None,
            actions: u32::from(self.buttons & ACTIONS),
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
                blow: None,
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
