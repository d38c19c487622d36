//! Continuous collision queries from files, whose answers are known.
//!
//! A vertex becomes a sphere and an edge a capsule; the face, or the other edge as a collapsed face, is the triangle. A
//! query is moved near the origin in exact arithmetic, and rounded to f32 ([`FileQuery::rounded`]). It is to be asked
//! with a radius that is larger than the rounding by far: so what touches must be found.

mod error;
mod file;
mod query;

pub use error::{QueryFileError, RowError};
pub use file::{parse_queries, read_queries};
pub use query::{FileQuery, QueryKind};
