//! Where to aim so that an arrow meets a target that moves: for bots, and for a mark on the screen.

use glam::DVec3;

/// How an arrow gets to a target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead {
    /// Velocity with which it has to be shot, metres a second. Its length is the arrow's speed.
    pub velocity: DVec3,
    /// Seconds until it is there.
    pub seconds: f64,
}

/// The soonest way for an arrow without drag from one place to a target: the flat one of two arcs. `None` if it does
/// not get there, or if a number is not finite.
///
/// `target` is where the target is now, `velocity` its velocity, which stays, and `speed` the arrow's speed. Places are
/// in metres, velocities in metres a second, gravity in metres a second squared.
///
/// The times at which an arrow of this speed and the target can be at one place are the positive roots of `|g|^2 t^4 /
/// 4 - (w.g) t^3 + (|w|^2 - d.g - s^2) t^2 + 2 (d.w) t + |d|^2`, d being the way to the target, w its velocity, g
/// gravity and s the speed. The least of them is found between the roots of the derivatives, where the polynomial is
/// monotone.
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
    // Seconds of a straight flight as the unit of time, and the distance as that of length: all coefficients are
    // moderate then.
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

/// The least positive root of a polynomial with the given coefficients, that of the constant first, whose constant is
/// positive.
fn first_root(polynomial: &[f64; 5]) -> Option<f64> {
    let all = derivatives(polynomial);
    let bound = bound(polynomial)?;
    // Roots of each derivative separate those of the one above.
    let mut breaks: Vec<f64> = Vec::new();
    for level in all.iter().rev() {
        breaks = roots_between(level, &breaks, bound);
    }
    breaks.into_iter().next()
}

/// The polynomial and its derivatives down to the linear one.
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

/// A number beyond all roots (Cauchy's bound); `None` without any coefficient but the constant.
fn bound(polynomial: &[f64; 5]) -> Option<f64> {
    let most = |values: &[f64]| values.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let highest = (1..5).rev().find(|power| polynomial[*power] != 0.0)?;
    let bound = 1.0 + most(&polynomial[..highest]) / polynomial[highest].abs();
    Some(bound.min(1e18))
}

/// Positive roots below `bound` of a polynomial that is monotone between the given numbers, in order.
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

/// The root between two numbers, to the last bit but few.
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
