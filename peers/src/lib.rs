//! Other ways of answering queries on an animated skin, beside clamber's: the same creature, the same poses, the same
//! queries, and for all that skin the whole mesh the same positions, from our fastest kernel. Not published.
//!
//! [`all`] lists what is compiled in; the features `bullet`, `embree`, `fcl` and `physx` add libraries in C++. Benches
//! `peers` and `accuracy` hold them against each other; README.md says how to run them and what each peer is asked.

mod heap;
#[cfg(any(feature = "bullet", feature = "embree", feature = "fcl"))]
mod native;
mod obvhs;
mod ours;
mod parry;
mod peer;
#[cfg(feature = "physx")]
mod physx;
mod push_out;
mod skin;
mod thesis;
mod triangle;

pub use heap::taken_from_heap;
pub use peer::{Answer, Entry, Make, Nearest, Peer, RayHit, Unsupported};
pub use push_out::mean_push_out;

/// All peers that are compiled in; ours first.
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
