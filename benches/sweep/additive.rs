//! Additive CCD of a point and a triangle, the baseline on single triangles (Li, Kaufman, Jiang 2021, "Codimensional
//! Incremental Potential Contact", ACM Transactions on Graphics 40(4), section 5.3). Its minimum separation is the
//! sphere's radius.

use glam::DVec3;

/// Relative gap, 0 to 1: the search ends at this share of the first gap, and each step leaves this share of the current
/// gap. The authors recommend this value.
pub(crate) const LEFT: f64 = 0.1;

/// The largest number of steps. The published method has no limit, but without one a sliding motion would not end.
pub(crate) const MOST_STEPS: u32 = 10_000;

/// The gap, beyond the separation, at which the search reports a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) enum End {
    /// [`LEFT`] times the gap at the start, as published.
    Share,
    /// A distance in metres, as in clamber's sweeps.
    Tolerance(f64),
}

/// Returns the time at which a point comes near a triangle, `None` if it does not, and the number of steps. `positions`
/// are the point and the corners a, b and c at the start. At the limit of steps the current time is returned.
pub(crate) fn additive(
    mut positions: [DVec3; 4],
    motions: [DVec3; 4],
    separation: f64,
    end: End,
) -> (Option<f64>, u32) {
    // Only relative motion matters.
    let mean = motions.iter().sum::<DVec3>() * 0.25;
    let motions = motions.map(|motion| motion - mean);
    let corners = motions[1..].iter().map(|motion| motion.length());
    let speed = motions[0].length() + corners.fold(0.0, f64::max);
    if speed == 0.0 {
        return (None, 0);
    }
    let gap =
        |distance: f64| (distance * distance - separation * separation) / (distance + separation);
    let mut distance = distance(positions);
    let end = match end {
        End::Share => LEFT * gap(distance),
        End::Tolerance(tolerance) => tolerance,
    };
    let (mut time, mut steps) = (0.0, 0);
    while steps < MOST_STEPS {
        steps += 1;
        let step = (1.0 - LEFT) * gap(distance) / speed;
        for (position, motion) in positions.iter_mut().zip(motions) {
            *position += motion * step;
        }
        distance = self::distance(positions);
        if time > 0.0 && gap(distance) < end {
            return (Some(time), steps);
        }
        time += step;
        if time > 1.0 {
            return (None, steps);
        }
    }
    (Some(time), steps)
}

/// Distance of a point from a triangle, by Voronoi regions (Ericson 2004, *Real-Time Collision Detection*, 5.1.5), as
/// in collision libraries.
fn distance([p, a, b, c]: [DVec3; 4]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ap.length();
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return bp.length();
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (ap - ab * (d1 / (d1 - d3))).length();
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return cp.length();
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (ap - ac * (d2 / (d2 - d6))).length();
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (bp - (c - b) * share).length();
    }
    let sum = 1.0 / (va + vb + vc);
    (ap - ab * (vb * sum) - ac * (vc * sum)).length()
}
