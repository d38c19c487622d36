use std::cell::Cell;

use super::*;
use crate::{Arm, GroundProbe, Path, Walking};

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
        let there = capsule.moved(way * time).with_radius(f64::INFINITY);
        self.overlap_capsule(&there, &mut found);
        let contact = found.pop()?;
        (0.0..=1.0).contains(&time).then_some(SweepContact {
            fraction: time,
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
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
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
        ];
        let vectors = [0, 1, 2].map(|axis| {
            let mut broken = DVec3::ZERO;
            broken[axis] = bad;
            let mut paths = [path; 4];
            paths[0].target = broken;
            paths[1].frame = broken;
            paths[2].start_axis[0] = broken;
            paths[3].start_axis[1] = broken;
            paths
        });
        for path in paths.into_iter().chain(vectors.into_iter().flatten()) {
            let moved = mover.slide(&path);
            assert_eq!((moved.position, moved.is_clear), (DVec3::ZERO, false));
        }
        let lost = Path {
            start: DVec3::X * bad,
            ..path
        };
        assert!(!mover.slide(&lost).is_clear);
    }
}

/// Two floors, one above the other. The upper one is not solid: queries of every kind find the lower one, in either
/// order of the two.
#[test]
fn what_is_not_solid_is_not_there_for_any_query() {
    let [upper, lower] = [0.0, -2.0].map(clamber_world::HalfSpace::below);
    let [upper, lower]: [(ObstacleId, &dyn Obstacle); 2] =
        [(ObstacleId(1), &upper), (ObstacleId(2), &lower)];
    let is_solid = |id: ObstacleId, _: &dyn Obstacle, _: &Contact| id == ObstacleId(2);
    let filters = ContactFilters {
        solid: Some(&is_solid),
        ..ContactFilters::default()
    };
    let body = MoverBody::ball(0.4, 0.01);
    let [above, within] = [DVec3::Y, DVec3::NEG_Y];
    for obstacles in [[upper, lower], [lower, upper]] {
        let mut memory = MoverMemory::default();
        let mover = Mover::new(&obstacles, 0.1, &mut memory).unwrap();
        let mut mover = mover.with_filters(filters);
        let down = DVec3::NEG_Y * 4.0;
        let met = mover.cast(&body.at(above), down).unwrap();
        assert!((met.fraction - 0.65).abs() < 1e-4, "{met:?}");
        let met = mover.sweep(&body.at(above), [down; 2]).unwrap();
        assert!((met.fraction - 0.65).abs() < 1e-4, "{met:?}");
        let met = mover.sweep_where(&body.at(above), [down; 2], |_| true);
        assert_eq!(met.unwrap().contact.obstacle, ObstacleId(2));
        let met = mover.cast_ray(above, DVec3::NEG_Y, 9.0).unwrap();
        assert!((met.contact.distance - 3.0).abs() < 1e-5, "{met:?}");
        assert!(mover.is_free(&body.at(above), DVec3::NEG_Y * 2.0));
        assert!(mover.overlap(&body, within, 0.5).is_empty());
        assert_eq!(mover.overlap(&body, within, 0.7).len(), 1);
        let moved = mover.slide(&Path::new(body, above, above + down));
        assert!((moved.position.y + 1.6).abs() < 1e-3, "{moved:?}");
        let probe = GroundProbe {
            body,
            up: DVec3::Y,
            max_slope: 0.8,
            reach: 0.7,
        };
        let ground = mover.find_ground(&probe, within).unwrap();
        assert_eq!(ground.touch.obstacle, ObstacleId(2));
    }
}

/// A contact that the `ground` filter rejects is no ground, but still solid.
#[test]
fn what_is_no_ground_is_not_found_as_such_but_blocks() {
    let floor = clamber_world::HalfSpace::below(0.0);
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(1), &floor)];
    let is_ground = |_: ObstacleId, _: &dyn Obstacle, _: &Contact| false;
    let body = MoverBody::ball(0.4, 0.01);
    let start = DVec3::Y * 0.5;
    let probe = GroundProbe {
        body,
        up: DVec3::Y,
        max_slope: 0.8,
        reach: 0.7,
    };
    for ground in [None, Some(&is_ground as &ContactFilter<'_>)] {
        let mut memory = MoverMemory::default();
        let mover = Mover::new(&obstacles, 0.1, &mut memory).unwrap();
        let mut mover = mover.with_filters(ContactFilters {
            ground,
            ..ContactFilters::default()
        });
        assert_eq!(mover.find_ground(&probe, start).is_some(), ground.is_none());
        let moved = mover.slide(&Path::new(body, start, DVec3::NEG_Y));
        assert!((moved.position.y - 0.4).abs() < 1e-3, "{moved:?}");
        assert_eq!(mover.holding_up(DVec3::Y, 0.8).is_some(), ground.is_none());
    }
}
