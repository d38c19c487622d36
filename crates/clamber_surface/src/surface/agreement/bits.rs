//! Query results as bits, since `==` takes -0 for 0.

use std::fmt::Debug;

use glam::Vec3;

use crate::mesh::{PartId, SurfaceTag, TriangleId};
use crate::surface::{CapsuleHit, MovingTriangle, SurfaceHit, SweepHit};

/// Appends every number of a query result, bit by bit.
pub(crate) trait Bits {
    fn append_to(&self, bits: &mut Vec<u64>);
}

/// The bits of one result.
fn bits(answer: &impl Bits) -> Vec<u64> {
    let mut bits = Vec::new();
    answer.append_to(&mut bits);
    bits
}

/// Asserts that results are the same bit for bit.
#[track_caller]
pub(crate) fn assert_same_bits<T: Bits + Debug>(found: &[T], wanted: &[T], case: &str) {
    let same =
        found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| bits(a) == bits(b));
    assert!(same, "{found:?}\nis not\n{wanted:?}\nof {case}");
}

impl<T: Bits, const N: usize> Bits for [T; N] {
    fn append_to(&self, bits: &mut Vec<u64>) {
        self.iter().for_each(|item| item.append_to(bits));
    }
}

impl Bits for bool {
    fn append_to(&self, bits: &mut Vec<u64>) {
        bits.push(u64::from(*self));
    }
}

impl Bits for f32 {
    fn append_to(&self, bits: &mut Vec<u64>) {
        bits.push(self.to_bits().into());
    }
}

impl Bits for f64 {
    fn append_to(&self, bits: &mut Vec<u64>) {
        bits.push(self.to_bits());
    }
}

impl Bits for Vec3 {
    fn append_to(&self, bits: &mut Vec<u64>) {
        self.to_array().append_to(bits);
    }
}

impl Bits for TriangleId {
    fn append_to(&self, bits: &mut Vec<u64>) {
        bits.push(self.0.into());
    }
}

impl Bits for PartId {
    fn append_to(&self, bits: &mut Vec<u64>) {
        bits.push(self.0.into());
    }
}

impl Bits for SurfaceTag {
    fn append_to(&self, bits: &mut Vec<u64>) {
        bits.extend([self.kind as u64, self.ledge.into()]);
    }
}

impl Bits for SurfaceHit {
    fn append_to(&self, bits: &mut Vec<u64>) {
        self.triangle.append_to(bits);
        self.barycentric.append_to(bits);
        [self.point, self.normal].append_to(bits);
        self.distance.append_to(bits);
        self.part.append_to(bits);
        self.tag.append_to(bits);
    }
}

impl Bits for CapsuleHit {
    fn append_to(&self, bits: &mut Vec<u64>) {
        self.surface.append_to(bits);
        self.segment.append_to(bits);
        self.along.append_to(bits);
    }
}

impl Bits for SweepHit {
    fn append_to(&self, bits: &mut Vec<u64>) {
        self.triangle.append_to(bits);
        self.barycentric.append_to(bits);
        [self.time, self.distance].append_to(bits);
        [self.point, self.separation_normal, self.normal].append_to(bits);
        self.part.append_to(bits);
        self.tag.append_to(bits);
        [self.started_inside, self.undecided].append_to(bits);
    }
}

impl Bits for MovingTriangle {
    fn append_to(&self, bits: &mut Vec<u64>) {
        self.triangle.append_to(bits);
        [self.previous, self.current].append_to(bits);
    }
}
