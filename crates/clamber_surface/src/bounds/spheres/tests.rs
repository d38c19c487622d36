//! Checks that the eight-wide spheres hold every vertex that they must hold, that all instruction sets give the
//! same bits, and that the spheres are as small as an f64 reference.

use glam::{DAffine3, DVec3};

use super::super::tests::node_of;
use super::super::tests::random::{JOINTS, MOTIONS, Motion, Spread, creature, palette};
use super::*;
use crate::geometry::{Affine, widen};
use crate::mesh::{ColliderMesh, VertexId};
use crate::rig::Palette;
use crate::skin::skin;
use crate::testing::{bend, direction, tube};

/// A node of random children of a random creature.
struct Case {
    mesh: ColliderMesh,
    children: Vec<Vec<VertexId>>,
    hierarchy: Hierarchy,
    table: JointTable,
}

impl Case {
    fn new(rng: &mut fastrand::Rng, case: usize) -> Self {
        let spread = Spread::ALL[case / 16 % 5];
        let (mesh, mut all) = creature(rng, 1 + case % 16, spread);
        let children: Vec<Vec<VertexId>> = (0..rng.usize(1..=LANES))
            .map(|_| {
                rng.shuffle(&mut all);
                let most = [1, 3, all.len()][rng.usize(0..3)].min(all.len());
                all[..rng.usize(1..=most)].to_vec()
            })
            .collect();
        Self {
            hierarchy: node_of(&mesh, &children),
            mesh,
            children,
            table: JointTable::default(),
        }
    }

    /// A palette of the given kind. About every other one moves the creature a kilometre away.
    fn pose(&mut self, rng: &mut fastrand::Rng, motion: Motion) -> Palette {
        let mut posed = palette(rng, motion, self.mesh.radius());
        if rng.bool() && !matches!(motion, Motion::Huge) {
            let shift = DAffine3::from_translation(widen(direction(rng)) * 1e3);
            let moved = posed.matrices().iter().map(|m| shift * m.to_f64());
            posed = Palette::from_matrices(moved.map(|m| Affine::from_f64(&m)));
        }
        self.table.update(posed.matrices());
        posed
    }

    fn spheres(&self, level: SimdLevel) -> Spheres {
        node_spheres(level, &self.hierarchy, &self.table)
    }

    /// The number of vertices outside their sphere, and the number of vertices checked.
    fn outside(&self, palette: &Palette) -> (usize, usize) {
        let found = self.spheres(SimdLevel::best());
        let skinned = skin(&self.mesh, palette.matrices()).unwrap();
        let (mut outside, mut checked) = (0, 0);
        for (lane, vertices) in self.children.iter().enumerate() {
            let sphere = found.sphere(lane);
            let escaped = vertices
                .iter()
                .filter(|v| !sphere.contains(skinned[v.index()]));
            outside += escaped.count();
            checked += vertices.len();
        }
        (outside, checked)
    }
}

fn node_spheres(level: SimdLevel, hierarchy: &Hierarchy, table: &JointTable) -> Spheres {
    spheres(level, hierarchy, &hierarchy.nodes[0], table)
}

/// Asserts that no vertex lies outside its sphere, for at least `checks` random vertices. Returns their number.
fn hunt(seed: u64, checks: usize) -> usize {
    let mut rng = fastrand::Rng::with_seed(seed);
    let (mut checked, mut case) = (0, 0);
    while checked < checks {
        let mut node = Case::new(&mut rng, case);
        for motion in MOTIONS.into_iter().chain(MOTIONS) {
            let palette = node.pose(&mut rng, motion);
            let (outside, seen) = node.outside(&palette);
            assert_eq!(outside, 0, "seed {seed}, case {case}, {motion:?}");
            let found = node.spheres(SimdLevel::best());
            assert!(found.radius.iter().all(|r| *r >= 0.0), "{found:?}");
            let may_be =
                matches!(motion, Motion::Huge) || found.radius.iter().all(|r| r.is_finite());
            assert!(may_be, "{motion:?}: {found:?}");
            checked += seen;
        }
        case += 1;
    }
    checked
}

#[test]
fn no_vertex_lies_outside_its_lane() {
    assert!(hunt(71, 1_500_000) >= 1_500_000);
}

#[test]
#[ignore = "a thousand million checks: takes minutes in release mode"]
fn no_vertex_lies_outside_its_lane_in_a_long_search() {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    let checked: usize = std::thread::scope(|scope| {
        let hunts: Vec<_> = (0..threads as u64)
            .map(|k| scope.spawn(move || hunt(1_000 + k, 1_000_000_000 / threads)))
            .collect();
        hunts.into_iter().map(|hunt| hunt.join().unwrap()).sum()
    });
    println!("{checked} vertices checked");
}

#[test]
fn without_inflation_vertices_escape() {
    let mut rng = fastrand::Rng::with_seed(72);
    let (mut escaped, mut checked) = (0, 0);
    for case in 0..300 {
        let mut node = Case::new(&mut rng, case);
        node.hierarchy.nodes[0].inflation = [0.0; LANES];
        for motion in MOTIONS {
            let palette = node.pose(&mut rng, motion);
            let (outside, seen) = node.outside(&palette);
            (escaped, checked) = (escaped + outside, checked + seen);
        }
    }
    assert!(escaped * 100 > checked, "{escaped} of {checked}");
}

fn bits(spheres: &Spheres) -> [[u32; LANES]; 4] {
    [spheres.x, spheres.y, spheres.z, spheres.radius].map(|row| row.map(f32::to_bits))
}

#[test]
fn every_instruction_set_gives_the_same_bits() {
    let mut rng = fastrand::Rng::with_seed(73);
    for case in 0..400 {
        let mut node = Case::new(&mut rng, case);
        for motion in MOTIONS {
            node.pose(&mut rng, motion);
            let wanted = bits(&node.spheres(SimdLevel::best()));
            for level in SimdLevel::available() {
                let found = bits(&node.spheres(level));
                assert_eq!(found, wanted, "case {case}, {motion:?}, {level}");
            }
        }
    }
}

#[test]
fn a_joint_that_moves_no_vertex_of_a_lane_does_not_widen_it() {
    let mesh = tube(4, 8);
    // One lane at each end of the tube: the first follows joint 0 alone.
    let ends = [0.0, 3.0].map(|x| {
        let vertices = (0..mesh.positions().len() as u32).map(VertexId);
        vertices
            .filter(|v| mesh.positions()[v.index()].x == x)
            .collect::<Vec<_>>()
    });
    let hierarchy = node_of(&mesh, &ends);
    let mut table = JointTable::default();
    let mut far = Affine::IDENTITY;
    far.rows = far.rows.map(|row| row.map(|m| m * 100.0));
    far.rows[0][3] = 1e6;
    table.update(&[Affine::IDENTITY, Affine::IDENTITY, Affine::IDENTITY, far]);
    let found = node_spheres(SimdLevel::best(), &hierarchy, &table);
    assert!(found.radius[0] < 0.500_01, "{found:?}");
    assert!(found.radius[1] >= 50.0, "{found:?}");
}

#[test]
fn overflow_gives_an_infinite_radius_and_never_nan() {
    let mesh = tube(2, 8);
    let all: Vec<VertexId> = (0..mesh.positions().len() as u32).map(VertexId).collect();
    let hierarchy = node_of(&mesh, &[all, vec![VertexId(0)]]);
    let mut table = JointTable::default();
    let at = |x: f32, scale: f32| Affine {
        rows: [[scale, 0.0, 0.0, x], [0.0; 4], [0.0; 4]],
    };
    let huge = Affine {
        rows: [[f32::MAX, f32::MAX, f32::MAX, 0.0]; 3],
    };
    let far = 1e30;
    for palette in [
        [at(far, 1.0), at(-far, 1.0)],
        [at(0.0, f32::MAX), at(0.0, f32::MAX)],
        [huge, Affine::IDENTITY],
    ] {
        table.update(&palette);
        for level in SimdLevel::available() {
            let found = node_spheres(level, &hierarchy, &table);
            let is_nan = found.radius.iter().any(|r| r.is_nan());
            assert!(!is_nan, "{level}: {found:?}");
            assert_eq!(found.radius[0], f32::INFINITY, "{level}: {found:?}");
        }
    }
}

/// The radius in f64 of the sphere of a lane, by the weight intervals and by the hull: about the same centre, and
/// without the terms for rounding.
fn reference(hierarchy: &Hierarchy, lane: usize, palette: &Palette) -> [f64; 2] {
    let node = &hierarchy.nodes[0];
    let rest = DVec3::new(
        node.x[lane].into(),
        node.y[lane].into(),
        node.z[lane].into(),
    );
    let radius = f64::from(node.radius[lane]);
    let rows = node.joints(hierarchy).iter().zip(node.weights(hierarchy));
    let moving = rows.filter(|(_, w)| w.middle[lane] + w.deviation[lane] > 0.0);
    let images: Vec<_> = moving
        .map(|(joint, weights)| {
            let map = palette.matrices()[*joint as usize].to_f64();
            let columns = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
            // This is asked only of rotations times a uniform scale.
            let stretch = columns.map(DVec3::length).into_iter().fold(0.0, f64::max);
            (map.transform_point3(rest), stretch, weights)
        })
        .collect();
    let center: DVec3 = images
        .iter()
        .map(|(image, _, weights)| *image * f64::from(weights.middle[lane]))
        .sum();
    let (mut apart, mut stretch, mut hull) = (0.0, 0.0f64, 0.0f64);
    for (image, joint, weights) in &images {
        let distance = (*image - center).length();
        apart += f64::from(weights.deviation[lane]) * distance;
        stretch = stretch.max(*joint);
        hull = hull.max(distance + radius * joint);
    }
    [radius * stretch + apart, hull]
}

/// Ratios of the eight-wide radii to the radii of the f64 reference, and the number of spheres whose hull was smaller.
#[derive(Default)]
struct Ratios {
    ratios: Vec<f64>,
    hulls: usize,
}

impl Ratios {
    fn measure(&mut self, mesh: &ColliderMesh, sets: &[Vec<VertexId>], palette: &Palette) {
        let mut table = JointTable::default();
        table.update(palette.matrices());
        for children in sets.chunks(LANES) {
            let hierarchy = node_of(mesh, children);
            let found = node_spheres(SimdLevel::best(), &hierarchy, &table);
            for lane in 0..children.len() {
                let [interval, hull] = reference(&hierarchy, lane, palette);
                let exact = interval.min(hull);
                // The radius of a small set far from the origin is mostly the term for rounding.
                if exact > f64::from(hierarchy.nodes[0].reach[lane]) * 1e-2 {
                    self.ratios.push(f64::from(found.radius[lane]) / exact);
                }
                self.hulls += usize::from(hull < interval);
            }
        }
    }

    /// The smallest ratio, the largest ratio, and the share of hulls.
    fn range(&mut self) -> (f64, f64, f64) {
        self.ratios.sort_by(f64::total_cmp);
        let count = self.ratios.len();
        let share = self.hulls as f64 / count as f64;
        (self.ratios[0], self.ratios[count - 1], share)
    }
}

#[test]
fn on_a_bent_tube_spheres_are_as_small_as_the_reference() {
    let mesh = tube(6, 24);
    let parts = mesh.parts().iter();
    let chunks = parts.flat_map(|part| part.vertices.chunks(40));
    let sets: Vec<Vec<VertexId>> = chunks.map(<[_]>::to_vec).collect();
    let mut ratios = Ratios::default();
    for step in 0..40 {
        let palette = bend(6, DVec3::new(0.0, 0.6, 0.8), f64::from(step) * 0.03 - 0.6);
        ratios.measure(&mesh, &sets, &palette);
    }
    let (least, worst, _) = ratios.range();
    assert!(least >= 1.0 && worst < 1.0001, "{least} to {worst}");
}

#[test]
fn the_smaller_of_hull_and_weight_interval_is_used() {
    let mut rng = fastrand::Rng::with_seed(53);
    let mut ratios = Ratios::default();
    for case in 0..400 {
        let spread = [Spread::Random, Spread::Few, Spread::NearlyEqual][case % 3];
        let (mesh, all) = creature(&mut rng, 1 + case % 5, spread);
        let palette = palette(&mut rng, Motion::Rotations, mesh.radius());
        ratios.measure(&mesh, &[all], &palette);
    }
    let (least, worst, hulls) = ratios.range();
    assert!(least >= 1.0 && worst < 1.01, "{least} to {worst}");
    assert!((0.1..0.9).contains(&hulls), "{hulls}");
}

#[test]
fn a_node_lists_the_joints_of_its_children_once() {
    let mut rng = fastrand::Rng::with_seed(74);
    for case in 0..200 {
        let node = Case::new(&mut rng, case);
        let joints = &node.hierarchy.joints;
        let ascends = joints.windows(2).all(|pair| pair[0] < pair[1]);
        assert!(ascends, "{joints:?}");
        assert!(joints.iter().all(|joint| *joint < JOINTS), "{joints:?}");
        assert_eq!(joints.len(), node.hierarchy.weights.len());
        for lane in 0..LANES {
            let weights = node.hierarchy.weights.iter();
            let middles = weights.map(|w| f64::from(w.middle[lane]));
            let child = f64::from(u8::from(lane < node.children.len()));
            assert_eq!(middles.sum::<f64>(), child, "case {case}, lane {lane}");
        }
    }
}
