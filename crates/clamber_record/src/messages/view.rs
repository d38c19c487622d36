//! Messages that only people look at.

use clamber_surface::surface::Diagnostics;

use super::message;

message! {
    /// A number with a name.
    Named {
        name: String (string, tag = 1),
        value: f64 (double, tag = 2),
    }
}

message! {
    /// The brain of a creature.
    Brain {
        /// Path of the current state, with the names of the states around it.
        state: String (string, tag = 1),
        /// Time since that state was entered, seconds.
        seconds: f64 (double, tag = 2),
        moods: Vec<Named> (message, repeated, tag = 3),
        /// Senses that are finite and not 0.
        senses: Vec<Named> (message, repeated, tag = 4),
        /// Remaining hit points of each weak point.
        hit_points: Vec<f64> (double, repeated, tag = 5),
        /// For each leg, whether its foot is planted.
        planted: Vec<bool> (bool, repeated, tag = 6),
    }
}

message! {
    /// Counts of the clusters, vertices and triangles that the queries of a tick touched.
    Touched {
        bounds_evaluated: u64 (uint64, tag = 1),
        clusters_touched: u64 (uint64, tag = 2),
        clusters_skinned: u64 (uint64, tag = 3),
        clusters: u64 (uint64, tag = 4),
        vertices_skinned: u64 (uint64, tag = 5),
        vertices: u64 (uint64, tag = 6),
        triangles_tested: u64 (uint64, tag = 7),
        most_sweep_steps: u32 (uint32, tag = 8),
    }
}

impl From<Diagnostics> for Touched {
    fn from(touched: Diagnostics) -> Self {
        Self {
            bounds_evaluated: touched.bounds_evaluated as u64,
            clusters_touched: touched.clusters_touched as u64,
            clusters_skinned: touched.clusters_skinned as u64,
            clusters: touched.clusters as u64,
            vertices_skinned: touched.vertices_skinned as u64,
            vertices: touched.vertices as u64,
            triangles_tested: touched.triangles_tested,
            most_sweep_steps: touched.most_cast_steps,
        }
    }
}
