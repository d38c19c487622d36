//! Triangles that share edges, and the connected sets that they form (islands).
//!
//! The three half-edges of every triangle are sorted by edge. Half-edges of the same edge are paired as neighbours,
//! and their triangles are joined into one island by union-find. O(n log n) for n triangles.

use super::{ColliderMesh, IslandId, TriangleId};

/// Neighbours and islands of the triangles that the mesh has now.
#[derive(Clone, Debug, Default)]
pub(super) struct Adjacency {
    /// By triangle: the neighbours across the edges from corner k to the next.
    neighbours: Vec<[Option<TriangleId>; 3]>,
    /// `None` for removed triangles.
    island_of: Vec<Option<IslandId>>,
    islands: usize,
}

impl ColliderMesh {
    /// The triangles across the three edges of a triangle: those from corner 0 to 1, from 1 to 2, and from 2 to 0.
    /// `None` for an edge where the surface ends, and for all edges of a triangle that was removed or never existed.
    ///
    /// Triangles are neighbours if they share two vertices. Vertices that the build kept apart
    /// ([`BuildReport::cracks`](super::BuildReport::cracks)) are not shared, so the surface ends there. Neighbours
    /// are mutual. If more than two triangles share an edge, those that run along it in opposite directions are
    /// paired first, then the remaining ones, both in the order of ascending ids. A triangle that is left over has
    /// no neighbour there.
    ///
    /// The first call after a build or an edit of triangles costs O(n log n) for all n triangles; later calls cost
    /// O(1).
    pub fn neighbours(&self, triangle: TriangleId) -> [Option<TriangleId>; 3] {
        let neighbours = self.adjacency().neighbours.get(triangle.index());
        neighbours.copied().unwrap_or_default()
    }

    /// The island that a triangle belongs to: all triangles that can be reached from it across shared edges. An
    /// edge connects all triangles that share it; a single shared vertex connects none. `None` if the triangle was
    /// removed or never existed. Edits renumber the islands, so an id is only good until the next edit.
    ///
    /// The first call after a build or an edit of triangles costs O(n log n) for all n triangles; later calls cost
    /// O(1).
    pub fn island_of(&self, triangle: TriangleId) -> Option<IslandId> {
        let island_of = self.adjacency().island_of.get(triangle.index());
        island_of.copied().flatten()
    }

    /// The number of islands; their ids are `0..island_count`. Costs the same as [`ColliderMesh::neighbours`].
    pub fn island_count(&self) -> usize {
        self.adjacency().islands
    }

    fn adjacency(&self) -> &Adjacency {
        self.adjacency.get_or(|| Adjacency::new(self))
    }
}

/// One side of a triangle, from `corner` to the next corner.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct HalfEdge {
    /// The two vertices of the side, the smaller one first.
    edge: [u32; 2],
    triangle: u32,
    corner: u8,
    /// True if the side runs from the smaller vertex to the larger.
    ascends: bool,
}

impl Adjacency {
    fn new(mesh: &ColliderMesh) -> Self {
        let mut neighbours = vec![[None; 3]; mesh.triangles.len()];
        let mut forest: Vec<u32> = (0..mesh.triangles.len() as u32).collect();
        let half_edges = half_edges(mesh);
        for around in half_edges.chunk_by(|a, b| a.edge == b.edge) {
            for [a, b] in pairs(around) {
                neighbours[a.triangle as usize][usize::from(a.corner)] =
                    Some(TriangleId(b.triangle));
                neighbours[b.triangle as usize][usize::from(b.corner)] =
                    Some(TriangleId(a.triangle));
            }
            for two in around.windows(2) {
                join(&mut forest, two[0].triangle, two[1].triangle);
            }
        }
        let (island_of, islands) = number_islands(mesh, &mut forest);
        Self {
            neighbours,
            island_of,
            islands,
        }
    }
}

/// The half-edges of all triangles that were not removed, sorted by edge, then by triangle.
fn half_edges(mesh: &ColliderMesh) -> Vec<HalfEdge> {
    let mut found = Vec::with_capacity(3 * mesh.triangles.len());
    for (corners, triangle) in mesh.triangles.iter().zip(0..) {
        if mesh.part_of(TriangleId(triangle)).is_none() {
            continue;
        }
        for corner in 0..3_u8 {
            let from = corners[usize::from(corner)].0;
            let to = corners[usize::from(corner + 1) % 3].0;
            found.push(HalfEdge {
                edge: [from.min(to), from.max(to)],
                triangle,
                corner,
                ascends: from < to,
            });
        }
    }
    found.sort_unstable();
    found
}

/// Pairs the half-edges of one edge: first half-edges of opposite directions, then the remaining ones.
fn pairs(around: &[HalfEdge]) -> impl Iterator<Item = [&HalfEdge; 2]> {
    let that = |ascends| around.iter().filter(move |half| half.ascends == ascends);
    let opposite = that(true).count().min(that(false).count());
    let both = that(true).zip(that(false)).map(|(a, b)| [a, b]);
    // All remaining half-edges run in the same direction.
    let left = move |skip| {
        that(true)
            .skip(opposite)
            .chain(that(false).skip(opposite))
            .skip(skip)
            .step_by(2)
    };
    both.chain(left(0).zip(left(1)).map(|(a, b)| [a, b]))
}

/// The lowest triangle in the union-find tree of a triangle.
fn root(forest: &mut [u32], mut triangle: u32) -> u32 {
    while forest[triangle as usize] != triangle {
        let parent = forest[triangle as usize];
        forest[triangle as usize] = forest[parent as usize];
        triangle = parent;
    }
    triangle
}

fn join(forest: &mut [u32], a: u32, b: u32) {
    let [a, b] = [root(forest, a), root(forest, b)];
    forest[a.max(b) as usize] = a.min(b);
}

/// Numbers the islands by their lowest triangles. Returns the island of each triangle, and the number of islands.
fn number_islands(mesh: &ColliderMesh, forest: &mut [u32]) -> (Vec<Option<IslandId>>, usize) {
    let mut island_of: Vec<Option<IslandId>> = vec![None; forest.len()];
    let mut islands = 0;
    for triangle in 0..forest.len() {
        if mesh.part_of(TriangleId(triangle as u32)).is_none() {
            continue;
        }
        let root = root(forest, triangle as u32) as usize;
        if root == triangle {
            island_of[root] = Some(IslandId(islands));
            islands += 1;
        }
        island_of[triangle] = island_of[root];
    }
    (island_of, islands as usize)
}

#[cfg(test)]
mod tests;
