//! Helpers that tests of pictures share.

use clamber_render::{Gpu, RenderError};

/// Opens a device; `None`, with a message, if there is none and none is required.
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
            eprintln!(
                "SKIPPED, {what}: no graphics adapter, install mesa-vulkan-drivers ({reason})"
            );
            None
        }
        Err(error) => panic!("{what}: {error}"),
    }
}
