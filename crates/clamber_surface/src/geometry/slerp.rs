//! Spherical interpolation (Shoemake 1985), without trigonometry where rotations are near each other, as keys and
//! frames are: there by a series in the cosine (Eberly 2011, "A Fast and Accurate Algorithm for Computing SLERP").

use glam::DQuat;

/// How far from 1 the cosine of half the turn may be for the series: below 0.4 radians of turn, where it is off by
/// less than 1e-12.
const SMALL: f64 = 0.02;

/// Terms of the series, the last first: `[1 / (n (2 n + 1)), n / (2 n + 1)]` of the n-th.
const TERMS: [[f64; 2]; 5] = [
    [1.0 / 55.0, 5.0 / 11.0],
    [1.0 / 36.0, 4.0 / 9.0],
    [1.0 / 21.0, 3.0 / 7.0],
    [1.0 / 10.0, 2.0 / 5.0],
    [1.0 / 3.0, 1.0 / 3.0],
];

/// Spherical interpolation along the shorter arc (Shoemake 1985), from `a` at 0 to `b` at 1.
/// Both must be unit quaternions; the result is one, to 1e-12.
pub fn slerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    Slerp::new(t).between(a, b)
}

/// [`slerp`] at one `t`, for many rotations.
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
        // What both would be divided by, the sine of the whole angle, is normalised away.
        mix(sin(&self.from), sin(&self.to)).normalize()
    }
}

/// `sin(t w) / sin(w)` at one `t`.
struct Share {
    t: f64,
    /// By which the terms grow, times the cosine's distance from 1; the last first.
    growth: [f64; 5],
}

impl Share {
    fn new(t: f64) -> Self {
        let growth = TERMS.map(|[u, v]| u * t * t - v);
        Self { t, growth }
    }

    /// Of a small angle, by its cosine.
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
    fn the_series_is_off_by_less_than_it_says_as_far_as_it_is_used() {
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
