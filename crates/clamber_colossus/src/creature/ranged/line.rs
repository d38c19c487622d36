//! A ball on a straight path, and its first contact there.

use clamber_surface::geometry::WorldCapsule;
use clamber_surface::surface::TargetMotion;
use glam::DVec3;

use crate::creature::{Person, Surroundings};

/// The straight path of a ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) from: DVec3,
    pub(super) way: DVec3,
    pub(super) radius: f64,
}

impl Line {
    /// Position of the ball's centre after a share of the path.
    pub(super) fn at(&self, share: f64) -> DVec3 {
        self.from + self.way * share
    }

    /// The share of the path after which the ball's centre meets terrain or another creature, and the direction away
    /// from that obstacle.
    ///
    /// The search begins `behind` metres before the start of the path, so that consecutive paths leave no gap.
    pub(super) fn stop(&self, behind: f64, around: &Surroundings<'_>) -> Option<(f64, DVec3)> {
        let length = self.way.length();
        let along = self.way.try_normalize()?;
        let from = self.from - along * behind;
        let all = around.terrain.iter().chain(around.creatures);
        let hits = all.filter_map(|obstacle| obstacle.cast_ray(from, along, length + behind));
        let first = hits.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        let out = first.normal.try_normalize();
        let out = out.filter(|out| out.dot(along) < 0.0).unwrap_or(-along);
        Some((((first.distance - behind) / length).clamp(0.0, 1.0), out))
    }

    /// The same for obstacles that move through a tick while the ball moves along the path.
    pub(super) fn meet(&self, behind: f64, around: &Surroundings<'_>) -> Option<(f64, DVec3)> {
        let length = self.way.length();
        let along = self.way.try_normalize()?;
        let middle = WorldCapsule::ball(self.from - along * behind, 0.0);
        let way = along * (length + behind);
        let all = around.terrain.iter().chain(around.creatures);
        let moving = TargetMotion::Moving;
        let hits = all.filter_map(|obstacle| obstacle.cast_capsule(&middle, [way; 2], moving));
        let first = hits.min_by(|a, b| a.fraction.total_cmp(&b.fraction))?;
        let out = first.separation_normal.try_normalize();
        let out = out.filter(|out| out.dot(along) < 0.0).unwrap_or(-along);
        let share = (first.fraction * (length + behind) - behind) / length;
        Some((share.clamp(0.0, 1.0), out))
    }

    /// The share of the path after which the ball touches a person that does not ride and is not hidden from the ball
    /// by terrain or another creature. It is the first touch, or if the person is hidden there, the point nearest to
    /// the middle of the body.
    pub(super) fn touch(&self, person: &Person, around: &Surroundings<'_>) -> Option<f64> {
        if person.riding.is_some() || !person.body.is_valid() {
            return None;
        }
        let first = first_touch(self.from, self.way, self.radius, &person.body)?;
        let length = self.way.length_squared().max(f64::MIN_POSITIVE);
        let nearest = (person.middle() - self.from).dot(self.way) / length;
        [first, nearest.clamp(first, 1.0)]
            .into_iter()
            .find(|share| self.is_open(self.at(*share), person, around))
    }

    /// True if nothing is between a place and a person's skin, towards the middle of the body.
    fn is_open(&self, from: DVec3, person: &Person, around: &Surroundings<'_>) -> bool {
        let way = person.middle() - from;
        let gap = way.length() - person.body.radius;
        let to_skin = Self {
            from,
            way: way.clamp_length_max(gap.max(0.0)),
            ..*self
        };
        gap <= 0.0 || to_skin.stop(0.0, around).is_none()
    }
}

/// The share of a ball's path after which it first touches a capsule. There, its centre enters a capsule that is
/// thicker by the ball's radius: an infinite cylinder cut off at both ends, and a ball at each end.
fn first_touch(from: DVec3, way: DVec3, radius: f64, body: &WorldCapsule) -> Option<f64> {
    let radius = radius + body.radius;
    let axis = body.ends[1] - body.ends[0];
    let length = axis.length_squared();
    let along = |place: DVec3| {
        if length > 0.0 {
            (place - body.ends[0]).dot(axis) / length
        } else {
            0.0
        }
    };
    let nearest = body.ends[0] + axis * along(from).clamp(0.0, 1.0);
    if from.distance_squared(nearest) <= radius * radius {
        return Some(0.0);
    }
    let balls = body.ends.map(|end| enters(from - end, way, radius));
    let side = (length > 0.0)
        .then(|| {
            let across = |vector: DVec3| vector - axis * (vector.dot(axis) / length);
            enters(across(from - body.ends[0]), across(way), radius)
        })
        .flatten()
        .filter(|share| (0.0..=1.0).contains(&along(from + way * *share)));
    let all = balls.into_iter().chain([side]).flatten();
    let first = all.fold(f64::INFINITY, f64::min);
    (first <= 1.0).then_some(first)
}

/// The share of a path from `from` after which it comes as near to the origin as `radius`; `None` if it never does, or
/// is that near from the start.
fn enters(from: DVec3, way: DVec3, radius: f64) -> Option<f64> {
    let (a, b) = (way.length_squared(), from.dot(way));
    let c = from.length_squared() - radius * radius;
    let root = b * b - a * c;
    // The path goes towards the ball and begins outside it.
    (a > 0.0 && b < 0.0 && c > 0.0 && root >= 0.0).then(|| c / (root.sqrt() - b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_touches_a_body_first_where_a_search_finds_it() {
        let mut random = fastrand::Rng::with_seed(1);
        let mut lot = |size: f64| (random.f64() - 0.5) * 2.0 * size;
        let (mut touched, mut missed, mut inside) = (0, 0, 0);
        for case in 0..20_000 {
            let mut place = |size: f64| DVec3::new(lot(size), lot(size), lot(size));
            let (from, first, aside) = (place(4.0), place(1.0), place(2.0));
            let way = (first - from) * 1.5 + aside;
            let second = match case % 4 {
                0 => first,
                1 => first + way.normalize() * 0.7,
                _ => first + place(1.5),
            };
            let body = WorldCapsule {
                ends: [first, second],
                radius: 0.3,
            };
            let radius = 0.1 + 0.01 * f64::from(case % 90);
            let gap = |share: f64| {
                let place = from + way * share;
                place.distance(body.nearest_on_axis(place)) - 0.3 - radius
            };
            // The distance from a convex body is convex along a line. Ternary search finds its minimum, and bisection
            // the first touch.
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..100 {
                let [a, b] = [(2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0];
                if gap(a) < gap(b) { high = b } else { low = a }
            }
            let least = 0.5 * (low + high);
            let found = first_touch(from, way, radius, &body);
            if gap(0.0) <= 0.0 {
                assert_eq!(found, Some(0.0), "case {case}");
                inside += 1;
            } else if gap(least) < -1e-9 {
                let (mut out, mut within) = (0.0, least);
                for _ in 0..100 {
                    let middle = 0.5 * (out + within);
                    if gap(middle) > 0.0 {
                        out = middle
                    } else {
                        within = middle
                    }
                }
                let found = found.unwrap_or(f64::NAN);
                assert!(
                    (found - within).abs() < 1e-6,
                    "case {case}: {found} {within}"
                );
                touched += 1;
            } else if gap(least) > 1e-9 {
                assert_eq!(found, None, "case {case}");
                missed += 1;
            }
        }
        assert!(
            touched > 2_000 && missed > 2_000 && inside > 100,
            "{touched} {missed} {inside}"
        );
    }
}
