//! Reads typed data from buffers (glTF 2.0, section 3.6), and checks every offset.

use std::cell::Cell;

use gltf::Accessor;
use gltf::accessor::sparse::IndexType;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::View;

use crate::buffers::Buffers;
use crate::{GltfErrorKind, LoadOptions};

/// Bytes of memory that a file may take for each byte of the file and its buffers.
///
/// Real models take up to 3 times their size. A file that makes the loader read the same data many times is refused
/// before memory runs out. Meshes that are shown many times are read once, and [`LoadOptions::max_repeated_vertices`]
/// limits the vertices of their further showings instead. Charges are estimates: a file that is made to take as much
/// memory as it can takes up to 100 times its size, plus [`FREE_GROWTH`], plus 512 bytes for each vertex of that limit
/// (`tests/files/broken.rs`).
const MAX_GROWTH: usize = 24;

/// Bytes of memory that every file may take besides, because small files may rightly grow by a larger factor.
const FREE_GROWTH: usize = 1 << 20;

/// Reads accessors of one file.
pub(crate) struct Reader<'a> {
    buffers: &'a Buffers,
    /// Bytes that may still be decoded.
    budget: Cell<usize>,
    /// [`LoadOptions::max_repeated_vertices`].
    repeats: usize,
    /// Vertices and triangles that repeated showings of meshes have made.
    repeated: Cell<[usize; 2]>,
}

impl<'a> Reader<'a> {
    /// A reader of the buffers of a file that is itself `file` bytes long.
    pub(crate) fn new(buffers: &'a Buffers, file: usize, options: &LoadOptions) -> Self {
        let held = buffers.held().saturating_add(file);
        Self {
            buffers,
            budget: Cell::new(held.saturating_mul(MAX_GROWTH).saturating_add(FREE_GROWTH)),
            repeats: options.max_repeated_vertices,
            repeated: Cell::new([0; 2]),
        }
    }

    /// Counts vertices and triangles that showing `object` once more is about to make; an error if they are more than
    /// the options allow.
    pub(crate) fn repeat(
        &self,
        object: &str,
        vertices: usize,
        triangles: usize,
    ) -> Result<(), GltfErrorKind> {
        let [before, triangles_before] = self.repeated.get();
        let repeated = [
            before.saturating_add(vertices),
            triangles_before.saturating_add(triangles),
        ];
        let limit = self.repeats;
        if repeated[0] > limit || repeated[1] / 2 > limit {
            let object = object.to_owned();
            return Err(GltfErrorKind::TooManyRepeats { object, limit });
        }
        self.repeated.set(repeated);
        Ok(())
    }

    /// Takes bytes that are about to be allocated for `object` from the budget; an error if it is spent.
    pub(crate) fn charge(&self, object: &str, bytes: usize) -> Result<(), GltfErrorKind> {
        let left = self.budget.get().checked_sub(bytes).ok_or_else(|| {
            let reason = "would take far more memory than the size of the file allows";
            GltfErrorKind::invalid(object, reason)
        })?;
        self.budget.set(left);
        Ok(())
    }

    /// Reads elements of `N` numbers as floats. Integers are divided by their range if the accessor is
    /// normalised, and converted unchanged if it is not.
    pub(crate) fn floats<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
    ) -> Result<Vec<[f32; N]>, GltfErrorKind> {
        let data_type = accessor.data_type();
        let normalized = accessor.normalized();
        self.elements(accessor, |bytes| decode_float(bytes, data_type, normalized))
    }

    /// Reads elements of `N` unsigned integers.
    pub(crate) fn integers<const N: usize>(
        &self,
        accessor: &Accessor<'_>,
    ) -> Result<Vec<[u32; N]>, GltfErrorKind> {
        let data_type = accessor.data_type();
        if !matches!(data_type, DataType::U8 | DataType::U16 | DataType::U32) {
            return Err(invalid(
                accessor,
                format!("must hold unsigned integers, not {data_type:?}"),
            ));
        }
        self.elements(accessor, |bytes| decode_integer(bytes, data_type))
    }

    fn elements<T: Copy + Default, const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<[T; N]>, GltfErrorKind> {
        let dimensions = accessor.dimensions();
        if dimensions.multiplicity() != N {
            let reason = format!("has {dimensions:?} elements, but {N} numbers each are needed");
            return Err(invalid(accessor, reason));
        }
        let component = accessor.data_type().size();
        if dimensions == Dimensions::Mat4 && component != 4 {
            return Err(invalid(accessor, "matrices must hold floats".into()));
        }
        let size = component * N;
        // An element that is replaced is decoded twice.
        let sparse = accessor.sparse().map_or(0, |sparse| sparse.count());
        let elements = accessor.count().saturating_add(sparse);
        let decoded = elements.saturating_mul(N * size_of::<T>());
        self.charge(&format!("accessor {}", accessor.index()), decoded)?;
        let element = |bytes: &[u8]| {
            let mut element = [T::default(); N];
            for (value, bytes) in element.iter_mut().zip(bytes.chunks_exact(component)) {
                *value = decode(bytes);
            }
            element
        };
        let mut elements = match accessor.view() {
            Some(view) => {
                let count = accessor.count();
                let strided = self
                    .strided(&view, accessor.offset(), count, size)
                    .map_err(|reason| invalid(accessor, reason))?;
                strided.map(element).collect()
            }
            None => vec![[T::default(); N]; accessor.count()],
        };
        self.apply_sparse(accessor, size, element, &mut elements)?;
        Ok(elements)
    }

    /// Overwrites the elements that a sparse accessor names.
    fn apply_sparse<T: Copy, const N: usize>(
        &self,
        accessor: &Accessor<'_>,
        size: usize,
        element: impl Fn(&[u8]) -> [T; N],
        elements: &mut [[T; N]],
    ) -> Result<(), GltfErrorKind> {
        let Some(sparse) = accessor.sparse() else {
            return Ok(());
        };
        if sparse.count() > accessor.count() {
            let reason = format!(
                "replaces {} of {} elements",
                sparse.count(),
                accessor.count()
            );
            return Err(invalid(accessor, reason));
        }
        let named = sparse.indices();
        let index_type = match named.index_type() {
            IndexType::U8 => DataType::U8,
            IndexType::U16 => DataType::U16,
            IndexType::U32 => DataType::U32,
        };
        let values = sparse.values();
        let broken = |reason| invalid(accessor, format!("sparse data: {reason}"));
        let indices = self
            .strided(
                &named.view(),
                named.offset(),
                sparse.count(),
                index_type.size(),
            )
            .map_err(broken)?;
        let replacements = self
            .strided(&values.view(), values.offset(), sparse.count(), size)
            .map_err(broken)?;
        for (index, bytes) in indices.zip(replacements) {
            let index = decode_integer(index, index_type) as usize;
            let count = elements.len();
            *elements
                .get_mut(index)
                .ok_or_else(|| broken(format!("names element {index} of {count}")))? =
                element(bytes);
        }
        Ok(())
    }

    /// `count` slices of `size` bytes each, one stride apart.
    fn strided(
        &self,
        view: &View<'_>,
        offset: usize,
        count: usize,
        size: usize,
    ) -> Result<impl Iterator<Item = &'a [u8]> + use<'a>, String> {
        let held = self
            .buffers
            .get(view.buffer().index())
            .and_then(|bytes| bytes.get(view.offset()..))
            .and_then(|bytes| bytes.get(..view.length()))
            .ok_or_else(|| format!("buffer view {} reaches beyond its buffer", view.index()))?;
        let stride = view.stride().unwrap_or(size);
        if stride < size {
            return Err(format!(
                "has elements of {size} bytes, but a stride of {stride}"
            ));
        }
        // The last element needs no padding after it.
        let needed = count
            .saturating_sub(1)
            .checked_mul(stride)
            .and_then(|bytes| bytes.checked_add(if count > 0 { size } else { 0 }))
            .ok_or("claims more bytes than can be addressed")?;
        let bytes = held
            .get(offset..)
            .and_then(|bytes| bytes.get(..needed))
            .ok_or_else(|| {
                format!(
                    "needs {needed} bytes from byte {offset} of buffer view {}, which has {}",
                    view.index(),
                    held.len()
                )
            })?;
        Ok((0..count).map(move |k| &bytes[k * stride..k * stride + size]))
    }
}

fn invalid(accessor: &Accessor<'_>, reason: String) -> GltfErrorKind {
    GltfErrorKind::invalid(format!("accessor {}", accessor.index()), reason)
}

/// Decodes a little-endian number; 0 if the slice is too short, which the callers rule out.
fn decode_integer(bytes: &[u8], data_type: DataType) -> u32 {
    match (data_type, bytes) {
        (DataType::U16, &[a, b, ..]) => u32::from(u16::from_le_bytes([a, b])),
        (DataType::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
        (_, &[a, ..]) => u32::from(a),
        (_, &[]) => 0,
    }
}

fn decode_float(bytes: &[u8], data_type: DataType, normalized: bool) -> f32 {
    let (value, range) = match (data_type, bytes) {
        (DataType::I8, &[a, ..]) => (f32::from(i8::from_le_bytes([a])), 127.0),
        (DataType::U8, &[a, ..]) => (f32::from(a), 255.0),
        (DataType::I16, &[a, b, ..]) => (f32::from(i16::from_le_bytes([a, b])), 32_767.0),
        (DataType::U16, &[a, b, ..]) => (f32::from(u16::from_le_bytes([a, b])), 65_535.0),
        (DataType::U32, _) => (decode_integer(bytes, data_type) as f32, u32::MAX as f32),
        (DataType::F32, &[a, b, c, d, ..]) => return f32::from_le_bytes([a, b, c, d]),
        _ => (0.0, 1.0),
    };
    if normalized {
        (value / range).max(-1.0)
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_and_normalised_integers_become_floats() {
        assert_eq!(decode_float(&[255], DataType::U8, true), 1.0);
        assert_eq!(decode_float(&[255], DataType::U8, false), 255.0);
        assert_eq!(decode_float(&[0x80], DataType::I8, true), -1.0);
        assert_eq!(decode_float(&[0x01, 0x80], DataType::I16, true), -1.0);
        assert_eq!(decode_float(&[0xff, 0xff], DataType::U16, true), 1.0);
        let bytes = 1.5f32.to_le_bytes();
        assert_eq!(decode_float(&bytes, DataType::F32, false), 1.5);
        assert_eq!(decode_integer(&[1, 2, 3, 4], DataType::U32), 0x0403_0201);
        assert_eq!(decode_integer(&[1, 2], DataType::U16), 0x0201);
    }
}
