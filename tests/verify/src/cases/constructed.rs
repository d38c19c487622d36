//! Cases whose coordinates are multiples of powers of two, and whose answer is partly known from their construction.

use glam::{DMat3, DVec3};

use super::Case;
use crate::MovingPair;

/// The known part of the answer to a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// At this time the distance is at most the radius.
    Touches(f64),
    /// The distance is always greater than the radius plus the tolerance.
    Misses,
    /// The answer is not known.
    Nothing,
}

/// Integer matrices that rotate or mirror, and scale by the factor beside them: 1, 3 and 9. Integers keep a turned case
/// exact.
const TURNS: [(DMat3, f64); 3] = [
    (DMat3::IDENTITY, 1.0),
    (
        DMat3::from_cols(
            DVec3::new(1.0, 2.0, 2.0),
            DVec3::new(2.0, 1.0, -2.0),
            DVec3::new(2.0, -2.0, 1.0),
        ),
        3.0,
    ),
    (
        DMat3::from_cols(
            DVec3::new(1.0, 4.0, 8.0),
            DVec3::new(8.0, -4.0, 1.0),
            DVec3::new(-4.0, -7.0, 4.0),
        ),
        9.0,
    ),
];

/// The tolerance, in the units of a draft. A power of two, so that heights in tolerances are exact.
const TOLERANCE: f64 = 1.0 / 4096.0;

/// A case before it is turned and scaled. All numbers are exact.
#[derive(Clone, Copy)]
struct Draft {
    corners: [[DVec3; 3]; 2],
    ends: [DVec3; 2],
    motions: [DVec3; 2],
    radius: f64,
    is_edge: bool,
    known: Known,
}

/// A random case of a vertex and a face or of two edges, and the known part of its answer.
pub fn constructed(rng: &mut fastrand::Rng) -> (Case, Known) {
    loop {
        let draft = match rng.usize(0..5) {
            0 | 1 => crossing(rng),
            2 | 3 => above_plane(rng),
            _ => random(rng),
        };
        // A few cases need more digits than f32 has; they are drawn again.
        if let Some(case) = draft.placed(rng) {
            return (case, draft.known);
        }
    }
}

impl Draft {
    /// The case, turned or mirrored, and scaled; `None` if a number of it is not exact in f32.
    fn placed(&self, rng: &mut fastrand::Rng) -> Option<Case> {
        let (turn, factor) = TURNS[rng.usize(0..TURNS.len())];
        let scale = [1.0, 1.0 / 64.0, 1024.0, 1.0 / (1u64 << 40) as f64][rng.usize(0..4)];
        let place = |p: DVec3| {
            let exact = turn * p * scale;
            let found = exact.as_vec3();
            (found.as_dvec3() == exact).then_some(found)
        };
        let all = |points: [DVec3; 3]| {
            let [a, b, c] = points.map(place);
            Some([a?, b?, c?])
        };
        let two = |points: [DVec3; 2]| {
            let [a, b] = points.map(place);
            Some([a?, b?])
        };
        let length = |x: f64| {
            let exact = x * factor * scale;
            let found = exact as f32;
            (f64::from(found) == exact).then_some(found)
        };
        let [start, end] = self.corners;
        let (ends, motions) = (two(self.ends)?, two(self.motions)?);
        let [ends, motions] = [ends, motions].map(|[a, b]| [a, if self.is_edge { b } else { a }]);
        Some(Case {
            pair: MovingPair {
                corners: [all(start)?, all(end)?],
                ends,
                motions,
                radius: length(self.radius)?,
            },
            tolerance: length(TOLERANCE)?,
        })
    }
}

/// A random vector of integers from `-most` to `most`.
fn integers(rng: &mut fastrand::Rng, most: i32) -> DVec3 {
    let mut integer = || f64::from(rng.i32(-most..=most));
    DVec3::new(integer(), integer(), integer())
}

/// Random weights in eighths that sum to 1, all on the first `corners` corners.
fn weights(rng: &mut fastrand::Rng, corners: usize) -> [f64; 3] {
    let mut eighths = [0u8; 3];
    for _ in 0..8 {
        eighths[rng.usize(0..corners)] += 1;
    }
    eighths.map(|w| f64::from(w) / 8.0)
}

fn weighted(corners: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2]
}

fn between([start, end]: [[DVec3; 3]; 2], time: f64) -> [DVec3; 3] {
    [0, 1, 2].map(|k| start[k] + (end[k] - start[k]) * time)
}

/// The core goes through a point of the triangle.
fn crossing(rng: &mut fastrand::Rng) -> Draft {
    let is_edge = rng.bool();
    let mut corners = [(); 2].map(|()| [(); 3].map(|()| integers(rng, 250)));
    if is_edge {
        corners = corners.map(|[a, b, _]| [a, b, b]);
    }
    let time = f64::from(rng.u32(0..=32)) / 32.0;
    let met = weighted(between(corners, time), weights(rng, 3));
    let axis = integers(rng, 30) * 8.0;
    let along = axis * (f64::from(rng.u32(0..=8)) / 8.0);
    let motion = integers(rng, 500);
    let motions = [motion, [motion, integers(rng, 500)][rng.usize(0..2)]];
    let ends = [met - along, met - along + axis];
    let ends = if is_edge { ends } else { [met; 2] };
    Draft {
        corners,
        ends: [0, 1].map(|k| ends[k] - motions[k] * time),
        motions,
        radius: [0.0, 1.0 / 64.0, 1.0, 40.0][rng.usize(0..4)],
        is_edge,
        known: Known::Touches(time),
    }
}

/// One to three corners move in the plane z = 0, the others below it. Each end of the core keeps its height
/// above the plane. At one time the core is exactly above a point of the corner, edge or face in the plane.
fn above_plane(rng: &mut fastrand::Rng) -> Draft {
    let is_edge = rng.bool();
    let supports = rng.usize(1..=3);
    let mut corners = [(); 2].map(|()| [(); 3].map(|()| integers(rng, 250)));
    for corners in &mut corners {
        for (k, corner) in corners.iter_mut().enumerate() {
            corner.z = if k < supports { 0.0 } else { -corner.z.abs() };
        }
        if is_edge {
            corners[2] = corners[1];
        }
    }
    let radius = [0.0, 1.0 / 64.0, 1.0, 40.0][rng.usize(0..4)];
    // Height minus radius, in tolerances: below, at and above the limits of a true contact (0) and of a contact that
    // may be reported (1). A height below the plane becomes 0.
    let over = [-1.0, 0.0, 0.0, 0.5, 1.0, 1.0 + 1.0 / 16.0, 2.0, 2.0][rng.usize(0..8)];
    let time = f64::from(rng.u32(0..=32)) / 32.0;
    let support = if is_edge { supports.min(2) } else { supports };
    let met = weighted(between(corners, time), weights(rng, support));
    let met = met.with_z((radius + over * TOLERANCE).max(0.0));
    let rising = rng.bool();
    let mut axis = integers(rng, 30) * 8.0;
    axis.z = if rising { axis.z.abs() } else { 0.0 };
    let along = if rising {
        0.0
    } else {
        f64::from(rng.u32(0..=8)) / 8.0
    };
    let motions = [integers(rng, 500), integers(rng, 500)].map(|motion| motion.with_z(0.0));
    let ends = [met - axis * along, met + axis * (1.0 - along)];
    let ends = if is_edge { ends } else { [met; 2] };
    let known = if over <= 0.0 {
        Known::Touches(time)
    } else if over > 1.0 {
        Known::Misses
    } else {
        Known::Nothing
    };
    Draft {
        corners,
        ends: [0, 1].map(|k| ends[k] - motions[k] * time),
        motions,
        radius,
        is_edge,
        known,
    }
}

fn random(rng: &mut fastrand::Rng) -> Draft {
    let is_edge = rng.bool();
    let mut corners = [(); 2].map(|()| [(); 3].map(|()| integers(rng, 100)));
    if is_edge {
        corners = corners.map(|[a, b, _]| [a, b, b]);
    }
    Draft {
        corners,
        ends: [integers(rng, 100), integers(rng, 100)],
        motions: [integers(rng, 200), integers(rng, 200)],
        radius: f64::from(rng.u32(0..20)),
        is_edge,
        known: Known::Nothing,
    }
}
