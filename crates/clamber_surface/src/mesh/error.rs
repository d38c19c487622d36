use thiserror::Error;

use crate::rig::JointId;

/// Why a palette does not fit a mesh. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PaletteError {
    /// It has another number of matrices than the mesh has joints.
    #[error("the mesh has {expected} joints, the palette {found} matrices")]
    JointCount {
        /// As the mesh has.
        expected: usize,
        /// As the palette has.
        found: usize,
    },
    /// A matrix is not finite, or could move a vertex, one to be added among them, farther than 2^100
    /// from the origin.
    #[error("matrix {0} of the palette is not finite, or moves vertices beyond 2^100")]
    Matrix(JointId),
}

/// Why a mesh could not be built or edited. Nothing was changed.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// The influences do not divide evenly among the vertices, or there are none. With
    /// [`influence_ends`](crate::mesh::MeshSource::influence_ends): there is not one end per vertex, or the ends do not
    /// ascend to the number of influences.
    #[error(
        "{influences} influences do not fit {vertices} vertices: each needs as many as the others, or \
         `influence_ends` one ascending end for each"
    )]
    InfluenceCount {
        /// Influences found.
        influences: usize,
        /// Vertices found.
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
    /// There are numbers of rest spaces, but not one per vertex.
    #[error("expected {expected} rest spaces, one per vertex, or none; found {found}")]
    RestSpaceCount {
        /// Number of vertices.
        expected: usize,
        /// Number of rest spaces.
        found: usize,
    },
    /// A position is infinite, NaN, or farther than 2^99 from the origin.
    #[error("the position of vertex {vertex} is not finite, or larger than 2^99")]
    Position {
        /// Index of the vertex in the input.
        vertex: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {vertices}")]
    VertexOutOfRange {
        /// Index of the triangle in the input.
        triangle: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// An influence names a joint that does not exist.
    #[error("vertex {vertex} follows joint {joint}, but there are only {joints}")]
    JointOutOfRange {
        /// Index of the vertex in the input.
        vertex: usize,
        /// The joint it names.
        joint: JointId,
        /// How many there are.
        joints: usize,
    },
    /// A weight is negative, infinite or NaN, or all weights of a vertex are zero.
    #[error("the weights of vertex {vertex} cannot be normalised: {weights:?}")]
    Weights {
        /// Index of the vertex in the input.
        vertex: usize,
        /// Its weights.
        weights: Vec<f32>,
    },
    /// No triangle is left after degenerate and duplicate ones were dropped.
    #[error("no usable triangle among the {triangles} given")]
    NoTriangles {
        /// Triangles given.
        triangles: usize,
    },
    /// More vertices, influences or triangles than a u32 can number.
    #[error("{found} {what} are more than a mesh can number (2^32 - 1)")]
    TooLarge {
        /// Which of them.
        what: &'static str,
        /// How many.
        found: usize,
    },
    /// The hierarchy over the triangles is so deep that a query could not descend it. It is balanced, so this is
    /// not met by meshes that can be numbered.
    #[error(
        "a query of this mesh may have {needed} nodes still to visit, {most} at most are possible"
    )]
    TooDeep {
        /// Nodes and clusters that a query may have still to visit.
        needed: usize,
        /// As many as it can have.
        most: usize,
    },
    /// A triangle to be added has no area at rest.
    #[error("a triangle of vertices {vertices:?} has no area at rest")]
    DegenerateTriangle {
        /// The vertices named.
        vertices: [u32; 3],
    },
}
