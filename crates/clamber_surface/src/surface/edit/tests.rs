mod agreement;
mod locality;
mod model;
mod refusals;
mod sound;

use std::sync::Arc;

use self::model::Model;
use self::sound::{assert_poses_hold, assert_sound};
use super::*;
use crate::SimdLevel;
use crate::geometry::Ray;
use crate::mesh::{Influence, SurfaceKind, SurfaceTag, VertexId};
use crate::surface::Anchor;
use crate::surface::agreement::{assert_queries_agree, assert_same_answers, questions};
use crate::testing::{advance, bend, bits, influence, tube};
use glam::{DVec3, Vec3};

/// Influences of a vertex that follows one joint alone.
fn rigid(joint: u32) -> [Influence; 1] {
    [influence(joint, 1.0)]
}

/// A tube that bent a moment ago, so that its two poses differ.
fn bent(joints: u32, sides: u32) -> SkinnedSurface {
    let mut surface = SkinnedSurface::new(tube(joints, sides));
    for angle in [0.2, 0.3] {
        advance(&mut surface, &bend(joints, DVec3::Z, angle));
    }
    surface
}

/// A surface for every instruction set, all edited alike.
fn on_every_level() -> Vec<(SkinnedSurface, Model, fastrand::Rng)> {
    let edited = |level: SimdLevel| {
        let mut surface = SkinnedSurface::with_simd_level(tube(5, 16), level);
        advance(&mut surface, &bend(5, DVec3::Z, 0.3));
        let model = Model::of(&surface);
        (surface, model, fastrand::Rng::with_seed(94))
    };
    SimdLevel::available().into_iter().map(edited).collect()
}

#[test]
fn all_instruction_sets_and_skinning_ahead_agree_after_edits() {
    let (mut lazy, mut eager) = (on_every_level(), on_every_level());
    let mut queries = fastrand::Rng::with_seed(95);
    let mut found = 0;
    for round in 0..30 {
        let case = format!("round {round}");
        for (surface, model, rng) in lazy.iter_mut().chain(&mut eager) {
            surface.edit(|edit| {
                for _ in 0..12 {
                    model.change(edit, rng);
                }
            });
        }
        for (surface, ..) in &mut eager {
            surface.skin_ahead();
        }
        let (first, ..) = &lazy[0];
        let questions = questions(first, &mut queries, 1);
        for (surface, ..) in lazy.iter().chain(&eager) {
            assert_sound(surface.mesh(), &case);
            assert_poses_hold(surface, &case);
            found += assert_same_answers(surface, &first.in_model(), &questions);
        }
    }
    assert!(found > 1_000, "{found}");
}

#[test]
fn an_added_vertex_moves_from_its_position_under_the_old_palette() {
    let mut surface = bent(4, 8);
    let influences = [0, 2, 3].map(|joint| influence(joint, 1.0));
    let position = Vec3::new(1.3, 4.0, -0.2);
    let vertex = surface.edit(|edit| edit.add_vertex(position, &influences).unwrap());
    let weights: Vec<_> = surface.mesh().influences(vertex).collect();
    assert_eq!(weights.iter().map(|(_, w)| w).sum::<f32>(), 1.0);
    let at = |palette: &[crate::geometry::Affine]| {
        let sum = weights.iter().fold(Vec3::ZERO, |sum, (joint, weight)| {
            sum + *weight * palette[joint.0 as usize].transform_point(position)
        });
        bits(&[sum])
    };
    let now = surface.in_model().position(vertex).unwrap();
    let before = surface.in_model().previous_position(vertex).unwrap();
    assert_eq!(bits(&[now]), at(surface.instance.current.palette()));
    assert_eq!(bits(&[before]), at(surface.instance.previous.palette()));
    assert_ne!(now, before);
    // The vertex is outside the former surface, and queries find it there.
    let corners = [VertexId(0), VertexId(1), vertex];
    let added = surface.edit(|edit| edit.add_triangle(corners, SurfaceTag::default()));
    let hit = surface.in_model().closest_point(now, 0.01).unwrap();
    assert_eq!(Ok(hit.triangle), added);
    assert_poses_hold(&surface, "a vertex far out");
}

#[test]
fn anchors_on_removed_triangles_report_it() {
    let mut surface = bent(4, 8);
    let corners = surface.mesh().triangles()[5];
    let weights = [0.2, 0.3, 0.5];
    let [gone, kept] = [5, 40].map(|t| surface.anchor(TriangleId(t), weights).unwrap());
    let before = surface.in_model().motion(&kept, 0.1).unwrap();
    assert!(surface.in_model().motion(&gone, 0.1).is_ok());
    surface
        .edit(|edit| edit.remove_triangle(TriangleId(5)))
        .unwrap();
    let refused = Err(SurfaceError::Triangle(TriangleId(5)));
    assert_eq!(surface.in_model().motion(&gone, 0.1), refused);
    assert_eq!(surface.in_model().motion(&kept, 0.1), Ok(before));
    // A triangle on the same corners has another id.
    let again = surface.edit(|edit| edit.add_triangle(corners, SurfaceTag::default()));
    assert_ne!(again, Ok(TriangleId(5)));
    assert_eq!(surface.in_model().motion(&gone, 0.1), refused);
    let anew = surface.anchor(again.unwrap(), weights).unwrap();
    assert!(surface.in_model().motion(&anew, 0.1).is_ok());
    // Removed together with a vertex.
    let corner = corners[0];
    surface.edit(|edit| edit.remove_vertex(corner)).unwrap();
    let refused = Err(SurfaceError::Triangle(anew.triangle));
    assert_eq!(surface.in_model().motion(&anew, 0.1), refused);
    assert_eq!(surface.in_model().position(corner), None);
    assert_eq!(surface.in_model().previous_position(corner), None);
}

#[test]
fn ids_are_never_reused() {
    let mut surface = bent(3, 6);
    let mut seen = std::collections::BTreeSet::new();
    let tag = SurfaceTag::default();
    for round in 0..200 {
        let (vertex, triangle) = surface.edit(|edit| {
            let vertex = edit.add_vertex(Vec3::new(0.5, 2.0, 0.1), &rigid(round % 3));
            let vertex = vertex.unwrap();
            let corners = [VertexId(0), VertexId(1), vertex];
            (vertex, edit.add_triangle(corners, tag).unwrap())
        });
        assert!(seen.insert((Some(vertex), None)), "{vertex}");
        assert!(seen.insert((None, Some(triangle))), "{triangle}");
        surface.edit(|edit| edit.remove_vertex(vertex)).unwrap();
        assert_eq!(surface.mesh().part_of(triangle), None);
    }
}

#[test]
fn an_edit_does_not_change_other_surfaces_that_share_the_mesh() {
    let mut one = bent(4, 8);
    let other = one.clone();
    let before = other.mesh().clone();
    assert!(Arc::ptr_eq(one.mesh(), other.mesh()));
    // An edit that changes nothing takes no copy.
    one.disable_triangle(TriangleId(3)).unwrap();
    let refused = one.edit(|edit| edit.remove_vertex(VertexId(u32::MAX)));
    assert!(refused.is_err() && Arc::ptr_eq(one.mesh(), other.mesh()));
    one.edit(|_| ());
    assert!(Arc::ptr_eq(one.mesh(), other.mesh()));

    let tag = SurfaceTag::default().with_user(1);
    one.edit(|edit| edit.set_tag(TriangleId(0), tag)).unwrap();
    assert!(!Arc::ptr_eq(one.mesh(), other.mesh()));
    let own = Arc::as_ptr(one.mesh());
    one.edit(|edit| edit.remove_vertex(VertexId(7))).unwrap();
    assert_eq!(Arc::as_ptr(one.mesh()), own, "one copy is enough");
    assert!(Arc::ptr_eq(other.mesh(), &before));
    let tags = vec![SurfaceTag::default(); before.tags().len()];
    assert_eq!(other.mesh().tags().to_vec(), tags);
    assert!(other.mesh().has_vertex(VertexId(7)) && !one.mesh().has_vertex(VertexId(7)));
    assert_sound(other.mesh(), "the other one");
}

#[test]
fn a_panic_in_an_edit_leaves_a_surface_that_answers_queries() {
    let mut surface = bent(4, 8);
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| ()));
    let unwound = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        surface.edit(|edit| {
            edit.remove_vertex(VertexId(9)).unwrap();
            panic!("in the middle of an edit");
        })
    }));
    std::panic::set_hook(hook);
    assert!(unwound.is_err());
    assert_sound(surface.mesh(), "after a panic");
    let mut rng = fastrand::Rng::with_seed(96);
    assert_queries_agree(&surface, &mut rng, 25);
}

#[test]
fn points_are_valid_on_meshes_that_continue_theirs_and_on_no_other() {
    let original = bent(4, 8);
    let before = original.anchor(TriangleId(3), [0.2, 0.3, 0.5]).unwrap();
    // A copy with a scab, whose tip is at a given height.
    let with_scab = |height: f32| {
        let mut copy = bent(4, 8);
        let scab = copy.edit(|edit| {
            let tip = edit.add_vertex(Vec3::Y * height, &rigid(0)).unwrap();
            let corners = [VertexId(0), VertexId(1), tip];
            edit.add_triangle(corners, SurfaceTag::default()).unwrap()
        });
        let anchor = copy.anchor(scab, [0.2, 0.3, 0.5]).unwrap();
        (copy, anchor)
    };
    let (high, on_high) = with_scab(3.0);
    let (low, on_low) = with_scab(2.0);
    let (again, _) = with_scab(3.0);
    let holds = |surface: &SkinnedSurface, anchor: &Anchor| {
        let moved = surface.in_model().motion(anchor, 0.1);
        assert_eq!(moved.is_ok(), surface.anchor_at(anchor).is_ok());
        match moved {
            Ok(_) => true,
            Err(SurfaceError::ForeignMesh { expected, found }) => {
                assert_eq!((expected, found), (surface.mesh().id(), anchor.mesh));
                false
            }
            Err(error) => panic!("{error}"),
        }
    };
    // The same triangle id at another place: once accepted as the surface's own, before ids counted edits.
    assert_eq!(on_high.triangle, on_low.triangle);
    assert!(holds(&high, &on_high) && holds(&low, &on_low) && holds(&again, &on_high));
    assert!(!holds(&high, &on_low) && !holds(&low, &on_high) && !holds(&original, &on_high));
    // Triangles of the build mean the same on all copies, whenever the point was found.
    let after = high.anchor(TriangleId(3), [0.2, 0.3, 0.5]).unwrap();
    let down = Ray::new(Vec3::new(2.05, 5.0, 0.03), Vec3::NEG_Y).unwrap();
    let hit = high.in_model().cast_ray(&down, 10.0).unwrap();
    let at_hit = high.anchor_at(&hit).unwrap();
    for surface in [&original, &high, &low, &again] {
        for built in [before, after, at_hit] {
            assert!(holds(surface, &built), "{built:?}");
        }
    }
    // Edits that change the meaning of no triangle change no mesh id.
    let mut tagged = with_scab(3.0).0;
    tagged.edit(|edit| {
        edit.set_tag(TriangleId(0), SurfaceTag::new(SurfaceKind::Stone))
            .unwrap();
        edit.remove_triangle(TriangleId(1)).unwrap();
    });
    assert_eq!(tagged.mesh().id(), high.mesh().id());
    assert!(holds(&tagged, &on_high));
}

#[test]
fn surfaces_have_the_same_mask_if_they_hide_the_same() {
    let mut rng = fastrand::Rng::with_seed(96);
    let mut surface = SkinnedSurface::new(tube(4, 6));
    let all = surface.mesh().triangles().len() as u32;
    let mut known: Vec<(Vec<bool>, u64)> = Vec::new();
    for round in 0..400 {
        let (triangle, part) = (TriangleId(rng.u32(0..all)), PartId(rng.u32(0..3)));
        match rng.u32(0..5) {
            0 => surface.enable_part(part),
            1 => surface.disable_part(part),
            2 => surface.disable_triangle(triangle),
            _ => surface.enable_triangle(triangle),
        }
        .unwrap();
        let parts = (0..3).map(|part| surface.instance.part_enabled[part]);
        let shows =
            |triangle| surface.instance.triangle_hidden.get(triangle as usize) != Some(&true);
        let state: Vec<bool> = parts.chain((0..all).map(shows)).collect();
        assert_eq!(surface.clone().mask(), surface.mask());
        for (other, mask) in &known {
            let equal = *other == state;
            assert_eq!(*mask == surface.mask(), equal, "round {round}");
        }
        known.push((state, surface.mask()));
    }
    let mut same = surface.clone();
    surface
        .edit(|edit| edit.remove_triangle(TriangleId(3)))
        .unwrap();
    same.enable_triangle(TriangleId(3)).unwrap();
    assert_eq!(surface.mask(), same.mask());
}
