//! Helpers that tests of pictures share.

#![allow(clippy::panic, reason = "a test's helpers may fail like the test")]

use std::io::Write;

use clamber_render::{Gpu, RenderError};

/// Opens a device; `None`, with a message, if there is no device and none is required.
///
/// With `CLAMBER_REQUIRE_GPU` set, a missing device is a failure.
pub(crate) fn gpu(what: &str) -> Option<Gpu> {
    match Gpu::new() {
        Ok(gpu) => {
            println!("{what}: on {}", gpu.name());
            Some(gpu)
        }
        Err(RenderError::NoAdapter { reason })
            if std::env::var_os("CLAMBER_REQUIRE_GPU").is_none() =>
        {
            // Not by `eprintln`: the output of passing tests is not shown.
            let line = format!(
                "SKIPPED {what}: no graphics adapter, install mesa-vulkan-drivers ({reason})\n"
            );
            let _ = std::io::stderr().write_all(line.as_bytes());
            None
        }
        Err(error) => panic!("{what}: {error}"),
    }
}
