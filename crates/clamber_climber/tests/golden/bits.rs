//! A hash of bits: 64-bit FNV-1a (Fowler, Noll, Vo).

use clamber_surface::surface::{Motion, SurfaceHit, SweepHit};
use glam::Vec3;

#[derive(Clone, Copy)]
pub(crate) struct Bits(u64);

impl Default for Bits {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Bits {
    fn word(&mut self, word: u64) {
        for byte in word.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }

    pub(crate) fn finish(self) -> u64 {
        self.0
    }

    fn singles(&mut self, numbers: impl IntoIterator<Item = f32>) {
        for number in numbers {
            self.word(u64::from(number.to_bits()));
        }
    }

    fn doubles(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for number in numbers {
            self.word(number.to_bits());
        }
    }

    pub(crate) fn positions(&mut self, positions: &[Vec3]) {
        for position in positions {
            self.singles(position.to_array());
        }
    }

    pub(crate) fn hits<'a>(&mut self, hits: impl IntoIterator<Item = &'a SurfaceHit>) {
        for hit in hits {
            self.word(u64::from(hit.triangle.0) + 1);
            self.singles(hit.barycentric);
            self.positions(&[hit.point, hit.normal]);
            self.singles([hit.distance as f32]);
        }
    }

    pub(crate) fn sweeps<'a>(&mut self, hits: impl IntoIterator<Item = &'a SweepHit>) {
        for hit in hits {
            self.word(u64::from(hit.triangle.0) + 1);
            self.singles(hit.barycentric);
            self.positions(&[hit.point, hit.separation_normal, hit.normal]);
            self.doubles([hit.time, hit.distance]);
            self.word(u64::from(hit.started_inside) + 2 * u64::from(hit.undecided));
        }
    }

    pub(crate) fn motion(&mut self, motion: &Motion) {
        self.positions(&[
            motion.position,
            motion.velocity,
            motion.angular_velocity,
            motion.normal,
        ]);
        self.singles(motion.frame.to_array());
        self.singles([motion.area_ratio]);
        self.singles(motion.stretches);
    }
}
