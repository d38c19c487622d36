use clamber_surface::geometry::MovingCapsule;
use glam::{DVec3, Vec3};
use parry3d::bounding_volume::Aabb;

/// Boxes are enlarged by this fraction of their coordinates, so that the rounding of f32 trees hides nothing.
const LOOSE: f64 = 1e-6;

/// Lengths are cut to this value, whose square is finite in f32.
const ENDLESS: f64 = 1e18;

/// Queries with a coordinate beyond this find nothing, as on skin. Sums of several such values are finite in f32, and
/// products of six in f64.
const FARTHEST: f64 = (1u128 << 100) as f64;

/// True if a position is finite and no coordinate is beyond [`FARTHEST`].
pub(super) fn is_usable(place: DVec3) -> bool {
    // NaN is not less than anything.
    place.abs().cmple(DVec3::splat(FARTHEST)).all()
}

/// True if the radius of a moving capsule is finite, not negative and not beyond [`FARTHEST`].
pub(super) fn is_usable_radius(radius: f64) -> bool {
    (0.0..=FARTHEST).contains(&radius)
}

/// Bounding boxes of a moving capsule at the start and the end of its path. In between, its box lies within their
/// linear interpolation.
#[derive(Clone, Copy, Debug)]
pub struct SweptBounds {
    low: [DVec3; 2],
    high: [DVec3; 2],
}

impl SweptBounds {
    /// Boxes around everything within `distance` of the capsule's segment.
    pub fn new(path: &MovingCapsule, distance: f64) -> Self {
        let (start, end) = (
            box_around(path.start, distance),
            box_around(path.end, distance),
        );
        Self {
            low: [start.0, end.0],
            high: [start.1, end.1],
        }
    }

    /// Box around everything within `radius` of a segment at rest. The radius may be infinite. `None` if an end is not
    /// finite or beyond 2^100, or if the radius is NaN or negative.
    pub fn around(ends: [DVec3; 2], radius: f64) -> Option<Self> {
        Self::is_usable(ends, radius).then(|| {
            let (low, high) = box_around(ends, radius);
            Self {
                low: [low; 2],
                high: [high; 2],
            }
        })
    }

    /// True if [`SweptBounds::around`] returns something.
    pub(super) fn is_usable(ends: [DVec3; 2], radius: f64) -> bool {
        is_usable(ends[0]) && is_usable(ends[1]) && radius >= 0.0
    }

    /// Box around the whole path, rounded outward to f32.
    pub fn bounds(&self) -> Aabb {
        let down = |x: f64| (x as f32).next_down();
        let up = |x: f64| (x as f32).next_up();
        let low = self.low[0].min(self.low[1]).to_array().map(down);
        let high = self.high[0].max(self.high[1]).to_array().map(up);
        Aabb::new(Vec3::from(low), Vec3::from(high))
    }

    /// True if the moving box meets a box at rest by the time `limit`.
    pub fn meets(&self, other: &Aabb, limit: f64) -> bool {
        let (mut from, mut until) = (0.0, limit);
        for axis in 0..3 {
            let low = self.low.map(|low| low[axis]);
            let high = self.high.map(|high| high[axis]);
            let below = f64::from(other.maxs[axis]);
            let above = f64::from(other.mins[axis]);
            narrow(low.map(|low| below - low), &mut from, &mut until);
            narrow(high.map(|high| high - above), &mut from, &mut until);
        }
        from <= until
    }
}

/// Corners of a box around everything within `distance` of a segment.
fn box_around([a, b]: [DVec3; 2], distance: f64) -> (DVec3, DVec3) {
    let (low, high) = (a.min(b), a.max(b));
    let size = low.abs().max(high.abs()).max_element();
    let around = DVec3::splat((distance + (size + distance) * LOOSE).min(ENDLESS));
    (low - around, high + around)
}

/// Narrows an interval of times to where the line from `first` at time 0 to `last` at time 1 is not negative, and
/// slightly beyond.
fn narrow([first, last]: [f64; 2], from: &mut f64, until: &mut f64) {
    if first < 0.0 && last < 0.0 {
        *until = -1.0;
    } else if first < 0.0 {
        *from = from.max(first / (first - last) * (1.0 - LOOSE));
    } else if last < 0.0 {
        *until = until.min(first / (first - last) * (1.0 + LOOSE) + f64::MIN_POSITIVE);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_that_a_sampled_step_meets_are_never_ruled_out() {
        let mut rng = fastrand::Rng::with_seed(41);
        let mut point =
            |size: f64| DVec3::new(rng.f64() - 0.5, rng.f64() - 0.5, rng.f64() - 0.5) * 2.0 * size;
        let (mut met, mut spared) = (0, 0);
        for case in 0..20_000 {
            let start = [point(3.0), point(3.0)];
            let path = MovingCapsule {
                start,
                end: [start[0] + point(4.0), start[1] + point(4.0)],
                radius: 0.3,
            };
            let low = point(3.0);
            let other = Aabb::new(low.as_vec3(), (low + point(1.0).abs()).as_vec3());
            let reach = SweptBounds::new(&path, path.radius);
            let steps = (0..=64).map(|step| path.at(f64::from(step) / 64.0));
            let meets = steps.into_iter().any(|[a, b]| {
                let (low, high) = (a.min(b) - path.radius, a.max(b) + path.radius);
                low.cmple(other.maxs.as_dvec3()).all() && high.cmpge(other.mins.as_dvec3()).all()
            });
            if meets {
                assert!(reach.meets(&other, 1.0), "case {case}: {path:?} {other:?}");
                met += 1;
            }
            spared += u32::from(!reach.meets(&other, 1.0));
        }
        assert!(met > 2_000 && spared > 2_000, "{met} {spared}");
    }
}
