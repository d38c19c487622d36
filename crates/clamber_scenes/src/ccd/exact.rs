//! Points and distances in exact rational arithmetic.

use dashu::rational::Relaxed;
use glam::{DVec3, Vec3};

/// A point or vector.
pub type Exact = [Relaxed; 3];

/// A number, exactly.
///
/// # Panics
/// If it is not finite.
pub fn number(x: f64) -> Relaxed {
    assert!(x.is_finite(), "{x} is no rational number");
    Relaxed::try_from(x).unwrap_or_default()
}

/// A point, exactly.
///
/// # Panics
/// If it is not finite.
pub fn exact(p: Vec3) -> Exact {
    p.to_array().map(|x| number(f64::from(x)))
}

/// The point in f64, each coordinate rounded once.
pub fn rounded(p: &Exact) -> DVec3 {
    let [x, y, z] = p;
    DVec3::new(x.to_f64().value(), y.to_f64().value(), z.to_f64().value())
}

/// `a + b`.
pub fn plus(a: &Exact, b: &Exact) -> Exact {
    zip(a, b, |a, b| a + b)
}

/// `a - b`.
pub fn minus(a: &Exact, b: &Exact) -> Exact {
    zip(a, b, |a, b| a - b)
}

/// The point that is at `a` at time 0 and at `b` at time 1.
pub fn between(a: &Exact, b: &Exact, time: &Relaxed) -> Exact {
    zip(a, b, |a, b| a + (b - a) * time)
}

/// The scalar product.
pub fn dot(a: &Exact, b: &Exact) -> Relaxed {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn zip(a: &Exact, b: &Exact, f: impl Fn(&Relaxed, &Relaxed) -> Relaxed) -> Exact {
    [f(&a[0], &b[0]), f(&a[1], &b[1]), f(&a[2], &b[2])]
}

fn cross(a: &Exact, b: &Exact) -> Exact {
    let part = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [part(1, 2), part(2, 0), part(0, 1)]
}

fn length_sq(a: &Exact) -> Relaxed {
    dot(a, a)
}

fn within_unit(t: &Relaxed) -> bool {
    *t >= Relaxed::ZERO && *t <= Relaxed::ONE
}

/// The squared distance of a point from a segment, which may be a point.
pub fn point_segment_sq(p: &Exact, [a, b]: [&Exact; 2]) -> Relaxed {
    let (along, from) = (minus(b, a), minus(p, a));
    let (share, whole) = (dot(&from, &along), length_sq(&along));
    if share <= Relaxed::ZERO {
        length_sq(&from)
    } else if share >= whole {
        length_sq(&minus(p, b))
    } else {
        length_sq(&from) - &share * &share / whole
    }
}

/// The squared distance of two segments, which may be points.
pub fn segments_sq([a, b]: [&Exact; 2], [c, d]: [&Exact; 2]) -> Relaxed {
    let least = point_segment_sq(a, [c, d])
        .min(point_segment_sq(b, [c, d]))
        .min(point_segment_sq(c, [a, b]))
        .min(point_segment_sq(d, [a, b]));
    let (u, v, apart) = (minus(b, a), minus(d, c), minus(c, a));
    let n = cross(&u, &v);
    let n_sq = length_sq(&n);
    if n_sq == Relaxed::ZERO {
        return least;
    }
    let s = dot(&cross(&apart, &v), &n) / &n_sq;
    let t = dot(&cross(&apart, &u), &n) / &n_sq;
    if within_unit(&s) && within_unit(&t) {
        let along = dot(&apart, &n);
        least.min(&along * &along / n_sq)
    } else {
        least
    }
}

/// The squared distance of a point from a triangle, which may be a segment or a point.
pub fn point_triangle_sq(p: &Exact, corners: &[Exact; 3]) -> Relaxed {
    let [a, b, c] = corners;
    let edges = point_segment_sq(p, [a, b])
        .min(point_segment_sq(p, [b, c]))
        .min(point_segment_sq(p, [c, a]));
    match face_sq(p, corners) {
        Some(face) => face.min(edges),
        None => edges,
    }
}

/// The squared distance of a segment from a triangle; either may have collapsed.
pub fn segment_triangle_sq([p, q]: [&Exact; 2], corners: &[Exact; 3]) -> Relaxed {
    if crosses([p, q], corners) {
        return Relaxed::ZERO;
    }
    let [a, b, c] = corners;
    let edges = segments_sq([a, b], [p, q])
        .min(segments_sq([b, c], [p, q]))
        .min(segments_sq([c, a], [p, q]));
    let ends = [p, q].map(|end| face_sq(end, corners));
    ends.into_iter().flatten().fold(edges, Relaxed::min)
}

/// The squared distance to the foot on the face, if it falls inside.
fn face_sq(p: &Exact, corners: &[Exact; 3]) -> Option<Relaxed> {
    let [a, b, c] = corners;
    let n = cross(&minus(b, a), &minus(c, a));
    let n_sq = length_sq(&n);
    if n_sq == Relaxed::ZERO {
        return None;
    }
    let inside =
        |a: &Exact, b: &Exact| dot(&cross(&minus(b, a), &minus(p, a)), &n) >= Relaxed::ZERO;
    let height = dot(&minus(p, a), &n);
    (inside(a, b) && inside(b, c) && inside(c, a)).then(|| &height * &height / n_sq)
}

/// True if a segment meets the face from one side to the other.
fn crosses([p, q]: [&Exact; 2], corners: &[Exact; 3]) -> bool {
    let [a, b, c] = corners;
    let n = cross(&minus(b, a), &minus(c, a));
    let (from, to) = (dot(&minus(p, a), &n), dot(&minus(q, a), &n));
    let zero = Relaxed::ZERO;
    let one_side = (from > zero && to > zero) || (from < zero && to < zero);
    // What lies in the plane meets the face at an edge or has an end in it.
    if one_side || from == to {
        return false;
    }
    let met = between(p, q, &(&from / (&from - &to)));
    face_sq(&met, corners).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f32, y: f32, z: f32) -> Exact {
        exact(Vec3::new(x, y, z))
    }

    #[test]
    fn distances_that_are_known() {
        let floor = [at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0), at(0.0, 4.0, 0.0)];
        let above = at(1.0, 1.0, 3.0);
        assert_eq!(point_triangle_sq(&above, &floor), number(9.0));
        assert_eq!(point_triangle_sq(&at(4.0, 4.0, 0.0), &floor), number(8.0));
        assert_eq!(
            point_triangle_sq(&at(-3.0, -4.0, 12.0), &floor),
            number(169.0)
        );
        // A face that has collapsed is its edges.
        let line = [at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0), at(2.0, 0.0, 0.0)];
        assert_eq!(point_triangle_sq(&above, &line), number(10.0));
        let through = [&above, &at(1.0, 1.0, -1.0)];
        assert_eq!(segment_triangle_sq(through, &floor), number(0.0));
        assert_eq!(segment_triangle_sq(through, &line), number(1.0));
        let beside = [&above, &at(5.0, 5.0, -1.0)];
        assert!(segment_triangle_sq(beside, &floor) > number(0.0));
        let point = [&above, &above];
        assert_eq!(segment_triangle_sq(point, &floor), number(9.0));
        // In the plane, across an edge and outside.
        let within = [&at(1.0, 1.0, 0.0), &at(9.0, 9.0, 0.0)];
        assert_eq!(segment_triangle_sq(within, &floor), number(0.0));
        let outside = [&at(0.0, -1.0, 0.0), &at(9.0, -1.0, 0.0)];
        assert_eq!(segment_triangle_sq(outside, &floor), number(1.0));
    }

    #[test]
    fn segments_that_are_skew_parallel_or_points() {
        let along = [&at(-1.0, 0.0, 0.0), &at(1.0, 0.0, 0.0)];
        let across = [&at(0.0, -1.0, 2.0), &at(0.0, 1.0, 2.0)];
        assert_eq!(segments_sq(along, across), number(4.0));
        let beside = [&at(0.5, 3.0, 0.0), &at(7.0, 3.0, 0.0)];
        assert_eq!(segments_sq(along, beside), number(9.0));
        let beyond = [&at(4.0, 4.0, 0.0), &at(7.0, 4.0, 0.0)];
        assert_eq!(segments_sq(along, beyond), number(25.0));
        let point = at(0.0, 3.0, 4.0);
        assert_eq!(segments_sq(along, [&point, &point]), number(25.0));
    }
}
