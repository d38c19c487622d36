//! An edit that is refused changes nothing.

use super::{bent, rigid};
use crate::geometry::{Affine, Similarity};
use crate::mesh::{
    ColliderMesh, MeshError, PaletteError, PartId, SurfaceTag, TriangleId, VertexId,
};
use crate::rig::{JointId, Palette};
use crate::surface::{Diagnostics, SkinnedSurface, SurfaceEdit, SurfaceError};
use crate::testing::{bend, influence, tube};
use glam::{DVec3, Vec3};

/// All state that an edit could change.
fn state(surface: &SkinnedSurface) -> (ColliderMesh, Diagnostics, String) {
    let instance = &surface.instance;
    let flags = (&instance.part_enabled, &instance.triangle_hidden);
    let roots = (instance.current.root(), instance.previous.root());
    let hidden = instance.hidden_triangles;
    let others = format!("{flags:?} {hidden} {roots:?} {}", surface.memory());
    let mesh = surface.mesh().as_ref().clone();
    (mesh, surface.diagnostics(), others)
}

fn assert_refused<T: std::fmt::Debug>(
    surface: &mut SkinnedSurface,
    edit: impl FnOnce(&mut SurfaceEdit<'_>) -> Result<T, SurfaceError>,
) -> SurfaceError {
    let before = state(surface);
    let error = surface.edit(edit).unwrap_err();
    assert!(state(surface) == before, "{error}");
    error
}

/// A surface from which something was removed, and which has answered a query.
fn edited() -> SkinnedSurface {
    let mut surface = bent(4, 8);
    surface.edit(|edit| {
        edit.remove_triangle(TriangleId(11)).unwrap();
        edit.remove_vertex(VertexId(20)).unwrap();
    });
    surface.in_model().closest_point(Vec3::ZERO, 0.3);
    surface
}

#[test]
fn vertices_and_triangles_that_do_not_exist_or_were_removed() {
    let mut surface = edited();
    let none = [surface.mesh().triangles().len() as u32, u32::MAX];
    for id in [11, none[0], none[1]].map(TriangleId) {
        let wanted = SurfaceError::Triangle(id);
        let found = assert_refused(&mut surface, |edit| edit.remove_triangle(id));
        assert_eq!(found, wanted);
        let tag = SurfaceTag::default();
        let found = assert_refused(&mut surface, |edit| edit.set_tag(id, tag));
        assert_eq!(found, wanted);
        assert_eq!(surface.disable_triangle(id), Err(wanted.clone()));
        assert_eq!(surface.enable_triangle(id), Err(wanted));
    }
    let none = [surface.mesh().positions().len() as u32, u32::MAX];
    for id in [20, none[0], none[1]].map(VertexId) {
        let wanted = SurfaceError::Vertex(id);
        let found = assert_refused(&mut surface, |edit| edit.remove_vertex(id));
        assert_eq!(found, wanted);
        for place in 0..3 {
            let mut corners = [1, 2, 9].map(VertexId);
            corners[place] = id;
            let add =
                |edit: &mut SurfaceEdit<'_>| edit.add_triangle(corners, SurfaceTag::default());
            assert_eq!(assert_refused(&mut surface, add), wanted);
        }
    }
    let part = PartId(u32::MAX);
    assert_eq!(surface.disable_part(part), Err(SurfaceError::Part(part)));
}

#[test]
fn triangles_without_area() {
    let mut surface = edited();
    // Two equal corners, and three in a line along the tube.
    for corners in [[1, 1, 2], [1, 9, 17]] {
        let error = assert_refused(&mut surface, |edit| {
            edit.add_triangle(corners.map(VertexId), SurfaceTag::default())
        });
        let vertices = corners;
        assert_eq!(error, MeshError::DegenerateTriangle { vertices }.into());
    }
}

#[test]
fn vertices_that_a_build_would_refuse() {
    let mut surface = edited();
    let vertex = surface.mesh().positions().len();
    for bad in [f32::NAN, f32::INFINITY, 7e29] {
        let position = Vec3::new(0.0, bad, 0.0);
        let error = assert_refused(&mut surface, |edit| edit.add_vertex(position, &rigid(0)));
        assert_eq!(error, MeshError::Position { vertex }.into(), "{bad}");
    }
    let error = assert_refused(&mut surface, |edit| edit.add_vertex(Vec3::X, &rigid(4)));
    let wanted = MeshError::JointOutOfRange {
        vertex,
        joint: JointId(4),
        joints: 4,
    };
    assert_eq!(error, wanted.into());
    for weights in [&[][..], &[0.0], &[0.0, 0.0], &[-0.5, 1.0], &[f32::INFINITY]] {
        let influences: Vec<_> = weights.iter().map(|w| influence(1, *w)).collect();
        let error = assert_refused(&mut surface, |edit| edit.add_vertex(Vec3::X, &influences));
        let weights = weights.to_vec();
        assert_eq!(error, MeshError::Weights { vertex, weights }.into());
    }
}

#[test]
fn a_vertex_that_either_palette_would_take_too_far() {
    // 2^60 times as large, and a vertex 2^50 away: 2^110.
    let mut large = Affine::IDENTITY;
    for axis in 0..3 {
        large.rows[axis][axis] = (1u64 << 60) as f32;
    }
    let large = Palette::from_matrices([Affine::IDENTITY, large, Affine::IDENTITY]);
    let small = bend(3, DVec3::Z, 0.1);
    let far = Vec3::X * (1u64 << 50) as f32;
    let mut surface = SkinnedSurface::new(tube(3, 6));
    let add = |edit: &mut SurfaceEdit<'_>| edit.add_vertex(far, &rigid(0));
    for palette in [&large, &small] {
        surface.advance(palette, Similarity::IDENTITY).unwrap();
        let error = assert_refused(&mut surface, add);
        assert_eq!(error, PaletteError::Matrix(JointId(1)).into());
    }
    // Once the large palette is in neither pose, the vertex is accepted; then the large palette is refused.
    surface.advance(&small, Similarity::IDENTITY).unwrap();
    surface.edit(add).unwrap();
    let refused = surface.advance(&large, Similarity::IDENTITY);
    assert_eq!(refused, Err(PaletteError::Matrix(JointId(1)).into()));
}

#[test]
fn changes_before_a_refused_one_stay() {
    let mut surface = edited();
    let count = surface.mesh().positions().len() as u32;
    let result = surface.edit(|edit| {
        edit.add_vertex(Vec3::Y, &rigid(1))?;
        edit.remove_triangle(TriangleId(2))?;
        edit.remove_triangle(TriangleId(2))?;
        edit.remove_triangle(TriangleId(3))
    });
    assert_eq!(result, Err(SurfaceError::Triangle(TriangleId(2))));
    assert!(surface.mesh().has_vertex(VertexId(count)));
    assert_eq!(surface.mesh().part_of(TriangleId(2)), None);
    assert!(surface.mesh().part_of(TriangleId(3)).is_some());
    super::assert_sound(surface.mesh(), "refused halfway");
}
