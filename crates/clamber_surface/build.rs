//! Sets `unoptimized` where nothing is optimised.
//!
//! Functions on SIMD registers are inlined into each other, so that the compiler may use the registers. Without
//! optimisation it keeps each of thousands of intermediate results in a stack slot of its own instead: with AVX-512,
//! 2.6 MB for one function, more than the whole stack of a thread of Bevy's.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-check-cfg=cfg(unoptimized)");
    if std::env::var("OPT_LEVEL").is_ok_and(|level| level == "0") {
        println!("cargo::rustc-cfg=unoptimized");
    }
}
