//! Where to aim so that an arrow meets a moving target: for bots, and for a mark on the screen.

use glam::DVec3;

/// How to shoot an arrow so that it meets a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead {
    /// Launch velocity relative to the fighter, along the axes of world space, metres a second. Its direction is the
    /// aim, its length the `speed` that [`lead`] was given. Do not add the fighter's own velocity to it: the shot does
    /// so itself ([`Fighter::arrow_velocity`](crate::Fighter::arrow_velocity)).
    pub velocity: DVec3,
    /// Seconds until the arrow meets the target.
    pub seconds: f64,
}

/// How to shoot an arrow without drag so that it meets a moving target as soon as possible: on the flatter of two
/// possible arcs. `None` if the target is out of reach or already at `from`, if the speed is not positive, or if a
/// number is not finite.
///
/// `from` is where the arrow leaves, `target` the target's position now, and `speed` the arrow's speed relative to the
/// fighter. `velocity` is the target's velocity, which counts as constant, minus the fighter's own velocity, which a
/// shot adds to the arrow's. Positions are in world space, metres, velocities in metres a second, gravity in metres a
/// second squared. With drag an arrow falls short.
///
/// The arrow and the target can meet at the positive roots of `|g|^2 t^4 / 4 - (w.g) t^3 + (|w|^2 - d.g - s^2) t^2 + 2
/// (d.w) t + |d|^2`, where d is the vector from `from` to the target, w its velocity, g gravity and s the speed. The
/// smallest root is found between the roots of the derivatives, where the polynomial is monotone.
pub fn lead(
    from: DVec3,
    target: DVec3,
    velocity: DVec3,
    gravity: DVec3,
    speed: f64,
) -> Option<Lead> {
    let (d, w, g) = (target - from, velocity, gravity);
    if !(d.is_finite() && w.is_finite() && g.is_finite() && speed > 0.0 && speed < f64::INFINITY) {
        return None;
    }
    if d == DVec3::ZERO {
        return None;
    }
    // The unit of length is the distance, and the unit of time is the duration of a straight flight. In these units no
    // coefficient is extreme.
    let (length, unit) = (d.length(), d.length() / speed);
    let (d, w, g) = (d / length, w / speed, g * (unit / speed));
    let polynomial = [
        1.0,
        2.0 * d.dot(w),
        w.length_squared() - d.dot(g) - 1.0,
        -w.dot(g),
        0.25 * g.length_squared(),
    ];
    let time = first_root(&polynomial)?;
    let along = d / time + w - g * (0.5 * time);
    Some(Lead {
        velocity: along.try_normalize()? * speed,
        seconds: time * unit,
    })
}

/// The smallest positive root of a polynomial. Coefficients begin with the constant, which must be positive.
fn first_root(polynomial: &[f64; 5]) -> Option<f64> {
    let all = derivatives(polynomial);
    let bound = bound(polynomial)?;
    // Between the roots of its derivative, each polynomial is monotone.
    let mut breaks: Vec<f64> = Vec::new();
    for level in all.iter().rev() {
        breaks = roots_between(level, &breaks, bound);
    }
    breaks.into_iter().next()
}

/// The polynomial and its derivatives, down to the linear one.
fn derivatives(polynomial: &[f64; 5]) -> [[f64; 5]; 4] {
    let mut all = [*polynomial; 4];
    for level in 1..4 {
        for power in 0..4 {
            all[level][power] = all[level - 1][power + 1] * (power + 1) as f64;
        }
        all[level][4] = 0.0;
    }
    all
}

/// A number above all roots (Cauchy's bound); `None` if all coefficients but the constant are zero.
fn bound(polynomial: &[f64; 5]) -> Option<f64> {
    let most = |values: &[f64]| values.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let highest = (1..5).rev().find(|power| polynomial[*power] != 0.0)?;
    let bound = 1.0 + most(&polynomial[..highest]) / polynomial[highest].abs();
    Some(bound.min(1e18))
}

/// Positive roots up to `bound`, ascending. The polynomial must be monotone between consecutive `breaks`.
fn roots_between(polynomial: &[f64; 5], breaks: &[f64], bound: f64) -> Vec<f64> {
    let at = |t: f64| polynomial.iter().rev().fold(0.0, |sum, x| sum * t + x);
    let mut roots = Vec::new();
    let (mut low, mut below) = (0.0, at(0.0));
    for high in breaks.iter().copied().chain([bound]) {
        let above = at(high);
        if above == 0.0 {
            roots.push(high);
        } else if below != 0.0 && (below < 0.0) != (above < 0.0) {
            roots.push(bisect(at, [low, high], below < 0.0));
        }
        (low, below) = (high, above);
    }
    roots
}

/// The root between two numbers, by bisection, to within a few units in the last place.
fn bisect(at: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2], rises: bool) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if (at(middle) < 0.0) == rises {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}
