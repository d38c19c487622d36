//! Triangle meshes of a few faces.

use clamber_surface::geometry::Similarity;
use glam::DVec3;

use super::turned;

/// A mesh in its own space; faces are counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    pub(crate) positions: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// A quadrilateral whose front is the side from which its corners are counter-clockwise.
    pub(crate) fn quad(corners: [DVec3; 4]) -> Self {
        Self {
            positions: corners.to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
        }
    }

    /// A closed box.
    pub(crate) fn boxed(low: DVec3, high: DVec3) -> Self {
        let corner = |k: u32| {
            let pick = |bit: u32, axis: usize| {
                if k & bit == 0 { low[axis] } else { high[axis] }
            };
            DVec3::new(pick(1, 0), pick(2, 1), pick(4, 2))
        };
        let faces: [[u32; 4]; 6] = [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ];
        let triangles = faces
            .iter()
            .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        Self {
            positions: (0..8).map(corner).collect(),
            triangles: triangles.collect(),
        }
    }

    /// A box 1 m thick, whose top is a square around the origin with a half side.
    pub(crate) fn floor(half: f64) -> Self {
        Self::boxed(DVec3::new(-half, -1.0, -half), DVec3::new(half, 0.0, half))
    }

    /// A height field of `count[0]` by `count[1]` quadrilaterals, from `low` in x and z.
    pub(crate) fn field(
        low: DVec3,
        step: f64,
        count: [u32; 2],
        height: impl Fn(f64, f64) -> f64,
    ) -> Self {
        let [columns, rows] = count;
        let mut shape = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                let x = low.x + step * f64::from(column);
                let z = low.z + step * f64::from(row);
                shape.positions.push(DVec3::new(x, low.y + height(x, z), z));
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let a = row * (columns + 1) + column;
                let below = a + columns + 1;
                shape.triangles.push([a, below, below + 1]);
                shape.triangles.push([a, below + 1, a + 1]);
            }
        }
        shape
    }

    /// Stairs that rise along +Z from the origin, with a landing of 5 m at the top and a floor of 5 m in front.
    pub(crate) fn stairs(count: u32, rise: f64, run: f64, half_width: f64) -> Self {
        let flat = |y: f64, from: f64, to: f64| {
            let (left, right) = (-half_width, half_width);
            Self::quad([
                DVec3::new(left, y, from),
                DVec3::new(left, y, to),
                DVec3::new(right, y, to),
                DVec3::new(right, y, from),
            ])
        };
        let riser = |z: f64, low: f64, high: f64| {
            let (left, right) = (-half_width, half_width);
            Self::quad([
                DVec3::new(left, low, z),
                DVec3::new(left, high, z),
                DVec3::new(right, high, z),
                DVec3::new(right, low, z),
            ])
        };
        let mut shape = flat(0.0, -5.0, 0.0);
        for step in 0..count {
            let (low, z) = (rise * f64::from(step), run * f64::from(step));
            let end = if step + 1 == count { z + 5.0 } else { z + run };
            shape = shape.and(riser(z, low, low + rise));
            shape = shape.and(flat(low + rise, z, end));
        }
        shape
    }

    /// The lower half of a cylinder about X through the origin, seen from within, with a cap at both ends.
    pub(crate) fn half_pipe(radius: f64, half_length: f64, segments: u32) -> Self {
        let mut shape = Self::default();
        for side in 0..=segments {
            let angle = core::f64::consts::PI * f64::from(side) / f64::from(segments);
            let (y, z) = (-radius * libm::sin(angle), radius * libm::cos(angle));
            shape.positions.push(DVec3::new(-half_length, y, z));
            shape.positions.push(DVec3::new(half_length, y, z));
        }
        for side in 0..segments {
            let a = 2 * side;
            shape.triangles.push([a, a + 1, a + 3]);
            shape.triangles.push([a, a + 3, a + 2]);
        }
        for x in [-half_length, half_length] {
            let corner = |y: f64, z: f64| DVec3::new(x, y, z);
            let wide = 2.0 * radius;
            let mut cap = Self::quad([
                corner(-wide, -wide),
                corner(-wide, wide),
                corner(wide, wide),
                corner(wide, -wide),
            ]);
            if x < 0.0 {
                cap = cap.flipped();
            }
            shape = shape.and(cap);
        }
        shape
    }

    #[must_use]
    pub(crate) fn and(mut self, other: Self) -> Self {
        let first = self.positions.len() as u32;
        self.positions.extend(other.positions);
        let triangles = other.triangles.into_iter();
        self.triangles
            .extend(triangles.map(|t| t.map(|v| v + first)));
        self
    }

    #[must_use]
    pub(crate) fn moved(self, by: DVec3) -> Self {
        self.placed(&Similarity::from_translation(by))
    }

    #[must_use]
    pub(crate) fn turned(self, axis: DVec3, angle: f64) -> Self {
        self.placed(&turned(axis, angle))
    }

    #[must_use]
    pub(crate) fn placed(mut self, pose: &Similarity) -> Self {
        for position in &mut self.positions {
            *position = pose.transform_point(*position);
        }
        self
    }

    #[must_use]
    pub(crate) fn flipped(mut self) -> Self {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        self
    }

    /// The same surface renumbered: vertices and triangles in another order, and corners of triangles rotated.
    #[must_use]
    pub(crate) fn renumbered(&self, seed: u64) -> Self {
        let mut rng = fastrand::Rng::with_seed(seed);
        let mut order: Vec<u32> = (0..self.positions.len() as u32).collect();
        rng.shuffle(&mut order);
        let mut positions = self.positions.clone();
        for (from, to) in order.iter().enumerate() {
            positions[*to as usize] = self.positions[from];
        }
        let turned = self.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| order[v as usize]);
            [[a, b, c], [b, c, a], [c, a, b]][rng.usize(..3)]
        });
        let mut triangles: Vec<_> = turned.collect();
        rng.shuffle(&mut triangles);
        Self {
            positions,
            triangles,
        }
    }

    /// The same surface with each triangle split into four.
    #[must_use]
    pub(crate) fn split(&self) -> Self {
        let mut shape = Self::default();
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| self.positions[v as usize]);
            let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
            let first = shape.positions.len() as u32;
            shape.positions.extend([a, b, c, ab, bc, ca]);
            let parts = [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]];
            shape.triangles.extend(parts.map(|t| t.map(|v| v + first)));
        }
        shape
    }
}
