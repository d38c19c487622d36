//! Divides a triangle into equal parts.

use glam::DVec3;

/// A part of a triangle: its middle, and its share of the area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) barycentric: [f64; 3],
    pub(super) share: f64,
}

/// Number of parts into which each side of a triangle is divided, so that no part is longer than `spacing`.
pub(super) fn parts(corners: &[DVec3; 3], spacing: f64) -> u32 {
    let [a, b, c] = *corners;
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    // More parts would exceed the limit of patches in any case.
    (longest / spacing).ceil().clamp(1.0, 65_536.0) as u32
}

/// The n^2 parts of a triangle whose sides are divided into n parts.
pub(super) fn pieces(n: u32) -> impl Iterator<Item = Piece> {
    let (size, share) = (f64::from(n), 1.0 / (f64::from(n) * f64::from(n)));
    let at = move |x: f64, y: f64| Piece {
        barycentric: [1.0 - (x + y) / size, x / size, y / size],
        share,
    };
    (0..n).flat_map(move |row| {
        (0..n - row).flat_map(move |column| {
            let (x, y) = (f64::from(column), f64::from(row));
            let upright = at(x + 1.0 / 3.0, y + 1.0 / 3.0);
            let inverted = (column + row + 1 < n).then(|| at(x + 2.0 / 3.0, y + 2.0 / 3.0));
            [Some(upright), inverted].into_iter().flatten()
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_cover_the_triangle() {
        for n in [1, 2, 3, 7] {
            let all: Vec<Piece> = pieces(n).collect();
            assert_eq!(all.len(), (n * n) as usize);
            let area: f64 = all.iter().map(|piece| piece.share).sum();
            assert!((area - 1.0).abs() < 1e-12);
            for k in 0..3 {
                let middle: f64 = all.iter().map(|p| p.barycentric[k] * p.share).sum();
                assert!((middle - 1.0 / 3.0).abs() < 1e-12, "corner {k}: {middle}");
            }
            let least = all.iter().flat_map(|p| p.barycentric).fold(1.0, f64::min);
            assert!(least > 0.0);
        }
    }
}
