//! The triangles of a surface near a box, kept from tick to tick.

use glam::Vec3;

use super::SkinnedSurface;
use crate::mesh::{TriangleId, VertexId};
use crate::query::MovingTriangle;

/// The triangles near a box, with the current and previous positions of their vertices: the data that a physics engine
/// needs of a creature near one body.
///
/// A patch belongs to one surface and is a mesh of its own: [`Patch::indices`] refer to the patch's own vertices. Its
/// memory is reused in each tick.
///
/// ```
/// # use std::sync::Arc;
/// # use clamber_surface::geometry::{Affine, Similarity};
/// # use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource, TriangleId};
/// # use clamber_surface::rig::Palette;
/// # use clamber_surface::surface::{Patch, PatchChange, SkinnedSurface};
/// # use glam::Vec3;
/// # let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
/// # let mesh = ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0;
/// let mut surface = SkinnedSurface::new(Arc::new(mesh));
/// let mut patch = Patch::default();
/// let (low, high) = (Vec3::splat(-0.1), Vec3::splat(0.1));
/// assert_eq!(patch.update(&surface, low, high, 0.1), PatchChange::Rebuilt);
/// assert_eq!(patch.triangles(), [TriangleId(0)]);
///
/// let mut lifted = Affine::IDENTITY;
/// lifted.rows[2][3] = 0.05;
/// surface.advance(&Palette::from_matrices([lifted]), Similarity::IDENTITY)?;
/// assert_eq!(patch.update(&surface, low, high, 0.1), PatchChange::Moved);
/// assert_eq!(patch.positions()[0] - patch.previous_positions()[0], Vec3::Z * 0.05);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Patch {
    /// Ids, in ascending order.
    triangles: Vec<TriangleId>,
    /// In the order in which triangles use them.
    vertices: Vec<VertexId>,
    indices: Vec<[u32; 3]>,
    positions: Vec<Vec3>,
    previous_positions: Vec<Vec3>,
    /// Memory for the triangles that a query finds.
    found: Vec<MovingTriangle>,
    /// Memory for vertices, by id, with their places in the patch.
    by_id: Vec<(VertexId, u32)>,
    /// Memory for flags: which vertices have this tick's positions.
    is_taken: Vec<bool>,
}

/// The effect of an update on a [`Patch`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PatchChange {
    /// The same triangles, and no position, current or previous, differs by a bit from the last update.
    Same,
    /// The same triangles; some positions, current or previous, are new.
    Moved,
    /// The patch was rebuilt with other triangles.
    Rebuilt,
}

impl Patch {
    /// Updates the patch to this tick's positions, and to other triangles if necessary. It then holds every enabled
    /// triangle that [moves within](super::ModelSpace::visit_box) the box from `low` to `high`, in model space.
    ///
    /// A rebuild takes in all triangles within `margin` of the box, so that the next rebuild is not due before the box
    /// has moved that far over the skin. A larger margin needs fewer rebuilds, and costs more in each tick between
    /// them. With a margin of 0 the patch holds no more triangles than it must, and is rebuilt whenever one leaves or
    /// enters.
    ///
    /// The patch is empty if the box is not finite, or if the margin is negative or not finite.
    pub fn update(
        &mut self,
        surface: &SkinnedSurface,
        low: Vec3,
        high: Vec3,
        margin: f32,
    ) -> PatchChange {
        let apart = |moving: &MovingTriangle| {
            if moving.meets_box(low, high) {
                0.0
            } else {
                margin
            }
        };
        self.update_near(surface, low, high, margin, apart)
    }

    /// [`Patch::update`] near a region that fills little of its box. `apart` returns a lower bound of the distance
    /// between the region and a moving triangle, in model units: 0 or less for a triangle that meets the region. If it
    /// is `#[inline(always)]`, it is compiled for the widest instruction set of the machine, as the query around it is.
    pub fn update_near(
        &mut self,
        surface: &SkinnedSurface,
        low: Vec3,
        high: Vec3,
        margin: f32,
        apart: impl Fn(&MovingTriangle) -> f32,
    ) -> PatchChange {
        let around = Vec3::splat(margin);
        self.found.clear();
        let (mut met, mut all_held) = (0, true);
        let (low, high) = (low - around, high + around);
        surface.in_model().visit_box(
            low,
            high,
            #[cfg_attr(not(unoptimized), inline(always))]
            |moving| {
                let apart = apart(moving);
                if apart <= margin {
                    self.found.push(*moving);
                }
                if apart <= 0.0 {
                    met += 1;
                    all_held &= self.triangles.binary_search(&moving.triangle).is_ok();
                }
            },
        );
        // With a margin of 0, no triangle beyond those met; if none is met, no triangle at all.
        let no_more = met > 0 && margin > 0.0 || met == self.triangles.len();
        if all_held && no_more && self.is_of(surface) {
            return self.take_positions(surface);
        }
        if met == 0 {
            self.found.clear();
        }
        self.rebuild(surface);
        PatchChange::Rebuilt
    }

    /// Removes all triangles; keeps the memory.
    pub fn clear(&mut self) {
        self.triangles.clear();
        self.vertices.clear();
        self.indices.clear();
        self.positions.clear();
        self.previous_positions.clear();
    }

    /// True if the patch has no triangles.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Ids of the patch's triangles in the surface, ascending; [`Patch::indices`] has the same order.
    pub fn triangles(&self) -> &[TriangleId] {
        &self.triangles
    }

    /// Ids of the patch's vertices in the surface, in the order in which its triangles use them; the positions have the
    /// same order.
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// The corners of each triangle, as indices into the patch's own vertices.
    pub fn indices(&self) -> &[[u32; 3]] {
        &self.indices
    }

    /// Current positions of the patch's vertices, in model space.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Positions of the patch's vertices a tick ago, in the *current* model frame: a moving root is part of their
    /// motion.
    pub fn previous_positions(&self) -> &[Vec3] {
        &self.previous_positions
    }

    /// Velocities of the patch's vertices over the last tick of `dt` seconds, in the current model frame, in model
    /// units per second; zero if `dt` is not positive.
    pub fn velocities(&self, dt: f64) -> impl ExactSizeIterator<Item = Vec3> {
        let dt = if dt > 0.0 { dt } else { f64::INFINITY };
        let pairs = self.positions.iter().zip(&self.previous_positions);
        pairs.map(move |(now, before)| ((now.as_dvec3() - before.as_dvec3()) / dt).as_vec3())
    }

    /// False if one of the patch's triangles was removed or hidden, or has other corners in this surface.
    fn is_of(&self, surface: &SkinnedSurface) -> bool {
        let all = surface.mesh().triangles();
        let mut own = self.triangles.iter().zip(&self.indices);
        own.all(|(triangle, corners)| {
            let corners = corners.map(|corner| self.vertices[corner as usize]);
            surface.is_enabled(*triangle) && all.get(triangle.index()) == Some(&corners)
        })
    }

    /// Takes the positions of all vertices: from the triangles found, which a query has skinned; the other vertices are
    /// skinned one by one.
    fn take_positions(&mut self, surface: &SkinnedSurface) -> PatchChange {
        let mut change = PatchChange::Same;
        self.is_taken.clear();
        self.is_taken.resize(self.vertices.len(), false);
        for found in 0..self.found.len() {
            let moving = self.found[found];
            if let Ok(triangle) = self.triangles.binary_search(&moving.triangle) {
                for (corner, place) in self.indices[triangle].into_iter().enumerate() {
                    let places = [moving.current[corner], moving.previous[corner]];
                    self.put(place as usize, places, &mut change);
                }
            }
        }
        let instance = &surface.instance;
        for place in 0..self.vertices.len() {
            if !self.is_taken[place] {
                let vertex = self.vertices[place].index();
                let places = [&instance.current, &instance.previous]
                    .map(|pose| pose.position(&instance.mesh, vertex));
                self.put(place, places, &mut change);
            }
        }
        change
    }

    /// Stores a vertex's current and previous position, unless that was done.
    fn put(&mut self, place: usize, [now, before]: [Vec3; 2], change: &mut PatchChange) {
        if std::mem::replace(&mut self.is_taken[place], true) {
            return;
        }
        let bits = |p: Vec3| p.to_array().map(f32::to_bits);
        let known = [
            &mut self.positions[place],
            &mut self.previous_positions[place],
        ];
        for (known, found) in known.into_iter().zip([now, before]) {
            if bits(found) != bits(*known) {
                *change = PatchChange::Moved;
            }
            *known = found;
        }
    }

    fn rebuild(&mut self, surface: &SkinnedSurface) {
        self.clear();
        self.found.sort_unstable_by_key(|moving| moving.triangle);
        let all = surface.mesh().triangles();
        self.by_id.clear();
        for moving in &self.found {
            let corners = all[moving.triangle.index()];
            self.by_id.extend(corners.map(|vertex| (vertex, NOWHERE)));
        }
        self.by_id.sort_unstable();
        self.by_id.dedup();
        for moving in &self.found {
            self.triangles.push(moving.triangle);
            let corners = all[moving.triangle.index()];
            let mut places = [0; 3];
            for (corner, vertex) in corners.into_iter().enumerate() {
                // Found, since it was added just above.
                let index = self.by_id.partition_point(|(known, _)| *known < vertex);
                let place = &mut self.by_id[index].1;
                if *place == NOWHERE {
                    *place = self.vertices.len() as u32;
                    self.vertices.push(vertex);
                    self.positions.push(moving.current[corner]);
                    self.previous_positions.push(moving.previous[corner]);
                }
                places[corner] = *place;
            }
            self.indices.push(places);
        }
    }
}

/// The place of a vertex that has none in the patch yet.
const NOWHERE: u32 = u32::MAX;

#[cfg(test)]
mod tests;
