//! The influences of all vertices, in little memory.

use std::ops::Range;

use super::weights::{WEIGHT_ONE, weight_of};
use crate::rig::JointId;

/// The influences of every vertex, one vertex after the other, each in ascending joint order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Influences {
    ends: Ends,
    pairs: Pairs,
}

impl Influences {
    /// Adds the influences of the next vertex: joints below 2^16, and their weights in units of 2^-24, from 1 to
    /// [`WEIGHT_ONE`].
    pub(super) fn push(&mut self, influences: impl IntoIterator<Item = (JointId, u32)>) {
        for (joint, units) in influences {
            self.pairs.push(joint.0 as u16, units);
        }
        self.ends.push(self.pairs.len() as u32);
    }

    /// Number of influences of all vertices.
    pub(super) fn len(&self) -> usize {
        self.pairs.len()
    }

    /// The joints and weights of a vertex; none for a vertex out of range.
    #[inline]
    pub(super) fn of(
        &self,
        vertex: usize,
    ) -> impl ExactSizeIterator<Item = (JointId, f32)> + Clone {
        self.units_of(vertex)
            .map(|(joint, units)| (joint, weight_of(units)))
    }

    /// [`Influences::of`] with the weights in units of 2^-24.
    #[inline]
    pub(super) fn units_of(
        &self,
        vertex: usize,
    ) -> impl ExactSizeIterator<Item = (JointId, u32)> + Clone {
        self.ends.range(vertex).map(|index| self.pairs.get(index))
    }

    /// The most influences that one vertex has.
    pub(super) fn most(&self) -> usize {
        let counts = (0..self.ends.len()).map(|vertex| self.ends.range(vertex).len());
        counts.max().unwrap_or(0)
    }

    /// The data of a mesh's fingerprint: all weights, then for each vertex the number of influences of the vertices
    /// before it, then the number of all influences, then all joints.
    pub(super) fn words(&self) -> impl Iterator<Item = u32> + '_ {
        let pairs = (0..self.pairs.len()).map(|index| self.pairs.get(index));
        let weights = pairs.clone().map(|(_, units)| weight_of(units).to_bits());
        let starts = (0..self.ends.len()).map(|vertex| self.ends.range(vertex).start);
        let starts = starts.chain([self.pairs.len()]).map(|start| start as u32);
        weights.chain(starts).chain(pairs.map(|(joint, _)| joint.0))
    }

    /// Drops memory that is not used.
    pub(super) fn shrink(&mut self) {
        match &mut self.ends {
            Ends::Near { blocks, ends } => {
                blocks.shrink_to_fit();
                ends.shrink_to_fit();
            }
            Ends::Far(ends) => ends.shrink_to_fit(),
        }
        match &mut self.pairs {
            Pairs::Together(pairs) => pairs.shrink_to_fit(),
            Pairs::Apart { joints, units } => {
                joints.shrink_to_fit();
                units.shrink_to_fit();
            }
        }
    }

    /// Size of the arrays in bytes.
    pub(super) fn memory(&self) -> usize {
        self.ends.memory() + self.pairs.memory()
    }
}

/// Number of vertices in a block of [`Ends::Near`].
const BLOCK: usize = 8;

/// For each vertex, the index after its last influence.
#[derive(Clone, Debug)]
enum Ends {
    /// As a distance from the start of its block of vertices, while no block has more than 255 influences.
    Near { blocks: Vec<u32>, ends: Vec<u8> },
    /// As an index, from the first such block on.
    Far(Vec<u32>),
}

impl Ends {
    fn len(&self) -> usize {
        match self {
            Self::Near { ends, .. } => ends.len(),
            Self::Far(ends) => ends.len(),
        }
    }

    /// The indices of a vertex's influences; none for a vertex out of range.
    #[inline]
    fn range(&self, vertex: usize) -> Range<usize> {
        if vertex >= self.len() {
            return 0..0;
        }
        match self {
            Self::Near { blocks, ends } => {
                let block = blocks[vertex / BLOCK] as usize;
                let before = if vertex.is_multiple_of(BLOCK) {
                    0
                } else {
                    ends[vertex - 1]
                };
                block + usize::from(before)..block + usize::from(ends[vertex])
            }
            Self::Far(ends) => {
                let before = vertex.checked_sub(1).map_or(0, |before| ends[before]);
                before as usize..ends[vertex] as usize
            }
        }
    }

    fn push(&mut self, end: u32) {
        if let Self::Near { blocks, ends } = self {
            if ends.len().is_multiple_of(BLOCK) {
                let start = ends.len().checked_sub(1);
                let start = start.map_or(0, |last| blocks[last / BLOCK] + u32::from(ends[last]));
                blocks.push(start);
            }
            if let Ok(near) = u8::try_from(end - blocks[ends.len() / BLOCK]) {
                ends.push(near);
                return;
            }
            let all = (0..ends.len()).map(|vertex| self.range(vertex).end as u32);
            *self = Self::Far(all.collect());
        }
        if let Self::Far(ends) = self {
            ends.push(end);
        }
    }

    fn memory(&self) -> usize {
        match self {
            Self::Near { blocks, ends } => size_of_val(&blocks[..]) + size_of_val(&ends[..]),
            Self::Far(ends) => size_of_val(&ends[..]),
        }
    }
}

impl Default for Ends {
    fn default() -> Self {
        Self::Near {
            blocks: Vec::new(),
            ends: Vec::new(),
        }
    }
}

/// Equal if each vertex has the same influences.
impl PartialEq for Ends {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && (0..self.len()).all(|v| self.range(v) == other.range(v))
    }
}

/// Joints and weights.
#[derive(Clone, Debug)]
enum Pairs {
    /// The joint in the upper byte; below it, the weight in units of 2^-24, less one.
    Together(Vec<u32>),
    /// From the first joint above 255 on.
    Apart { joints: Vec<u16>, units: Vec<u32> },
}

/// Number of bits below the joint in [`Pairs::Together`].
const JOINT: u32 = WEIGHT_ONE.trailing_zeros();

impl Pairs {
    fn len(&self) -> usize {
        match self {
            Self::Together(pairs) => pairs.len(),
            Self::Apart { joints, .. } => joints.len(),
        }
    }

    #[inline]
    fn get(&self, index: usize) -> (JointId, u32) {
        match self {
            Self::Together(pairs) => {
                let pair = pairs[index];
                (JointId(pair >> JOINT), (pair & (WEIGHT_ONE - 1)) + 1)
            }
            Self::Apart { joints, units } => (JointId(u32::from(joints[index])), units[index]),
        }
    }

    fn push(&mut self, joint: u16, units: u32) {
        if let Self::Together(pairs) = self {
            if let Ok(joint) = u8::try_from(joint) {
                pairs.push(u32::from(joint) << JOINT | (units - 1));
                return;
            }
            let all = (0..pairs.len()).map(|index| self.get(index));
            let (joints, units) = all.map(|(joint, units)| (joint.0 as u16, units)).unzip();
            *self = Self::Apart { joints, units };
        }
        if let Self::Apart { joints, units: all } = self {
            joints.push(joint);
            all.push(units);
        }
    }

    fn memory(&self) -> usize {
        match self {
            Self::Together(pairs) => size_of_val(&pairs[..]),
            Self::Apart { joints, units } => size_of_val(&joints[..]) + size_of_val(&units[..]),
        }
    }
}

impl Default for Pairs {
    fn default() -> Self {
        Self::Together(Vec::new())
    }
}

impl PartialEq for Pairs {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && (0..self.len()).all(|i| self.get(i) == other.get(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vertex with up to `most` influences by joints below `joints`.
    fn vertex(rng: &mut fastrand::Rng, most: usize, joints: u32) -> Vec<(JointId, u32)> {
        let mut all: Vec<u32> = (0..rng.usize(1..=most))
            .map(|_| rng.u32(0..joints))
            .collect();
        all.sort_unstable();
        all.dedup();
        let units = [1, WEIGHT_ONE, WEIGHT_ONE - 1];
        let pairs = all.into_iter();
        pairs
            .map(|joint| {
                let any = rng.u32(1..=WEIGHT_ONE);
                (
                    JointId(joint),
                    *rng.choice(&units)
                        .filter(|_| joint % 2 == 0)
                        .unwrap_or(&any),
                )
            })
            .collect()
    }

    #[test]
    fn influences_are_those_of_plain_lists_however_many_and_by_whichever_joints() {
        let mut rng = fastrand::Rng::with_seed(9);
        for (most, joints) in [
            (1, 1),
            (4, 256),
            (4, 300),
            (31, 256),
            (300, 256),
            (300, 65_536),
        ] {
            let (mut packed, mut plain) = (Influences::default(), Vec::new());
            // A vertex that needs more room comes late.
            let counts = (0..600).map(|v| if v < 400 { most.min(4) } else { most });
            for (index, most) in counts.enumerate() {
                let joints = if index < 500 { joints.min(256) } else { joints };
                let next = vertex(&mut rng, most, joints);
                packed.push(next.iter().copied());
                plain.push(next);
            }
            for (index, wanted) in plain.iter().enumerate() {
                assert_eq!(packed.units_of(index).collect::<Vec<_>>(), *wanted);
                assert_eq!(packed.of(index).len(), wanted.len());
                let weights = wanted
                    .iter()
                    .map(|(joint, units)| (*joint, weight_of(*units)));
                assert!(packed.of(index).eq(weights), "{most} by {joints}");
            }
            assert_eq!(packed.of(plain.len()).len(), 0);
            assert_eq!(packed.len(), plain.iter().map(Vec::len).sum::<usize>());
            assert_eq!(packed.most(), plain.iter().map(Vec::len).max().unwrap());
            let (near, together) = (
                matches!(packed.ends, Ends::Near { .. }),
                matches!(packed.pairs, Pairs::Together(_)),
            );
            assert_eq!(
                (near, together),
                (most <= 31, joints <= 256),
                "{most} by {joints}"
            );

            let mut others = Influences::default();
            others.push([(JointId(0), WEIGHT_ONE)]);
            assert_ne!(packed, others);
            assert_eq!(packed, packed.clone());
        }
    }

    #[test]
    fn words_are_weights_starts_and_joints() {
        let mut influences = Influences::default();
        influences.push([(JointId(3), WEIGHT_ONE)]);
        influences.push([(JointId(1), WEIGHT_ONE / 2), (JointId(2), WEIGHT_ONE / 2)]);
        let [one, half] = [1.0_f32, 0.5].map(f32::to_bits);
        let words: Vec<u32> = influences.words().collect();
        assert_eq!(words, [one, half, half, 0, 1, 3, 3, 1, 2]);
    }
}
