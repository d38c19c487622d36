//! For measuring this library in its own tests and benches: slow references, and stages of what is one call elsewhere.
//! Not covered by any promise of stability.

pub use crate::query::brute_force::BruteForce;
pub use crate::skin::reference::{error_bound, skin_vertex_reference};
pub use crate::skin::whole::{skin_clusters, skin_scalar};
pub use crate::surface::winding::winding_number;
