//! Tests that the error without any graphics driver says which package to install.

use std::process::Command;

use clamber_render::{Gpu, RenderError};

/// Environment variable that is set in the child process, which finds no driver.
const CHILD: &str = "CLAMBER_WITHOUT_ADAPTER";

#[test]
fn no_adapter_is_an_error_that_says_what_to_install() {
    if std::env::var_os(CHILD).is_some() {
        match Gpu::new() {
            Err(error @ RenderError::NoAdapter { .. }) => println!("found none: {error}"),
            other => panic!("{other:?}"),
        }
        return;
    }
    let this = std::env::current_exe().unwrap();
    // Drivers are chosen by environment variables, which a test must not change in its own process.
    let output = Command::new(this)
        .args([
            "--exact",
            "no_adapter_is_an_error_that_says_what_to_install",
        ])
        .arg("--nocapture")
        .env(CHILD, "1")
        .env("WGPU_BACKEND", "vulkan")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    let why = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}{why}");
    assert!(said.contains("found none: no graphics adapter"), "{said}");
    assert!(
        said.contains("apt-get install mesa-vulkan-drivers"),
        "{said}"
    );
}
