//! Spherical interpolation (Shoemake 1985). Rotations that are near each other, as neighbouring keys and frames are,
//! need no trigonometry: for them it uses a series in the cosine (Eberly 2011, "A Fast and Accurate Algorithm for
//! Computing SLERP").

use glam::DQuat;

/// Largest distance from 1 of the cosine of half the turn for which the series is used: turns below 0.4 radians. The
/// series is off by less than 1e-12 there.
const SMALL: f64 = 0.02;

/// Terms of the series, the last term first: `[1 / (n (2 n + 1)), n / (2 n + 1)]` for the n-th.
const TERMS: [[f64; 2]; 5] = [
    [1.0 / 55.0, 5.0 / 11.0],
    [1.0 / 36.0, 4.0 / 9.0],
    [1.0 / 21.0, 3.0 / 7.0],
    [1.0 / 10.0, 2.0 / 5.0],
    [1.0 / 3.0, 1.0 / 3.0],
];

/// Interpolates between two rotations along the shorter arc (Shoemake 1985), from `a` at `t = 0` to `b` at `t = 1`.
/// Both must be unit quaternions; the result is a unit quaternion to 1e-12.
pub fn slerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    Slerp::new(t).between(a, b)
}

/// [`slerp`] at one `t`, for many pairs of rotations.
pub(crate) struct Slerp {
    from: Share,
    to: Share,
}

impl Slerp {
    pub(crate) fn new(t: f64) -> Self {
        Self {
            from: Share::new(1.0 - t),
            to: Share::new(t),
        }
    }

    pub(crate) fn between(&self, a: DQuat, b: DQuat) -> DQuat {
        let cos = a.dot(b);
        let mix = |from: f64, to: f64| a * from + b * to.copysign(cos);
        if 1.0 - cos.abs() < SMALL {
            return mix(self.from.of_small(cos.abs()), self.to.of_small(cos.abs()));
        }
        let angle = libm::acos(cos.abs());
        let sin = |share: &Share| libm::sin(share.t * angle);
        // Neither share is divided by the sine of the whole angle: normalisation replaces that.
        mix(sin(&self.from), sin(&self.to)).normalize()
    }
}

/// `sin(t w) / sin(w)` at one `t`, for any angle `w`.
struct Share {
    t: f64,
    /// Ratio of each term to the term before it, divided by `cos(w) - 1`; the last term first.
    growth: [f64; 5],
}

impl Share {
    fn new(t: f64) -> Self {
        let growth = TERMS.map(|[u, v]| u * t * t - v);
        Self { t, growth }
    }

    /// The share for a small angle, given its cosine.
    fn of_small(&self, cos: f64) -> f64 {
        let mut sum = 1.0;
        for growth in self.growth {
            sum = 1.0 + growth * (cos - 1.0) * sum;
        }
        self.t * sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{rotation_from_axis_angle, rotation_vector};
    use glam::DVec3;

    #[test]
    fn it_takes_the_shorter_arc_at_constant_speed() {
        for angle in [1e-9, 1e-4, 0.01, 0.39, 0.41, 1.2, 3.1] {
            let b = rotation_from_axis_angle(DVec3::Y, angle);
            for end in [b, -b] {
                for k in 0..=8 {
                    let t = f64::from(k) / 8.0;
                    let turned = rotation_vector(slerp(DQuat::IDENTITY, end, t));
                    let off = (turned - DVec3::Y * (angle * t)).length();
                    assert!(off < 1e-12, "{angle} {t}: {turned}");
                    let length = slerp(DQuat::IDENTITY, end, t).length();
                    assert!((length - 1.0).abs() < 1e-12, "{angle} {t}: {length}");
                }
            }
        }
    }

    #[test]
    fn the_series_is_off_by_less_than_1e_12_over_its_range() {
        let mut worst = 0.0_f64;
        for step in 1..=200 {
            let cos = 1.0 - SMALL * f64::from(step) / 200.0;
            let angle = libm::acos(cos);
            for part in 0..=100 {
                let t = f64::from(part) / 100.0;
                let exact = libm::sin(t * angle) / libm::sin(angle);
                worst = worst.max((Share::new(t).of_small(cos) - exact).abs());
            }
        }
        assert!(worst < 1e-12, "{worst:e}");
    }
}
