//! Keeps graphs in files, so that each creature's graph is built once.

mod key;
mod sound;

pub(crate) use sound::divides;

use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use clamber_surface::mesh::Rig;
use xxhash_rust::xxh3::xxh3_128;

use crate::{ClimbGraph, GraphConfig, NavigationError, Progress};

/// A graph, and how it was obtained.
#[derive(Debug)]
#[non_exhaustive]
pub struct CachedGraph {
    /// The creature's graph, read or built.
    pub graph: ClimbGraph,
    /// Path of the graph's file in the given folder.
    pub file: PathBuf,
    /// How the graph was obtained.
    pub origin: GraphOrigin,
}

/// How a graph was obtained.
#[derive(Debug)]
#[non_exhaustive]
pub enum GraphOrigin {
    /// The graph was read from its file.
    Read,
    /// The graph was built, and saved in its file.
    Built,
    /// The graph was built, but its file could not be written: the next call builds it again.
    NotSaved(io::Error),
}

impl ClimbGraph {
    /// The graph of a creature, from its file in `folder`. Without a file the graph is built, as by
    /// [`ClimbGraph::build`], and saved there for the next call. The folder is created if it is missing.
    ///
    /// The file's name is a hash of the skin, skeleton, clips, plates, transform and configuration, and of this crate's
    /// version, so a changed creature gets a file of its own. Old files are never removed. If a file is damaged, the
    /// graph is built and saved again. Several programs may use a folder at the same time.
    ///
    /// `progress` is called only by a build. A build takes seconds, so run it on a thread of its own:
    ///
    /// ```no_run
    /// use std::ops::ControlFlow;
    /// use std::sync::Arc;
    /// use std::sync::atomic::{AtomicBool, Ordering};
    ///
    /// use clamber_climber::ClimberConfig;
    /// use clamber_navigation::{ClimbGraph, GraphConfig};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let rig = clamber_gltf::load("colossus.glb")?.rig;
    /// let cancelled = Arc::new(AtomicBool::new(false));
    /// let asked = Arc::clone(&cancelled);
    /// let build = std::thread::spawn(move || {
    ///     let config = GraphConfig::new(ClimberConfig::colossus_climber());
    ///     let folder = "cache/climbing".as_ref();
    ///     ClimbGraph::cached(folder, &rig, &config, |_| {
    ///         if asked.load(Ordering::Relaxed) {
    ///             return ControlFlow::Break(());
    ///         }
    ///         ControlFlow::Continue(())
    ///     })
    /// });
    /// // The game goes on. It asks `build.is_finished()` in each frame, and sets `cancelled` if the player leaves.
    /// cancelled.store(false, Ordering::Relaxed);
    /// let cached = build.join().map_err(|_| "the build panicked")??;
    /// println!("{} patches, {:?}", cached.graph.patches().len(), cached.origin);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// As [`ClimbGraph::build`]. A folder that cannot be written is not an error: see [`GraphOrigin::NotSaved`].
    pub fn cached(
        folder: &Path,
        rig: &Rig,
        config: &GraphConfig,
        progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<CachedGraph, NavigationError> {
        config.check()?;
        let key = key::key(rig, config);
        let file = folder.join(format!("{key:032x}.climbgraph"));
        let known = contents(&file);
        if let Some(graph) = known.and_then(|bytes| read(&bytes, key, rig, config)) {
            return Ok(CachedGraph {
                graph,
                file,
                origin: GraphOrigin::Read,
            });
        }
        let graph = Self::build(rig, config, progress)?;
        let origin = match save(&graph, key, folder, &file) {
            Ok(()) => GraphOrigin::Built,
            Err(error) => GraphOrigin::NotSaved(error),
        };
        Ok(CachedGraph {
            graph,
            file,
            origin,
        })
    }
}

/// The first bytes of a file. The key follows, and a hash of the rest. Change it if this layout changes.
const MAGIC: &[u8; 16] = b"clamber graph 1\n";

/// Largest file of a graph that is read, bytes. The giant's graph has some megabytes; the limit keeps a wrong file from
/// filling the memory.
const LARGEST_FILE: u64 = 1 << 30;

/// The most names that are tried for a file that is being written.
const MOST_PARTS: u32 = 1000;

/// The content of a regular file of at most [`LARGEST_FILE`] bytes; `None` for anything else, such as a device or a
/// pipe.
fn contents(file: &Path) -> Option<Vec<u8>> {
    let about = std::fs::metadata(file).ok()?;
    if !about.is_file() || about.len() > LARGEST_FILE {
        return None;
    }
    let mut bytes = Vec::new();
    let opened = File::open(file).ok()?;
    opened.take(LARGEST_FILE).read_to_end(&mut bytes).ok()?;
    Some(bytes)
}

fn save(graph: &ClimbGraph, key: u128, folder: &Path, file: &Path) -> io::Result<()> {
    let rest = postcard::to_stdvec(graph).map_err(io::Error::other)?;
    let mut bytes = MAGIC.to_vec();
    bytes.extend(key.to_le_bytes());
    bytes.extend(xxh3_128(&rest).to_le_bytes());
    bytes.extend(rest);
    std::fs::create_dir_all(folder)?;
    // Write to a temporary name first, so that no other program reads an incomplete file.
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    // An existing file of this name belongs to another program, or was left by a process that was killed.
    let mut attempt = 0;
    let (half, mut part) = loop {
        let name = format!("{}-{count}-{attempt}.part", std::process::id());
        let half = file.with_extension(name);
        match File::create_new(&half) {
            Ok(part) => break (half, part),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < MOST_PARTS => {
                attempt += 1;
            }
            Err(error) => return Err(error),
        }
    };
    let written = part.write_all(&bytes);
    drop(part);
    let written = written.and_then(|()| std::fs::rename(&half, file));
    if written.is_err() {
        let _ = std::fs::remove_file(&half);
    }
    written
}

/// The graph in a file's content; `None` if the content is damaged or is another creature's graph.
fn read(bytes: &[u8], key: u128, rig: &Rig, config: &GraphConfig) -> Option<ClimbGraph> {
    let rest = bytes.strip_prefix(MAGIC)?;
    let (found, rest) = rest.split_first_chunk::<16>()?;
    let (hash, rest) = rest.split_first_chunk::<16>()?;
    let is_whole = *found == key.to_le_bytes() && *hash == xxh3_128(rest).to_le_bytes();
    if !is_whole {
        return None;
    }
    let graph: ClimbGraph = postcard::from_bytes(rest).ok()?;
    let fits = graph.config == *config && graph.is_sound(rig.collider.triangles().len());
    fits.then_some(graph)
}
