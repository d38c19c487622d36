//! clamber and other ways of answering queries on an animated skin, behind one trait, for benches. Not published.
//!
//! All peers get the same creature, poses and queries. Peers that skin the whole mesh get the same positions, from
//! clamber's fastest kernel.
//!
//! [`all`] lists the peers that are compiled in; the features `bullet`, `embree`, `fcl` and `physx` add libraries in
//! C++. The benches `peers` and `accuracy` compare them. README.md says how to run the benches, and which calls of each
//! library are used.

mod ball;
mod heap;
#[cfg(any(feature = "bullet", feature = "embree", feature = "fcl"))]
mod native;
mod obvhs;
mod ours;
mod parry;
mod peer;
#[cfg(feature = "physx")]
mod physx;
mod plot;
mod push_out;
mod skin;
mod thesis;
mod triangle;

pub use ball::ball;
pub use heap::taken_from_heap;
pub use peer::{Answer, Entry, Kind, Make, Nearest, Peer, RayHit, Unsupported};
pub use plot::Plot;
pub use push_out::mean_push_out;

/// All peers that are compiled in; clamber's come first.
pub fn all() -> Vec<Entry> {
    [
        ours::ENTRIES,
        thesis::ENTRIES,
        parry::ENTRIES,
        obvhs::ENTRIES,
        #[cfg(any(feature = "bullet", feature = "embree", feature = "fcl"))]
        native::ENTRIES,
        #[cfg(feature = "physx")]
        physx::ENTRIES,
    ]
    .concat()
}
