//! Pictures, and the numbers in them.

mod common;
mod creatures;
mod overlays;
mod pictures;
mod shadows;
mod skinning;
mod stored;
mod text;
