//! What tests of pictures share.

use clamber_render::{Gpu, RenderError};

/// A device; `None`, said loudly, where there is none and none is required.
///
/// `CLAMBER_REQUIRE_GPU` makes its absence a failure.
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
