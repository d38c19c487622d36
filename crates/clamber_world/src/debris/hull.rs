//! The outside of a body, and the region that it may reach in a tick.

use clamber_surface::geometry::Similarity;
use clamber_surface::surface::{MovingTriangle, SkinnedSurface};
use glam::{DMat3, DQuat, DVec3, Vec3};
use rapier3d::dynamics::RigidBody;
use rapier3d::geometry::{ColliderSet, TypedShape};
use rapier3d::math::Pose;
use rapier3d::parry::bounding_volume::BoundingVolume;
use rapier3d::parry::query::PointQuery;
use rapier3d::parry::shape::Triangle;

use super::corners::{Corners, Transforms};

/// A box around all solid colliders of a body, in the body's space, or a ball if the only collider is a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hull {
    middle: DVec3,
    half: DVec3,
    is_ball: bool,
}

impl Hull {
    /// `None` for a body without a solid collider.
    pub(super) fn of(body: &RigidBody, colliders: &ColliderSet) -> Option<Self> {
        let solid = body.colliders().iter().filter_map(|handle| {
            let collider = colliders.get(*handle)?;
            (collider.is_enabled() && !collider.is_sensor()).then_some(collider)
        });
        let boxes = solid.clone().map(|collider| {
            let on_body = collider.position_wrt_parent();
            let on_body = on_body.copied().unwrap_or(Pose::IDENTITY);
            collider.shape().compute_aabb(&on_body)
        });
        let all = boxes.reduce(|all, one| all.merged(&one))?;
        let is_ball = |shape| matches!(shape, TypedShape::Ball(_));
        Some(Self {
            middle: all.center().as_dvec3(),
            half: all.half_extents().as_dvec3(),
            is_ball: solid
                .map(|c| is_ball(c.shape().as_typed_shape()))
                .eq([true]),
        })
    }

    /// True for a ball, which is the body's core, too.
    pub(super) fn is_ball(&self) -> bool {
        self.is_ball
    }

    /// Radius of a ball about the middle that encloses the hull.
    pub(super) fn radius(&self) -> f64 {
        if self.is_ball {
            self.half.x
        } else {
            self.half.length()
        }
    }

    /// True if skin may have touched the hull in this tick, on the way from one pose to the other. `origin` is the
    /// world position of rapier's origin.
    pub(super) fn may_touch(
        &self,
        surface: &SkinnedSurface,
        poses: [&Pose; 2],
        origin: DVec3,
    ) -> bool {
        let reach = Reach::new(*self, poses, 0.0).on(surface.world_from_model(), origin);
        let (mut touched, space) = (false, surface.in_model());
        space.visit_box(reach.low, reach.high, |moving| {
            touched |= reach.apart(moving) <= 0.0;
        });
        touched
    }

    /// The hull's middle under a pose, in rapier's space.
    pub(super) fn middle_at(&self, pose: &Pose) -> DVec3 {
        self.frame_at(pose).middle
    }

    /// The hull's middle and axes under a pose, in rapier's space. The axes of a ball never turn.
    fn frame_at(&self, pose: &Pose) -> Frame {
        let rotation = pose.rotation.as_dquat().normalize();
        Frame {
            middle: rotation * self.middle + pose.translation.as_dvec3(),
            rotation: if self.is_ball {
                DQuat::IDENTITY
            } else {
                rotation
            },
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Frame {
    middle: DVec3,
    rotation: DQuat,
}

/// The region that a body may reach in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    hull: Hull,
    /// Frames before the tick, and after it if nothing stops the body.
    frames: [Frame; 2],
    /// Half the angle between the two frames, radians.
    half_turn: f64,
    /// Enlargement of the hull, metres.
    around: f64,
}

impl Reach {
    /// The region of a body that moves from one pose to another, enlarged by `around` metres.
    pub(super) fn new(hull: Hull, poses: [&Pose; 2], around: f64) -> Self {
        let frames = poses.map(|pose| hull.frame_at(pose));
        let cosine = frames[0].rotation.dot(frames[1].rotation).abs().min(1.0);
        Self {
            hull,
            frames,
            half_turn: libm::acos(cosine),
            around,
        }
    }

    /// The middle of the body before the tick, in rapier's space.
    pub(super) fn middle(&self) -> DVec3 {
        self.frames[0].middle
    }

    /// Radius of a ball about the middle that encloses the enlarged hull, metres.
    pub(super) fn radius(&self) -> f64 {
        self.hull.radius() + self.around
    }

    /// The region in the model space of a surface. `origin` is the world position of rapier's origin.
    pub(super) fn on(&self, world_from_model: &Similarity, origin: DVec3) -> ReachOnSurface {
        let to_model = world_from_model.rotation.conjugate();
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let half = self.hull.half + self.around;
        // Between the two frames, the hull leaves the box around both by at most the height of its arcs over their
        // chords.
        let cut = self.hull.radius() * (1.0 - libm::cos(self.half_turn));
        let frames = self.frames.map(|frame| {
            let middle = world_from_model.inverse_transform_point(origin + frame.middle);
            let axes = DMat3::from_quat(to_model * frame.rotation);
            let across = axes.x_axis.abs() * half.x
                + axes.y_axis.abs() * half.y
                + axes.z_axis.abs() * half.z;
            let across = (across + cut) / world_from_model.scale;
            (low, high) = (low.min(middle - across), high.max(middle + across));
            let turned = axes.transpose() * world_from_model.scale;
            (turned.as_mat3(), (turned * -middle).as_vec3())
        });
        ReachOnSurface {
            low: low.as_vec3(),
            high: high.as_vec3(),
            transforms: Transforms::new(frames),
            half: half.as_vec3(),
            is_ball: self.hull.is_ball,
            turn: 2.0 * self.half_turn as f32,
            scale: world_from_model.scale as f32,
        }
    }
}

/// A [`Reach`] in the model space of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReachOnSurface {
    /// Low corner of a box around the whole region; `high` is the other corner.
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    /// Transforms from the model to the body's frame, before and after.
    transforms: Transforms,
    half: Vec3,
    is_ball: bool,
    /// Angle by which the frame turns, radians.
    turn: f32,
    scale: f32,
}

impl ReachOnSurface {
    /// Half of the longest side of the region's box.
    pub(super) fn half_side(&self) -> f32 {
        ((self.high - self.low) * 0.5).max_element()
    }

    /// A lower bound of the distance at which a moving triangle passes the region, in units of the model. It is less
    /// than the distance where the triangle passes by a corner.
    ///
    /// Corners are taken to move in straight lines from the first frame to the second. In a frame that turns by the
    /// angle a, a point that moves evenly by m, and is never farther than f from the middle, has an acceleration of at
    /// most `a^2 f + 2 a m`. So it is at most an eighth of that off the straight line.
    // Inlined into the query that calls it, which uses wider instructions.
    #[inline(always)]
    pub(super) fn apart(&self, moving: &MovingTriangle) -> f32 {
        let corners = Corners::new(moving, &self.transforms);
        let (low, high) = corners.bounds();
        let apart = (low.max(-high) - self.half).max_element();
        if !self.is_ball {
            let apart = apart.max(self.beyond_plane(&corners));
            return (apart - self.cut(&corners)) / self.scale;
        }
        if apart > self.half.x * AT_ONCE {
            return apart / self.scale;
        }
        let triangle = Triangle::from([0, 1, 2].map(|corner| corners.before(corner)));
        let distance = triangle.distance_to_local_point(Vec3::ZERO, false);
        let apart = apart.max(distance - self.half.x - corners.most_moved());
        apart / self.scale
    }

    /// Distance between the box and all corners along the triangle's normal; negative if they overlap there.
    #[inline(always)]
    fn beyond_plane(&self, corners: &Corners) -> f32 {
        let [a, b, c] = [corners.before(0), corners.before(1), corners.before(2)];
        let normal = (b - a).cross(c - a);
        // A shorter normal may not become a unit vector, because its square has few bits.
        if normal.length_squared() < 1e-30 {
            return f32::NEG_INFINITY;
        }
        let normal = normal.normalize();
        let (low, high) = corners.along(normal);
        low.max(-high) - normal.abs().dot(self.half)
    }

    #[inline(always)]
    fn cut(&self, corners: &Corners) -> f32 {
        if self.turn == 0.0 {
            return 0.0;
        }
        let farthest = corners.farthest();
        // An upper bound of the motion in a frame that does not turn.
        let moved = corners.most_moved() + self.turn * farthest;
        self.turn * (self.turn * farthest + 2.0 * moved) / 8.0
    }
}

/// Triangles farther than this from the box around a ball, as a fraction of its radius, are not measured more closely.
const AT_ONCE: f32 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_surface::geometry::rotation_from_axis_angle;
    use clamber_surface::mesh::TriangleId;
    use rapier3d::dynamics::RigidBodyBuilder;
    use rapier3d::geometry::ColliderBuilder;
    use rapier3d::math::Vector;
    use rapier3d::pipeline::PhysicsWorld;

    fn hull(colliders: &[ColliderBuilder]) -> Option<Hull> {
        let mut world = PhysicsWorld::default();
        let body = world.insert_body(RigidBodyBuilder::dynamic());
        for collider in colliders {
            world.insert_collider(collider.clone(), Some(body));
        }
        Hull::of(&world.bodies[body], &world.colliders)
    }

    #[test]
    fn the_hull_is_the_box_around_all_solid_enabled_colliders() {
        let colliders = [
            ColliderBuilder::ball(0.5),
            ColliderBuilder::cuboid(0.1, 0.2, 0.3).translation(Vector::new(1.0, 0.0, 0.0)),
            ColliderBuilder::ball(9.0).sensor(true),
            ColliderBuilder::ball(9.0).enabled(false),
        ];
        let all = hull(&colliders).unwrap();
        let (low, high) = (all.middle - all.half, all.middle + all.half);
        assert!((low - DVec3::splat(-0.5)).length() < 1e-6, "{low}");
        assert!((high - DVec3::new(1.1, 0.5, 0.5)).length() < 1e-6, "{high}");
        assert!(!all.is_ball);
        assert_eq!(hull(&colliders[2..]), None);
        let ball = hull(&[ColliderBuilder::ball(0.5).translation(Vector::Y)]).unwrap();
        assert!(ball.is_ball && ball.radius() == 0.5 && ball.middle == DVec3::Y);
    }

    /// A rotation by up to an angle about any axis.
    fn turn(rng: &mut fastrand::Rng, most: f64) -> DQuat {
        let axis = vector(rng).normalize_or(DVec3::X);
        rotation_from_axis_angle(axis, rng.f64() * most)
    }

    /// In the cube from -1 to 1.
    fn vector(rng: &mut fastrand::Rng) -> DVec3 {
        DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 2.0 - 1.0
    }

    /// Least distance of a triangle from the body's own shape, sampled at many times of the tick. From its first pose,
    /// the body turns by an angle about an axis and moves by a displacement.
    fn nearest(
        shape: &ColliderBuilder,
        corners: &[[DVec3; 3]; 2],
        first: &Pose,
        (axis, angle, moved): (DVec3, f64, DVec3),
    ) -> f64 {
        let mut nearest = f64::INFINITY;
        for step in 0..=64 {
            let share = f64::from(step) / 64.0;
            let at = |corner: usize| corners[0][corner].lerp(corners[1][corner], share).as_vec3();
            let triangle = Triangle::new(at(0), at(1), at(2));
            let turned = rotation_from_axis_angle(axis, angle * share).as_quat();
            let place = first.translation + (moved * share).as_vec3();
            let pose = Pose::from_parts(place, turned * first.rotation);
            let shape = shape.shape.as_ref();
            let apart = rapier3d::parry::query::distance(&pose, shape, &Pose::IDENTITY, &triangle);
            nearest = nearest.min(f64::from(apart.unwrap().distance));
        }
        nearest
    }

    #[test]
    fn the_distance_of_a_passing_triangle_is_never_overestimated() {
        let mut rng = fastrand::Rng::with_seed(7);
        let shapes = [
            ColliderBuilder::ball(0.5),
            ColliderBuilder::cuboid(0.3, 0.4, 0.5),
            ColliderBuilder::capsule_x(0.8, 0.2),
        ];
        let (mut met, mut passed) = (0, 0);
        for round in 0..3000 {
            let shape = &shapes[round % 3];
            let hull = hull(std::slice::from_ref(shape)).unwrap();
            let first = Pose::from_parts(vector(&mut rng).as_vec3(), turn(&mut rng, 3.0).as_quat());
            let fast = if round % 2 == 0 { 0.05 } else { 1.0 };
            let moved = vector(&mut rng) * fast;
            let (axis, angle) = (vector(&mut rng).normalize_or(DVec3::X), rng.f64() * fast);
            let turned = rotation_from_axis_angle(axis, angle).as_quat();
            let last =
                Pose::from_parts(first.translation + moved.as_vec3(), turned * first.rotation);
            let root = Similarity {
                rotation: turn(&mut rng, 3.0),
                scale: 0.5 + rng.f64() * 2.0,
                translation: vector(&mut rng) * 10.0,
            };
            let origin = vector(&mut rng) * 5.0;
            let reach = Reach::new(hull, [&first, &last], 0.0).on(&root, origin);
            let at = first.translation.as_dvec3() + vector(&mut rng) * 0.8;
            let corners = [(); 3].map(|()| at + vector(&mut rng) * 0.4);
            let skin = vector(&mut rng) * fast;
            let corners = [
                corners,
                corners.map(|p| p + skin + vector(&mut rng) * 0.2 * fast),
            ];
            let in_model = |p: DVec3| root.inverse_transform_point_f32(p + origin);
            let moving = MovingTriangle {
                triangle: TriangleId(0),
                previous: corners[0].map(in_model),
                current: corners[1].map(in_model),
            };
            let nearest = nearest(shape, &corners, &first, (axis, angle, moved));
            let said = f64::from(reach.apart(&moving)) * root.scale;
            assert!(said <= nearest + 1e-4, "{round}: said {said}, is {nearest}");
            // A triangle that meets the body also meets the region's box.
            if nearest < 1e-3 {
                let slack = Vec3::splat(0.01);
                assert!(
                    moving.meets_box(reach.low - slack, reach.high + slack),
                    "{round}"
                );
                met += 1;
            }
            passed += usize::from(said > 0.0);
        }
        assert!(met > 500 && passed > 500, "{met} met, {passed} passed");
    }
}
