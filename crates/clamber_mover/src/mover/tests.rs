use std::cell::Cell;

use super::*;
use crate::{Arm, Path, Walking};

/// A ball with a radius of 1 m and with bounds, so that distant queries skip it. It counts its overlap queries.
struct Ball(DVec3, Cell<usize>);

impl Obstacle for Ball {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        self.1.set(self.1.get() + 1);
        let nearest = capsule.nearest_on_axis(self.0);
        let normal = (nearest - self.0).normalize_or(DVec3::Y);
        let distance = nearest.distance(self.0) - 1.0;
        if distance <= capsule.radius {
            contacts.push(Contact {
                point: self.0 + normal,
                normal,
                distance,
                material: MaterialPoint {
                    key: 0,
                    coordinates: normal.to_array(),
                },
                tag: Default::default(),
            });
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        _: TargetMotion,
    ) -> Option<SweepContact> {
        // Two balls touch at the smaller root of a quadratic.
        let (from, way) = (capsule.ends[0] - self.0, displacements[0]);
        let (a, b) = (way.length_squared(), from.dot(way));
        let reach = 1.0 + capsule.radius;
        let c = from.length_squared() - reach * reach;
        let time = (-b - (b * b - a * c).sqrt()) / a;
        let mut found = Vec::new();
        self.overlap_capsule(
            &capsule.moved(way * time).with_radius(f64::INFINITY),
            &mut found,
        );
        let contact = found.pop()?;
        (0.0..=1.0).contains(&time).then_some(SweepContact {
            time,
            contact,
            separation_normal: contact.normal,
            started_inside: false,
        })
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let place = self.0 + DVec3::from_array(point.coordinates);
        Some(PointMotion::translated(place, place, dt))
    }

    fn bounds(&self) -> Option<(DVec3, f64)> {
        Some((self.0, 1.0))
    }
}

#[test]
fn an_endless_ray_hits_distant_obstacles_along_any_axis() {
    for direction in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::new(0.6, 0.0, -0.8)] {
        for distance in [5.0, 5e4] {
            let ball = Ball(direction * distance, Cell::new(0));
            let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(3), &ball)];
            let mut memory = MoverMemory::default();
            let mut mover = Mover::new(&obstacles, 0.1, &mut memory).unwrap();
            for length in [f64::INFINITY, f64::MAX, 1e160, 1e200, 2.0 * distance] {
                let met = mover.cast_ray(DVec3::ZERO, direction, length);
                let off = met.map(|met| met.contact.distance - (distance - 1.0));
                let is_there = off.is_some_and(|off| off.abs() < 1e-5);
                assert!(is_there, "{direction} {distance} {length}: {met:?}");
            }
            assert_eq!(mover.cast_ray(DVec3::ZERO, direction, f64::NAN), None);
            assert_eq!(mover.cast_ray(DVec3::ZERO, -direction, f64::INFINITY), None);
            assert_eq!(mover.cast_ray(DVec3::ZERO, direction, -1.0), None);
            // After an endless ray, near obstacles are queried and distant ones are skipped again.
            mover.cast_ray(DVec3::ZERO, direction, f64::INFINITY);
            for (place, is_asked) in [(ball.0, true), (DVec3::ZERO, false)] {
                ball.1.set(0);
                mover.overlap(&MoverBody::ball(0.4, 0.01), place, 0.1);
                assert_eq!(ball.1.get() > 0, is_asked, "{distance} {place}");
                mover.cast_ray(DVec3::ZERO, direction, f64::INFINITY);
            }
        }
    }
}

#[test]
fn a_path_that_is_not_finite_leaves_the_body_at_its_start() {
    let obstacles: [(ObstacleId, &dyn Obstacle); 0] = [];
    let mut memory = MoverMemory::default();
    let mut mover = Mover::new(&obstacles, 0.1, &mut memory).unwrap();
    let path = Path::new(MoverBody::ball(0.4, 0.01), DVec3::ZERO, DVec3::X);
    assert_eq!(mover.slide(&path).position, DVec3::X);
    for bad in [f64::NAN, f64::INFINITY] {
        let arm = |pivot, length| Path {
            arm: Some(Arm { pivot, length }),
            ..path
        };
        let walking = |up, max_slope| Path {
            walking: Some(Walking { up, max_slope }),
            ..path
        };
        let broken = DVec3::new(0.0, bad, 0.0);
        let paths = [
            arm(DVec3::Y, bad),
            arm(broken, 1.0),
            walking(DVec3::Y, bad),
            walking(broken, 0.8),
            Path {
                target: broken,
                ..path
            },
        ];
        for path in paths {
            let moved = mover.slide(&path);
            assert_eq!((moved.position, moved.is_clear), (DVec3::ZERO, false));
        }
    }
}
