use glam::{DAffine3, DMat3, DVec3, Vec3};

use super::*;
use crate::geometry::{Affine, Capsule, MAX_COORDINATE, Sphere, rotation_from_axis_angle, widen};
use crate::mesh::{
    BuildOptions, ColliderMesh, Influence, MeshSource, PartId, SurfaceTag, VertexId,
};
use crate::rig::{JointId, Palette};
use crate::skin::skin;
use crate::surface::{SkinnedSurface, SurfaceError};
use crate::testing::{bend, direction, point, rigid, tube};

const JOINTS: u32 = 20;
const VERTICES: usize = 60;

/// How the weights of a test creature are spread.
#[derive(Clone, Copy, Debug)]
enum Spread {
    Random,
    /// All near their mean, as in the middle of a limb.
    NearlyEqual,
    /// From 1 down to some 1e-9, which rounds to nothing, on joints in any order.
    Uneven,
    /// A vertex follows one or two joints of the node's many.
    Few,
    /// All vertices alike.
    Constant,
}

fn weight(rng: &mut fastrand::Rng, spread: Spread, k: usize) -> f32 {
    match spread {
        Spread::Random => rng.f32(),
        Spread::NearlyEqual => 1.0 + 1e-3 * rng.f32(),
        Spread::Uneven => libm::powf(10.0, -9.0 * rng.f32()),
        Spread::Few => rng.f32() * [0.0, 1.0][usize::from(rng.u32(0..4) == 0 || k == 0)],
        Spread::Constant => 1.0 + k as f32,
    }
}

/// A patch of vertices in a ball (or at one point) somewhere, of `influences` joints each, and one
/// triangle beside it, since the patch may have no area.
fn creature(
    rng: &mut fastrand::Rng,
    influences: usize,
    spread: Spread,
) -> (ColliderMesh, Vec<VertexId>) {
    let size = [1e-3, 1.0, 1e3][rng.usize(0..3)];
    let offset = direction(rng) * [0.0, 1.0, 1e3][rng.usize(0..3)];
    // A part of a creature is often thin, or small beside its distance from the origin.
    let stretch = Vec3::new(1.0, rng.f32(), rng.f32()) * size * [1e-3, 1.0][rng.usize(0..2)];
    let mut positions: Vec<Vec3> = (0..VERTICES)
        .map(|_| direction(rng) * stretch + offset)
        .collect();
    positions.extend([Vec3::ONE, Vec3::X, Vec3::Y].map(|p| (p + Vec3::ONE) * size + offset));
    let first = rng.u32(0..JOINTS);
    let mut given = Vec::new();
    for _ in 0..positions.len() {
        for k in 0..influences {
            given.push(Influence {
                joint: JointId((first + k as u32) % JOINTS),
                weight: weight(rng, spread, k),
            });
        }
    }
    let triangles: Vec<[u32; 3]> = (0..21).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    let source = MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &given,
        influence_ends: &[],
        tags: &[],
        joint_count: JOINTS as usize,
    };
    let (mesh, _) = ColliderMesh::build(&source, &BuildOptions::default()).unwrap();
    let patch = (0..mesh.positions().len() as u32 - 3).map(VertexId);
    let patch = patch.collect();
    (mesh, patch)
}

/// Kinds of random palettes.
#[derive(Clone, Copy, Debug)]
enum Motion {
    /// The whole creature as one.
    Rigid,
    /// Each joint turned a little, as in a limb.
    Bent,
    Rotations,
    NonUniform,
    Mirrored,
    /// Any elements.
    Sheared,
    Tiny,
    Subnormal,
    /// As far as a surface takes it.
    Huge,
    /// Some matrices zero.
    Zeros,
}

const MOTIONS: [Motion; 10] = [
    Motion::Rigid,
    Motion::Bent,
    Motion::Rotations,
    Motion::NonUniform,
    Motion::Mirrored,
    Motion::Sheared,
    Motion::Tiny,
    Motion::Subnormal,
    Motion::Huge,
    Motion::Zeros,
];

fn rotation(rng: &mut fastrand::Rng, angle: f64) -> DAffine3 {
    let axis = widen(direction(rng));
    DAffine3::from_quat(rotation_from_axis_angle(
        axis.normalize(),
        angle * rng.f64(),
    ))
}

fn matrix(rng: &mut fastrand::Rng, motion: Motion, radius: f32) -> DAffine3 {
    let shift = DAffine3::from_translation(widen(point(rng, radius)));
    let diagonal = |scale: Vec3| DAffine3::from_mat3(DMat3::from_diagonal(widen(scale)));
    let scale = Vec3::new(rng.f32(), rng.f32(), rng.f32()) * 4.0;
    let linear = match motion {
        Motion::Rigid | Motion::Bent => rotation(rng, 0.3),
        Motion::Rotations => rotation(rng, 6.3),
        Motion::NonUniform => rotation(rng, 6.3) * diagonal(scale) * rotation(rng, 6.3),
        Motion::Mirrored => rotation(rng, 6.3) * diagonal(Vec3::new(-1.0, 1.0, 1.0)),
        _ => {
            let mut column = || widen(point(rng, 2.0));
            DAffine3::from_mat3(DMat3::from_cols(column(), column(), column()))
        }
    };
    let map = shift * linear;
    let scaled = |factor: f64| DAffine3 {
        matrix3: map.matrix3 * factor,
        translation: map.translation * factor,
    };
    match motion {
        Motion::Tiny => scaled(1e-20),
        Motion::Subnormal => scaled(1e-43),
        Motion::Huge => {
            scaled(MAX_COORDINATE * 0.999 / Affine::from_f64(&map).reach(f64::from(radius)))
        }
        Motion::Zeros if rng.bool() => scaled(0.0),
        _ => map,
    }
}

fn palette(rng: &mut fastrand::Rng, motion: Motion, radius: f32) -> Palette {
    let one = matrix(rng, motion, radius);
    let matrices = (0..JOINTS).map(|_| match motion {
        Motion::Rigid => one,
        Motion::Bent => one * rotation(rng, 0.3),
        _ => matrix(rng, motion, radius),
    });
    Palette::from_matrices(matrices.map(|m| Affine::from_f64(&m)))
}

/// Checks all bounds of a node against all of its vertices; gives how many were checked.
fn check(mesh: &ColliderMesh, vertices: &[VertexId], palette: &Palette, case: &str) -> usize {
    let node = NodeBounds::new(mesh, vertices).unwrap();
    let maps = JointMaps::new(mesh, palette).unwrap();
    check_node(
        &node,
        &skin(mesh, palette.matrices()).unwrap(),
        vertices,
        &maps,
        case,
    )
}

fn check_node(
    node: &NodeBounds,
    skinned: &[Vec3],
    vertices: &[VertexId],
    maps: &JointMaps,
    case: &str,
) -> usize {
    let (hull, interval) = (node.hull(maps), node.weight_interval(maps));
    let (sphere, capsule) = (node.sphere(maps), node.capsule(maps));
    assert!(
        hull.radius.is_finite() && interval.radius.is_finite(),
        "{case}"
    );
    assert!(capsule.radius.is_finite(), "{case}");
    for v in vertices {
        let p = skinned[v.index()];
        assert!(hull.contains(p), "{case}: {p} outside hull {hull:?}");
        assert!(
            interval.contains(p),
            "{case}: {p} outside interval {interval:?}"
        );
        assert!(sphere.contains(p), "{case}: {p} outside {sphere:?}");
        assert!(capsule.contains(p), "{case}: {p} outside {capsule:?}");
        assert!(node.volume(maps).contains(p), "{case}: {p}");
    }
    vertices.len()
}

#[test]
fn no_vertex_lies_outside_whatever_the_creature_and_the_palette() {
    let mut rng = fastrand::Rng::with_seed(51);
    let mut checked = 0;
    for case in 0..2_400 {
        let influences = 1 + case % 16;
        let spread = [
            Spread::Random,
            Spread::NearlyEqual,
            Spread::Uneven,
            Spread::Few,
            Spread::Constant,
        ][case / 16 % 5];
        let (mesh, all) = creature(&mut rng, influences, spread);
        let small = all[..rng.usize(1..6).min(all.len())].to_vec();
        let nodes = [&all[..], &small].map(|v| (v, NodeBounds::new(&mesh, v).unwrap()));
        for motion in MOTIONS.into_iter().chain(MOTIONS) {
            let palette = palette(&mut rng, motion, mesh.radius());
            let maps = JointMaps::new(&mesh, &palette).unwrap();
            let skinned = skin(&mesh, palette.matrices()).unwrap();
            for (vertices, node) in &nodes {
                let case = format!("case {case}, {influences} {spread:?}, {motion:?}");
                checked += check_node(node, &skinned, vertices, &maps, &case);
            }
        }
    }
    assert!(checked > 2_000_000, "{checked} vertices");
}

#[test]
fn a_kilometre_away_what_skinning_rounds_is_within_the_bound() {
    // Rest radius and weights add nothing here: only the inflation holds the vertex.
    let mut rng = fastrand::Rng::with_seed(52);
    let (mut checked, mut outside) = (0, 0);
    for case in 0..2_000 {
        let (mesh, _) = creature(&mut rng, 1 + case % 16, Spread::Random);
        let shift = widen(direction(&mut rng)) * 1e3;
        let turn = rotation_from_axis_angle(widen(direction(&mut rng)).normalize(), 1.0);
        let palette = rigid(JOINTS, turn, shift);
        checked += check(&mesh, &[VertexId(0)], &palette, &format!("case {case}"));
        // The same ball without inflation, to see that this test sees something.
        let maps = JointMaps::new(&mesh, &palette).unwrap();
        let node = NodeBounds::new(&mesh, &[VertexId(0)]).unwrap();
        let center = node.weight_interval(&maps).center;
        let skinned = skin(&mesh, palette.matrices()).unwrap()[0];
        outside += usize::from(center != skinned);
    }
    assert!(checked == 2_000 && outside > 500, "{outside} of {checked}");
}

#[test]
fn at_rest_the_bound_is_the_rest_ball_by_a_hair() {
    let mesh = tube(4, 16);
    let bounds = PartBounds::new(&mesh);
    let palette = Palette::from_matrices([Affine::IDENTITY; 4]);
    let maps = JointMaps::new(&mesh, &palette).unwrap();
    assert_eq!(bounds.part_count(), mesh.parts().len());
    for (k, part) in mesh.parts().iter().enumerate() {
        let id = PartId(k as u32);
        check(&mesh, &part.vertices, &palette, &format!("{id}"));
        let node = bounds.node(id).unwrap();
        let (rest, sphere) = (node.rest_sphere(), bounds.sphere(id, &maps).unwrap());
        let share = sphere.radius / rest.radius;
        assert!(
            (1.0..1.00001).contains(&share),
            "{id}: {sphere:?}, {rest:?}"
        );
        let (rest, capsule) = (node.rest_capsule(), bounds.capsule(id, &maps).unwrap());
        let share = capsule.radius / rest.radius;
        assert!(
            (1.0..1.00001).contains(&share),
            "{id}: {capsule:?}, {rest:?}"
        );
    }
}

#[test]
fn on_a_bent_tube_the_sphere_is_within_a_fifth_of_the_tightest() {
    let mesh = tube(6, 24);
    let bounds = PartBounds::new(&mesh);
    let mut worst = [0.0f32; 2];
    for step in 0..40 {
        let palette = bend(6, DVec3::new(0.0, 0.6, 0.8), f64::from(step) * 0.03 - 0.6);
        let maps = JointMaps::new(&mesh, &palette).unwrap();
        let skinned = skin(&mesh, palette.matrices()).unwrap();
        for (k, part) in mesh.parts().iter().enumerate() {
            let id = PartId(k as u32);
            check(
                &mesh,
                &part.vertices,
                &palette,
                &format!("step {step}, part {id}"),
            );
            let positions = part.vertices.iter().map(|v| skinned[v.index()]);
            let tightest = Sphere::nearly_smallest(positions.clone()).unwrap();
            let sphere = bounds.sphere(id, &maps).unwrap();
            worst[0] = worst[0].max(sphere.radius / tightest.radius);
            let tightest = Capsule::around_principal_axis(positions).unwrap();
            let capsule = bounds.capsule(id, &maps).unwrap();
            worst[1] = worst[1].max(capsule.radius / tightest.radius);
        }
    }
    assert!(worst[0] < 1.2 && worst[1] < 1.6, "{worst:?}");
}

#[test]
fn the_smaller_of_hull_and_weight_interval_counts() {
    let mut rng = fastrand::Rng::with_seed(53);
    let mut hulls = 0;
    for case in 0..400 {
        let spread = [Spread::Random, Spread::Few, Spread::NearlyEqual][case % 3];
        let (mesh, all) = creature(&mut rng, 1 + case % 5, spread);
        let node = NodeBounds::new(&mesh, &all).unwrap();
        let palette = palette(&mut rng, Motion::Rotations, mesh.radius());
        let maps = JointMaps::new(&mesh, &palette).unwrap();
        let (hull, interval) = (node.hull(&maps), node.weight_interval(&maps));
        let sphere = node.sphere(&maps);
        let smaller = hull.radius.min(interval.radius);
        assert!(
            sphere.radius <= smaller.next_up(),
            "case {case}: {sphere:?}, {smaller}"
        );
        hulls += usize::from(hull.radius < interval.radius);
    }
    assert!((40..360).contains(&hulls), "hull smaller in {hulls} of 400");
}

#[test]
fn one_vertex_has_its_skinned_position_and_no_more() {
    let mesh = tube(4, 12);
    let palette = bend(4, DVec3::Z, 0.5);
    let maps = JointMaps::new(&mesh, &palette).unwrap();
    let skinned = skin(&mesh, palette.matrices()).unwrap();
    for (v, position) in skinned.iter().enumerate() {
        let node = NodeBounds::new(&mesh, &[VertexId(v as u32)]).unwrap();
        let sphere = node.sphere(&maps);
        assert!(
            sphere.contains(*position) && sphere.radius < 2e-5,
            "{v}: {sphere:?}"
        );
        let capsule = node.capsule(&maps);
        assert!(
            capsule.contains(*position) && capsule.radius < 2e-5,
            "{v}: {capsule:?}"
        );
    }
}

#[test]
fn middles_of_weights_add_up_to_exactly_one() {
    let mut rng = fastrand::Rng::with_seed(54);
    for case in 0..300 {
        let spread = [Spread::Uneven, Spread::Few][case / 16 % 2];
        let (mesh, patch) = creature(&mut rng, 1 + case % 16, spread);
        let vertices = patch[..rng.usize(1..=patch.len())].to_vec();
        let node = NodeBounds::new(&mesh, &vertices).unwrap();
        let sum: f64 = node.intervals().iter().map(|i| f64::from(i.middle)).sum();
        assert_eq!(sum, 1.0, "case {case}");
        for v in &vertices {
            for interval in node.intervals() {
                let weight = mesh.influences(*v).find(|(j, _)| *j == interval.joint);
                let weight = weight.map_or(0.0, |(_, w)| w);
                let (low, high) = (interval.low, interval.high);
                assert!((low..=high).contains(&weight), "case {case}: {interval:?}");
                let off = (weight - interval.middle).abs();
                assert!(off <= interval.deviation, "case {case}: {interval:?}");
            }
        }
    }
}

#[test]
fn parts_without_triangles_and_bad_input() {
    let mesh = tube(3, 8);
    let mut surface = SkinnedSurface::new(mesh.clone());
    for triangle in &mesh.parts()[0].triangles {
        surface.remove_triangle(*triangle).unwrap();
    }
    let bounds = PartBounds::new(surface.mesh());
    let palette = Palette::from_matrices([Affine::IDENTITY; 3]);
    let mut maps = JointMaps::new(surface.mesh(), &palette).unwrap();
    assert_eq!(bounds.sphere(PartId(0), &maps), None);
    assert_eq!(bounds.capsule(PartId(99), &maps), None);
    assert!(bounds.volume(PartId(1), &maps).is_some());

    // A part that an edit appended is bounded as well.
    let corners = mesh.triangles()[mesh.parts()[0].triangles[0].index()];
    surface
        .add_triangle(corners, SurfaceTag::default())
        .unwrap();
    assert!(PartBounds::new(surface.mesh()).node(PartId(0)).is_some());

    assert!(NodeBounds::new(&mesh, &[]).is_none());
    assert!(NodeBounds::new(&mesh, &[VertexId(u32::MAX)]).is_none());
    let short = Palette::from_matrices([Affine::IDENTITY; 2]);
    let refused = maps.update(&mesh, &short);
    assert!(matches!(
        refused,
        Err(SurfaceError::JointCount {
            expected: 3,
            found: 2
        })
    ));
    for bad in [f32::NAN, f32::INFINITY, 2e30] {
        let mut broken = Affine::IDENTITY;
        broken.rows[1][2] = bad;
        let palette = Palette::from_matrices([Affine::IDENTITY, broken, Affine::IDENTITY]);
        let refused = maps.update(&mesh, &palette);
        assert!(
            matches!(refused, Err(SurfaceError::Palette(JointId(1)))),
            "{bad}"
        );
    }
    assert!(
        maps.stretch(JointId(2))
            .is_some_and(|s| (1.0..1.0001).contains(&s))
    );
    assert!(maps.stretch(JointId(3)).is_none());
}
