//! Slow references and single stages of larger calls, for measurements in this library's own tests and benches.
//! These items are not covered by any promise of stability.

pub use crate::query::brute_force::BruteForce;
pub use crate::skin::reference::{error_bound, skin_vertex_reference};
pub use crate::skin::whole::{skin_clusters, skin_scalar};
pub use crate::surface::winding::{winding_number, winding_of};
