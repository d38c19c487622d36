//! Closed balls made of rings and segments, as plain triangles, smooth or bumpy.

use glam::{DVec3, Vec3};

/// Positions and triangles of a ball with `rings` rings from pole to pole and `segments` segments around +Y.
///
/// `radius` gives the distance from the origin by two angles, radians: from +Y, and around +Y.
pub fn ball(
    rings: u32,
    segments: u32,
    radius: impl Fn(f64, f64) -> f64,
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let half = core::f64::consts::PI;
    let at = |ring: u32, segment: u32| {
        let a = half * f64::from(ring) / f64::from(rings);
        let b = 2.0 * half * f64::from(segment) / f64::from(segments);
        let (across, up) = (libm::sin(a), libm::cos(a));
        let direction = DVec3::new(across * libm::cos(b), up, across * libm::sin(b));
        (direction * radius(a, b)).as_vec3()
    };
    let mut positions = vec![at(0, 0), at(rings, 0)];
    for ring in 1..rings {
        positions.extend((0..segments).map(|segment| at(ring, segment)));
    }
    let vertex = |ring: u32, segment: u32| match ring {
        0 => 0,
        ring if ring == rings => 1,
        ring => 2 + (ring - 1) * segments + segment % segments,
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for segment in 0..segments {
            let [a, b] = [0, 1].map(|k| vertex(ring, segment + k));
            let [c, d] = [0, 1].map(|k| vertex(ring + 1, segment + k));
            if ring > 0 {
                triangles.push([a, b, c]);
            }
            if ring + 1 < rings {
                triangles.push([b, d, c]);
            }
        }
    }
    (positions, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_is_closed_and_faces_outwards() {
        let (positions, triangles) = ball(6, 8, |_, _| 2.0);
        assert_eq!(positions.len(), 2 + 5 * 8);
        assert_eq!(triangles.len(), 2 * 8 * 5);
        let corner = |v: u32| positions[v as usize].as_dvec3();
        let volume: f64 = triangles
            .iter()
            .map(|[a, b, c]| corner(*a).dot(corner(*b).cross(corner(*c))) / 6.0)
            .sum();
        let whole = 4.0 / 3.0 * core::f64::consts::PI * 8.0;
        assert!((0.75 * whole..whole).contains(&volume), "{volume}");
    }
}
