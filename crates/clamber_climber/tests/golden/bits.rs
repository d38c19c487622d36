//! A hash of the bits of answers.

use clamber_surface::Fingerprint;
use clamber_surface::surface::{Motion, SurfaceHit, SweepHit};
use glam::Vec3;

#[derive(Clone, Copy, Default)]
pub(crate) struct Bits(Fingerprint);

impl Bits {
    fn word(&mut self, word: u64) {
        self.0.word(word);
    }

    pub(crate) fn finish(self) -> u64 {
        self.0.value()
    }

    fn singles<const N: usize>(&mut self, numbers: [f32; N]) {
        self.0.floats(&numbers);
    }

    fn doubles(&mut self, numbers: impl IntoIterator<Item = f64>) {
        self.0.numbers(numbers);
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
            self.word(u64::from(hit.hit.triangle.0) + 1);
            self.singles(hit.hit.barycentric);
            self.positions(&[hit.hit.point, hit.separation_normal, hit.hit.normal]);
            self.doubles([hit.fraction, hit.hit.distance]);
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
