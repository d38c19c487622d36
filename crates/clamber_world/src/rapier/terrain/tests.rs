use rapier3d::parry::bounding_volume::BoundingSphere;
use rapier3d::parry::mass_properties::MassProperties;
use rapier3d::parry::partitioning::{Bvh, BvhBuildStrategy};
use rapier3d::parry::query::details::NormalConstraints;
use rapier3d::parry::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use rapier3d::parry::shape::CompositeShape;
use rapier3d::parry::utils::Array2;
use rapier3d::prelude::*;

use super::*;
use crate::debris::PatchShape;
use crate::testing::{assert_near, cast, point, sweep};

static NO_POSES: BodyPoses = BodyPoses::new();

fn world_of(collider: ColliderBuilder) -> PhysicsWorld {
    let mut world = PhysicsWorld::default();
    world.insert_collider(collider, None);
    world.detect_collisions(&(), &());
    world
}

/// Level ground, 8 m wide, at height 1, as each kind of shape with triangles.
fn grounds() -> Vec<(&'static str, ColliderBuilder)> {
    let heights = Array2::new(5, 5, vec![1.0; 25]);
    let corners = [(-4., -4.), (-4., 4.), (4., 4.), (4., -4.)];
    let corners = corners.map(|(x, z)| Vector::new(x, 1.0, z)).to_vec();
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    let own = PatchShape::new(&triangles, corners.iter().copied());
    vec![
        (
            "a composite shape that is not parry's",
            ColliderBuilder::new(SharedShape::new(own)),
        ),
        (
            "height field",
            ColliderBuilder::heightfield(heights, Vector::new(8.0, 1.0, 8.0)),
        ),
        (
            "triangle mesh",
            ColliderBuilder::trimesh(corners, triangles).unwrap(),
        ),
    ]
}

#[test]
fn height_fields_and_meshes_answer_per_triangle() {
    for (name, collider) in grounds() {
        let world = world_of(collider);
        let terrain = RapierTerrain::of_world(&world, &NO_POSES);
        let p = DVec3::new(0.3, 1.5, 0.4);
        let closest = terrain.closest_point(p, 2.0).unwrap();
        assert!((closest.distance - 0.5).abs() < 1e-6, "{name}: {closest:?}");
        assert_near(closest.normal, DVec3::Y, 1e-6, name);
        assert_near(closest.point, DVec3::new(0.3, 1.0, 0.4), 1e-6, name);
        assert_eq!(terrain.closest_point(p, 0.4), None, "{name}");
        let far = terrain.closest_point(p * 50.0, f64::INFINITY);
        assert!(far.is_some(), "{name}");
        let mut contacts = Vec::new();
        terrain.overlap_sphere(p, 0.7, &mut contacts);
        assert!(contacts.len() >= 2, "{name}: {contacts:?}");
        let few = contacts.len();
        terrain.overlap_sphere(p, f64::INFINITY, &mut contacts);
        assert!(contacts.len() >= 2 * few, "{name}: all of them, appended");
        let down = DVec3::new(0.0, -3.0, 0.0);
        let hit = terrain.cast_ray(p, down, 2.0).unwrap();
        assert!((hit.distance - 0.5).abs() < 1e-6, "{name}: {hit:?}");
        let at_its_end = terrain.cast_ray(p, DVec3::NEG_Y, hit.distance);
        assert_eq!(at_its_end, Some(hit), "{name}");
        assert_eq!(terrain.cast_ray(p, DVec3::NEG_Y, 0.4999), None, "{name}");
        assert_eq!(terrain.cast_ray(p, DVec3::Y, f64::INFINITY), None, "{name}");
    }
}

#[test]
fn convex_shapes_are_solid() {
    let world = world_of(ColliderBuilder::cuboid(1.0, 1.0, 1.0));
    let terrain = RapierTerrain::of_world(&world, &NO_POSES);
    for (place, reach, distance, normal) in [
        (DVec3::new(0.8, 0.3, 0.0), 1.0, -0.2, DVec3::X),
        (DVec3::Y * 3.0, 10.0, 2.0, DVec3::Y),
    ] {
        let contact = terrain.closest_point(place, reach).unwrap();
        assert!((contact.distance - distance).abs() < 1e-6, "{contact:?}");
        assert_near(contact.separation_normal(place), normal, 1e-6, place);
    }
}

#[test]
fn a_shape_that_is_its_own_part_has_no_parts() {
    let own = SelfPart(
        Ball::new(1.0),
        Bvh::from_leaves(BvhBuildStrategy::default(), &[BOX]),
    );
    let collider = ColliderBuilder::new(SharedShape::new(own));
    let world = world_of(collider);
    let terrain = RapierTerrain::of_world(&world, &NO_POSES);
    let mut contacts = Vec::new();
    terrain.overlap_sphere(DVec3::ZERO, 2.0, &mut contacts);
    assert_eq!(contacts, []);
    assert_eq!(terrain.closest_point(DVec3::ZERO, 2.0), None);
    // Rays are cast by the shape itself.
    let hit = terrain.cast_ray(DVec3::Y * 2.0, DVec3::NEG_Y, 4.0);
    assert!(hit.is_some());
}

/// Bounds of [`SelfPart`].
const BOX: Aabb = Aabb {
    mins: Vector::NEG_ONE,
    maxs: Vector::ONE,
};

/// A composite shape whose only part is itself.
#[derive(Clone)]
struct SelfPart(Ball, Bvh);

impl CompositeShape for SelfPart {
    fn map_part_at(
        &self,
        _: u32,
        f: &mut dyn FnMut(Option<&Pose>, &dyn Shape, Option<&dyn NormalConstraints>),
    ) {
        f(None, self, None);
    }

    fn bvh(&self) -> &Bvh {
        &self.1
    }
}

impl Shape for SelfPart {
    fn compute_local_aabb(&self) -> Aabb {
        BOX
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.0.compute_local_bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, _: Vector, _: u32) -> Option<Box<dyn Shape>> {
        None
    }

    fn mass_properties(&self, _: Real) -> MassProperties {
        MassProperties::default()
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> Real {
        0.0
    }

    fn ccd_angular_thickness(&self) -> Real {
        0.0
    }

    fn as_composite_shape(&self) -> Option<&(dyn CompositeShape + Sync)> {
        Some(self)
    }
}

impl RayCast for SelfPart {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time: Real,
        solid: bool,
    ) -> Option<RayIntersection> {
        self.0.cast_local_ray_and_get_normal(ray, max_time, solid)
    }
}

impl PointQuery for SelfPart {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        self.0.project_local_point(point, solid)
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        self.0.project_local_point_and_get_feature(point)
    }
}

#[test]
fn compounds_answer_per_part() {
    let parts = [-1.0f32, 1.0].map(|x| {
        let place = Pose::from_translation(Vector::X * x);
        (place, SharedShape::ball(0.5))
    });
    let world = world_of(ColliderBuilder::compound(parts.to_vec()));
    let terrain = RapierTerrain::of_world(&world, &NO_POSES);
    let mut contacts = Vec::new();
    terrain.overlap_sphere(DVec3::Y * 0.2, 1.0, &mut contacts);
    assert_eq!(contacts.len(), 2, "{contacts:?}");
}

#[test]
fn a_world_origin_keeps_far_scenes_exact() {
    let world = world_of(ColliderBuilder::cuboid(1.0, 1.0, 1.0));
    let origin = DVec3::new(3e6, -2e6, 1e6);
    let terrain = RapierTerrain::of_world(&world, &NO_POSES).with_origin(origin);
    let p = origin + DVec3::new(0.1, 1.25, 0.0);
    let contact = terrain.closest_point(p, 1.0).unwrap();
    assert!((contact.distance - 0.25).abs() < 1e-6, "{contact:?}");
    assert!((contact.point - (origin + DVec3::new(0.1, 1.0, 0.0))).length() < 1e-6);
    let motion = terrain.motion(&contact.material, 0.1).unwrap();
    assert!((motion.position - contact.point).length() < 1e-6);
    assert_eq!(motion.velocity, DVec3::ZERO);
}

#[test]
fn points_of_a_turning_body_move_on_arcs() {
    let mut world = PhysicsWorld::default();
    let body = RigidBodyBuilder::kinematic_velocity_based().angvel(Vector::Y * 6.0);
    world.insert(
        body.translation(Vector::new(1.0, 0.0, 0.0)),
        ColliderBuilder::cuboid(3.0, 0.5, 3.0).translation(Vector::Y * 0.2),
    );
    world.step();
    let dt = f64::from(world.integration_parameters.dt);
    let at = DVec3::new(3.0, 1.0, 0.0);
    let material = {
        let terrain = RapierTerrain::of_world(&world, &NO_POSES);
        terrain.closest_point(at, 1.0).unwrap().material
    };
    let mut before = BodyPoses::default();
    before.record(&world.bodies);
    world.step();
    let terrain = RapierTerrain::of_world(&world, &before);
    let motion = terrain.motion(&material, dt).unwrap();
    let angle = 6.0 * dt;
    let from_axis = DVec3::new(2.0, 0.0, 0.0);
    let turned = DVec3::new(2.0 * libm::cos(angle), 0.0, -2.0 * libm::sin(angle));
    let arc = DVec3::new(3.0, 0.7, 0.0) + turned - from_axis;
    // Rapier integrates the body's rotation in f32.
    assert!((motion.position - arc).length() < 5e-5, "{motion:?} {arc}");
    assert_near(motion.velocity, (turned - from_axis) / dt, 5e-3, "velocity");
    let turned = motion.turn * DVec3::X;
    let expected = DVec3::new(libm::cos(angle), 0.0, -libm::sin(angle));
    assert!((turned - expected).length() < 1e-5, "{turned}");
}

#[test]
fn terrain_is_sync() {
    fn shared<T: Sync>(_: &T) {}
    let world = world_of(ColliderBuilder::cuboid(1.0, 1.0, 1.0));
    shared(&RapierTerrain::of_world(&world, &NO_POSES));
}

#[test]
fn queries_do_not_see_sensors_and_filtered_colliders() {
    let world = world_of(ColliderBuilder::cuboid(1.0, 1.0, 1.0).sensor(true));
    let terrain = RapierTerrain::of_world(&world, &NO_POSES);
    assert_eq!(terrain.closest_point(DVec3::ZERO, 9.0), None);
    // A caller's filter does not bring sensors back.
    let terrain = terrain.with_filter(&|_, _| true);
    assert_eq!(terrain.closest_point(DVec3::ZERO, 9.0), None);
    let world = world_of(ColliderBuilder::cuboid(1.0, 1.0, 1.0));
    let terrain = RapierTerrain::of_world(&world, &NO_POSES);
    assert!(terrain.closest_point(DVec3::ZERO, 9.0).is_some());
    let terrain = terrain.with_filter(&|_, collider| !collider.shape().is_convex());
    assert_eq!(terrain.closest_point(DVec3::ZERO, 9.0), None);
}

/// Which queries see a moving box about the origin: a ray, the closest point, an overlap, a cast, a sweep, a motion.
fn seen(terrain: &RapierTerrain<'_>, material: &MaterialPoint) -> [bool; 6] {
    let capsule = WorldCapsule::ball(DVec3::Y * 3.0, 0.4);
    let way = DVec3::Y * -2.5;
    let mut contacts = Vec::new();
    terrain.overlap_sphere(DVec3::Y * 1.2, 0.4, &mut contacts);
    [
        terrain.cast_ray(DVec3::Y * 3.0, way, 9.0).is_some(),
        terrain.closest_point(DVec3::Y * 1.2, 9.0).is_some(),
        !contacts.is_empty(),
        cast(terrain, &capsule, way).is_some(),
        sweep(terrain, &capsule, way).is_some(),
        terrain.motion(material, 0.1).is_some(),
    ]
}

/// Rapier's tree keeps a collider that was disabled or became a sensor until the next step.
#[test]
fn no_query_sees_disabled_colliders_sensors_or_filtered_ones() {
    type Change = fn(&mut Collider);
    let hide: [(&str, Change, Change); 2] = [
        (
            "disabled",
            |c| c.set_enabled(false),
            |c| c.set_enabled(true),
        ),
        ("a sensor", |c| c.set_sensor(true), |c| c.set_sensor(false)),
    ];
    for moves in [false, true] {
        let mut world = PhysicsWorld::default();
        let (body, handle) = world.insert(
            RigidBodyBuilder::kinematic_position_based(),
            ColliderBuilder::cuboid(1.0, 1.0, 1.0),
        );
        world.step();
        let mut before = BodyPoses::new();
        let mut tick = |world: &mut PhysicsWorld, height: f32| {
            before.record(&world.bodies);
            let place = Vector::new(0.0, if moves { height } else { 0.0 }, 0.0);
            world.bodies[body].set_next_kinematic_translation(place);
            world.step();
            before.clone()
        };
        let poses = tick(&mut world, 0.1);
        let terrain = RapierTerrain::of_world(&world, &poses);
        let hit = terrain.closest_point(DVec3::Y * 3.0, 9.0).unwrap();
        let all = seen(&terrain, &hit.material);
        assert_eq!(all, [true; 6], "moves: {moves}");
        let filtered = terrain.with_filter(&|_, _| false);
        let none = seen(&filtered, &hit.material);
        assert_eq!(none, [false; 6], "filtered, moves: {moves}");
        for (name, hide, show) in hide {
            for steps_after in [false, true] {
                let told = format!("{name}, stepped after it: {steps_after}, moves: {moves}");
                hide(&mut world.colliders[handle]);
                let poses = if steps_after {
                    tick(&mut world, 0.2)
                } else {
                    poses.clone()
                };
                let terrain = RapierTerrain::of_world(&world, &poses);
                assert_eq!(seen(&terrain, &hit.material), [false; 6], "{told}");
                show(&mut world.colliders[handle]);
                let poses = tick(&mut world, 0.15);
                let terrain = RapierTerrain::of_world(&world, &poses);
                let shown = seen(&terrain, &hit.material);
                assert_eq!(shown, [true; 6], "shown again, {told}");
            }
        }
    }
}

#[test]
fn bad_input_and_removed_colliders_find_nothing() {
    let mut world = world_of(ColliderBuilder::cuboid(1.0, 1.0, 1.0));
    let material = {
        let terrain = RapierTerrain::of_world(&world, &NO_POSES);
        let mut contacts = Vec::new();
        for bad in [DVec3::NAN, DVec3::splat(f64::INFINITY), DVec3::splat(1e300)] {
            assert_eq!(terrain.closest_point(bad, 1.0), None);
            assert_eq!(terrain.cast_ray(bad, DVec3::X, 1.0), None);
            terrain.overlap_sphere(bad, 1.0, &mut contacts);
        }
        assert_eq!(terrain.cast_ray(DVec3::Y * 5.0, DVec3::NAN, 9.0), None);
        assert_eq!(terrain.closest_point(DVec3::ZERO, f64::NAN), None);
        assert_eq!(terrain.cast_ray(DVec3::Y * 5.0, -DVec3::Y, f64::NAN), None);
        assert_eq!(terrain.cast_ray(DVec3::Y * 5.0, -DVec3::Y, -1.0), None);
        terrain.overlap_sphere(DVec3::ZERO, f64::NAN, &mut contacts);
        assert!(contacts.is_empty());
        terrain.closest_point(DVec3::ZERO, 9.0).unwrap().material
    };
    let handle = world.colliders.iter().next().unwrap().0;
    let moves = |world: &PhysicsWorld| {
        let terrain = RapierTerrain::of_world(world, &NO_POSES);
        terrain.motion(&material, 0.1).is_some()
    };
    assert!(moves(&world));
    world.colliders[handle].set_enabled(false);
    assert!(!moves(&world));
    world.colliders[handle].set_enabled(true);
    world.colliders[handle].set_sensor(true);
    assert!(!moves(&world));
    world.remove_collider(handle);
    let terrain = RapierTerrain::of_world(&world, &NO_POSES);
    assert!(terrain.motion(&material, 0.1).is_none());
}

mod agreement;
mod capsules;

/// Bodies that move across the path of a ball: at most [`FEW`] of them, or more, so that a tree is built. The first
/// contact among all is the earliest of the contacts with each body alone, wherever in the list that body is.
#[test]
fn among_many_moving_bodies_the_first_contact_is_that_with_one_of_them_alone() {
    let mut rng = fastrand::Rng::with_seed(31);
    let ball = WorldCapsule::ball(DVec3::ZERO, 0.3);
    let mut met = 0;
    for round in 0..60 {
        let count = [1, FEW, FEW + 1, 40][round % 4];
        let mut along = |from: f32, size: f32| from + rng.f32() * size;
        let starts: Vec<_> = (0..count)
            .map(|_| Vector::new(along(2.0, 12.0), along(2.0, 6.0), along(-0.5, 1.0)))
            .collect();
        let first = |starts: &[Vector]| {
            let mut world = PhysicsWorld::default();
            let mut handles = Vec::new();
            for start in starts {
                let body = RigidBodyBuilder::kinematic_position_based().translation(*start);
                handles.push(world.insert(body, ColliderBuilder::ball(0.4)).0);
            }
            world.step();
            let mut before = BodyPoses::default();
            before.record(&world.bodies);
            for (handle, start) in handles.iter().zip(starts) {
                let across = *start - Vector::Y * (2.0 * start.y);
                world.bodies[*handle].set_next_kinematic_translation(across);
            }
            world.step();
            // No body is in the way at the end of the tick.
            let terrain = RapierTerrain::of_world(&world, &before);
            sweep(&terrain, &ball, DVec3::X * 12.0).map(|hit| hit.fraction)
        };
        let alone = starts.iter().filter_map(|start| first(&[*start]));
        let alone = alone.reduce(f64::min);
        assert_eq!(first(&starts), alone, "{count} bodies");
        met += u32::from(alone.is_some());
    }
    assert!(met > 15, "{met}");
}
