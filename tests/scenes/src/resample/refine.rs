//! More vertices: halves the longest edge again and again. Triangles stay well shaped, and the surface at
//! rest stays the same set of points.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use super::{Edge, Pieces, Point, Triangle, edge};

pub(super) fn refine(pieces: &mut Pieces, vertices: usize) {
    let mut sharing: HashMap<Edge, Vec<u32>> = HashMap::new();
    for (index, triangle) in pieces.triangles.iter().enumerate() {
        let [a, b, c] = triangle.corners;
        for edge in [edge(a, b), edge(b, c), edge(c, a)] {
            sharing.entry(edge).or_default().push(index as u32);
        }
    }
    // Longest first, ties by the smaller edge: the hash map's order has no effect.
    let edges = sharing.keys().copied();
    let mut queue: BinaryHeap<(u64, Reverse<Edge>)> = edges
        .map(|edge| (pieces.length(edge), Reverse(edge)))
        .collect();
    while pieces.points.len() < vertices {
        let Some((_, Reverse([a, b]))) = queue.pop() else {
            return;
        };
        let Some(triangles) = sharing.remove(&[a, b]) else {
            continue;
        };
        let middle = pieces.points.len() as u32;
        let point = Point::between(&pieces.points[a as usize], &pieces.points[b as usize]);
        pieces.points.push(point);
        let mut made = vec![edge(a, middle), edge(middle, b)];
        for old in triangles {
            let new = pieces.triangles.len() as u32;
            let Triangle { corners, tag } = pieces.triangles[old as usize];
            // In the triangle's own winding: from `first` through `middle` to `second`.
            let Some(first) = (0..3).find(|k| edge(corners[*k], corners[(k + 1) % 3]) == [a, b])
            else {
                continue;
            };
            let [first, second, apex] = [0, 1, 2].map(|k| corners[(first + k) % 3]);
            pieces.triangles[old as usize].corners = [first, middle, apex];
            let corners = [middle, second, apex];
            pieces.triangles.push(Triangle { corners, tag });
            for triangle in sharing.entry(edge(second, apex)).or_default() {
                if *triangle == old {
                    *triangle = new;
                }
            }
            sharing.entry(edge(first, middle)).or_default().push(old);
            sharing.entry(edge(middle, second)).or_default().push(new);
            sharing.insert(edge(middle, apex), vec![old, new]);
            made.push(edge(middle, apex));
        }
        let made = made.into_iter();
        queue.extend(made.map(|edge| (pieces.length(edge), Reverse(edge))));
    }
}
