//! Projection of a point onto the intersection of half-spaces: the positions, or velocities, that moving walls leave to
//! a body.
//!
//! A least-distance problem in three dimensions, solved by a dual active-set method (Goldfarb and Idnani 1983, "A
//! numerically stable dual method for solving strictly convex quadratic programs"). At most three planes support the
//! point. Each pivot adds the plane that is violated most. At most seven subsets of these four planes contain the new
//! one; the subset whose point satisfies all four planes is the next basis. Since every subset is tested, the method
//! does not depend on the signs of the multipliers, and normals that are parallel up to rounding do no harm.
//!
//! If the intersection is empty, or becomes much nearer with a little relief, all planes are relaxed by the same
//! amount, the least that helps. Planes that are opposite to within a hundredth of a degree intersect thousands of
//! times as far away as they overlap. Such an intersection is of no use, and counts as empty. The distance of the
//! nearest point is a convex function of the relief: with more relief, the point comes nearer ever more slowly. So each
//! attempt that fails gives a lower bound on the relief.

use glam::DVec3;

/// If relaxing all planes by d brings the point nearer by more than this times d, they are relaxed. So planes have to
/// be at least 2e-4 radians from opposite to count as a wedge. With a larger value, the rounding of f32 normals throws
/// a crushed body hundreds of metres; with a smaller one, acute valleys count as closed.
const STEEPEST: f64 = 1e4;

/// Relief by which the steepness is measured, as a fraction of the largest gap and of the distance: a hundred times the
/// tolerance [`HELD`].
const PROBE: f64 = 1e-11;

/// A plane that is violated by no more than this fraction of the largest gap, or of the distance, counts as satisfied:
/// a hundred times the rounding of a point on three planes. Times [`STEEPEST`] it is 1e-9.
const HELD: f64 = 1e-13;

/// After this many pivots, [`HELD`] doubles with each pivot: where many planes meet in one point, rounding could
/// otherwise make them alternate endlessly. Sets of 32 planes take a dozen pivots at most.
const PATIENCE: usize = 64;

/// Number of doublings of [`HELD`] until every plane counts as satisfied.
const DOUBLINGS: usize = 44;

/// Sine of the angle below which two planes count as parallel: a smaller sine is rounding, and two planes at such an
/// angle cannot both support the point.
const PARALLEL: f64 = 1e-13;

/// Precision of the point, as a fraction of the largest gap. The least relief is found to this precision divided by the
/// largest steepness.
const NARROW: f64 = 1e-8;

/// First step beyond the estimated least relief, as a fraction of the precision sought.
const FIRST_STEP: f64 = 0.25;

/// Factor by which the step grows each time that it is not enough.
const LONGER: f64 = 8.0;

/// Maximum number of attempts to find the least relief. Three or four are usual; every third attempt halves the
/// interval.
const ATTEMPTS: usize = 150;

/// A plane that a mover stays on one side of: the half-space of all points or velocities y with `normal . y >= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovePlane {
    /// Unit normal that points into the half-space. Planes whose normal is shorter than a half, longer than 2, or not
    /// finite are ignored.
    pub normal: DVec3,
    /// Distance of the plane from the origin along `normal`; may be negative. Metres in a half-space of points, metres
    /// a second in one of velocities.
    pub offset: f64,
}

/// The projection of a point onto half-spaces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Projection {
    /// The point nearest to the target.
    pub point: DVec3,
    /// Violation of the worst plane, in the unit of the offsets; 0, or rounding, if the half-spaces leave room.
    pub missed: f64,
}

/// Projects `target` onto the intersection of half-spaces: the nearest point inside all of them. If the intersection is
/// empty, the result is the point at which the worst plane is violated least; among several such points, the nearest.
/// Planes that leave no room between them and are within 2e-4 radians of opposite count as having no intersection.
///
/// The point is exact to 1e-9 of the largest gap between target and plane, to 1e-9 of the distance, and to the rounding
/// of coordinates. If the intersection is empty, [`Projection::missed`] is exact to 1e-12 of that gap, and the point to
/// 1e-8 of it. The order of the planes does not change any bit of the result. Planes that are not finite are ignored. A
/// target that is not finite is returned as it is, with nothing missed.
pub fn project_onto_half_spaces(target: DVec3, planes: &[MovePlane]) -> Projection {
    project_where_it_pays(target, planes, 0.0, STEEPEST)
}

/// [`project_onto_half_spaces`] with a limit to how far the point moves for a gain of room. Beyond the distance `free`
/// from the target, planes are also relaxed wherever this brings the point nearer by more than `steepest` times the
/// relief. So the point minimises `max(free, |point - target|) + steepest * missed`, changes continuously with the
/// offsets, and is no farther away than `free` and `steepest` times the largest gap together. `steepest` is at least 1.
pub(crate) fn project_where_it_pays(
    target: DVec3,
    planes: &[MovePlane],
    free: f64,
    steepest: f64,
) -> Projection {
    match Search::new(target, planes, free, steepest) {
        Some(search) => search.above(search.least_relieved()),
        None => Projection {
            point: target,
            missed: 0.0,
        },
    }
}

/// The problem, with the target at the origin and scaled so that the largest gap is 1.
struct Search<'a> {
    target: DVec3,
    planes: &'a [MovePlane],
    /// The largest gap: the violation of the worst plane at the target.
    size: f64,
    /// Distance up to which the point may move for any gain of room, in largest gaps.
    free: f64,
    /// Largest steepness beyond `free`.
    steepest: f64,
    /// Largest possible distance of the point, in largest gaps; follows from the two above.
    reach: f64,
}

/// Bounds that follow from a relief that is not enough.
#[derive(Clone, Copy)]
struct TooLittle {
    /// No relief below this is enough.
    least: f64,
    /// Estimated relief above which other planes carry the point: where nearly closed planes cease to carry it.
    turn: f64,
}

/// A plane seen from the target: all x with `normal . x >= gap`.
#[derive(Clone, Copy)]
struct Wall {
    normal: DVec3,
    gap: f64,
}

/// The point nearest to the target on up to three planes.
#[derive(Clone, Copy)]
struct Corner {
    walls: [Wall; 3],
    count: usize,
    point: DVec3,
    /// Multipliers of the planes: the point is the sum of their normals times these.
    pushes: [f64; 3],
    /// True if all planes carry the point: no multiplier is negative.
    carries: bool,
    /// How much nearer the point comes for each unit of relief: by duality, at most the sum of the multipliers over the
    /// distance, if the planes carry.
    steepness: f64,
}

impl<'a> Search<'a> {
    /// `None` if the target is above all planes, to within 1e-300.
    fn new(target: DVec3, planes: &'a [MovePlane], free: f64, steepest: f64) -> Option<Self> {
        let gaps = planes.iter().filter_map(|plane| gap(plane, target));
        let size = gaps.fold(0.0, f64::max);
        // Reciprocals of smaller gaps overflow.
        (size > 1e-300).then_some(Self {
            target,
            planes,
            size,
            free: free / size,
            steepest,
            reach: (free / size + steepest).min(STEEPEST),
        })
    }

    /// The nearest point above all planes with the least relief that helps.
    fn least_relieved(&self) -> DVec3 {
        let mut low = match self.sound(0.0) {
            Ok(point) => return point,
            Err(too_little) => too_little,
        };
        // With the largest gap as relief, the target itself is above all planes.
        let (mut high, mut point) = (1.0, DVec3::ZERO);
        let narrow = NARROW / self.steepest;
        let mut step = FIRST_STEP * narrow;
        for attempt in 1..=ATTEMPTS {
            if high - low.least <= narrow {
                break;
            }
            let halves = attempt % 3 == 0;
            let relief = if halves {
                0.5 * (low.least + high)
            } else {
                low.next(high, step)
            };
            match self.sound(relief) {
                Ok(found) => (high, point) = (relief, found),
                Err(too_little) => {
                    // The lower bound from nearly opposite planes is too low: take a longer step.
                    step *= if too_little.least > relief || halves {
                        1.0
                    } else {
                        LONGER
                    };
                    low = TooLittle {
                        least: too_little.least.max(low.least),
                        ..too_little
                    };
                }
            }
        }
        point
    }

    fn above(&self, point: DVec3) -> Projection {
        let moved = self.target + point * self.size;
        let point = if moved.is_finite() {
            moved
        } else {
            self.target
        };
        let gaps = self.planes.iter().filter_map(|plane| gap(plane, point));
        Projection {
            point,
            missed: gaps.fold(0.0, f64::max),
        }
    }

    /// The nearest point above all planes lowered by `relief`, if it is within reach and more relief does not pay.
    /// Otherwise, a lower bound on the relief.
    fn sound(&self, relief: f64) -> Result<DVec3, TooLittle> {
        let at = |relief: f64| {
            let least = |least| TooLittle { least, turn: least };
            self.nearest(relief).map_err(least)
        };
        let corner = at(relief)?;
        let too_steep = || TooLittle {
            least: relief,
            turn: relief
                + corner
                    .carries_for()
                    .min(corner.lacks_itself(self.free).max(0.0)),
        };
        // In most cases the planes that carry the point decide at once. If the point is on other planes, too, these may
        // carry it at a larger relief. Then the change in distance is measured, unless it is all rounding.
        let distance = corner.point.length();
        let steepest = if distance <= self.free {
            STEEPEST
        } else {
            self.steepest
        };
        if corner.carries && corner.steepness <= steepest {
            return Ok(corner.point);
        }
        let is_known = corner.carries && self.met(corner.point, relief) == corner.count;
        if is_known || corner.steepness > steepest * 1e3 {
            return Err(too_steep());
        }
        let probe = PROBE * (1.0 + distance);
        let nearer = distance - at(relief + probe)?.point.length();
        if nearer <= steepest * probe {
            Ok(corner.point)
        } else {
            Err(too_steep())
        }
    }

    /// The nearest point above all planes lowered by `relief`, and the planes that carry it. `Err` with a lower bound
    /// on the relief if no point is within reach.
    fn nearest(&self, relief: f64) -> Result<Corner, f64> {
        let mut corner = Corner::nowhere();
        let mut held = HELD;
        for pivot in 0..PATIENCE + DOUBLINGS {
            if pivot > PATIENCE {
                held *= 2.0;
            }
            let slack = held * (1.0 + corner.point.length());
            let Some(wall) = self.worst(corner.point, relief, slack) else {
                return Ok(corner);
            };
            corner = match corner.joined(wall, slack) {
                Some(corner) => corner,
                None => return Err(relief + corner.lacks(wall, self.reach).max(0.0)),
            };
            if corner.point.length() > self.reach * (1.0 + HELD) {
                return Err(relief + corner.lacks_itself(self.reach).max(0.0));
            }
        }
        Err(relief)
    }

    /// Number of planes, lowered by `relief`, that a point violates, is on, or is nearly on.
    fn met(&self, point: DVec3, relief: f64) -> usize {
        let near = 100.0 * HELD * (1.0 + point.length());
        let gaps = self.planes.iter().filter_map(|plane| {
            let wall = gap(plane, self.target)? / self.size - relief;
            Some(wall - plane.normal.dot(point))
        });
        gaps.filter(|missed| *missed >= -near).count()
    }

    /// The plane that a point violates most, if by more than `slack`.
    fn worst(&self, point: DVec3, relief: f64, slack: f64) -> Option<Wall> {
        let scale = 1.0 / self.size;
        let mut worst: Option<Wall> = None;
        let mut most = slack;
        for plane in self.planes {
            let Some(gap) = gap(plane, self.target) else {
                continue;
            };
            let wall = Wall {
                normal: plane.normal,
                gap: gap * scale - relief,
            };
            let missed = wall.missed(point);
            if missed > most || missed == most && worst.is_some_and(|worst| wall.precedes(&worst)) {
                (most, worst) = (missed, Some(wall));
            }
        }
        worst
    }
}

impl TooLittle {
    /// The relief to try next, between `least` and `high`: a step above the turn, else a step below it, else a step
    /// below `high`, else the middle.
    fn next(&self, high: f64, step: f64) -> f64 {
        let turn = self.turn.max(self.least);
        let tries = [turn + step, turn - step, high - step];
        let is_between = |relief: &&f64| **relief >= self.least + step && **relief <= high - step;
        let next = tries.iter().find(is_between);
        next.map_or(0.5 * (self.least + high), |relief| *relief)
    }
}

/// The amount by which a point violates a plane, negative inside the half-space; `None` if the plane is ignored.
fn gap(plane: &MovePlane, point: DVec3) -> Option<f64> {
    let gap = plane.offset - plane.normal.dot(point);
    ((0.25..=4.0).contains(&plane.normal.length_squared()) && gap.is_finite()).then_some(gap)
}

impl Wall {
    fn missed(&self, point: DVec3) -> f64 {
        self.gap - self.normal.dot(point)
    }

    /// Orders walls that are violated by the same amount, by their values alone.
    fn precedes(&self, other: &Self) -> bool {
        let key = |wall: &Self| [wall.gap, wall.normal.x, wall.normal.y, wall.normal.z];
        let (own, others) = (key(self), key(other));
        let pairs = own.iter().zip(&others);
        let mut orders = pairs.map(|(a, b)| a.total_cmp(b));
        orders
            .find(|order| order.is_ne())
            .is_some_and(|order| order.is_lt())
    }
}

impl Corner {
    fn nowhere() -> Self {
        Self {
            walls: [Wall {
                normal: DVec3::ZERO,
                gap: 0.0,
            }; 3],
            count: 0,
            point: DVec3::ZERO,
            pushes: [0.0; 3],
            carries: true,
            steepness: 0.0,
        }
    }

    fn walls(&self) -> &[Wall] {
        &self.walls[..self.count]
    }

    /// The nearest point above these walls and a new one that the current point violates. So the new wall is one of the
    /// walls that carry the result. `None` if there is no such point.
    fn joined(&self, wall: Wall, slack: f64) -> Option<Self> {
        let mut best: Option<Self> = None;
        let mut nearest = f64::INFINITY;
        // The new wall is tried with none, one or two of the old ones: the subset that carries is the answer. If
        // rounding leaves no such subset, the nearest point is the answer.
        for kept in [0b000, 0b001, 0b010, 0b100, 0b011, 0b101, 0b110_usize] {
            if kept >> self.count != 0 {
                continue;
            }
            let mut corner = Self::nowhere();
            corner.push(wall);
            for (index, &old) in self.walls().iter().enumerate() {
                if kept >> index & 1 == 1 {
                    corner.push(old);
                }
            }
            if !corner.settle() {
                continue;
            }
            let distance = corner.point.length_squared();
            let above = |wall: &Wall| wall.missed(corner.point) <= slack;
            if (corner.carries || distance < nearest)
                && above(&wall)
                && self.walls().iter().all(above)
            {
                if corner.carries {
                    return Some(corner);
                }
                (nearest, best) = (distance, Some(corner));
            }
        }
        best
    }

    /// The additional relief over which all of these walls carry.
    fn carries_for(&self) -> f64 {
        let mut lowered = *self;
        lowered.walls.iter_mut().for_each(|wall| wall.gap = 1.0);
        if !lowered.settle() {
            return 0.0;
        }
        let pairs = self.pushes.iter().zip(&lowered.pushes).take(self.count);
        let left = pairs
            .filter(|(_, lost)| **lost > 0.0)
            .map(|(push, lost)| push / lost);
        let least = left.fold(f64::INFINITY, f64::min);
        if least.is_finite() {
            least.max(0.0)
        } else {
            0.0
        }
    }

    /// A lower bound on the additional relief that these walls need for a point within reach, from their multipliers.
    /// Their point gives the same bound, but between nearly parallel walls it is mostly rounding.
    fn lacks_itself(&self, reach: f64) -> f64 {
        let (mut sum, mut weights, mut gap) = (DVec3::ZERO, 0.0, 0.0);
        for (wall, push) in self.walls().iter().zip(self.pushes) {
            sum += wall.normal * push;
            weights += push;
            gap += wall.gap * push;
        }
        if self.carries && weights > 0.0 {
            (gap - sum.length() * reach) / weights
        } else {
            0.0
        }
    }

    /// A lower bound on the additional relief that these walls and a new one need for a point within reach. Each
    /// combination of walls with weights of at least zero gives a bound; the largest one counts.
    fn lacks(&self, wall: Wall, reach: f64) -> f64 {
        let mut most = f64::NEG_INFINITY;
        for kept in 0b000..1_usize << self.count {
            let mut others = Self::nowhere();
            for (index, &old) in self.walls().iter().enumerate() {
                if kept >> index & 1 == 1 {
                    others.push(old);
                }
            }
            let Some(axes) = axes(others.walls()) else {
                continue;
            };
            // The weights with which the other walls oppose the new one.
            let (mut sum, mut weights, mut gap) = (wall.normal, 1.0, wall.gap);
            let mut opposes = true;
            for (other, axis) in others.walls().iter().zip(&axes).rev() {
                let weight = -sum.dot(*axis) / other.normal.dot(*axis);
                opposes &= weight >= 0.0;
                sum += other.normal * weight;
                weights += weight;
                gap += other.gap * weight;
            }
            if opposes {
                most = most.max((gap - sum.length() * reach) / weights);
            }
        }
        most
    }

    fn push(&mut self, wall: Wall) {
        if let Some(free) = self.walls.get_mut(self.count) {
            *free = wall;
            self.count += 1;
        }
    }

    /// Finds the point on all walls. False if two of them are parallel, or three are parallel to one line.
    fn settle(&mut self) -> bool {
        let Some(axes) = axes(self.walls()) else {
            return false;
        };
        let pairs = || self.walls[..self.count].iter().zip(&axes);
        let mut point = DVec3::ZERO;
        // A second round removes the rounding of the first, which nearly parallel walls magnify.
        for _ in 0..self.count.min(2) {
            for (wall, axis) in pairs() {
                point += *axis * (wall.missed(point) / wall.normal.dot(*axis));
            }
        }
        let (mut rest, mut sum, mut carries) = (point, 0.0, true);
        let mut pushes = [0.0; 3];
        // The last axis is perpendicular to the normals of all walls but the last.
        for ((wall, axis), push) in pairs().zip(&mut pushes).rev() {
            *push = rest.dot(*axis) / wall.normal.dot(*axis);
            rest -= wall.normal * *push;
            sum += push.abs();
            carries &= *push >= 0.0;
        }
        self.pushes = pushes;
        self.steepness = sum / point.length();
        (self.point, self.carries) = (point, carries);
        true
    }
}

/// Unit vectors, each perpendicular to the normals of all walls before its own, so that a step along it does not change
/// the distance to those walls. `None` if a normal is a combination of the normals before it, up to rounding.
fn axes(walls: &[Wall]) -> Option<[DVec3; 3]> {
    let mut axes = [DVec3::ZERO; 3];
    for (k, wall) in walls.iter().enumerate().take(3) {
        let (before, rest) = axes.split_at_mut(k);
        let mut axis = wall.normal;
        // A second pass, since rounding is a large part of a short remainder.
        for _ in 0..2 {
            for other in before.iter() {
                axis -= *other * other.dot(axis);
            }
        }
        let length = axis.length();
        if length < PARALLEL {
            return None;
        }
        rest[0] = axis / length;
    }
    Some(axes)
}

#[cfg(test)]
mod tests;
