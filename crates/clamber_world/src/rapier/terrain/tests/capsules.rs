//! Capsules that overlap, are cast and swept.

use rapier3d::parry::shape::HalfSpace;

use super::*;

#[test]
fn falling_ball_meets_every_kind_of_shape() {
    let shapes = [
        ("ball", ColliderBuilder::ball(1.0)),
        ("cuboid", ColliderBuilder::cuboid(1.0, 1.0, 1.0)),
        (
            "round cuboid",
            ColliderBuilder::round_cuboid(0.8, 0.8, 0.8, 0.2),
        ),
        ("capsule", ColliderBuilder::capsule_y(0.5, 0.5)),
        ("cylinder", ColliderBuilder::cylinder(1.0, 1.0)),
        ("cone", ColliderBuilder::cone(1.0, 1.0)),
        (
            "plane",
            ColliderBuilder::new(SharedShape::new(HalfSpace::new(Vector::Y)))
                .translation(Vector::Y),
        ),
    ];
    for (name, collider) in shapes.into_iter().chain(grounds()) {
        let world = world_of(collider);
        let terrain = RapierTerrain::of_world(&world, &NO_POSES);
        let ball = WorldCapsule::ball(DVec3::Y * 3.0, 0.5);
        for moving in [false, true] {
            let met = if moving {
                terrain.sweep_capsule(&ball, DVec3::NEG_Y * 4.0)
            } else {
                terrain.cast_capsule(&ball, DVec3::NEG_Y * 4.0)
            };
            let met = met.unwrap_or_else(|| panic!("{name}"));
            assert!((met.time - 0.375).abs() < 3e-5, "{name}: {met:?}");
            assert!((met.away - DVec3::Y).length() < 1e-6, "{name}: {met:?}");
            assert!((met.contact.distance - 0.5).abs() < 1e-4, "{name}: {met:?}");
            assert!(
                (met.contact.point - DVec3::Y).length() < 2e-4,
                "{name}: {met:?}"
            );
            assert!(!met.started_inside, "{name}");
        }
        assert_eq!(terrain.cast_capsule(&ball, DVec3::NEG_Y), None, "{name}");
        assert_eq!(terrain.cast_capsule(&ball, DVec3::Y * 9.0), None, "{name}");
    }
}
