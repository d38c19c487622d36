//! A box around the whole surface, from the palette alone.
//!
//! Let `(c_i, r_i)` be a ball around the rest positions of all vertices that joint i moves. A skinned vertex is
//! `sum w_i M_i p`, and each `M_i p` lies in the ball `(M_i c_i, s_i r_i)`. So the vertex lies in the convex hull
//! of these balls, and in every box that holds them all.
//!
//! Each coordinate of a vertex that is skinned in f32 is off by at most
//! `g(n + 4) sum w_i (s_i |p| + |t_i|) + (4 n + 4) 2^-149` ([`crate::skin`]), with `g(k) = k u / (1 - k u)` and
//! `u = 2^-24`. The first term is the same convex combination, so enlarging the ball of each joint by
//! `g(n + 4) (s_i max |p| + |t_i|)` covers it. The second term is added as well. The box is computed in f64; the
//! some 20 roundings of 2^-53 that this takes are covered by one unit more: `g(n + 5)`.

use glam::{DVec3, Vec3};

use super::JointTable;
use super::joint_table::Joint;
use crate::geometry::{round_up_to_f32, widen};
use crate::mesh::{JointBall, JointBalls};

/// An axis-aligned box in model space. For a mesh without vertices it is empty: `min` is above `max`.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct RootBox {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl RootBox {
    /// The smallest box that holds both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }
}

/// A box that holds every vertex, as f32 skinning computes it. O(joints).
///
/// # Panics
/// If the palette that the table has read has fewer matrices than the mesh has joints.
pub(crate) fn root_box(balls: &JointBalls, table: &JointTable) -> RootBox {
    box_of(balls, table, &Lost::of(balls.influences))
}

/// The rounding error of skinning, per coordinate.
struct Lost {
    /// As a share of the numbers that are added up, `s_i |p| + |t_i|`.
    relative: f64,
    /// By underflow, in model units.
    underflow: f64,
}

impl Lost {
    /// For vertices with at most this many influences.
    fn of(influences: usize) -> Self {
        let influences = influences as f64;
        let roundings = (influences + 5.0) * f64::from(f32::EPSILON) * 0.5;
        Self {
            relative: roundings / (1.0 - roundings),
            underflow: (4.0 * influences + 4.0) * f64::from(f32::from_bits(1)),
        }
    }
}

fn box_of(balls: &JointBalls, table: &JointTable, lost: &Lost) -> RootBox {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for rest in &balls.balls {
        let joint = &table.joints()[rest.joint.index()];
        let (center, radius) = (
            image(joint, widen(rest.ball.center)),
            radius(joint, rest, lost),
        );
        min = min.min(center - radius);
        max = max.max(center + radius);
    }
    let up = |v: DVec3| v.to_array().map(round_up_to_f32);
    RootBox {
        min: -Vec3::from(up(-min)),
        max: Vec3::from(up(max)),
    }
}

fn radius(joint: &Joint, rest: &JointBall, lost: &Lost) -> f64 {
    let (stretch, shift) = (f64::from(joint.stretch), f64::from(joint.shift));
    let lost = lost.relative * (stretch * f64::from(rest.reach) + shift) + lost.underflow;
    let radius = stretch * f64::from(rest.ball.radius) + lost;
    // NaN is infinity times 0: the infinite stretch of a ball of radius 0.
    if radius.is_nan() {
        f64::INFINITY
    } else {
        radius
    }
}

fn image(joint: &Joint, p: DVec3) -> DVec3 {
    let row = |m: &[f32; 4]| {
        let [x, y, z, t] = m.map(f64::from);
        x * p.x + y * p.y + z * p.z + t
    };
    let [x, y, z] = &joint.rows;
    DVec3::new(row(x), row(y), row(z))
}

#[cfg(test)]
mod tests {
    use super::super::tests::assert_in_root_box;
    use super::super::tests::random::{MOTIONS, Spread, creature, palette};
    use super::*;
    use crate::geometry::Affine;
    use crate::skin::skin;
    use crate::testing::{bend, direction, influence, tube};

    #[test]
    fn no_vertex_lies_outside_the_root_box() {
        let mut rng = fastrand::Rng::with_seed(61);
        let mut checked = 0;
        for case in 0..900 {
            let spread = [Spread::Random, Spread::Few, Spread::Constant][case % 3];
            let (mesh, _) = creature(&mut rng, 1 + case % 16, spread);
            for motion in MOTIONS.into_iter().chain(MOTIONS) {
                let palette = palette(&mut rng, motion, mesh.radius());
                let case = format!("case {case}, {motion:?}");
                let found = assert_in_root_box(&mesh, palette.matrices(), &case);
                assert!(found.min.is_finite() && found.max.is_finite(), "{found:?}");
                checked += mesh.positions().len();
            }
        }
        assert!(checked > 1_000_000, "{checked}");
    }

    #[test]
    fn no_added_vertex_lies_outside_the_root_box() {
        let mut rng = fastrand::Rng::with_seed(63);
        for case in 0..400 {
            let (mut mesh, _) = creature(&mut rng, 1 + case % 4, Spread::Random);
            let balls = mesh.joint_balls().clone();
            let joints = mesh.joint_count() as u32;
            for _ in 0..6 {
                let far = mesh.radius() * [0.0, 1.0, 3.0][rng.usize(0..3)];
                let position = direction(&mut rng) * far;
                let any = |_| influence(rng.u32(0..joints), 1.0);
                let influences: Vec<_> = (0..1 + case % 7).map(any).collect();
                let vertex = mesh.check_vertex(position, &influences).unwrap();
                mesh.add_vertex(vertex);
            }
            assert_ne!(*mesh.joint_balls(), balls, "case {case}");
            assert_eq!(mesh.joint_balls().influences, mesh.max_influences());
            for motion in MOTIONS {
                let palette = palette(&mut rng, motion, mesh.radius());
                let case = format!("case {case}, {motion:?}");
                assert_in_root_box(&mesh, palette.matrices(), &case);
            }
        }
    }

    #[test]
    fn a_mesh_at_one_point_is_boxed_by_the_inflation_alone() {
        // Every joint's ball is a point here: without inflation the box would be its image in f64.
        let mut rng = fastrand::Rng::with_seed(62);
        let mut escaped = 0;
        for case in 0..2_000 {
            let (mesh, _) = creature(&mut rng, 1, Spread::Constant);
            let palette = palette(&mut rng, MOTIONS[case % 6], mesh.radius());
            let mut table = JointTable::default();
            table.update(palette.matrices());
            let mut balls = mesh.joint_balls().clone();
            assert_in_root_box(&mesh, palette.matrices(), &format!("case {case}"));
            for rest in &mut balls.balls {
                (rest.ball.center, rest.ball.radius) = (mesh.positions()[0], 0.0);
            }
            let nothing = Lost {
                relative: 0.0,
                underflow: 0.0,
            };
            let found = box_of(&balls, &table, &nothing);
            let p = skin(&mesh, palette.matrices()).unwrap()[0];
            escaped += usize::from(!(p.cmpge(found.min).all() && p.cmple(found.max).all()));
        }
        assert!(escaped > 300, "{escaped}");
    }

    #[test]
    fn the_box_of_a_bent_tube_is_tight() {
        let mesh = tube(6, 24);
        let palette = bend(6, DVec3::Z, 0.4);
        let found = assert_in_root_box(&mesh, palette.matrices(), "tube");
        let skinned = skin(&mesh, palette.matrices()).unwrap();
        let min = skinned.iter().fold(Vec3::INFINITY, |m, p| m.min(*p));
        let max = skinned.iter().fold(Vec3::NEG_INFINITY, |m, p| m.max(*p));
        let share = (found.max - found.min).length() / (max - min).length();
        assert!(share < 1.6, "{share}");
    }

    #[test]
    fn an_infinite_stretch_gives_an_infinite_box() {
        let mesh = tube(2, 8);
        let palette = [
            Affine {
                rows: [[f32::MAX; 4]; 3],
            },
            Affine::IDENTITY,
        ];
        let mut table = JointTable::default();
        table.update(&palette);
        let found = root_box(mesh.joint_balls(), &table);
        assert_eq!(found.min, Vec3::NEG_INFINITY);
        assert_eq!(found.max, Vec3::INFINITY);
    }
}
