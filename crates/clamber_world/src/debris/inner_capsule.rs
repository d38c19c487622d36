//! A capsule inside a body, which skin must never reach.

use glam::{DQuat, DVec3};
use rapier3d::dynamics::RigidBody;
use rapier3d::geometry::{ColliderSet, Shape, TypedShape};
use rapier3d::math::Pose;

/// Distance at which rapier predicts contacts along the motion of body and skin, as a fraction of the body's inner
/// radius. Contacts between faces that are farther apart than their own size come out askew.
const LOOK_AHEAD: f64 = 0.5;

/// A capsule inside the body's largest solid collider, in the body's local space: its segment, of length 0 for a ball,
/// and its radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct InnerCapsule {
    pub(super) ends: [DVec3; 2],
    pub(super) radius: f64,
}

impl InnerCapsule {
    /// `None` for a body without a solid collider.
    pub(super) fn of(body: &RigidBody, colliders: &ColliderSet) -> Option<Self> {
        let mut largest: Option<Self> = None;
        for handle in body.colliders() {
            let Some(collider) = colliders.get(*handle).filter(|c| !c.is_sensor()) else {
                continue;
            };
            let on_body = collider
                .position_wrt_parent()
                .copied()
                .unwrap_or(Pose::IDENTITY);
            Self::of_shape(collider.shape(), &on_body, &mut largest);
        }
        largest
    }

    fn of_shape(shape: &dyn Shape, pose: &Pose, largest: &mut Option<Self>) {
        let along = |axis: DVec3, half: f32, radius: f32| Self {
            ends: [-axis * f64::from(half), axis * f64::from(half)],
            radius: f64::from(radius),
        };
        let core = match shape.as_typed_shape() {
            TypedShape::Ball(ball) => along(DVec3::X, 0.0, ball.radius),
            TypedShape::Capsule(capsule) => Self {
                ends: [capsule.segment.a, capsule.segment.b].map(|end| end.as_dvec3()),
                radius: f64::from(capsule.radius),
            },
            TypedShape::Cuboid(cuboid) => {
                let half = cuboid.half_extents;
                let (thin, long) = (half.min_element(), half.max_element());
                let axis = [DVec3::X, DVec3::Y, DVec3::Z][half.max_position()];
                along(axis, long - thin, thin)
            }
            TypedShape::Cylinder(cylinder) => {
                let radius = cylinder.radius.min(cylinder.half_height);
                along(DVec3::Y, cylinder.half_height - radius, radius)
            }
            TypedShape::Compound(compound) => {
                for (on_shape, part) in compound.shapes() {
                    Self::of_shape(&**part, &(*pose * *on_shape), largest);
                }
                return;
            }
            _ => {
                let center = shape.compute_local_aabb().center();
                let nearest = shape.project_local_point(center, false);
                if !shape.is_convex() || !nearest.is_inside {
                    return;
                }
                Self {
                    ends: [center.as_dvec3(); 2],
                    radius: (center - nearest.point).as_dvec3().length(),
                }
            }
        };
        let core = Self {
            ends: core.ends.map(|end| place(pose, end)),
            ..core
        };
        let usable = core.radius > 0.0 && core.ends.iter().all(|end| end.is_finite());
        if usable && largest.is_none_or(|largest| largest.radius < core.radius) {
            *largest = Some(core);
        }
    }

    /// Distance at which rapier predicts contacts along the motion of body and skin, metres.
    pub(super) fn look_ahead(&self) -> f32 {
        (self.radius * LOOK_AHEAD) as f32
    }

    /// The capsule's ends under a pose, in rapier's space.
    pub(super) fn ends_at(&self, pose: &Pose) -> [DVec3; 2] {
        self.ends.map(|end| place(pose, end))
    }
}

/// Transforms a point by a pose in f64, so that only the pose's own rounding remains.
fn place(pose: &Pose, point: DVec3) -> DVec3 {
    let rotation: DQuat = pose.rotation.as_dquat().normalize();
    rotation * point + pose.translation.as_dvec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rapier3d::prelude::*;

    fn core(colliders: &[ColliderBuilder]) -> Option<InnerCapsule> {
        let mut world = PhysicsWorld::default();
        let body = world.insert_body(RigidBodyBuilder::dynamic());
        for collider in colliders {
            world.insert_collider(collider.clone(), Some(body));
        }
        InnerCapsule::of(&world.bodies[body], &world.colliders)
    }

    #[test]
    fn the_inner_capsule_is_the_longest_one_inside() {
        let half = |core: InnerCapsule| (core.ends[1] - core.ends[0]).length() / 2.0;
        for (collider, radius, length) in [
            (ColliderBuilder::ball(0.5), 0.5, 0.0),
            (ColliderBuilder::capsule_z(2.0, 0.25), 0.25, 2.0),
            (ColliderBuilder::cuboid(0.25, 0.5, 2.0), 0.25, 1.75),
            (ColliderBuilder::cylinder(2.0, 0.5), 0.5, 1.5),
            (ColliderBuilder::cylinder(0.5, 2.0), 0.5, 0.0),
        ] {
            let core = core(&[collider]).unwrap();
            assert_eq!((core.radius, half(core)), (radius, length), "{core:?}");
        }
        let cone = core(&[ColliderBuilder::cone(1.0, 1.0)]).unwrap();
        assert!(cone.radius > 0.3 && cone.radius < 0.6, "{cone:?}");
    }

    #[test]
    fn the_largest_of_several_colliders_is_used_at_its_own_place() {
        let small = ColliderBuilder::ball(0.1);
        let large = ColliderBuilder::ball(0.4).translation(Vector::new(0.0, 3.0, 0.0));
        let core = core(&[small, large]).unwrap();
        assert_eq!(core.ends, [DVec3::Y * 3.0; 2]);
    }

    #[test]
    fn a_body_without_a_solid_collider_has_no_inner_capsule() {
        assert_eq!(core(&[]), None);
        assert_eq!(core(&[ColliderBuilder::ball(1.0).sensor(true)]), None);
        let corners = vec![Vector::ZERO, Vector::X, Vector::Y];
        let mesh = ColliderBuilder::trimesh(corners, vec![[0, 1, 2]]).unwrap();
        assert_eq!(core(&[mesh]), None);
    }
}
