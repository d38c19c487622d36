use clamber_surface::mesh::SurfaceTag;
use clamber_surface::surface::TargetMotion;
use glam::DVec3;

use crate::{Contact, MaterialPoint, Obstacle, PointMotion, SweepContact, WorldCapsule};

/// Endless ground, without a physics engine: everything on one side of a plane is solid. It does not move.
///
/// ```
/// use clamber_world::glam::DVec3;
/// use clamber_world::{HalfSpace, Obstacle};
///
/// let ground = HalfSpace::below(0.0);
/// let below = ground.cast_ray(DVec3::Y * 5.0, DVec3::NEG_Y, 100.0).unwrap();
/// assert_eq!((below.distance, below.normal), (5.0, DVec3::Y));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    normal: DVec3,
    /// Distance of the plane from the origin, along the normal.
    offset: f64,
    tag: SurfaceTag,
}

impl HalfSpace {
    /// Everything below a height in metres, where Y is up.
    pub fn below(height: f64) -> Self {
        Self {
            normal: DVec3::Y,
            offset: height,
            tag: SurfaceTag::default(),
        }
    }

    /// Everything behind a plane through `point`, in world space. `normal` points out of the solid and may have any
    /// length but zero. `None` if the normal is zero, or a number is not finite.
    pub fn behind(point: DVec3, normal: DVec3) -> Option<Self> {
        let normal = normal.try_normalize()?;
        point.is_finite().then(|| Self {
            normal,
            offset: normal.dot(point),
            tag: SurfaceTag::default(),
        })
    }

    /// The same half-space of another material: contacts carry `tag`.
    #[must_use]
    pub const fn with_tag(self, tag: SurfaceTag) -> Self {
        Self { tag, ..self }
    }

    /// How far a point is in front of the plane, metres; negative in the solid.
    fn height(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.offset
    }

    /// The contact below a point.
    fn contact(&self, from: DVec3) -> Contact {
        let distance = self.height(from);
        let point = from - self.normal * distance;
        Contact {
            point,
            normal: self.normal,
            distance,
            material: MaterialPoint {
                key: 0,
                coordinates: point.to_array(),
            },
            tag: self.tag,
        }
    }
}

impl Obstacle for HalfSpace {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let [a, b] = capsule.ends;
        let lower = if self.height(b) < self.height(a) {
            b
        } else {
            a
        };
        let contact = self.contact(lower);
        if capsule.is_valid() && contact.distance <= capsule.radius {
            contacts.push(contact);
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        _: TargetMotion,
    ) -> Option<SweepContact> {
        if !capsule.is_valid() || !displacements.iter().all(|way| way.is_finite()) {
            return None;
        }
        // A cast may stop short by twice this, which covers rounding up to a million kilometres from the origin.
        let slack = 0.5 * capsule.sweep_tolerance();
        let ends = capsule.ends.into_iter().zip(displacements);
        let contacts = ends.filter_map(|(end, way)| {
            let gap = self.height(end) - capsule.radius;
            let approach = -self.normal.dot(way);
            let started_inside = gap <= 0.0;
            if !started_inside && (gap - approach > slack || approach <= 0.0) {
                return None;
            }
            let time = if gap <= slack {
                0.0
            } else {
                (gap - slack) / approach
            };
            Some(SweepContact {
                fraction: time,
                contact: self.contact(end + way * time),
                separation_normal: self.normal,
                started_inside,
            })
        });
        contacts.min_by(|a, b| {
            let nearer = a.contact.distance.total_cmp(&b.contact.distance);
            a.fraction.total_cmp(&b.fraction).then(nearer)
        })
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let at = DVec3::from(point.coordinates);
        Some(PointMotion {
            was_teleported: false,
            ..PointMotion::translated(at, at, dt)
        })
    }

    fn rests(&self, _: &MaterialPoint) -> bool {
        true
    }

    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        let direction = direction.try_normalize()?;
        if max_distance.is_nan() || max_distance < 0.0 || !origin.is_finite() {
            return None;
        }
        let height = self.height(origin);
        let distance = if height <= 0.0 {
            0.0
        } else {
            height / -self.normal.dot(direction)
        };
        // The distance is infinite along the plane, and negative away from it.
        ((0.0..f64::INFINITY).contains(&distance) && distance <= max_distance).then(|| Contact {
            distance,
            ..self.contact(origin + direction * distance)
        })
    }

    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let contact = self.contact(point);
        (point.is_finite() && max_distance >= 0.0 && contact.distance <= max_distance)
            .then_some(contact)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope() -> HalfSpace {
        HalfSpace::behind(DVec3::new(3.0, -2.0, 1e6), DVec3::new(1.0, 2.0, -0.5)).unwrap()
    }

    fn random(rng: &mut fastrand::Rng, size: f64) -> DVec3 {
        DVec3::from([(); 3].map(|()| (rng.f64() * 2.0 - 1.0) * size))
    }

    #[test]
    fn planes_without_a_direction_are_refused() {
        assert_eq!(HalfSpace::behind(DVec3::ZERO, DVec3::ZERO), None);
        assert_eq!(HalfSpace::behind(DVec3::ZERO, DVec3::NAN), None);
        assert_eq!(HalfSpace::behind(DVec3::INFINITY, DVec3::Y), None);
    }

    /// A cast that meets the plane stops in front of it, by at most its tolerance; one that does not meet it ends in
    /// front of it.
    #[test]
    fn casts_stop_in_front_of_the_plane() {
        let mut rng = fastrand::Rng::with_seed(3);
        let (slope, mut met) = (slope(), 0);
        for _ in 0..100_000 {
            let ends = [(); 2].map(|()| DVec3::new(0.0, 0.0, 1e6) + random(&mut rng, 5.0));
            let capsule = WorldCapsule {
                ends,
                radius: rng.f64(),
            };
            let ways = [(); 2].map(|()| random(&mut rng, 4.0));
            let gap = |by: [DVec3; 2]| {
                let ends = capsule
                    .with_ends_moved(by)
                    .ends
                    .map(|end| slope.height(end));
                ends[0].min(ends[1]) - capsule.radius
            };
            match slope.cast_capsule(&capsule, ways, TargetMotion::Moving) {
                None => assert!(gap([DVec3::ZERO; 2]) > 0.0 && gap(ways) > -1e-9),
                Some(hit) if gap([DVec3::ZERO; 2]) <= 0.0 => {
                    assert!(hit.started_inside && hit.fraction == 0.0);
                }
                Some(hit) => {
                    met += 1;
                    let gap = gap(ways.map(|way| way * hit.fraction));
                    assert!(!hit.started_inside && (0.0..=1.0).contains(&hit.fraction));
                    assert!((-1e-9..=capsule.sweep_tolerance()).contains(&gap), "{gap}");
                    let off = hit.contact.distance - capsule.radius;
                    assert!((off - gap).abs() < 1e-8, "{off}, {gap}");
                }
            }
        }
        assert!(met > 5_000, "{met}");
    }

    #[test]
    fn rays_and_nearest_points_lie_on_the_plane() {
        let mut rng = fastrand::Rng::with_seed(4);
        let slope = slope();
        for _ in 0..10_000 {
            let from = DVec3::new(0.0, 0.0, 1e6) + random(&mut rng, 5.0);
            let nearest = slope.closest_point(from, f64::INFINITY).unwrap();
            assert!(slope.height(nearest.point).abs() < 1e-8);
            assert_eq!(nearest.distance, slope.height(from));
            let direction = random(&mut rng, 1.0);
            let hit = slope.cast_ray(from, direction, 1e3);
            let comes = slope.height(from) <= 0.0
                || slope.height(from + direction.normalize() * 1e3) <= 0.0;
            assert_eq!(hit.is_some(), comes);
            if let Some(hit) = hit.filter(|hit| hit.distance > 0.0) {
                assert!(
                    hit.point
                        .distance(from + direction.normalize() * hit.distance)
                        < 1e-6
                );
            }
        }
    }

    #[test]
    fn what_is_not_finite_finds_nothing() {
        let ground = HalfSpace::below(0.0);
        let nan = WorldCapsule::ball(DVec3::NAN, 1.0);
        let mut contacts = Vec::new();
        ground.overlap_capsule(&nan, &mut contacts);
        assert!(contacts.is_empty());
        let still = TargetMotion::Still;
        let ball = WorldCapsule::ball(DVec3::Y, 0.5);
        assert_eq!(ground.cast_capsule(&nan, [DVec3::ZERO; 2], still), None);
        assert_eq!(ground.cast_capsule(&ball, [DVec3::NAN; 2], still), None);
        assert_eq!(ground.closest_point(DVec3::NAN, 1.0), None);
        assert_eq!(ground.closest_point(DVec3::Y, f64::NAN), None);
        assert_eq!(ground.closest_point(DVec3::Y, 0.5), None);
        assert_eq!(ground.cast_ray(DVec3::Y, DVec3::NAN, 1.0), None);
        assert_eq!(ground.cast_ray(DVec3::Y, DVec3::X, f64::INFINITY), None);
        assert_eq!(ground.cast_ray(DVec3::Y, DVec3::NEG_Y, 0.5), None);
    }
}
