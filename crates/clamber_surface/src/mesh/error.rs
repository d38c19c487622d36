use thiserror::Error;

use crate::rig::JointId;

/// The reason why a mesh rejects a palette. The call changed nothing.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PaletteError {
    /// The number of matrices differs from the number of joints.
    #[error("the mesh has {expected} joints, but the palette has {found} matrices")]
    JointCount {
        /// Number of joints of the mesh.
        expected: usize,
        /// Number of matrices of the palette.
        found: usize,
    },
    /// A matrix is not finite, or could move a vertex farther than 2^100 from the origin. The vertex may be one
    /// that an edit is adding.
    #[error("matrix {0} of the palette is not finite, or could move a vertex beyond 2^100")]
    Matrix(JointId),
}

/// The reason why a mesh cannot be built or edited. The call changed nothing.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// The influences cannot be assigned to the vertices.
    ///
    /// Without [`influence_ends`](crate::mesh::MeshSource::influence_ends): there are no influences or no vertices,
    /// or the number of influences is neither 1 nor a multiple of the number of vertices. With it: there is not one end
    /// per vertex, the ends are not in ascending order, or the last end is not the number of influences.
    #[error(
        "{influences} influences do not fit {vertices} vertices: every vertex needs the same number, or \
         `influence_ends` needs one end per vertex, in ascending order"
    )]
    InfluenceCount {
        /// Number of influences.
        influences: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// There are tags, but not one per triangle.
    #[error("expected {expected} tags, one per triangle, or none; found {found}")]
    TagCount {
        /// Number of triangles.
        expected: usize,
        /// Number of tags.
        found: usize,
    },
    /// There are rest spaces, but not one per vertex.
    #[error("expected {expected} rest spaces, one per vertex, or none; found {found}")]
    RestSpaceCount {
        /// Number of vertices.
        expected: usize,
        /// Number of rest spaces.
        found: usize,
    },
    /// A position is infinite, NaN, or farther than 2^99 from the origin.
    #[error(
        "the position of vertex {vertex} is not finite, or is farther than 2^99 from the origin"
    )]
    Position {
        /// Index of the vertex in the input, or the id that a vertex to be added would get.
        vertex: usize,
    },
    /// A triangle refers to a vertex that does not exist.
    #[error(
        "triangle {triangle} refers to vertex {vertex}, but there are only {vertices} vertices"
    )]
    VertexOutOfRange {
        /// Index of the triangle in the input.
        triangle: usize,
        /// The vertex that it refers to.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// An influence refers to a joint that does not exist.
    #[error("vertex {vertex} refers to joint {joint}, but there are only {joints} joints")]
    JointOutOfRange {
        /// Index of the vertex in the input, or the id that a vertex to be added would get.
        vertex: usize,
        /// The joint that it refers to.
        joint: JointId,
        /// Number of joints.
        joints: usize,
    },
    /// A weight is negative, infinite or NaN, or no weight of a vertex is positive.
    #[error("the weights of vertex {vertex} cannot be normalised: {weights:?}")]
    Weights {
        /// Index of the vertex in the input, or the id that a vertex to be added would get.
        vertex: usize,
        /// The weights of the vertex as given.
        weights: Vec<f32>,
    },
    /// No triangle is left after degenerate and duplicate ones were dropped.
    #[error("no usable triangle among the {triangles} given")]
    NoTriangles {
        /// Number of triangles given.
        triangles: usize,
    },
    /// There are more vertices, influences, triangles or joints than a mesh can have.
    #[error("{found} {what} are more than a mesh can have: {most}")]
    TooLarge {
        /// Name of the items that are too many, such as `"vertices"`.
        what: &'static str,
        /// Number of these items.
        found: usize,
        /// Largest number of these items that a mesh can have.
        most: usize,
    },
    /// The hierarchy over the clusters is too deep for a query to descend. The hierarchy is balanced, so a mesh
    /// small enough to be numbered is not expected to cause this error.
    #[error(
        "a query of this mesh may need a stack of {needed} nodes; at most {most} are available"
    )]
    TooDeep {
        /// The most nodes and clusters that a query may have to keep on its stack.
        needed: usize,
        /// The size of that stack.
        most: usize,
    },
    /// A triangle to be added has no area at rest.
    #[error("the triangle of vertices {vertices:?} has no area at rest")]
    DegenerateTriangle {
        /// Its vertices.
        vertices: [u32; 3],
    },
}
