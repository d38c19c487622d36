//! The vertices and triangles of primitives. Each is read once, however often it is shown.

use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::rc::Rc;

use glam::Vec3;
use gltf::Primitive;
use gltf::mesh::Semantic;

use crate::GltfErrorKind;
use crate::accessor::Reader;
use crate::looks::{self, Looks};
use crate::vertices::{self, WeightSet};

/// Vertices and triangles that were read. Each further request for them counts as a repeat.
#[derive(Default)]
pub(crate) struct Readings {
    shapes: RefCell<BTreeMap<Vec<usize>, Rc<Shape>>>,
    triangles: RefCell<BTreeMap<[Option<usize>; 3], Triangles>>,
}

/// Corners of triangles.
type Triangles = Rc<[[u32; 3]]>;

/// The vertices of a primitive, as in the file.
pub(crate) struct Shape {
    /// With morph targets at their weights.
    pub(crate) positions: Vec<Vec3>,
    weights: OnceCell<Vec<WeightSet>>,
    looks: OnceCell<Looks>,
}

impl Readings {
    /// The vertices of a primitive of a mesh with this index, morphed by these weights.
    pub(crate) fn shape(
        &self,
        mesh: usize,
        primitive: &Primitive<'_>,
        morph_weights: &[f32],
        object: &str,
        reader: &Reader<'_>,
    ) -> Result<Rc<Shape>, GltfErrorKind> {
        let mut key = attributes(primitive);
        if primitive.morph_targets().next().is_some() {
            key.extend([MORPHED, mesh, primitive.index()]);
            key.extend(morph_weights.iter().map(|weight| weight.to_bits() as usize));
        }
        if let Some(shape) = self.shapes.borrow().get(&key) {
            reader.repeat(object, shape.positions.len(), 0)?;
            return Ok(shape.clone());
        }
        let shape = Rc::new(Shape {
            positions: vertices::positions(primitive, morph_weights, object, reader)?,
            weights: OnceCell::new(),
            looks: OnceCell::new(),
        });
        self.shapes.borrow_mut().insert(key, shape.clone());
        Ok(shape)
    }

    /// The triangles of a primitive with this number of vertices.
    pub(crate) fn triangles(
        &self,
        primitive: &Primitive<'_>,
        vertices: usize,
        object: &str,
        reader: &Reader<'_>,
    ) -> Result<Triangles, GltfErrorKind> {
        let indices = primitive.indices().map(|accessor| accessor.index());
        let key = [indices, Some(primitive.mode() as usize), Some(vertices)];
        if let Some(triangles) = self.triangles.borrow().get(&key) {
            reader.repeat(object, 0, triangles.len())?;
            return Ok(triangles.clone());
        }
        let triangles: Triangles = vertices::triangles(primitive, vertices, object, reader)?.into();
        self.triangles.borrow_mut().insert(key, triangles.clone());
        Ok(triangles)
    }
}

impl Shape {
    /// The shape's sets of joints and weights. `primitive` must be the one that the shape was read from.
    pub(crate) fn weights(
        &self,
        primitive: &Primitive<'_>,
        object: &str,
        reader: &Reader<'_>,
    ) -> Result<&[WeightSet], GltfErrorKind> {
        let count = self.positions.len();
        once(&self.weights, || {
            vertices::weight_sets(primitive, count, object, reader)
        })
        .map(Vec::as_slice)
    }

    /// The shape's normals, texture coordinates and colours. `primitive` must be the one that the shape was read from.
    pub(crate) fn looks(
        &self,
        primitive: &Primitive<'_>,
        morph_weights: &[f32],
        object: &str,
        reader: &Reader<'_>,
    ) -> Result<&Looks, GltfErrorKind> {
        let count = self.positions.len();
        once(&self.looks, || {
            looks::looks(primitive, count, morph_weights, object, reader)
        })
    }
}

/// The value of a cell. `read` makes it in the first call.
fn once<T>(
    cell: &OnceCell<T>,
    read: impl FnOnce() -> Result<T, GltfErrorKind>,
) -> Result<&T, GltfErrorKind> {
    if let Some(value) = cell.get() {
        return Ok(value);
    }
    let value = read()?;
    Ok(cell.get_or_init(|| value))
}

/// Marks the part of a key that tells morphed vertices apart. [`attributes`] uses the numbers below it.
const MORPHED: usize = 6;

/// Numbers that are equal for primitives whose vertices have the same accessors: three for each attribute that is read.
pub(crate) fn attributes(primitive: &Primitive<'_>) -> Vec<usize> {
    let mut numbers = Vec::new();
    let mut push = |kind: usize, set: u32, accessor: usize| {
        numbers.extend([kind, set as usize, accessor]);
    };
    for (semantic, accessor) in primitive.attributes() {
        match semantic {
            Semantic::Positions => push(0, 0, accessor.index()),
            Semantic::Joints(set) => push(1, set, accessor.index()),
            Semantic::Weights(set) => push(2, set, accessor.index()),
            Semantic::Normals => push(3, 0, accessor.index()),
            Semantic::TexCoords(set) => push(4, set, accessor.index()),
            Semantic::Colors(set) => push(5, set, accessor.index()),
            _ => {}
        }
    }
    numbers
}
