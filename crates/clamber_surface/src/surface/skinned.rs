use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::SurfaceError;
use crate::geometry::{Affine, Similarity};
use crate::mesh::{ColliderMesh, check_matrices};
use crate::query::{Instance, ModelSpace};
use crate::rig::Palette;
use crate::simd::SimdLevel;
use crate::skin::skin_checked;

/// One posed instance of a [`ColliderMesh`], with a current and a previous pose.
///
/// All its geometry is in the creature's model space, in f32; [`SkinnedSurface::world_from_model`] maps it to the
/// world. Between two ticks every vertex moves on a straight line in the *current* model frame. The previous palette is
/// re-expressed in that frame, so a moving root is part of every vertex's motion.
///
/// ```
/// use std::sync::Arc;
/// use clamber_surface::geometry::{Affine, Ray, Similarity};
/// use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
/// use clamber_surface::rig::Palette;
/// use clamber_surface::surface::SkinnedSurface;
/// use glam::Vec3;
///
/// let (mesh, _) = ColliderMesh::build(
///     &MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]),
///     &ColliderBuildOptions::default(),
/// )?;
/// let mut surface = SkinnedSurface::new(Arc::new(mesh));
/// let mut lifted = Affine::IDENTITY;
/// lifted.rows[2][3] = 0.5;
/// surface.advance(&Palette::from_matrices([lifted]), Similarity::IDENTITY)?;
///
/// let ray = Ray::new(Vec3::new(0.2, 0.2, 2.0), -Vec3::Z).unwrap();
/// let hit = surface.in_model().cast_ray(&ray, 10.0).unwrap();
/// assert_eq!(hit.distance, 1.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SkinnedSurface {
    pub(crate) instance: Instance,
    world_from_model: Similarity,
    /// [`SkinnedSurface::was_teleported`].
    placed: bool,
    /// [`SkinnedSurface::bounding_ball`].
    ball: Option<(DVec3, f64)>,
}

impl SkinnedSurface {
    /// A surface at rest, with its model space equal to world space: every matrix of its palette is the identity.
    pub fn new(mesh: Arc<ColliderMesh>) -> Self {
        Self::with_simd_level(mesh, SimdLevel::best())
    }

    /// [`SkinnedSurface::new`] on a given instruction set, for measurements and tests: the results are the same.
    #[doc(hidden)]
    pub fn with_simd_level(mesh: Arc<ColliderMesh>, simd_level: SimdLevel) -> Self {
        let mut surface = Self {
            instance: Instance::new(mesh, simd_level),
            world_from_model: Similarity::IDENTITY,
            placed: true,
            ball: None,
        };
        surface.bound();
        surface
    }

    /// Starts the next tick: the current pose becomes the previous one, and the given pose becomes current.
    ///
    /// Needs a new pose in every tick: with the same pose the skin has stood still. Where poses are made less often, a
    /// [`PoseTrack`](crate::rig::PoseTrack) blends them.
    ///
    /// Costs O(joints), and O(nodes and clusters that the last two ticks touched). No vertex is skinned, unless the
    /// last tick touched at least three quarters of all clusters; then all clusters are skinned. That depends on which
    /// clusters queries reached, not on how many threads they ran on.
    ///
    /// # Errors
    /// [`SurfaceError::Palette`] about the given palette, or about the previous one re-expressed in the new model
    /// frame; [`SurfaceError::WorldFromModel`] if `world_from_model` is not [valid](Similarity::is_valid). The surface
    /// is unchanged then.
    pub fn advance(
        &mut self,
        palette: &Palette,
        world_from_model: Similarity,
    ) -> Result<(), SurfaceError> {
        self.validate(palette, &world_from_model)?;
        let world_from_model = world_from_model.normalized();
        let ahead = self.touched_nearly_everything();
        let Instance {
            mesh,
            current,
            previous,
            ..
        } = &mut self.instance;
        if world_from_model == self.world_from_model {
            // The last tick's bounds and positions can be used as they are.
            std::mem::swap(current, previous);
        } else {
            let now_from_before = world_from_model.relative(&self.world_from_model);
            let moved = |before: &Affine| Affine::from_f64(&(now_from_before * before.to_f64()));
            let before = current.palette().iter();
            check_matrices(before.clone().map(moved), mesh.radius())?;
            previous.set(mesh, before.map(moved));
        }
        self.pose(palette, world_from_model, ahead);
        self.placed = false;
        self.instance.is_still = false;
        Ok(())
    }

    /// Places the surface without motion: the given pose becomes both current and previous. For the first tick, a
    /// teleport, and waking up.
    ///
    /// # Errors
    /// [`SurfaceError::Palette`] about the given palette, [`SurfaceError::WorldFromModel`] if `world_from_model` is not
    /// [valid](Similarity::is_valid). The surface is unchanged then.
    pub fn teleport(
        &mut self,
        palette: &Palette,
        world_from_model: Similarity,
    ) -> Result<(), SurfaceError> {
        self.validate(palette, &world_from_model)?;
        let Instance { mesh, previous, .. } = &mut self.instance;
        previous.set(mesh, palette.matrices().iter().copied());
        let ahead = self.touched_nearly_everything();
        self.pose(palette, world_from_model.normalized(), ahead);
        self.placed = true;
        self.instance.is_still = true;
        Ok(())
    }

    /// True if the surface was last posed by [`SkinnedSurface::teleport`], or is new; false after
    /// [`SkinnedSurface::advance`].
    pub const fn was_teleported(&self) -> bool {
        self.placed
    }

    /// Puts the surface to sleep: it stands still in its current pose, without motion, until it is teleported or
    /// advanced again.
    ///
    /// For a creature that is neither touched nor drawn: its clips, its palette and [`SkinnedSurface::advance`] can be
    /// skipped. Queries still work. Costs O(joints), once.
    ///
    /// To wake the surface, [`SkinnedSurface::teleport`] it where it is by then. `advance` would take the whole way
    /// since it fell asleep for the motion of one tick.
    pub fn sleep(&mut self) {
        let Instance {
            mesh,
            current,
            previous,
            ..
        } = &mut self.instance;
        previous.set(mesh, current.palette().iter().copied());
        self.instance.is_still = true;
        self.bound();
    }

    /// Centre and radius, in world space, of a ball that holds all skin over the tick that ends now, from its start to
    /// its end. `None` if the mesh has no vertices, or if the ball is not finite.
    ///
    /// The ball follows from the palettes alone: it surrounds a box around the joints' bounding balls.
    pub fn bounding_ball(&self) -> Option<(DVec3, f64)> {
        self.ball
    }

    /// Computes the bounding ball, after poses have changed.
    pub(super) fn bound(&mut self) {
        let root = self.instance.current.root();
        let root = root.union(self.instance.previous.root());
        let (low, high) = (root.min.as_dvec3(), root.max.as_dvec3());
        let center = self.world_from_model.transform_point((low + high) * 0.5);
        let radius = (high - low).length() * 0.5 * self.world_from_model.scale;
        let size = radius + center.length();
        let is_there = low.cmple(high).all() && size.is_finite();
        self.ball = is_there.then_some((center, radius + BALL_SLACK * size));
    }

    /// Skins every cluster now and refits every bound to the result, where queries would skip what they do not touch.
    /// For comparison: the surface does this by itself where it is faster.
    #[doc(hidden)]
    pub fn skin_ahead(&mut self) {
        self.instance.current.fill(&self.instance.mesh);
    }

    /// A view of the surface in its own model space, with its queries.
    pub fn in_model(&self) -> ModelSpace<'_> {
        ModelSpace {
            instance: &self.instance,
        }
    }

    /// The rest data, which surfaces may share.
    pub fn mesh(&self) -> &Arc<ColliderMesh> {
        &self.instance.mesh
    }

    /// The map from the creature's model space to the world, as of the current tick.
    pub fn world_from_model(&self) -> &Similarity {
        &self.world_from_model
    }

    /// The instruction set that queries run on.
    #[doc(hidden)]
    pub fn simd_level(&self) -> SimdLevel {
        self.instance.simd_level
    }

    /// Skins every vertex once, removed ones included, into `positions`: in model space, by vertex id. For renderers
    /// and others that need the whole surface. The memory of `positions` is reused. Queries neither need it nor profit
    /// from it.
    pub fn skin_all(&self, positions: &mut Vec<Vec3>) {
        let palette = self.instance.current.palette();
        skin_checked(self.mesh(), palette, self.simd_level(), positions);
    }

    /// True if this tick touched so many clusters that skinning the next tick ahead costs less than finding out which
    /// clusters it needs.
    fn touched_nearly_everything(&self) -> bool {
        let asked = self.instance.current.asked_cluster_count();
        let all = self.mesh().clusters().living();
        asked * 4 >= all * 3
    }

    /// Makes a pose current, skinned ahead or not. The caller has checked it.
    fn pose(&mut self, palette: &Palette, world_from_model: Similarity, ahead: bool) {
        let Instance {
            mesh,
            current,
            triangles_tested,
            most_cast_steps,
            ..
        } = &mut self.instance;
        current.set(mesh, palette.matrices().iter().copied());
        *triangles_tested.get_mut() = 0;
        *most_cast_steps.get_mut() = 0;
        if ahead {
            current.fill(mesh);
        }
        self.world_from_model = world_from_model;
        self.bound();
    }

    fn validate(
        &self,
        palette: &Palette,
        world_from_model: &Similarity,
    ) -> Result<(), SurfaceError> {
        self.mesh().check_palette(palette.matrices())?;
        if !world_from_model.is_valid() {
            return Err(SurfaceError::WorldFromModel);
        }
        Ok(())
    }
}

/// Share of a surface's size and distance by which its bounding ball is made larger than its box requires: more than
/// some twenty roundings of f64.
const BALL_SLACK: f64 = 1e-14;

#[cfg(test)]
mod tests;
