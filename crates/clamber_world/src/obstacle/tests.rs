//! The default methods of an obstacle, compared with a surface's own.

use clamber_surface::geometry::Similarity;
use clamber_surface::surface::SkinnedSurface;
use glam::Vec3;

use super::*;
use crate::Attachment;
use crate::testing::{point, rest, rigid};

/// A creature's skin as an obstacle with only the three required methods, and bounds if wanted.
struct Least<'a> {
    skin: &'a SkinnedSurface,
    has_bounds: bool,
}

impl Obstacle for Least<'_> {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.skin.overlap_capsule(capsule, contacts);
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        Obstacle::cast_capsule(self.skin, capsule, displacements, target)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        self.skin.motion(point, dt)
    }

    fn bounds(&self) -> Option<(DVec3, f64)> {
        self.has_bounds.then(|| self.skin.bounds())?
    }
}

/// Eighty random triangles within two metres, on each axis, of a place 100 m from the origin.
fn rubble() -> (SkinnedSurface, DVec3) {
    let mut rng = fastrand::Rng::with_seed(22);
    let positions: Vec<Vec3> = (0..240).map(|_| point(&mut rng, 2.0).as_vec3()).collect();
    let triangles: Vec<[u32; 3]> = (0..80).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut skin = rigid(&positions, &triangles);
    let place = DVec3::new(60.0, 0.0, -80.0);
    skin.teleport(&rest(), Similarity::from_translation(place))
        .unwrap();
    (skin, place)
}

#[test]
fn default_rays_and_closest_points_agree_with_the_surfaces_own() {
    let (skin, place) = rubble();
    let mut rng = fastrand::Rng::with_seed(23);
    let mut hits = 0;
    for has_bounds in [false, true] {
        let least = Least {
            skin: &skin,
            has_bounds,
        };
        for _ in 0..500 {
            let from = place + point(&mut rng, 3.0);
            for reach in [0.0, 0.3, 3.0, f64::INFINITY] {
                let [ours, all] = [&least as &dyn Obstacle, &skin].map(|obstacle| {
                    let nearest = obstacle.closest_point(from, reach);
                    nearest.map(|contact| contact.distance)
                });
                assert_eq!(ours, all, "{from} within {reach}");
            }
            let direction = point(&mut rng, 5.0);
            for length in [0.5, 8.0, f64::INFINITY] {
                let ours = least.cast_ray(from, direction, length);
                let all = skin.cast_ray(from, direction, length);
                let Some(all) = all else { continue };
                let ours = ours.expect("a ball of radius 0 hits wherever a ray hits");
                let apart = all.distance - ours.distance;
                // Short by the tolerance over the sine of the angle between ray and triangle.
                let sine = all.normal.dot(direction.normalize()).abs();
                let allowed = (2e-6 + 1e-9 * ours.distance) / sine;
                assert!(
                    (-1e-5..allowed.max(1e-5)).contains(&apart),
                    "{apart} {ours:?} {all:?}"
                );
                hits += 1;
            }
        }
    }
    assert!(hits > 500, "{hits}");
}

#[test]
fn defaults_find_nothing_for_invalid_input() {
    let (skin, place) = rubble();
    let least = Least {
        skin: &skin,
        has_bounds: false,
    };
    for bad in [f64::NAN, -1.0] {
        assert_eq!(least.closest_point(place, bad), None);
        assert_eq!(least.cast_ray(place, DVec3::X, bad), None);
    }
    for bad in [DVec3::NAN, DVec3::INFINITY] {
        assert_eq!(least.closest_point(bad, 1.0), None);
        assert_eq!(least.cast_ray(bad, DVec3::X, 1.0), None);
        assert_eq!(least.cast_ray(place, bad, 1.0), None);
    }
    assert_eq!(least.cast_ray(place, DVec3::ZERO, 1.0), None);
}

/// A number that is not finite is found on each axis of each vector, and the largest finite numbers pass.
#[test]
fn one_number_that_is_not_finite_is_found_wherever_it_stands() {
    let most = DVec3::splat(f64::MAX);
    let motion = PointMotion {
        velocity: -most,
        ..PointMotion::translated(most, most, 1.0)
    };
    assert!(motion.is_finite());
    let attachment = Attachment {
        obstacle: ObstacleId(0),
        material: MaterialPoint {
            key: 0,
            coordinates: [-f64::MAX; 3],
        },
        point: most,
        frame: DQuat::IDENTITY,
        offset: -most,
    };
    assert!(attachment.is_finite());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let broken = |v: &mut DVec3| v[axis] = bad;
            let mut motions = [motion; 4];
            broken(&mut motions[0].position);
            broken(&mut motions[1].previous_position);
            broken(&mut motions[2].velocity);
            motions[3].turn = DQuat::from_xyzw(0.0, bad, 0.0, 1.0);
            let mut attachments = [attachment; 4];
            broken(&mut attachments[0].point);
            broken(&mut attachments[1].offset);
            attachments[2].material.coordinates[axis] = bad;
            attachments[3].frame = DQuat::from_xyzw(0.0, bad, 0.0, 1.0);
            for index in 0..4 {
                let told = format!("{bad}, axis {axis}, vector {index}");
                assert!(!motions[index].is_finite(), "{told}");
                assert!(!attachments[index].is_finite(), "{told}");
            }
        }
    }
}

#[test]
fn a_translated_point_moves_without_turning() {
    let motion = PointMotion::translated(DVec3::X, DVec3::X * 1.5, 0.1);
    assert_eq!(
        (motion.velocity, motion.was_teleported),
        (DVec3::X * 5.0, false)
    );
    let still = PointMotion::translated(DVec3::X, DVec3::X, 0.0);
    assert_eq!((still.velocity, still.was_teleported), (DVec3::ZERO, true));
    assert!(motion.is_finite() && still.is_finite());
}
