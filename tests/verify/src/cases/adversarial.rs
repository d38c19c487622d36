//! Cases that are hard for sweeps, at human scale.

use core::f64::consts::TAU;

use glam::{DVec3, Vec3};

use super::Case;
use super::place::{across, direction, point, turned};
use crate::MovingPair;

/// The difficulty of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// No particular difficulty: a random case.
    Random,
    /// The triangle has a height of 1e-7 m.
    Sliver,
    /// The triangle is nearly a line of about a metre, with a height of 1e-20 to 1e-3 m, and the core is close to it.
    Needle,
    /// The core passes a corner, an edge or a face at a distance of about the radius.
    Grazing,
    /// The core slides along a face, at a distance of the radius plus twice the tolerance.
    Slide,
    /// The triangle's corners move in straight lines to their places after a rotation of up to a full turn.
    Spin,
    /// Halfway, the triangle collapses to a line or a point.
    Collapse,
    /// All displacements are denormal numbers.
    Denormal,
    /// Triangle and core have the same motion.
    Still,
    /// A random or grazing case, a kilometre from the origin.
    Far,
    /// Triangle and core overlap at the start.
    Inside,
    /// The radius is 0.
    Thin,
}

/// All kinds of adversarial cases.
pub const KINDS: [Kind; 12] = [
    Kind::Random,
    Kind::Sliver,
    Kind::Needle,
    Kind::Grazing,
    Kind::Slide,
    Kind::Spin,
    Kind::Collapse,
    Kind::Denormal,
    Kind::Still,
    Kind::Far,
    Kind::Inside,
    Kind::Thin,
];

/// A case before it is rounded to f32.
#[derive(Clone, Copy)]
struct Draft {
    corners: [[DVec3; 3]; 2],
    ends: [DVec3; 2],
    motions: [DVec3; 2],
    radius: f64,
    tolerance: f64,
}

/// A random case of a kind, with a sphere or a capsule.
pub fn adversarial(kind: Kind, rng: &mut fastrand::Rng) -> Case {
    let mut draft = random(rng);
    match kind {
        Kind::Random => {}
        Kind::Sliver => sliver(&mut draft, rng),
        Kind::Needle => needle(&mut draft, rng),
        Kind::Grazing => grazing(&mut draft, rng),
        Kind::Slide => return slide(&draft, rng),
        Kind::Spin => spin(&mut draft, rng),
        Kind::Collapse => collapse(&mut draft, rng),
        Kind::Denormal => return denormal(&draft, rng),
        Kind::Still => return still(&draft, rng),
        Kind::Far => {
            if rng.bool() {
                grazing(&mut draft, rng);
            }
            let offset = direction(rng) * 1e3;
            draft.corners = draft.corners.map(|corners| corners.map(|p| p + offset));
            draft.ends = draft.ends.map(|end| end + offset);
        }
        Kind::Inside => {
            // Large enough that rounding cannot remove the overlap.
            draft.radius = draft.radius.max(1e-3);
            let weights = [rng.f64(), rng.f64(), rng.f64()];
            let [a, b, c] = draft.corners[0];
            let inside = a * weights[0] + b * weights[1] + c * weights[2];
            let inside = inside / (weights[0] + weights[1] + weights[2]);
            let within = direction(rng) * (draft.radius * 0.99 * rng.f64());
            draft.ends = draft.ends.map(|end| end - draft.ends[0] + inside + within);
        }
        Kind::Thin => draft.radius = 0.0,
    }
    draft.rounded(rng.bool())
}

impl Draft {
    fn rounded(&self, is_sphere: bool) -> Case {
        Case {
            pair: MovingPair {
                corners: self.corners.map(|corners| corners.map(|p| p.as_vec3())),
                ends: core(self.ends.map(|p| p.as_vec3()), is_sphere),
                motions: core(self.motions.map(|p| p.as_vec3()), is_sphere),
                radius: self.radius as f32,
            },
            tolerance: self.tolerance as f32,
        }
    }
}

/// Ends or motions of a capsule, or those of a sphere, which has the first one twice.
fn core([a, b]: [Vec3; 2], is_sphere: bool) -> [Vec3; 2] {
    [a, if is_sphere { a } else { b }]
}

/// A random draft: the core moves roughly towards the triangle's place at time 1.
fn random(rng: &mut fastrand::Rng) -> Draft {
    let start = [(); 3].map(|()| point(rng));
    let shift = point(rng) * [0.0, 0.1, 2.0][rng.usize(0..3)];
    let own = [0.0, 0.3, 1.0][rng.usize(0..3)];
    let end = start.map(|p| p + shift + point(rng) * own);
    let first = point(rng) * 3.0;
    let ends = [first, first + point(rng)];
    let target = end[0] + (end[1] - end[0]) * rng.f64() + (end[2] - end[0]) * rng.f64();
    let overshoot = [0.0, 0.8, 1.5][rng.usize(0..3)];
    let turn = point(rng) * [0.0, 0.5][rng.usize(0..2)];
    let motion = (target - first) * overshoot;
    Draft {
        corners: [start, end],
        ends,
        motions: [motion, motion + turn],
        radius: [0.001, 0.03, 0.3, 1.0][rng.usize(0..4)] * rng.f64(),
        tolerance: [0.0, 1e-6, 1e-4, 1e-4, 1e-2][rng.usize(0..5)],
    }
}

fn sliver(draft: &mut Draft, rng: &mut fastrand::Rng) {
    for corners in &mut draft.corners {
        let [a, b, _] = *corners;
        corners[2] = a + (b - a) * rng.f64() + across(rng, (b - a).normalize()) * 1e-7;
    }
    if rng.bool() {
        let (axis, angle) = (direction(rng), rng.f64() * TAU);
        draft.corners[1] = draft.corners[0].map(|p| turned(p, axis, angle));
    }
}

/// A random length between two powers of ten, given by their exponents.
fn between_powers(rng: &mut fastrand::Rng, low: f64, high: f64) -> f64 {
    libm::exp10(low + (high - low) * rng.f64())
}

/// Makes the triangle a needle. Often it has a corner at the origin and lies along an axis or in a coordinate plane,
/// where f32 can hold such small heights.
fn needle(draft: &mut Draft, rng: &mut fastrand::Rng) {
    let long = point(rng) * [DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::ONE][rng.usize(0..3)];
    let base = [DVec3::ZERO, point(rng)][rng.usize(0..2)];
    let share = rng.f64() * 1.2 - 0.1;
    let mut corners = |at: DVec3, share: f64| {
        let aside = point(rng) * between_powers(rng, -20.0, -3.0);
        [at, at + long, at + long * share + aside]
    };
    let start = corners(base, share);
    let later = corners(base, share);
    let shift = point(rng);
    let end = match rng.usize(0..4) {
        0 => later.map(|p| p + shift * between_powers(rng, -7.0, 0.0)),
        // A quarter of a turn.
        1 => later.map(|p| DVec3::new(p.y, -p.x, p.z) + shift * 0.1),
        2 => [start[1], start[0], later[2]],
        _ => start.map(|p| p + shift),
    };
    let gap = between_powers(rng, -9.0, 0.0);
    let near = start[0] + long * rng.f64() + point(rng) * gap;
    let along = end[1] - end[0];
    let target = end[0] + along * rng.f64() + point(rng) * between_powers(rng, -9.0, 0.0);
    draft.corners = [start, end];
    draft.ends = [near, near + point(rng) * [1.0, 1e-6][rng.usize(0..2)]];
    draft.motions = [target - near; 2];
    draft.radius = [0.0, gap * 0.1 * rng.f64(), gap * rng.f64(), 1e-3][rng.usize(0..4)];
    draft.tolerance = [0.0, 1e-9, 1e-6, 1e-4][rng.usize(0..4)];
}

/// Moves the core so that it grazes the triangle: at some time, the core is at about the radius from a point of the
/// triangle, and the whole triangle is on the other side of the plane through that point.
fn grazing(draft: &mut Draft, rng: &mut fastrand::Rng) {
    let n = direction(rng);
    let top = draft.corners[0][0];
    let supports = rng.usize(1..=3);
    for corners in &mut draft.corners {
        let lift = corners[0] - top;
        for (k, corner) in corners.iter_mut().enumerate() {
            // Corners that support the core stay in a plane, the others stay below it.
            let height = n.dot(*corner - top - lift);
            let below = if k < supports { 0.0 } else { -height.abs() };
            *corner += n * (below - height);
        }
    }
    let time = rng.f64();
    let [start, end] = draft.corners;
    let (b, c) = match supports {
        1 => (0.0, 0.0),
        2 => (rng.f64(), 0.0),
        _ => (rng.f64() * 0.5, rng.f64() * 0.5),
    };
    let met = |[x, y, z]: [DVec3; 3]| x + (y - x) * b + (z - x) * c;
    let passing = across(rng, n) * rng.f64() * 4.0;
    let motion = met(end) - met(start) + passing;
    let off = [0.0, 1e-9, -1e-9, 1e-7, -1e-7, 1e-5, -1e-3][rng.usize(0..7)];
    let tolerances = [0.0, 0.0, 0.5, 1.0, 1.001, 2.0][rng.usize(0..6)];
    let gap = draft.radius + off + draft.tolerance * tolerances;
    let at = met(start) + (met(end) - met(start)) * time + n * gap;
    let axis = across(rng, n) + n * [0.0, 0.0, rng.f64()][rng.usize(0..3)];
    draft.ends = [at - motion * time, at - motion * time + axis];
    draft.motions = [motion; 2];
}

/// A core that slides along the triangle's face. The triangle is parallel to a coordinate plane, so that rounding does
/// not tilt it.
fn slide(draft: &Draft, rng: &mut fastrand::Rng) -> Case {
    let tolerance = [1e-4, 1e-3, 1e-6][rng.usize(0..3)];
    let mut case = draft.rounded(rng.bool());
    case.tolerance = tolerance;
    let axis = rng.usize(0..3);
    let gap = case.pair.radius + 2.0 * tolerance;
    let (level, travel) = ([0.0, rng.f32()][rng.usize(0..2)], rng.f32());
    for corner in case.pair.corners[0].iter_mut() {
        corner[axis] = level;
    }
    for corner in case.pair.corners[1].iter_mut() {
        corner[axis] = level + travel;
    }
    for (end, motion) in case.pair.ends.iter_mut().zip(&mut case.pair.motions) {
        end[axis] = level + gap;
        motion[axis] = travel;
    }
    case
}

fn spin(draft: &mut Draft, rng: &mut fastrand::Rng) {
    let (axis, angle) = (direction(rng), rng.f64() * TAU);
    let hub = point(rng) * [0.0, 0.5, 2.0][rng.usize(0..3)];
    let shift = point(rng) * [0.0, 0.5][rng.usize(0..2)];
    let [start, end] = &mut draft.corners;
    *end = start.map(|p| hub + shift + turned(p - hub, axis, angle));
    if rng.bool() {
        let ends = draft.ends;
        let angle = rng.f64() * TAU;
        draft.motions = ends.map(|p| turned(p - hub, axis, angle) - (p - hub));
    }
    if rng.bool() {
        // Near the hub, which the triangle passes.
        draft.ends = draft
            .ends
            .map(|p| p - draft.ends[0] + hub + point(rng) * 0.3);
    }
}

fn collapse(draft: &mut Draft, rng: &mut fastrand::Rng) {
    let start = draft.corners[0];
    let center = point(rng);
    let line = direction(rng);
    let onto_line = rng.bool();
    let middle = start.map(|p| {
        let along = if onto_line { line.dot(p - center) } else { 0.0 };
        center + line * along
    });
    for ((end, p), m) in draft.corners[1].iter_mut().zip(start).zip(middle) {
        *end = m * 2.0 - p;
    }
    if rng.bool() {
        // The core is near the centre when the triangle collapses.
        let at = center + point(rng) * draft.radius;
        let apart = draft.ends[1] - draft.ends[0];
        draft.ends = [
            at - draft.motions[0] * 0.5,
            at - draft.motions[0] * 0.5 + apart,
        ];
    }
}

/// Triangle and core are side by side, a few f32 steps apart, with denormal displacements.
fn denormal(draft: &Draft, rng: &mut fastrand::Rng) -> Case {
    let is_sphere = rng.bool();
    let mut case = draft.rounded(is_sphere);
    let size = [1.0, 1.0, 1e-20, 1e-38][rng.usize(0..4)];
    let corners = case.pair.corners[0].map(|p| p * size);
    // Near the origin a denormal displacement moves a corner; elsewhere it is lost to rounding.
    let later = corners.map(|p| p + slow(rng));
    case.pair.corners = [corners, later];
    case.pair.radius *= size;
    let axis = rng.usize(0..3);
    let top = corners
        .map(|p| p[axis])
        .into_iter()
        .fold(f32::MIN, f32::max);
    let mut ends = [corners[0], corners[0] + point(rng).as_vec3() * size];
    for end in &mut ends {
        end[axis] = top + case.pair.radius;
        for _ in 0..rng.usize(0..4) {
            end[axis] = end[axis].next_up();
        }
    }
    case.pair.ends = core(ends, is_sphere);
    case.pair.motions = core([slow(rng), slow(rng)], is_sphere);
    case
}

/// A vector of denormal coordinates, down to the smallest number.
fn slow(rng: &mut fastrand::Rng) -> Vec3 {
    let mut part = || {
        let places = rng.u32(1..=23);
        let size = f32::from_bits(rng.u32(0..1 << places));
        if rng.bool() { size } else { -size }
    };
    Vec3::new(part(), part(), part())
}

/// All coordinates are multiples of 2^-10, so that all points move by exactly the same vector.
fn still(draft: &Draft, rng: &mut fastrand::Rng) -> Case {
    let coarse = |p: DVec3| ((p * 1024.0).round() / 1024.0).as_vec3();
    let shift = coarse(point(rng) * [0.0, 1.0, 8.0][rng.usize(0..3)]);
    let corners = draft.corners[0].map(coarse);
    let near = draft.corners[0][0] + direction(rng) * (draft.radius + draft.tolerance * 2.0);
    let first = coarse([near, draft.ends[0]][rng.usize(0..2)]);
    let ends = [first, first + coarse(draft.ends[1] - draft.ends[0])];
    let is_sphere = rng.bool();
    let mut case = draft.rounded(is_sphere);
    case.pair.corners = [corners, corners.map(|p| p + shift)];
    case.pair.ends = core(ends, is_sphere);
    case.pair.motions = [shift; 2];
    case
}
