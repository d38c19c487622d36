//! A box around the whole surface, from the palette alone.
//!
//! Let `(c_i, r_i)` be a ball at rest around all vertices that joint i moves. A skinned vertex is
//! `sum w_i M_i p`, and each `M_i p` lies in the ball `(M_i c_i, s_i r_i)`, so the vertex lies in the
//! convex hull of these balls, and in every box that holds them all. A coordinate of a vertex that
//! f32 skinned is off by at most `g(n + 4) sum w_i (s_i |p| + |t_i|) + (4 n + 4) 2^-149`
//! ([`crate::skin::error_bound`]), which is the same convex combination: growing each joint's ball
//! by `g(n + 4) (s_i max |p| + |t_i|)` pays for it, with `g(k) = k u / (1 - k u)`, `u = 2^-24`. All is
//! computed in f64, whose some 20 roundings of 2^-53 are within one unit more: `g(n + 5)`.

use glam::{DVec3, Vec3};

use super::JointTable;
use super::joint_table::Joint;
use crate::geometry::{Sphere, round_up_to_f32, widen};
use crate::mesh::{ColliderMesh, VertexId};
use crate::rig::JointId;

/// Axis-aligned, in model space. Empty, `min` above `max`, for a mesh without vertices.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct RootBox {
    pub(crate) min: Vec3,
    pub(crate) max: Vec3,
}

impl RootBox {
    /// Holds both.
    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }
}

/// Rest data for [`RootBox`]: for each joint the ball of the vertices that it moves.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct RootBalls {
    /// By ascending joint.
    balls: Vec<RestBall>,
    /// The most that one vertex has.
    influences: usize,
    /// Per coordinate, what skinning may lose as a share of what it adds up.
    relative: f64,
    /// Per coordinate, what it may lose by underflow.
    underflow: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct RestBall {
    joint: u32,
    center: DVec3,
    radius: f64,
    /// Largest distance of a vertex or the centre from the mesh's origin, rounded up.
    reach: f64,
}

impl RootBalls {
    /// Reads all vertices of a mesh, those without triangles included: some 66 passes over them.
    pub(crate) fn new(mesh: &ColliderMesh) -> Self {
        let mut moved: Vec<Vec<Vec3>> = vec![Vec::new(); mesh.joint_count()];
        for (v, position) in mesh.positions().iter().enumerate() {
            for (joint, _) in mesh.influences(VertexId(v as u32)) {
                moved[joint.0 as usize].push(*position);
            }
        }
        let balls = (0..).zip(&moved).filter_map(|(joint, positions)| {
            let sphere = Sphere::nearly_smallest(positions.iter().copied())?;
            let points = positions.iter().chain([&sphere.center]);
            let reach_sq = points.map(|p| widen(*p).length_squared());
            Some(RestBall {
                joint,
                center: widen(sphere.center),
                radius: f64::from(sphere.radius),
                reach: reach_sq.fold(0.0, f64::max).sqrt() * (1.0 + 1e-15),
            })
        });
        let mut found = Self {
            balls: balls.collect(),
            ..Self::default()
        };
        found.allow_for(mesh.max_influences());
        found
    }

    /// Grows so as to hold one more vertex, which these joints move. The balls stay where they are.
    pub(crate) fn hold(&mut self, position: Vec3, joints: impl ExactSizeIterator<Item = JointId>) {
        let position = widen(position);
        let reach = position.length() * (1.0 + 1e-15);
        self.allow_for(joints.len().max(self.influences));
        for JointId(joint) in joints {
            match self.balls.binary_search_by_key(&joint, |ball| ball.joint) {
                Ok(place) => {
                    let ball = &mut self.balls[place];
                    let distance = (position - ball.center).length() * (1.0 + 1e-15);
                    ball.radius = ball.radius.max(distance);
                    ball.reach = ball.reach.max(reach);
                }
                Err(place) => {
                    let ball = RestBall {
                        joint,
                        center: position,
                        radius: 0.0,
                        reach,
                    };
                    self.balls.insert(place, ball);
                }
            }
        }
    }

    /// Sets what skinning may lose for vertices of at most so many influences.
    fn allow_for(&mut self, influences: usize) {
        self.influences = influences;
        let influences = influences as f64;
        let roundings = (influences + 5.0) * f64::from(f32::EPSILON) * 0.5;
        self.relative = roundings / (1.0 - roundings);
        self.underflow = (4.0 * influences + 4.0) * f64::from(f32::from_bits(1));
    }

    /// A box that holds every vertex as f32 skinning yields it. O(joints).
    ///
    /// # Panics
    /// If the table has read a palette with fewer joints than the mesh has.
    pub(crate) fn bounds(&self, table: &JointTable) -> RootBox {
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for ball in &self.balls {
            let joint = &table.joints()[ball.joint as usize];
            let (center, radius) = (image(joint, ball.center), self.radius(joint, ball));
            min = min.min(center - radius);
            max = max.max(center + radius);
        }
        let up = |v: DVec3| v.to_array().map(round_up_to_f32);
        RootBox {
            min: -Vec3::from(up(-min)),
            max: Vec3::from(up(max)),
        }
    }

    fn radius(&self, joint: &Joint, ball: &RestBall) -> f64 {
        let (stretch, shift) = (f64::from(joint.stretch), f64::from(joint.shift));
        let lost = self.relative * (stretch * ball.reach + shift) + self.underflow;
        let radius = stretch * ball.radius + lost;
        // An infinite stretch of a point.
        if radius.is_nan() {
            f64::INFINITY
        } else {
            radius
        }
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
    use super::super::tests::random::{MOTIONS, Spread, creature, palette};
    use super::*;
    use crate::geometry::Affine;
    use crate::mesh::Influence;
    use crate::skin::skin;
    use crate::testing::{bend, direction, tube};

    fn bounds(mesh: &ColliderMesh, palette: &[Affine]) -> RootBox {
        let mut table = JointTable::default();
        table.update(palette);
        RootBalls::new(mesh).bounds(&table)
    }

    fn check(mesh: &ColliderMesh, palette: &[Affine], found: &RootBox, case: &str) -> usize {
        let skinned = skin(mesh, palette).unwrap();
        for p in &skinned {
            let inside = p.cmpge(found.min).all() && p.cmple(found.max).all();
            assert!(inside, "{case}: {p} outside {found:?}");
        }
        skinned.len()
    }

    #[test]
    fn no_vertex_lies_outside_the_root_box() {
        let mut rng = fastrand::Rng::with_seed(61);
        let mut checked = 0;
        for case in 0..900 {
            let spread = [Spread::Random, Spread::Few, Spread::Constant][case % 3];
            let (mesh, _) = creature(&mut rng, 1 + case % 16, spread);
            let balls = RootBalls::new(&mesh);
            let mut table = JointTable::default();
            for motion in MOTIONS.into_iter().chain(MOTIONS) {
                let palette = palette(&mut rng, motion, mesh.radius());
                table.update(palette.matrices());
                let found = balls.bounds(&table);
                assert!(found.min.is_finite() && found.max.is_finite(), "{found:?}");
                let case = format!("case {case}, {motion:?}");
                checked += check(&mesh, palette.matrices(), &found, &case);
            }
        }
        assert!(checked > 1_000_000, "{checked}");
    }

    #[test]
    fn no_vertex_that_was_added_lies_outside_the_root_box() {
        let mut rng = fastrand::Rng::with_seed(63);
        for case in 0..400 {
            let (mut mesh, _) = creature(&mut rng, 1 + case % 4, Spread::Random);
            let balls = mesh.root_balls().clone();
            let joints = mesh.joint_count() as u32;
            for _ in 0..6 {
                let far = mesh.radius() * [0.0, 1.0, 3.0][rng.usize(0..3)];
                let position = direction(&mut rng) * far;
                let influence = |_| Influence {
                    joint: JointId(rng.u32(0..joints)),
                    weight: 1.0,
                };
                let influences: Vec<_> = (0..1 + case % 7).map(influence).collect();
                let vertex = mesh.check_vertex(position, &influences).unwrap();
                mesh.add_vertex(vertex);
            }
            assert_ne!(*mesh.root_balls(), balls, "case {case}");
            let (grown, anew) = (mesh.root_balls(), RootBalls::new(&mesh));
            let lost = |balls: &RootBalls| (balls.relative, balls.underflow);
            assert_eq!(lost(grown), lost(&anew), "case {case}");
            let mut table = JointTable::default();
            for motion in MOTIONS {
                let palette = palette(&mut rng, motion, mesh.radius());
                table.update(palette.matrices());
                let found = mesh.root_balls().bounds(&table);
                let case = format!("case {case}, {motion:?}");
                check(&mesh, palette.matrices(), &found, &case);
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
            let mut balls = RootBalls::new(&mesh);
            check(
                &mesh,
                palette.matrices(),
                &balls.bounds(&table),
                &format!("{case}"),
            );
            balls.relative = 0.0;
            for ball in &mut balls.balls {
                (ball.center, ball.radius) = (widen(mesh.positions()[0]), 0.0);
            }
            let found = balls.bounds(&table);
            let p = skin(&mesh, palette.matrices()).unwrap()[0];
            escaped += usize::from(!(p.cmpge(found.min).all() && p.cmple(found.max).all()));
        }
        assert!(escaped > 300, "{escaped}");
    }

    #[test]
    fn the_box_of_a_bent_tube_is_tight() {
        let mesh = tube(6, 24);
        let palette = bend(6, DVec3::Z, 0.4);
        let found = bounds(&mesh, palette.matrices());
        check(&mesh, palette.matrices(), &found, "tube");
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
        let found = bounds(&mesh, &palette);
        assert_eq!(found.min, Vec3::NEG_INFINITY);
        assert_eq!(found.max, Vec3::INFINITY);
    }
}
