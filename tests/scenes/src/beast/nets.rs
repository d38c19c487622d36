//! Surface nets (Gibson 1998): one vertex per grid cell that the surface crosses, one quad per crossed
//! grid edge. The mesh is closed by construction.

use glam::DVec3;

use super::field::Field;

pub(super) struct Polygons {
    pub(super) positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// The grid of samples.
struct Grid {
    low: DVec3,
    cell: f64,
    size: [usize; 3],
    values: Vec<f64>,
}

impl Grid {
    fn sample(field: &Field<'_>, cell: f64) -> Self {
        let (low, high) = field.bounds();
        let size = ((high - low) / cell)
            .to_array()
            .map(|n| n.ceil() as usize + 2);
        let mut grid = Self {
            low,
            cell,
            size,
            values: Vec::new(),
        };
        grid.values = (0..size[0] * size[1] * size[2])
            .map(|index| field.at(grid.point(grid.place(index))))
            .collect();
        grid
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * self.size[1] + j) * self.size[0] + i
    }

    fn place(&self, index: usize) -> [usize; 3] {
        let rows = index / self.size[0];
        [
            index % self.size[0],
            rows % self.size[1],
            rows / self.size[1],
        ]
    }

    fn point(&self, [i, j, k]: [usize; 3]) -> DVec3 {
        self.low + DVec3::new(i as f64, j as f64, k as f64) * self.cell
    }
}

pub(super) fn polygonise(field: &Field<'_>, cell: f64) -> Polygons {
    let grid = Grid::sample(field, cell);
    let mut positions = Vec::new();
    // The vertex of each cell, indexed by the cell's lowest corner.
    let mut vertex_of = vec![u32::MAX; grid.values.len()];
    for (index, vertex) in vertex_of.iter_mut().enumerate() {
        let place = grid.place(index);
        let inner = (0..3).all(|axis| place[axis] + 1 < grid.size[axis]);
        if let Some(crossing) = inner.then(|| mean_crossing(&grid, place)).flatten() {
            *vertex = positions.len() as u32;
            positions.push(field.onto_skin(crossing, cell));
        }
    }
    let mut triangles = Vec::new();
    for index in 0..grid.values.len() {
        let place = grid.place(index);
        for axis in 0..3 {
            let quad = crossed_edge(&grid, place, axis).map(|cells| cells.map(|c| vertex_of[c]));
            if let Some([a, b, c, d]) = quad {
                // Split along the shorter diagonal, for rounder triangles.
                let length = |v: u32, w: u32| positions[v as usize].distance(positions[w as usize]);
                if length(a, c) <= length(b, d) {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
    }
    Polygons {
        positions,
        triangles,
    }
}

/// The mean of the points where the surface crosses a cell's edges; `None` if it crosses none.
fn mean_crossing(grid: &Grid, place: [usize; 3]) -> Option<DVec3> {
    let corner = |bits: usize| {
        let at = std::array::from_fn(|axis| place[axis] + (bits >> axis & 1));
        (grid.point(at), grid.values[grid.index(at)])
    };
    let mut sum = DVec3::ZERO;
    let mut count = 0.0;
    for from in 0..8usize {
        for axis in 0..3 {
            let to = from | 1 << axis;
            let ((p, a), (q, b)) = (corner(from), corner(to));
            if to != from && (a < 0.0) != (b < 0.0) {
                sum += p.lerp(q, a / (a - b));
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// The four cells around the grid edge from `place` along `axis`, counter-clockwise seen from
/// outside; `None` if the surface does not cross that edge.
fn crossed_edge(grid: &Grid, place: [usize; 3], axis: usize) -> Option<[usize; 4]> {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    if place[axis] + 1 >= grid.size[axis] || place[u] == 0 || place[v] == 0 {
        return None;
    }
    let mut next = place;
    next[axis] += 1;
    let starts_inside = grid.values[grid.index(place)] < 0.0;
    if starts_inside == (grid.values[grid.index(next)] < 0.0) {
        return None;
    }
    let cell = |du: usize, dv: usize| {
        let mut at = place;
        at[u] -= du;
        at[v] -= dv;
        grid.index(at)
    };
    let around = [cell(1, 1), cell(0, 1), cell(0, 0), cell(1, 0)];
    Some(if starts_inside {
        around
    } else {
        let [a, b, c, d] = around;
        [d, c, b, a]
    })
}
