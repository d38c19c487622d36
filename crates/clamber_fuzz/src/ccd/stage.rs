use std::sync::Arc;
use std::time::{Duration, Instant};

use clamber_oracle::exact::Claim;
use clamber_oracle::{Core, MovingPair};
use clamber_surface::geometry::{Affine, Capsule, Similarity};
use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshError, MeshSource};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::{CastOptions, SkinnedSurface, SurfaceError, SweepHit};
use glam::Vec3;

/// Most steps that the library takes for a triangle; what has none to show by then is to be flagged.
pub const CAP: u32 = 256;

/// A surface of one triangle, each corner on a joint of its own whose matrix puts it anywhere: so the
/// library's sweeps meet any moving triangle, its corners exactly as given.
#[derive(Clone, Debug)]
pub struct Stage {
    surface: SkinnedSurface,
}

/// What a sweep answered.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// The contact, if it found one.
    pub hit: Option<SweepHit>,
    /// Steps of the exact test.
    pub steps: u32,
    /// How long the query took, with all caches empty.
    pub took: Duration,
}

impl Answer {
    /// What it says.
    pub fn claim(&self) -> Claim {
        Claim {
            time: self.hit.map(|hit| hit.time),
            undecided: self.hit.is_some_and(|hit| hit.undecided),
        }
    }
}

impl Stage {
    /// With the triangle at rest.
    ///
    /// # Errors
    /// None that are known of.
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
        let (mesh, _) = ColliderMesh::build(&source, &BuildOptions::default())?;
        Ok(Self {
            surface: SkinnedSurface::new(Arc::new(mesh)),
        })
    }

    /// Moves the triangle as the pair's does, and sweeps the pair's core against it.
    ///
    /// # Errors
    /// [`SurfaceError`] if the pair is not finite, or larger than a surface may be.
    pub fn sweep(&mut self, pair: &MovingPair, tolerance: f32) -> Result<Answer, SurfaceError> {
        let [start, end] = pair.corners;
        self.surface.place(&palette(start), Similarity::IDENTITY)?;
        self.surface.advance(&palette(end), Similarity::IDENTITY)?;
        let radius = pair.radius;
        let begin = Instant::now();
        let (ends, motions) = match pair.core {
            Core::Sphere { center, motion } => ([center; 2], [motion; 2]),
            Core::Capsule { ends, motions } => (ends, motions),
        };
        let options = CastOptions::MOVING.with_tolerance(tolerance.into());
        let capsule = Capsule::new(ends[0], ends[1], radius);
        let space = self.surface.in_model();
        let hit = capsule.and_then(|capsule| space.cast_capsule(&capsule, motions, &options));
        let took = begin.elapsed();
        let steps = self.surface.diagnostics().most_cast_steps;
        Ok(Answer { hit, steps, took })
    }
}

/// Takes every vertex to its joint's place, wherever it is at rest: `0 x + t` is exact.
fn palette(corners: [Vec3; 3]) -> Palette {
    Palette::from_matrices(corners.map(|corner| Affine {
        rows: corner.to_array().map(|t| [0.0, 0.0, 0.0, t]),
    }))
}
