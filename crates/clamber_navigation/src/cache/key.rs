//! What a graph depends on, as a number.

use std::fmt::{self, Write as _};

use xxhash_rust::xxh3::Xxh3;

use crate::{GraphConfig, GraphSource};

/// To be raised when graphs of the same creature change.
const FORMAT: u32 = 6;

/// Takes text.
struct Digest(Xxh3);

impl fmt::Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

/// A hash of everything that a graph depends on, as it is printed for debugging: numbers are printed to their last bit,
/// and no field can be forgotten.
pub(super) fn key(source: &GraphSource<'_>, config: &GraphConfig) -> u128 {
    let GraphSource {
        skeleton,
        mesh,
        clips,
        rate,
        plates,
        weak_points: _,
        world_from_model,
        ground,
    } = source;
    let mut digest = Digest(Xxh3::new());
    let version = env!("CARGO_PKG_VERSION");
    // A digest takes all text.
    let _ = write!(
        digest,
        "{version} {FORMAT} {config:?} {world_from_model:?} {ground:?} "
    );
    let _ = write!(digest, "{skeleton:?} {clips:?} {rate:?} {plates:?} ");
    let _ = write!(digest, "{:?} {:?} ", mesh.triangles(), mesh.tags());
    for (vertex, position) in (0..).zip(mesh.positions()) {
        let vertex = clamber_surface::mesh::VertexId(vertex);
        let _ = write!(digest, "{position:?} {} ", mesh.has_vertex(vertex));
        for influence in mesh.influences(vertex) {
            let _ = write!(digest, "{influence:?}");
        }
    }
    for triangle in 0..mesh.triangles().len() as u32 {
        let part = mesh.part_of(clamber_surface::mesh::TriangleId(triangle));
        let _ = write!(digest, "{part:?}");
    }
    digest.0.digest128()
}
