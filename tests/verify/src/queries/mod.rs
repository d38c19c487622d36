//! Continuous collision queries from files, with known answers.
//!
//! The vertex of a query becomes a sphere, an edge a capsule. The triangle is the face, or the other edge as a
//! collapsed face. A query is moved to the origin in exact arithmetic, and rounded to f32 ([`FileQuery::rounded`]). Its
//! radius is far larger than the rounding, so a sweep must find every contact.

mod file;
mod query;

pub use file::{parse_queries, read_queries};
pub use query::{FileQuery, QueryKind};
