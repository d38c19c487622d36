//! Solids of the scenes: boxes and triangle meshes.

use glam::DVec3;

/// A shape in its own space.
#[derive(Clone, Debug)]
pub enum Solid {
    /// An axis-aligned box.
    Block {
        /// The corner with the smallest coordinates.
        low: DVec3,
        /// The corner with the largest.
        high: DVec3,
    },
    /// Triangles.
    Mesh(Mesh),
}

/// Triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Three vertices each.
    pub triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// An axis-aligned box between its smallest and its largest corner.
    pub fn block(low: [f64; 3], high: [f64; 3]) -> Self {
        let [low, high] = [low, high].map(DVec3::from_array);
        Self::Block { low, high }
    }

    /// A floor, 1 m thick. Its top is a square around the origin, `half` metres to each side.
    pub fn floor(half: f64) -> Self {
        Self::block([-half, -1.0, -half], [half, 0.0, half])
    }

    /// A level field of `columns` by 16 squares of 1 m. It starts at `x` along X, and reaches 8 m to both sides.
    pub fn field(x: f64, columns: u32) -> Self {
        let mut mesh = Mesh::default();
        for row in 0..=16u32 {
            for column in 0..=columns {
                let (x, z) = (x + f64::from(column), f64::from(row) - 8.0);
                mesh.positions.push(DVec3::new(x, 0.0, z));
            }
        }
        for row in 0..16 {
            for column in 0..columns {
                let a = row * (columns + 1) + column;
                let below = a + columns + 1;
                mesh.triangles.push([a, below, below + 1]);
                mesh.triangles.push([a, below + 1, a + 1]);
            }
        }
        Self::Mesh(mesh)
    }

    /// Stairs along +Z, 4 m wide: a floor from z = -5 m to `start`, then `count` treads of 0.3 m, each higher than the
    /// one before by `rise`, which may be negative. The last tread is `last` deep. In metres.
    pub fn stairs(start: f64, count: u32, rise: f64, last: f64) -> Self {
        let mut mesh = Mesh::default();
        mesh.strip(DVec3::new(0.0, 0.0, -5.0), DVec3::Z * start);
        for step in 0..count {
            let before = f64::from(step);
            let foot = DVec3::new(0.0, rise * before, start + 0.3 * before);
            let edge = foot + DVec3::Y * rise;
            let depth = if step + 1 == count { last } else { 0.3 };
            mesh.strip(foot, edge);
            mesh.strip(edge, edge + DVec3::Z * depth);
        }
        Self::Mesh(mesh)
    }

    /// A ramp: level from x = -10 to x = 2, then 30 m up along +X at an angle, radians.
    pub fn ramp(angle: f64) -> Self {
        let end = DVec3::new(2.0 + 30.0 * libm::cos(angle), 30.0 * libm::sin(angle), 0.0);
        let line = [DVec3::X * -10.0, DVec3::X * 2.0, end];
        let positions = line.map(|at| [at.with_z(-5.0), at.with_z(5.0)]);
        Self::Mesh(Mesh {
            positions: positions.concat(),
            triangles: vec![[0, 1, 3], [0, 3, 2], [2, 3, 5], [2, 5, 4]],
        })
    }

    /// The solid as triangles.
    pub fn mesh(&self) -> Mesh {
        match self {
            Self::Block { low, high } => Mesh::block(*low, *high),
            Self::Mesh(mesh) => mesh.clone(),
        }
    }
}

impl Mesh {
    pub(crate) fn block(low: DVec3, high: DVec3) -> Self {
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
        let triangles = faces.map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        Self {
            positions: (0..8).map(corner).collect(),
            triangles: triangles.concat(),
        }
    }

    /// Adds a quadrilateral between two lines along X, 2 m to both sides. It faces up, or towards -Z.
    fn strip(&mut self, from: DVec3, to: DVec3) {
        let first = self.positions.len() as u32;
        let side = DVec3::X * 2.0;
        self.positions
            .extend([from - side, to - side, to + side, from + side]);
        let triangles = [[0, 1, 2], [0, 2, 3]];
        self.triangles
            .extend(triangles.map(|t| t.map(|v: u32| v + first)));
    }
}
