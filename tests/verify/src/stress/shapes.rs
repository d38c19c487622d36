//! Closed shapes of plain triangles, in f64, about one unit in size.

use glam::DVec3;

/// Positions and triangles.
pub(super) struct Shape {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// The unit vector at a share of a full turn around +Y.
fn around(share: f64) -> DVec3 {
    let angle = share * core::f64::consts::TAU;
    DVec3::new(libm::cos(angle), 0.0, libm::sin(angle))
}

/// A closed surface of revolution around +Y: a pole, rings of `[height, radius]`, another pole. It faces outwards if
/// the heights ascend.
pub(super) fn revolved(bottom: f64, rings: &[[f64; 2]], top: f64, segments: u32) -> Shape {
    let mut positions = vec![DVec3::Y * bottom, DVec3::Y * top];
    for [height, radius] in rings {
        positions.extend((0..segments).map(|segment| {
            around(f64::from(segment) / f64::from(segments)) * *radius + DVec3::Y * *height
        }));
    }
    let at = |ring: usize, segment: u32| 2 + ring as u32 * segments + segment % segments;
    let last = rings.len() - 1;
    let mut triangles = Vec::new();
    for segment in 0..segments {
        triangles.push([0, at(0, segment), at(0, segment + 1)]);
        triangles.push([1, at(last, segment + 1), at(last, segment)]);
        for ring in 0..last {
            let (a, b) = (at(ring, segment), at(ring, segment + 1));
            let (c, d) = (at(ring + 1, segment), at(ring + 1, segment + 1));
            triangles.extend([[a, c, d], [a, d, b]]);
        }
    }
    Shape {
        positions,
        triangles,
    }
}

/// A ball of diameter 1 with about the given number of triangles.
pub(super) fn ball(triangles: usize) -> Shape {
    let rings = ((triangles as f64 / 4.0).sqrt() as u32).max(2);
    let segments = 2 * rings;
    let at = |ring: u32| {
        let angle = core::f64::consts::PI * f64::from(ring) / f64::from(rings + 1);
        [-0.5 * libm::cos(angle), 0.5 * libm::sin(angle)]
    };
    let all: Vec<_> = (1..=rings).map(at).collect();
    revolved(-0.5, &all, 0.5, segments)
}

/// A tube of length 1 and diameter 0.1 with about the given number of triangles.
pub(super) fn tube(triangles: usize) -> Shape {
    let segments = ((triangles as f64 / 8.0).sqrt() as u32).clamp(3, 1_000);
    let rings = (triangles / (2 * segments as usize)).max(2);
    let height = |ring: usize| (ring + 1) as f64 / (rings + 1) as f64;
    let all: Vec<_> = (0..rings).map(|ring| [height(ring), 0.05]).collect();
    revolved(0.0, &all, 1.0, segments)
}

/// A tube of length 1 and diameter 0.1 whose rings come in pairs, `gap` apart.
pub(super) fn tube_of_pairs(triangles: usize, gap: f64) -> Shape {
    let segments = ((triangles as f64 / 8.0).sqrt() as u32).clamp(3, 1_000);
    let pairs = (triangles / (4 * segments as usize)).max(1);
    let mut all = Vec::new();
    for pair in 0..pairs {
        let height = (pair + 1) as f64 / (pairs + 1) as f64;
        all.extend([[height, 0.05], [height + gap, 0.05]]);
    }
    revolved(0.0, &all, 1.0, segments)
}
