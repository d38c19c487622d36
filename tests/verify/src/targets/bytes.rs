//! Choices and numbers made from bytes.

use glam::Vec3;

/// A source of choices and numbers. The first four bytes seed a random generator, which takes over after the last byte:
/// a few bytes make a whole case, and a fuzzer that changes one byte changes one choice.
pub(crate) struct Bytes<'a> {
    rest: &'a [u8],
    beyond: fastrand::Rng,
}

impl<'a> Bytes<'a> {
    pub(crate) fn new(data: &'a [u8]) -> Self {
        let (first, rest) = data.split_at(data.len().min(4));
        let mut seed = [0; 8];
        seed[..first.len()].copy_from_slice(first);
        Self {
            rest,
            beyond: fastrand::Rng::with_seed(u64::from_le_bytes(seed)),
        }
    }

    pub(crate) fn byte(&mut self) -> u8 {
        match self.rest.split_first() {
            Some((first, rest)) => {
                self.rest = rest;
                *first
            }
            None => self.beyond.u8(..),
        }
    }

    fn word(&mut self) -> u32 {
        u32::from_le_bytes([self.byte(), self.byte(), self.byte(), self.byte()])
    }

    /// True in about one of `n` cases, `n` from 1 to 256.
    pub(crate) fn one_in(&mut self, n: u32) -> bool {
        u32::from(self.byte()) * n < 256
    }

    /// A number from 0 to `n - 1`, `n` from 1 to 2^16.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        if n <= 256 {
            usize::from(self.byte()) % n
        } else {
            usize::from(u16::from_le_bytes([self.byte(), self.byte()])) % n
        }
    }

    pub(crate) fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.below(choices.len())]
    }

    /// A number from 0 to 1, both included, in 255 steps.
    pub(crate) fn share(&mut self) -> f32 {
        f32::from(self.byte()) / 255.0
    }

    /// A multiple of 1/16 from -6 to 6, so that points coincide or lie on common lines and planes; or an
    /// unusual number, which is finite.
    pub(crate) fn number(&mut self) -> f32 {
        let byte = self.byte() as i8;
        if (-96..=96).contains(&byte) {
            return f32::from(byte) / 16.0;
        }
        match byte.unsigned_abs() % 16 {
            0 => -0.0,
            1 => f32::from_bits(1),
            2 => 1e-42,
            3 => 1e-30,
            4 => 1e-8,
            5 => 1.0 + f32::EPSILON,
            6 => -1.0 + f32::EPSILON / 2.0,
            7 => 1.0 / 3.0,
            8 => 1e3,
            9 => -1e7,
            10 => 1e15,
            11 => -1e25,
            _ => {
                let any = f32::from_bits(self.word());
                if any.is_finite() { any } else { 0.0 }
            }
        }
    }

    /// Any number, including infinities, NaN and the largest numbers.
    pub(crate) fn hostile(&mut self) -> f32 {
        match self.byte() % 8 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => f32::NEG_INFINITY,
            3 => f32::MAX,
            4 => -f32::MAX,
            5 => f32::from_bits(self.word()),
            _ => self.number(),
        }
    }

    pub(crate) fn point(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }

    /// As [`Bytes::point`], with [`Bytes::hostile`] numbers.
    pub(crate) fn hostile_point(&mut self) -> Vec3 {
        Vec3::new(self.hostile(), self.hostile(), self.hostile())
    }
}
