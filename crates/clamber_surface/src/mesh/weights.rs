//! Normalises influences as the skinning contract requires: one per joint, in ascending joint order, with integer
//! weights.

use crate::rig::JointId;

/// How much one joint moves one vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Influence {
    /// The joint.
    pub joint: JointId,
    /// The weight: finite, not negative. A build normalises the weights of each vertex to a sum of 1.
    pub weight: f32,
}

/// The weight 1, in units of 2^-24. Integers up to it are exact in f32, and so is every partial
/// sum of weights that add up to it.
pub(crate) const WEIGHT_ONE: u32 = 1 << 24;

/// Normalises the influences of one vertex, as a build does. Returns one influence per joint, in ascending joint
/// order, none of weight zero. The weights are multiples of 2^-24 that sum to exactly 1. `None` if a weight is
/// negative or not finite, or if no weight is positive.
pub fn normalize_influences(influences: &[Influence]) -> Option<Vec<Influence>> {
    let influence = |(joint, units): (JointId, u32)| Influence {
        joint,
        weight: weight_of(units),
    };
    Some(normalize(influences)?.into_iter().map(influence).collect())
}

/// The weight for a number of units of 2^-24; exact.
pub(crate) fn weight_of(units: u32) -> f32 {
    units as f32 / WEIGHT_ONE as f32
}

/// Joints and their weights in units of 2^-24, in ascending joint order, without zeros. The units add up to exactly
/// [`WEIGHT_ONE`]. `None` if a weight is negative or not finite, or if no weight is positive.
///
/// Influences of the same joint are merged. Each share is rounded down. The units that are then missing go to the
/// largest remainders, on a tie to the smaller joint. No weight is off by more than one unit.
pub(crate) fn normalize(influences: &[Influence]) -> Option<Vec<(JointId, u32)>> {
    if influences
        .iter()
        .any(|i| !i.weight.is_finite() || i.weight < 0.0)
    {
        return None;
    }
    let positive = influences.iter().filter(|i| i.weight > 0.0);
    let mut merged: Vec<(JointId, f64)> =
        positive.map(|i| (i.joint, f64::from(i.weight))).collect();
    // Stable: the weights of one joint are added in the order given.
    merged.sort_by_key(|(joint, _)| *joint);
    merged.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    let sum: f64 = merged.iter().map(|(_, weight)| weight).sum();
    if merged.is_empty() {
        return None;
    }
    let mut shares: Vec<(JointId, u32, f64)> = merged
        .iter()
        .map(|(joint, weight)| {
            let exact = weight / sum * f64::from(WEIGHT_ONE);
            (*joint, exact as u32, exact - exact.floor())
        })
        .collect();
    distribute_rest(&mut shares);
    let kept = shares.into_iter().filter(|(_, units, _)| *units > 0);
    Some(kept.map(|(joint, units, _)| (joint, units)).collect())
}

/// Distributes the units that rounding down left over, or takes back units if rounding made the shares too large.
fn distribute_rest(shares: &mut [(JointId, u32, f64)]) {
    let given: u64 = shares.iter().map(|(_, units, _)| u64::from(*units)).sum();
    let rest = i64::from(WEIGHT_ONE) - given as i64;
    let mut by_remainder: Vec<usize> = (0..shares.len()).collect();
    by_remainder.sort_by(|&a, &b| shares[b].2.total_cmp(&shares[a].2).then(a.cmp(&b)));
    for &index in by_remainder.iter().cycle().take(rest.max(0) as usize) {
        shares[index].1 += 1;
    }
    // Shares are rounded down, so an excess can only come from the rounding of a division.
    let mut excess = (-rest).max(0);
    for share in shares.iter_mut().rev() {
        let taken = excess.min(i64::from(share.1));
        share.1 -= taken as u32;
        excess -= taken;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::influence;

    fn influences(weights: &[(u32, f32)]) -> Vec<Influence> {
        let weights = weights.iter();
        weights
            .map(|(joint, weight)| influence(*joint, *weight))
            .collect()
    }

    #[test]
    fn sums_are_exact_and_weights_near_for_any_count() {
        let mut rng = fastrand::Rng::with_seed(11);
        for _ in 0..20_000 {
            let count = rng.usize(1..40);
            let scale = [1e-30, 1.0, 1e30][rng.usize(0..3)];
            let given: Vec<(u32, f32)> = (0..count)
                .map(|_| (rng.u32(0..50), rng.f32() * scale))
                .collect();
            let sum: f64 = given.iter().map(|(_, w)| f64::from(*w)).sum();
            if sum == 0.0 {
                continue;
            }
            let units = normalize(&influences(&given)).unwrap();
            let total: u32 = units.iter().map(|(_, u)| u).sum();
            assert_eq!(total, WEIGHT_ONE, "{given:?}");
            assert!(units.windows(2).all(|w| w[0].0 < w[1].0), "{units:?}");
            for (joint, unit) in units {
                let wanted: f64 = given
                    .iter()
                    .filter(|(j, _)| *j == joint.0)
                    .map(|(_, w)| f64::from(*w))
                    .sum();
                let error = f64::from(unit) - wanted / sum * f64::from(WEIGHT_ONE);
                assert!(error.abs() <= 1.0 + 1e-6, "{given:?}: {error}");
            }
        }
    }

    #[test]
    fn one_joint_twice_is_one_influence() {
        let units = normalize(&influences(&[(3, 0.25), (1, 0.5), (3, 0.25)])).unwrap();
        let half = WEIGHT_ONE / 2;
        assert_eq!(units, vec![(JointId(1), half), (JointId(3), half)]);
    }

    #[test]
    fn the_spare_unit_of_three_thirds_goes_to_the_smallest_joint() {
        let units = normalize(&influences(&[(2, 1.0), (0, 1.0), (1, 1.0)])).unwrap();
        let third = WEIGHT_ONE / 3;
        assert_eq!(units[0], (JointId(0), third + 1));
        assert_eq!(units[2], (JointId(2), third));
    }

    #[test]
    fn weights_that_are_negative_not_finite_or_all_zero_are_refused() {
        for bad in [f32::NAN, f32::INFINITY, -0.1] {
            assert_eq!(normalize(&influences(&[(0, 1.0), (1, bad)])), None, "{bad}");
        }
        assert_eq!(normalize(&influences(&[(0, 0.0)])), None);
        assert_eq!(normalize(&[]), None);
    }
}
