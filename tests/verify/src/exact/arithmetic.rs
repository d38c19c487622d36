//! Points and distances in exact rational arithmetic.

use dashu_ratio::Relaxed;
use glam::{DVec3, Vec3};

/// A point or vector in rational numbers.
pub type Exact = [Relaxed; 3];

/// Converts a number exactly.
///
/// # Panics
/// If the number is not finite.
pub fn number(x: f64) -> Relaxed {
    assert!(x.is_finite(), "{x} is not finite");
    Relaxed::try_from(x).unwrap_or_default()
}

/// Converts a point exactly.
///
/// # Panics
/// If a coordinate is not finite.
pub fn exact(p: Vec3) -> Exact {
    p.to_array().map(|x| number(f64::from(x)))
}

/// Converts a point to f64, each coordinate rounded once.
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

/// The dot product.
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

/// The squared length of a vector.
pub fn length_sq(a: &Exact) -> Relaxed {
    dot(a, a)
}

fn scaled(a: &Exact, factor: &Relaxed) -> Exact {
    a.each_ref().map(|x| x * factor)
}

fn within_unit(t: &Relaxed) -> bool {
    *t >= Relaxed::ZERO && *t <= Relaxed::ONE
}

/// The shorter one of two vectors; the first one if they are equally long.
fn shorter(a: Exact, b: Exact) -> Exact {
    if length_sq(&b) < length_sq(&a) { b } else { a }
}

/// The vector from the nearest point of a segment, which may be a point, to a point.
fn from_segment(p: &Exact, [a, b]: [&Exact; 2]) -> Exact {
    let (along, from) = (minus(b, a), minus(p, a));
    let (share, whole) = (dot(&from, &along), length_sq(&along));
    if share <= Relaxed::ZERO {
        from
    } else if share >= whole {
        minus(p, b)
    } else {
        minus(&from, &scaled(&along, &(share / whole)))
    }
}

/// The vector between the nearest points of two segments, from the first to the second; each segment may be a point.
fn between_segments([a, b]: [&Exact; 2], [c, d]: [&Exact; 2]) -> Exact {
    let to_ends = shorter(from_segment(c, [a, b]), from_segment(d, [a, b]));
    let from_ends = shorter(from_segment(a, [c, d]), from_segment(b, [c, d]));
    let least = shorter(to_ends, from_ends.map(|x| -x));
    let (u, v, apart) = (minus(b, a), minus(d, c), minus(c, a));
    let n = cross(&u, &v);
    let n_sq = length_sq(&n);
    if n_sq == Relaxed::ZERO {
        return least;
    }
    let s = dot(&cross(&apart, &v), &n) / &n_sq;
    let t = dot(&cross(&apart, &u), &n) / &n_sq;
    if within_unit(&s) && within_unit(&t) {
        shorter(least, scaled(&n, &(dot(&apart, &n) / &n_sq)))
    } else {
        least
    }
}

/// The vector from the nearest point of a triangle, which may be a segment or a point, to a point.
pub fn from_triangle(p: &Exact, corners: &[Exact; 3]) -> Exact {
    let [a, b, c] = corners;
    let edges = shorter(
        shorter(from_segment(p, [a, b]), from_segment(p, [b, c])),
        from_segment(p, [c, a]),
    );
    match from_face(p, corners) {
        Some(face) => shorter(face, edges),
        None => edges,
    }
}

/// The vector from the nearest point of a triangle to the nearest point of a segment; either may have
/// collapsed. Zero if they intersect.
pub fn between_triangle_and_segment(corners: &[Exact; 3], [p, q]: [&Exact; 2]) -> Exact {
    if crosses([p, q], corners) {
        return [Relaxed::ZERO, Relaxed::ZERO, Relaxed::ZERO];
    }
    let [a, b, c] = corners;
    let edges = shorter(
        shorter(
            between_segments([a, b], [p, q]),
            between_segments([b, c], [p, q]),
        ),
        between_segments([c, a], [p, q]),
    );
    let ends = [p, q].map(|end| from_face(end, corners));
    ends.into_iter().flatten().fold(edges, shorter)
}

/// The vector from the projection of a point on the face to the point; `None` if the projection is outside
/// the face, or the face has no area.
fn from_face(p: &Exact, corners: &[Exact; 3]) -> Option<Exact> {
    let [a, b, c] = corners;
    let n = cross(&minus(b, a), &minus(c, a));
    let n_sq = length_sq(&n);
    if n_sq == Relaxed::ZERO {
        return None;
    }
    let inside =
        |a: &Exact, b: &Exact| dot(&cross(&minus(b, a), &minus(p, a)), &n) >= Relaxed::ZERO;
    let height = dot(&minus(p, a), &n);
    (inside(a, b) && inside(b, c) && inside(c, a)).then(|| scaled(&n, &(height / n_sq)))
}

/// True if a segment crosses or touches the face without lying in its plane.
fn crosses([p, q]: [&Exact; 2], corners: &[Exact; 3]) -> bool {
    let [a, b, c] = corners;
    let n = cross(&minus(b, a), &minus(c, a));
    let (from, to) = (dot(&minus(p, a), &n), dot(&minus(q, a), &n));
    let zero = Relaxed::ZERO;
    let one_side = (from > zero && to > zero) || (from < zero && to < zero);
    // A segment in the plane of the face touches the face at an edge, or has an end in it; callers test edges and ends.
    if one_side || from == to {
        return false;
    }
    let met = between(p, q, &(&from / (&from - &to)));
    from_face(&met, corners).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f32, y: f32, z: f32) -> Exact {
        exact(Vec3::new(x, y, z))
    }

    fn point_triangle_sq(p: &Exact, corners: &[Exact; 3]) -> Relaxed {
        let apart = from_triangle(p, corners);
        assert_separates(&apart, corners, [p, p]);
        length_sq(&apart)
    }

    fn segment_triangle_sq(ends: [&Exact; 2], corners: &[Exact; 3]) -> Relaxed {
        let apart = between_triangle_and_segment(corners, ends);
        assert_separates(&apart, corners, ends);
        length_sq(&apart)
    }

    fn segments_sq(of: [&Exact; 2], and: [&Exact; 2]) -> Relaxed {
        let apart = between_segments(of, and);
        let [a, b] = of.map(Clone::clone);
        assert_separates(&apart, &[a, b.clone(), b], and);
        length_sq(&apart)
    }

    /// Asserts that the distance of every corner and end along `apart` is at least the length of `apart`. Then `apart`
    /// is the shortest vector between the shapes.
    fn assert_separates(apart: &Exact, corners: &[Exact; 3], ends: [&Exact; 2]) {
        for (corner, end) in corners.iter().flat_map(|c| ends.map(|end| (c, end))) {
            let gap = dot(apart, &minus(end, corner));
            assert!(gap >= length_sq(apart), "{apart:?} {corners:?} {ends:?}");
        }
    }

    #[test]
    fn known_distances() {
        let floor = [at(0.0, 0.0, 0.0), at(4.0, 0.0, 0.0), at(0.0, 4.0, 0.0)];
        let above = at(1.0, 1.0, 3.0);
        assert_eq!(point_triangle_sq(&above, &floor), number(9.0));
        assert_eq!(point_triangle_sq(&at(4.0, 4.0, 0.0), &floor), number(8.0));
        assert_eq!(
            point_triangle_sq(&at(-3.0, -4.0, 12.0), &floor),
            number(169.0)
        );
        // A collapsed face consists of its edges.
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
    fn skew_and_parallel_segments_and_points() {
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
