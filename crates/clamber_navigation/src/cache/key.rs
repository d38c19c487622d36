//! The hash of everything that a graph depends on.

use std::fmt::{self, Write as _};

use clamber_surface::mesh::Rig;
use xxhash_rust::xxh3::Xxh3;

use crate::GraphConfig;

/// Version of the graph's content. Raise it when graphs of the same creature change; otherwise old files are read.
const FORMAT: u32 = 8;

/// A hash that takes text.
struct Digest(Xxh3);

impl fmt::Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

/// A hash of everything that a graph depends on, from its debug output, which prints every field, and floats to their
/// last bit.
pub(super) fn key(rig: &Rig, config: &GraphConfig) -> u128 {
    let Rig {
        skeleton,
        clips,
        collider: mesh,
        ..
    } = rig;
    let mut digest = Digest(Xxh3::new());
    let version = env!("CARGO_PKG_VERSION");
    // Writing to a digest never fails.
    let _ = write!(
        digest,
        "{version} {FORMAT} {config:?} {skeleton:?} {clips:?} "
    );
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
