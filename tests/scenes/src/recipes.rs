//! The programs of `docs/recipes`, as documentation tests; each module is one page:
//!
//! ```sh
//! cargo test -p clamber_scenes --doc
//! ```
//!
//! The programs run in this crate's folder, and load `../../assets/colossus.glb`.

/// Declares a module for each page of this name.
macro_rules! pages {
    ($($page:ident)+) => {
        $(#[doc = include_str!(concat!("../../../docs/recipes/", stringify!($page), ".md"))]
        mod $page {})+
    };
}

pages! {
    arrows
    camera
    creature_from_blender
    crouching
    debugging
    falling_crates
    own_engine
    own_model
    person
    players
    recording
    rules
    saving
    scaling
    server
    tuning
}
