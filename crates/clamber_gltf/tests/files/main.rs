//! Tests with small files made in code: how they load, and how broken files are refused.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod broken;
mod buffers;
mod builder;
mod creatures;
mod errors;
mod height;
#[cfg(unix)]
mod links;
mod meshes;
mod repeated;
mod resolver;
mod scenes;
mod tags;
mod unread;
mod weights;
