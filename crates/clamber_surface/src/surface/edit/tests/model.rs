//! Random edits of a surface, and a simple model of them: the expected state afterwards.

use std::collections::BTreeSet;

use crate::mesh::{Influence, PartId, SurfaceKind, SurfaceTag, TriangleId, VertexId};
use crate::surface::{SkinnedSurface, SurfaceEdit, SurfaceError};
use crate::testing::{influence, point};
use glam::Vec3;

/// Kinds of edits: four flags, two additions, two removals, a tag.
pub(super) const KINDS: usize = 9;

struct Known {
    corners: [VertexId; 3],
    tag: SurfaceTag,
    enabled: bool,
}

/// The expected state: the mesh as built, and the edits made since.
pub(super) struct Model {
    joints: u32,
    /// `None` for removed vertices.
    vertices: Vec<Option<Vec3>>,
    triangles: Vec<Option<Known>>,
    at_first: usize,
    parts: Vec<bool>,
    /// Number of edits made, by kind.
    pub(super) made: [usize; KINDS],
}

impl Model {
    pub(super) fn of(surface: &SkinnedSurface) -> Self {
        let mesh = surface.mesh();
        let known = |(corners, tag): (&[VertexId; 3], &SurfaceTag)| {
            Some(Known {
                corners: *corners,
                tag: *tag,
                enabled: true,
            })
        };
        Self {
            joints: mesh.joint_count() as u32,
            vertices: mesh.positions().iter().copied().map(Some).collect(),
            triangles: mesh
                .triangles()
                .iter()
                .zip(mesh.tags().iter())
                .map(known)
                .collect(),
            at_first: mesh.triangles().len(),
            parts: vec![true; mesh.parts().len()],
            made: [0; KINDS],
        }
    }

    /// Disables or enables a part or a triangle.
    pub(super) fn flag(&mut self, surface: &mut SkinnedSurface, rng: &mut fastrand::Rng) {
        let enabled = rng.u32(0..3) > 0;
        if rng.u32(0..3) == 0 {
            let part = PartId(rng.u32(0..self.parts.len() as u32));
            if enabled {
                surface.enable_part(part).unwrap();
            } else {
                surface.disable_part(part).unwrap();
            }
            self.parts[part.index()] = enabled;
            self.made[usize::from(enabled)] += 1;
            return;
        }
        let id = self.any_triangle(rng);
        let result = if enabled {
            surface.enable_triangle(id)
        } else {
            surface.disable_triangle(id)
        };
        match &mut self.triangles[id.index()] {
            Some(known) => {
                known.enabled = enabled;
                self.made[2 + usize::from(enabled)] += 1;
                assert_eq!(result, Ok(()));
            }
            None => assert_eq!(result, Err(SurfaceError::Triangle(id))),
        }
    }

    /// Adds, removes or tags something. Keeps about as many triangles as the mesh was built with.
    pub(super) fn change(&mut self, edit: &mut SurfaceEdit<'_>, rng: &mut fastrand::Rng) {
        let there = self.triangles.iter().flatten().count();
        let few = there < self.at_first;
        match rng.u32(0..if few { 6 } else { 10 }) {
            0 => self.tag(edit, rng),
            1 | 2 => self.add_vertex(edit, rng),
            3..=5 => self.add_triangle(edit, rng),
            6..=8 => self.remove_triangle(edit, rng),
            _ => self.remove_vertex(edit, rng),
        }
    }

    fn any_triangle(&self, rng: &mut fastrand::Rng) -> TriangleId {
        TriangleId(rng.u32(0..self.triangles.len() as u32))
    }

    fn any_vertex(&self, rng: &mut fastrand::Rng) -> VertexId {
        // Prefers the last ones, which were added.
        let count = self.vertices.len() as u32;
        let last = if rng.bool() { count.min(12) } else { count };
        VertexId(count - 1 - rng.u32(0..last))
    }

    fn add_vertex(&mut self, edit: &mut SurfaceEdit<'_>, rng: &mut fastrand::Rng) {
        let near = rng.usize(0..self.vertices.len());
        let Some(near) = self.vertices[near] else {
            return;
        };
        let spread = [0.0, 0.1, 1.0][rng.usize(0..3)];
        let position = near + point(rng, spread);
        let count = [1, 2, 4, 9][rng.usize(0..4)];
        let first = rng.u32(0..self.joints);
        let influences: Vec<Influence> = (0..count)
            .map(|k| influence((first + k / 2) % self.joints, rng.f32() + 0.01))
            .collect();
        let id = edit.add_vertex(position, &influences).unwrap();
        assert_eq!(id.index(), self.vertices.len(), "an id used twice");
        self.vertices.push(Some(position));
        self.made[4] += 1;
    }

    fn add_triangle(&mut self, edit: &mut SurfaceEdit<'_>, rng: &mut fastrand::Rng) {
        let mut corners = [(); 3].map(|()| self.any_vertex(rng));
        let beside = self.any_triangle(rng);
        if let (true, Some(known)) = (rng.u32(0..4) > 0, &self.triangles[beside.index()]) {
            let [a, b, c] = known.corners;
            corners = [[b, a, corners[2]], [a, b, c]][usize::from(rng.u32(0..4) == 0)];
        }
        let tag = any_tag(rng);
        match edit.add_triangle(corners, tag) {
            Ok(id) => {
                assert_eq!(id.index(), self.triangles.len(), "an id used twice");
                self.triangles.push(Some(Known {
                    corners,
                    tag,
                    enabled: true,
                }));
                self.made[5] += 1;
            }
            Err(SurfaceError::Vertex(v)) => assert!(self.vertices[v.index()].is_none(), "{v}"),
            Err(error) => assert!(matches!(error, SurfaceError::Mesh(_)), "{error}"),
        }
    }

    fn remove_triangle(&mut self, edit: &mut SurfaceEdit<'_>, rng: &mut fastrand::Rng) {
        let id = self.any_triangle(rng);
        let wanted = match self.triangles[id.index()].take() {
            Some(_) => Ok(()),
            None => Err(SurfaceError::Triangle(id)),
        };
        self.made[6] += usize::from(wanted.is_ok());
        assert_eq!(edit.remove_triangle(id), wanted);
    }

    fn remove_vertex(&mut self, edit: &mut SurfaceEdit<'_>, rng: &mut fastrand::Rng) {
        let id = self.any_vertex(rng);
        let wanted = match self.vertices[id.index()].take() {
            Some(_) => Ok(()),
            None => Err(SurfaceError::Vertex(id)),
        };
        self.made[7] += usize::from(wanted.is_ok());
        assert_eq!(edit.remove_vertex(id), wanted);
        for triangle in &mut self.triangles {
            if triangle.as_ref().is_some_and(|t| t.corners.contains(&id)) {
                *triangle = None;
            }
        }
    }

    fn tag(&mut self, edit: &mut SurfaceEdit<'_>, rng: &mut fastrand::Rng) {
        let (id, tag) = (self.any_triangle(rng), any_tag(rng));
        let result = edit.set_tag(id, tag);
        match &mut self.triangles[id.index()] {
            Some(known) => {
                known.tag = tag;
                self.made[8] += 1;
                assert_eq!(result, Ok(()));
            }
            None => assert_eq!(result, Err(SurfaceError::Triangle(id))),
        }
    }

    /// Compares rest data, flags and parts with the expected state.
    pub(super) fn check(&mut self, surface: &SkinnedSurface, case: &str) {
        let mesh = surface.mesh();
        // New parts come with triangles, and are enabled.
        self.parts.resize(mesh.parts().len(), true);
        assert_eq!(mesh.triangles().len(), self.triangles.len(), "{case}");
        assert_eq!(mesh.positions().len(), self.vertices.len(), "{case}");
        for (id, position) in (0..).map(VertexId).zip(&self.vertices) {
            assert_eq!(mesh.has_vertex(id), position.is_some(), "{case}: {id}");
            let posed = surface.in_model().position(id);
            assert_eq!(posed.is_some(), position.is_some(), "{case}");
            if let Some(position) = position {
                assert_eq!(mesh.positions()[id.index()], *position, "{case}: {id}");
            }
        }
        let mut hidden = 0;
        for (id, known) in (0..).map(TriangleId).zip(&self.triangles) {
            let part = mesh.part_of(id);
            assert_eq!(part.is_some(), known.is_some(), "{case}: {id}");
            let Some((known, part)) = known.as_ref().zip(part) else {
                assert!(!surface.is_enabled(id), "{case}: {id}");
                continue;
            };
            assert_eq!(mesh.triangles()[id.index()], known.corners, "{case}: {id}");
            assert_eq!(mesh.tags()[id.index()], known.tag, "{case}: {id}");
            let enabled = known.enabled && self.parts[part.index()];
            assert_eq!(surface.is_enabled(id), enabled, "{case}: {id}");
            hidden += usize::from(!known.enabled);
        }
        assert_eq!(surface.instance.hidden_triangles, hidden, "{case}");
        for (id, part) in (0..).map(PartId).zip(mesh.parts()) {
            let all = (0..self.triangles.len() as u32).map(TriangleId);
            let own: Vec<_> = all.filter(|t| mesh.part_of(*t) == Some(id)).collect();
            assert_eq!(part.triangles, own, "{case}: part {id}");
            let corners = own.iter().flat_map(|t| mesh.triangles()[t.index()]);
            let corners: BTreeSet<VertexId> = corners.collect();
            assert!(part.vertices.iter().eq(&corners), "{case}: part {id}");
        }
    }
}

fn any_tag(rng: &mut fastrand::Rng) -> SurfaceTag {
    SurfaceTag {
        kind: [SurfaceKind::Skin, SurfaceKind::Fur, SurfaceKind::Stone][rng.usize(0..3)],
        user: rng.u32(..),
    }
}
