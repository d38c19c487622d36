//! The fuzz targets. Each makes a case from any bytes, runs the library on it, checks the library's promises, and
//! returns how much it checked. **A panic is a finding.**

pub(crate) mod bits;
mod builder;
mod bytes;
mod import;
mod mesh;
mod palettes;
mod poses;
mod queries;
mod seed;

pub use builder::builder;
pub use import::import;
pub use palettes::{Palettes, palettes};
pub use queries::{Queries, queries};
pub use seed::square;
