//! The cost of an edit depends on the parts that it touches: clusters rebuilt, cached results lost, memory.

use std::ops::Range;

use super::model::Model;
use super::sound::assert_poses_hold;
use super::{bent, rigid};
use crate::mesh::clusters::{Cluster, Clusters};
use crate::mesh::{ColliderMesh, PartId, SurfaceTag, TriangleId, VertexId};
use crate::surface::{Diagnostics, SkinnedSurface};
use crate::testing::{advance, ball, bend, clusters_below, tube};
use glam::{DVec3, Vec3};

/// The part that the tests edit.
const PART: PartId = PartId(3);

/// All data of a cluster: its entry, and everything that it points to.
fn stored(clusters: &Clusters, cluster: &Cluster) -> String {
    let (rest, joints) = (cluster.rest(clusters), cluster.joints(clusters));
    let (vertices, triangles) = (cluster.vertices(clusters), cluster.triangles(clusters));
    let corners = cluster.corners(clusters);
    format!("{cluster:?} {rest:?} {joints:?} {vertices:?} {triangles:?} {corners:?}")
}

/// Living clusters outside [`PART`], by index.
fn others(mesh: &ColliderMesh) -> Vec<(usize, String)> {
    let clusters = mesh.clusters();
    let all = clusters.clusters.iter().enumerate();
    all.filter(|(_, c)| c.part != PART && !c.is_dead())
        .map(|(index, c)| (index, stored(clusters, c)))
        .collect()
}

fn of_part(mesh: &ColliderMesh) -> Vec<usize> {
    let all = mesh.clusters().clusters.iter().enumerate();
    all.filter(|(_, c)| c.part == PART && !c.is_dead())
        .map(|(index, _)| index)
        .collect()
}

fn touch_everything(surface: &SkinnedSurface) -> usize {
    let everything = ball(Vec3::ZERO, f32::MAX);
    let mut hits = Vec::new();
    surface.in_model().overlap_capsule(&everything, &mut hits);
    hits.len()
}

#[test]
fn an_edit_reclusters_only_its_part_and_keeps_other_cached_results() {
    let mut surface = bent(7, 24);
    let triangle = surface.mesh().parts()[PART.index()].triangles[4];
    let corners = surface.mesh().triangles()[triangle.index()];
    let all = touch_everything(&surface);
    let touched = surface.diagnostics();
    assert_eq!(touched.clusters_skinned, touched.clusters);
    let (before, old) = (others(surface.mesh()), of_part(surface.mesh()));
    assert!(before.len() > 5 && !old.is_empty());

    let edit = |surface: &mut SkinnedSurface| {
        surface.edit(|edit| {
            edit.remove_triangle(triangle).unwrap();
            let tip = edit.add_vertex(Vec3::new(3.2, 0.9, 0.1), &rigid(3));
            let corners = [corners[0], corners[1], tip.unwrap()];
            edit.add_triangle(corners, SurfaceTag::default()).unwrap()
        })
    };
    let mut ahead = surface.clone();
    let added = edit(&mut surface);
    assert_eq!(surface.mesh().part_of(added), Some(PART));
    let new = of_part(surface.mesh());
    assert_eq!(others(surface.mesh()), before);
    assert_eq!(surface.mesh().clusters().loose, []);
    assert!(new.iter().all(|index| !old.contains(index)), "{new:?}");
    let after = surface.diagnostics();
    let wanted = Diagnostics {
        clusters: before.len() + new.len(),
        clusters_touched: before.len(),
        clusters_skinned: before.len(),
        vertices: after.vertices,
        vertices_skinned: after.vertices_skinned,
        ..touched
    };
    assert_eq!(after, wanted);
    assert!(after.vertices_skinned > 0 && after.vertices_skinned < after.vertices);
    let asked = surface.instance.current.asked_clusters();
    assert_eq!(asked.count(), before.len());

    // The rest is skinned on demand, and nothing twice.
    assert_eq!(touch_everything(&surface), all);
    assert_eq!(surface.diagnostics().clusters_skinned, wanted.clusters);
    let asked = surface.instance.current.asked_clusters();
    assert_eq!(asked.count(), wanted.clusters);
    assert_poses_hold(&surface, "lazily");

    // The same holds for clusters that were skinned ahead.
    ahead.skin_ahead();
    edit(&mut ahead);
    let diagnostics = ahead.diagnostics();
    assert_eq!(diagnostics.clusters_skinned, before.len());
    assert_eq!(diagnostics.clusters_touched, 0);
    assert_eq!(ahead.instance.current.asked_clusters().count(), 0);
    assert_poses_hold(&ahead, "ahead");
    // Dead clusters are not skinned and do not enlarge any bound.
    ahead.skin_ahead();
    let diagnostics = ahead.diagnostics();
    assert_eq!(diagnostics.clusters_skinned, diagnostics.clusters);
    let mut empty = 0;
    let mesh = ahead.mesh();
    for (index, node) in (0..).zip(&mesh.hierarchy().nodes) {
        let bounds = ahead.instance.current.bounds(mesh, index);
        for lane in 0..usize::from(node.lanes) {
            let below = clusters_below(mesh.hierarchy(), node.child(lane));
            let clusters = &mesh.clusters().clusters;
            let dead = below.iter().all(|c| clusters[*c as usize].is_dead());
            assert_eq!(bounds.is_empty(lane), dead, "node {index}, lane {lane}");
            empty += usize::from(dead);
        }
    }
    assert!(empty >= old.len(), "{empty}");
    assert_poses_hold(&ahead, "ahead again");
}

#[test]
fn dead_clusters_do_not_prevent_skinning_ahead() {
    let mut surface = bent(7, 24);
    let mesh = ColliderMesh::clone(surface.mesh());
    surface.edit(|edit| {
        for part in &mesh.parts()[..6] {
            let corners = mesh.triangles()[part.triangles[0].index()];
            edit.add_triangle(corners, SurfaceTag::default()).unwrap();
        }
    });
    let clusters = surface.mesh().clusters();
    assert!(clusters.dead * 3 > clusters.living(), "{}", clusters.dead);
    touch_everything(&surface);
    advance(&mut surface, &bend(7, DVec3::Z, 0.4));
    let diagnostics = surface.diagnostics();
    assert_eq!(diagnostics.clusters_skinned, diagnostics.clusters);
}

#[test]
fn a_change_of_tag_touches_no_cluster() {
    let mut surface = bent(5, 12);
    touch_everything(&surface);
    let mesh = ColliderMesh::clone(surface.mesh());
    let before = surface.diagnostics();
    let tag = SurfaceTag::default().with_user(1);
    surface
        .edit(|edit| edit.set_tag(TriangleId(7), tag))
        .unwrap();
    assert_eq!(surface.mesh().tags()[7], tag);
    assert_eq!(surface.diagnostics(), before);
    assert_eq!(surface.mesh().clusters(), mesh.clusters());
    assert_eq!(surface.mesh().hierarchy(), mesh.hierarchy());
}

#[test]
fn ten_thousand_edits_take_at_most_three_times_the_memory_of_a_rebuild() {
    let mut surface = bent(5, 10);
    let (mut rng, mut most) = (fastrand::Rng::with_seed(97), 0.0f64);
    let mut model = Model::of(&surface);
    let mut made = 0;
    while made < 10_000 {
        surface.edit(|edit| {
            for _ in 0..5 {
                model.change(edit, &mut rng);
            }
        });
        made = model.made.iter().sum();
        if rng.u32(0..100) == 0 {
            let mut fresh = surface.mesh().as_ref().clone();
            fresh.cluster();
            let fresh = SkinnedSurface::new(fresh.into());
            let share = surface.memory() as f64 / fresh.memory() as f64;
            most = most.max(share);
        }
    }
    assert!(most > 1.0 && most < 3.0, "{most}");
}

#[test]
fn triangles_are_found_after_all_were_removed_and_added_again() {
    let mut surface = bent(4, 8);
    let mesh = surface.mesh().clone();
    let all = touch_everything(&surface);
    for round in 0..3 {
        surface.edit(|edit| {
            for id in (0..).map(TriangleId).take(mesh.triangles().len()) {
                assert_eq!(edit.remove_triangle(id).is_ok(), round == 0, "{id}");
            }
        });
        if round > 0 {
            let ids = (0..surface.mesh().triangles().len() as u32).map(TriangleId);
            let left: Vec<_> = ids.filter(|t| surface.is_enabled(*t)).collect();
            assert_eq!(left.len(), all);
            surface.edit(|edit| {
                for id in left {
                    edit.remove_triangle(id).unwrap();
                }
            });
        }
        assert_eq!(touch_everything(&surface), 0);
        assert_eq!(surface.diagnostics().clusters, 0);
        surface.skin_ahead();
        assert_eq!(touch_everything(&surface), 0);
        let nearest = surface.in_model().closest_point(Vec3::ZERO, f32::INFINITY);
        assert_eq!(nearest, None);
        let vertices = mesh.positions().len();
        assert_eq!(surface.mesh().clusters().loose.len(), vertices);
        assert_poses_hold(&surface, "nothing left");
        surface.edit(|edit| {
            for corners in mesh.triangles() {
                let [a, b, c]: [VertexId; 3] = *corners;
                edit.add_triangle([b, c, a], SurfaceTag::default()).unwrap();
            }
        });
        assert_eq!(touch_everything(&surface), all);
        assert_poses_hold(&surface, "all again");
    }
}

#[test]
fn hundreds_of_clusters_are_all_skinned_after_an_edit() {
    // Large enough that several tasks skin it, with feature `rayon`.
    let mut surface = SkinnedSurface::new(tube(20, 160));
    assert_poses_hold(&surface, "built");
    surface.edit(|edit| {
        edit.remove_vertex(VertexId(5_000)).unwrap();
        edit.add_vertex(Vec3::Y, &rigid(0)).unwrap();
    });
    assert!(surface.mesh().clusters().living() > 256);
    assert_poses_hold(&surface, "edited");
}

#[test]
#[ignore = "measures: run it in release"]
fn time_of_edits_of_a_mesh_of_a_hundred_thousand_triangles() {
    let mut surface = SkinnedSurface::new(tube(50, 256));
    touch_everything(&surface);
    let time = |work: &mut dyn FnMut()| {
        let start = std::time::Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    };
    let lists = time(&mut || assert_eq!(surface.mesh().parts().len(), 50));
    println!("lists of the parts, which the first edit would make: {lists:.2} ms");
    let mut edit = |name: &str, parts: Range<usize>| {
        let triangles = surface.mesh().parts()[parts].iter().map(|p| p.triangles[0]);
        let triangles: Vec<_> = triangles.collect();
        let ms = time(&mut || {
            surface.edit(|edit| {
                for triangle in &triangles {
                    edit.remove_triangle(*triangle).unwrap();
                }
            });
        });
        println!("{name}: {ms:.2} ms");
    };
    edit("the first edit, of one part", 20..21);
    for part in 30..35 {
        edit("an edit of another part", part..part + 1);
    }
    edit("an edit of the same part", 30..31);
    edit("an edit of ten parts", 10..20);
    let before = surface.mesh().clusters().clusters.len();
    let mut mesh = surface.mesh().as_ref().clone();
    let (triangles, parts) = (mesh.triangles().len(), mesh.parts().len());
    println!("{triangles} triangles, {parts} parts, {before} clusters");
    println!("all anew: {:.2} ms", time(&mut || mesh.cluster()));
}
