use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::MovingPair;
use crate::exact::Claim;
use clamber_surface::geometry::{Affine, Capsule, Similarity};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshError, MeshSource};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::{CastOptions, SkinnedSurface, SurfaceError, SweepHit};
use glam::Vec3;

/// Largest number of steps that the library takes for a triangle. If the steps do not decide a query, its hit is
/// flagged as undecided.
pub const CAP: u32 = 256;

/// A surface of one triangle, for sweeps against any moving triangle. Each corner has a joint of its own, whose
/// matrix puts the corner exactly at a given position.
#[derive(Clone, Debug)]
pub struct Stage {
    surface: SkinnedSurface,
}

/// The answer of a sweep.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The contact; `None` if the sweep found none.
    pub hit: Option<SweepHit>,
    /// Number of steps of the exact test.
    pub steps: u32,
    /// Time of the query, with empty skin caches.
    pub took: Duration,
}

impl Answer {
    /// The claim of the answer, for the checks of [`exact`](crate::exact).
    pub fn claim(&self) -> Claim {
        Claim {
            time: self.hit.map(|hit| hit.fraction),
            undecided: self.hit.is_some_and(|hit| hit.undecided),
        }
    }
}

impl Stage {
    /// A stage with the triangle at rest.
    pub fn new() -> Result<Self, MeshError> {
        let whole = |joint| Influence {
            joint: JointId(joint),
            weight: 1.0,
        };
        let source = MeshSource {
            positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
            triangles: &[[0, 1, 2]],
            influences: &[whole(0), whole(1), whole(2)],
            joint_count: 3,
            ..MeshSource::default()
        };
        let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
        Ok(Self {
            surface: SkinnedSurface::new(Arc::new(mesh)),
        })
    }

    /// Moves the triangle like the pair's triangle, and sweeps the pair's core against it. `tolerance` is a distance. A
    /// core that is not finite hits nothing.
    ///
    /// # Errors
    /// [`SurfaceError`] if the triangle is not finite, or larger than a surface may be.
    pub fn sweep(&mut self, pair: &MovingPair, tolerance: f32) -> Result<Answer, SurfaceError> {
        let [start, end] = pair.corners;
        self.surface
            .teleport(&palette(start), Similarity::IDENTITY)?;
        self.surface.advance(&palette(end), Similarity::IDENTITY)?;
        let begin = Instant::now();
        let options = CastOptions::MOVING.with_tolerance(tolerance.into());
        let capsule = Capsule::new(pair.ends[0], pair.ends[1], pair.radius);
        let space = self.surface.in_model();
        let hit = capsule.and_then(|capsule| space.cast_capsule(&capsule, pair.motions, &options));
        let took = begin.elapsed();
        let steps = self.surface.diagnostics().most_cast_steps;
        Ok(Answer { hit, steps, took })
    }
}

/// A palette that takes every vertex to its joint's position, independent of the vertex's rest position: `0 x + t` is
/// exact.
fn palette(corners: [Vec3; 3]) -> Palette {
    Palette::from_matrices(corners.map(|corner| Affine {
        rows: corner.to_array().map(|t| [0.0, 0.0, 0.0, t]),
    }))
}
