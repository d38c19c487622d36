//! Projection of a point onto the intersection of half-spaces: where a body may go, or how fast, between walls that move.
//!
//! A least-distance problem in three dimensions, solved by a dual active-set method (Goldfarb and Idnani 1983, "A
//! numerically stable dual method for solving strictly convex quadratic programs"). At most three planes support the
//! point. In each pivot the plane that is violated most joins them, and of the at most seven subsets that contain it the
//! one whose point satisfies all four planes is the next basis. Testing every subset needs no sign of a multiplier, so
//! normals that are parallel to rounding do no harm.
//!
//! If the intersection is empty, all planes are relaxed by the same amount, the least that makes it non-empty. Planes that
//! are opposite to within a hundredth of a degree intersect thousands of times as far away as they overlap. Such an
//! intersection is of no use, and counts as empty.

use glam::DVec3;

/// If relaxing all planes by d brings the point nearer by more than this times d, they are relaxed. Opposite planes
/// therefore have to differ by 2e-4 radians to count as a wedge. With a larger value the rounding of f32 normals throws a
/// crushed body hundreds of metres; with a smaller one acute valleys count as closed.
const STEEPEST: f64 = 1e4;

/// By how much planes are relaxed to measure how fast the point follows, as a share of the largest gap and of the distance:
/// a hundred times the tolerance [`HELD`].
const PROBE: f64 = 1e-11;

/// A plane that is violated by no more than this share of the largest gap, or of the distance, counts as satisfied: a
/// hundred roundings of a point on three planes. Times [`STEEPEST`] it stays 1e-9.
const HELD: f64 = 1e-13;

/// After this many pivots [`HELD`] doubles with each: where many planes meet in one point, rounding could make them take
/// turns for ever. Sets of 32 planes take a dozen pivots at most.
const PATIENCE: usize = 64;

/// Doublings of [`HELD`] until everything counts as satisfied.
const DOUBLINGS: usize = 44;

/// Smaller sines are rounding: two such planes cannot both support the point.
const PARALLEL: f64 = 1e-13;

/// Halvings in search of the least relief, which begins at the largest gap and ends at the rounding
/// of it.
const HALVINGS: usize = 50;

/// All points y with `normal . y >= offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Unit length. Planes whose normal is shorter than a half, longer than 2, or not finite are
    /// ignored.
    pub normal: DVec3,
    /// Metres for points, metres a second for velocities.
    pub offset: f64,
}

/// The projection of a point onto half-spaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The nearest point.
    pub point: DVec3,
    /// By how much the worst plane is violated; 0, or rounding, if the intersection is not empty.
    pub missed: f64,
}

/// The point nearest to `target` inside all half-spaces. If their intersection is empty, the point that violates the worst
/// plane least, and of these the nearest.
///
/// Exact to 1e-9 of the largest gap between target and plane, to 1e-9 of the distance, and to the rounding of coordinates.
/// The same bits in whatever order the planes come. Planes that are not finite are ignored.
pub fn project_onto_half_spaces(target: DVec3, planes: &[HalfSpace]) -> Projection {
    let Some(search) = Search::new(target, planes) else {
        return Projection {
            point: target,
            missed: 0.0,
        };
    };
    if let Some(point) = search.sound(0.0) {
        return search.above(point);
    }
    // Relieved of the largest gap, the target itself is above all.
    let (mut low, mut high, mut point) = (0.0, 1.0, DVec3::ZERO);
    for _ in 0..HALVINGS {
        let relief = 0.5 * (low + high);
        match search.sound(relief) {
            Some(found) => (high, point) = (relief, found),
            None => low = relief,
        }
    }
    search.above(point)
}

/// The problem with the target at the origin and the largest gap 1.
struct Search<'a> {
    target: DVec3,
    planes: &'a [HalfSpace],
    /// The largest gap: by how much the target misses the worst plane.
    size: f64,
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
    /// Whether all planes push: their multipliers are positive.
    carries: bool,
    /// How much nearer the point comes for each metre by which the planes are lowered: by duality,
    /// at most the sum of their multipliers over the distance, if they carry.
    steepness: f64,
}

impl<'a> Search<'a> {
    /// None if the target is above all planes.
    fn new(target: DVec3, planes: &'a [HalfSpace]) -> Option<Self> {
        let gaps = planes.iter().filter_map(|plane| gap(plane, target));
        let size = gaps.fold(0.0, f64::max);
        // Below, reciprocals overflow.
        (size > 1e-300).then_some(Self {
            target,
            planes,
            size,
        })
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

    /// The nearest point above all planes lowered by `relief`, if it is within reach.
    fn sound(&self, relief: f64) -> Option<DVec3> {
        let corner = self.nearest(relief)?;
        // In most cases the planes that carry tell at once. Where more than three meet they may not
        // be the only ones; then the distance itself has the last word, unless it is all rounding.
        if corner.carries && corner.steepness <= STEEPEST {
            return Some(corner.point);
        }
        if corner.steepness > STEEPEST * 1e3 {
            return None;
        }
        let distance = corner.point.length();
        let probe = PROBE * (1.0 + distance);
        let nearer = distance - self.nearest(relief + probe)?.point.length();
        (nearer <= STEEPEST * probe).then_some(corner.point)
    }

    /// The nearest point above all planes lowered by `relief`, and what carries it.
    fn nearest(&self, relief: f64) -> Option<Corner> {
        let mut corner = Corner::nowhere();
        let mut held = HELD;
        for pivot in 0..PATIENCE + DOUBLINGS {
            if pivot > PATIENCE {
                held *= 2.0;
            }
            let slack = held * (1.0 + corner.point.length());
            let Some(wall) = self.worst(corner.point, relief, slack) else {
                return Some(corner);
            };
            corner = corner.joined(wall, slack)?;
            if corner.point.length_squared() > STEEPEST * STEEPEST {
                return None;
            }
        }
        None
    }

    /// The plane that a point misses most, if by more than `slack`.
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

/// By how much a point misses a plane; none if the plane is to be ignored.
fn gap(plane: &HalfSpace, point: DVec3) -> Option<f64> {
    let gap = plane.offset - plane.normal.dot(point);
    ((0.25..=4.0).contains(&plane.normal.length_squared()) && gap.is_finite()).then_some(gap)
}

impl Wall {
    fn missed(&self, point: DVec3) -> f64 {
        self.gap - self.normal.dot(point)
    }

    /// An order of walls that are missed alike, by nothing but their values.
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
            carries: true,
            steepness: 0.0,
        }
    }

    fn walls(&self) -> &[Wall] {
        &self.walls[..self.count]
    }

    /// The nearest point above these walls and a new one that the point misses, which therefore is
    /// one of those that carry. None if there is no such point.
    fn joined(&self, wall: Wall, slack: f64) -> Option<Self> {
        let mut best: Option<Self> = None;
        let mut nearest = f64::INFINITY;
        // With none of the old walls, one, two: those that carry are the answer. Rounding may leave
        // none that do; then the nearest is.
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

    fn push(&mut self, wall: Wall) {
        if let Some(free) = self.walls.get_mut(self.count) {
            *free = wall;
            self.count += 1;
        }
    }

    /// Finds the point on all walls. False if two of them are parallel, or three have a direction
    /// in common.
    fn settle(&mut self) -> bool {
        let Some(axes) = axes(self.walls()) else {
            return false;
        };
        let pairs = || self.walls[..self.count].iter().zip(&axes);
        let mut point = DVec3::ZERO;
        // A second round takes out the rounding that the first leaves, magnified, between walls
        // that are nearly parallel.
        for _ in 0..self.count.min(2) {
            for (wall, axis) in pairs() {
                point += *axis * (wall.missed(point) / wall.normal.dot(*axis));
            }
        }
        let (mut rest, mut sum, mut carries) = (point, 0.0, true);
        // The last axis is square to all walls but the last.
        for (wall, axis) in pairs().rev() {
            let multiplier = rest.dot(*axis) / wall.normal.dot(*axis);
            rest -= wall.normal * multiplier;
            sum += multiplier.abs();
            carries &= multiplier >= 0.0;
        }
        self.steepness = sum / point.length();
        (self.point, self.carries) = (point, carries);
        true
    }
}

/// Unit vectors, each square to the normals of all walls before its own, so that a step along it
/// leaves those walls alone. None if one has nothing left.
fn axes(walls: &[Wall]) -> Option<[DVec3; 3]> {
    let mut axes = [DVec3::ZERO; 3];
    for (k, wall) in walls.iter().enumerate().take(3) {
        let (before, rest) = axes.split_at_mut(k);
        let mut axis = wall.normal;
        // Once leaves what rounding adds, which is much of a short remainder.
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
