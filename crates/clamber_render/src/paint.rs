use crate::Look;

/// Makes the colours and looks of a mesh's vertices from groups of triangles of one material each, as in model files.
///
/// The last group that uses a vertex sets the vertex's colour and look.
///
/// ```
/// use clamber_render::{Look, RenderMesh, Paint};
/// use glam::Vec3;
///
/// let positions = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
/// let mut paint = Paint::new(positions.len());
/// paint.add(&[[0, 1, 2]], [0.5, 0.4, 0.3], &[], Look::Fur);
/// paint.add(&[[0, 2, 3]], [1.0; 3], &[], Look::Stone);
/// let source = RenderMesh {
///     positions: &positions,
///     colors: &paint.colors,
///     looks: &paint.looks,
///     triangles: &paint.triangles,
///     ..RenderMesh::default()
/// };
/// assert_eq!(source.looks, [Look::Stone, Look::Fur, Look::Stone, Look::Stone]);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Paint {
    /// Linear red, green and blue, one for each vertex; white for vertices without a group.
    pub colors: Vec<[f32; 3]>,
    /// One look for each vertex, set by the last group that uses it; [`Look::Plain`] for vertices without a group.
    pub looks: Vec<Look>,
    /// Triangles of all groups, one group after the other.
    pub triangles: Vec<[u32; 3]>,
}

impl Paint {
    /// Paint for a mesh of `vertices` vertices, without groups.
    pub fn new(vertices: usize) -> Self {
        Self {
            colors: vec![[1.0; 3]; vertices],
            looks: vec![Look::Plain; vertices],
            triangles: Vec::new(),
        }
    }

    /// Adds a group of triangles with one linear colour and one look.
    ///
    /// `own` has the linear colours of the mesh's vertices, which are multiplied by `color`. Their fourth number,
    /// opacity, is not used. Vertices beyond the end of `own` are white. Corners out of range are kept;
    /// [`Renderer::add_mesh`](crate::Renderer::add_mesh) refuses them.
    pub fn add(&mut self, triangles: &[[u32; 3]], color: [f32; 3], own: &[[f32; 4]], look: Look) {
        for corner in triangles.iter().flatten() {
            let vertex = *corner as usize;
            let own = own.get(vertex).copied().unwrap_or([1.0; 4]);
            if let (Some(to), Some(its_look)) =
                (self.colors.get_mut(vertex), self.looks.get_mut(vertex))
            {
                *to = [0, 1, 2].map(|channel| color[channel] * own[channel]);
                *its_look = look;
            }
        }
        self.triangles.extend_from_slice(triangles);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_of_vertices_and_materials_are_multiplied_for_vertices_of_triangles() {
        let mut paint = Paint::new(4);
        let own = [[0.5, 1.0, 0.25, 0.0]; 3];
        paint.add(&[[0, 1, 9]], [1.0, 0.5, 1.0], &own, Look::Fur);
        let expected = [[0.5, 0.5, 0.25], [0.5, 0.5, 0.25], [1.0; 3], [1.0; 3]];
        assert_eq!(paint.colors, expected);
        assert_eq!(paint.looks[1..3], [Look::Fur, Look::Plain]);
        assert_eq!(paint.triangles, [[0, 1, 9]]);
    }
}
