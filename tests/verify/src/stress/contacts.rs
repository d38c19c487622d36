//! Checks that casts and sweeps miss no contact, report none late, and report no false one. The motion of the skin is
//! known in f64.

use crate::agreement::{Among, Answers, Cast, Found, Hit, Question, Shape, point_of, weights};
use crate::brute_force::distance;
use glam::DVec3;

use super::posed::Posed;
use super::soups::random_direction;

/// Number of times within a tick at which all triangles are checked.
const TIMES: usize = 6;

/// Number of points of a capsule's segment at which distances are checked.
const ALONG: usize = 5;

/// A moving sphere or capsule in f64, by both ends of its segment, which are equal for a sphere.
#[derive(Clone, Copy, Debug)]
struct Mover {
    start: [DVec3; 2],
    ways: [DVec3; 2],
    radius: f64,
    tolerance: f64,
    /// True if the skin moves, too.
    sweeps: bool,
}

impl Mover {
    fn of(cast: &Cast) -> Self {
        Self {
            start: cast.shape.ends.map(|end| end.as_dvec3()),
            ways: cast.displacements.map(|way| way.as_dvec3()),
            radius: cast.shape.radius.into(),
            tolerance: cast.tolerance.unwrap_or_default(),
            sweeps: cast.moving,
        }
    }

    /// The segment at a time.
    fn at(&self, time: f64) -> [DVec3; 2] {
        [0, 1].map(|k| self.start[k] + self.ways[k] * time)
    }

    /// The point of the segment nearest to `p`, up to rounding.
    fn facing(&self, time: f64, p: DVec3) -> DVec3 {
        let [a, b] = self.at(time);
        let along = (p - a).dot(b - a) / (b - a).length_squared();
        let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
        a + (b - a) * along
    }

    /// Upper bound of the rounding error of a distance in f64, with a margin.
    fn lost(&self, posed: &Posed<'_>) -> f64 {
        let size = self.start[0].length() + self.ways[0].length() + f64::from(posed.farthest);
        1e-12 * (size + self.radius)
    }
}

/// Checks casts and sweeps that aim at known points; returns the number of those that had to touch.
pub(super) fn check(posed: &Posed<'_>, rng: &mut fastrand::Rng, rounds: usize) -> usize {
    let mut checked = 0;
    for round in 0..rounds {
        let triangle = posed.any_triangle(rng);
        let weights = weights(rng);
        let unit = posed.extent;
        let radius = unit * libm::exp10f(-3.0 + 2.0 * rng.f32());
        // The motion starts at a random place nearby, and ends within the radius of a point of the skin.
        let end = point_of(posed.triangles[triangle], weights);
        let within = random_direction(rng).as_vec3() * (radius * 0.9 * rng.f32());
        let way = random_direction(rng).as_vec3() * (unit * rng.f32());
        let center = end + within - way;
        let tolerance = posed.aims(rng).tolerance();
        let cast = Cast {
            shape: Shape::ball(center, radius),
            displacements: [way; 2],
            moving: round % 2 == 0,
            tolerance: Some(tolerance.into()),
        };
        checked += compare(posed, cast, triangle, weights);

        let other = end + random_direction(rng).as_vec3() * (unit * 0.3 * rng.f32());
        let back = random_direction(rng).as_vec3() * (unit * rng.f32());
        let ends = [center, other - back];
        let cast = Cast {
            shape: Shape { ends, radius },
            displacements: [way, back],
            ..cast
        };
        checked += compare(posed, cast, triangle, weights);
    }
    checked
}

/// Asks a question and checks its answer against the known motion; returns 1 if a contact was certain, else 0.
fn compare(posed: &Posed<'_>, cast: Cast, triangle: usize, weights: [f32; 3]) -> usize {
    let mover = &Mover::of(&cast);
    let among = Among::All;
    let question = &Question::CastCapsule { cast, among };
    let mut found = Vec::new();
    posed.surface.in_model().answer(question, &mut found);
    let found = found.first();
    let mut time = f64::INFINITY;
    if let Some(
        contact @ Found::Contact {
            hit, fraction: at, ..
        },
    ) = found
    {
        assert_near(posed, question, mover, hit, *at, contact.is_undecided());
        time = *at;
    }
    let enough = mover.radius - mover.lost(posed);
    let mut known = false;
    let mut at_latest = |at: f64, distance: f64, of: usize| {
        if distance <= enough {
            known = true;
            let name = || posed.name(of);
            assert!(
                time <= at,
                "missed or late: {question:?} touches {} by {at}: {found:?}",
                name()
            );
        }
    };
    // Checks the target point over the whole tick.
    let weights = weights.map(f64::from);
    for step in 0..=64 {
        let at = f64::from(step) / 64.0;
        let [a, b, c] = corners(posed, mover, triangle, at);
        let sum = weights.iter().sum::<f64>();
        let p = (a * weights[0] + b * weights[1] + c * weights[2]) / sum;
        at_latest(at, (mover.facing(at, p) - p).length(), triangle);
    }
    // Checks all triangles at some times.
    for step in 0..TIMES {
        let at = (step as f64 + 0.5) / TIMES as f64;
        if at >= time {
            break;
        }
        let [a, b] = mover.at(at);
        let points = if a == b { 1 } else { ALONG };
        for of in 0..posed.surface.mesh().triangles().len() {
            let corners = corners(posed, mover, of, at);
            for k in 0..points {
                let p = a + (b - a) * (k as f64 / (ALONG - 1) as f64);
                at_latest(at, distance(p, &corners), of);
            }
        }
    }
    usize::from(known)
}

fn corners(posed: &Posed<'_>, mover: &Mover, triangle: usize, at: f64) -> [DVec3; 3] {
    posed.corners_at(triangle, if mover.sweeps { at } else { 1.0 })
}

/// Checks that a reported contact touches within the tolerance, and that its point and distance are right.
fn assert_near(
    posed: &Posed<'_>,
    question: &Question,
    mover: &Mover,
    hit: &Hit,
    time: f64,
    undecided: bool,
) {
    let [a, b, c] = corners(posed, mover, hit.triangle as usize, time);
    let [u, v, w] = hit.barycentric.map(f64::from);
    let point = a * u + b * v + c * w;
    let size = f64::from(posed.farthest);
    let rounded = 1e-6 * ((a - b).length() + (b - c).length() + size);
    let same = (hit.point.as_dvec3() - point).length() <= rounded;
    assert!(same, "{question:?}: {hit:?} is not at {point}");
    let distance = (mover.facing(time, point) - point).length();
    let limit = mover.radius + mover.tolerance + rounded + mover.lost(posed);
    let near = undecided || distance <= limit;
    assert!(near, "{question:?}: {hit:?} is {distance} away");
    let told = (hit.distance - distance).abs() <= rounded + mover.lost(posed);
    assert!(
        told,
        "{question:?}: the distance of {hit:?} is wrong, it is {distance}"
    );
}
