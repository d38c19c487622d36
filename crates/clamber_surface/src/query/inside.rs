//! Whether a point is inside the creature.
//!
//! A ray from the point to infinity leaves a closed surface once more than it enters it if the point is inside
//! (Jordan's theorem; Haines 1994, "Point in Polygon Strategies", Graphics Gems IV, in the plane). The count goes
//! wrong where the ray meets an edge or a corner, which all triangles around it count, and where it leaves through a
//! hole. Three rays in unrelated directions are counted, and two that agree decide.

use glam::Vec3;

use super::ModelSpace;
use crate::geometry::Ray;

/// Directions of the rays, up, down and to the side, some 77 to 109 degrees apart, so that a sheet that is open behind
/// seldom stops two of them. Far from axes and diagonals, along which edges of modelled
/// creatures run.
pub(super) const DIRECTIONS: [Vec3; 3] = [
    Vec3::new(0.371, 0.803, 0.467),
    Vec3::new(-0.523, -0.541, 0.659),
    Vec3::new(0.881, -0.331, 0.337),
];

impl ModelSpace<'_> {
    /// True if a point is inside: where the surface winds around it at least once, by the triangles that queries see.
    /// A point that is not finite is not.
    ///
    /// Where the surface has holes, and for the few points from which a ray meets an edge exactly, two of three
    /// directions decide: near a hole a point may count as either, as on the surface itself. Mirrored parts count
    /// with their outside outside.
    pub fn is_inside(&self, point: Vec3) -> bool {
        let mut inside = 0;
        for (asked, direction) in DIRECTIONS.into_iter().enumerate() {
            inside += i32::from(self.leaves_more_than_it_enters(point, direction));
            // Two that agree decide.
            if asked == 1 && inside != 1 {
                break;
            }
        }
        inside >= 2
    }

    fn leaves_more_than_it_enters(&self, point: Vec3, direction: Vec3) -> bool {
        let Some(ray) = Ray::new(point, direction) else {
            return false;
        };
        let mut crossings = 0;
        let instance = self.instance;
        instance.visit_ray(&ray, f64::INFINITY, |posed, triangle, _| {
            let [corners] = posed.corners(triangle);
            let outward = instance.outward_normal(corners, posed.part());
            let along = outward.map_or(0.0, |normal| normal.dot(direction.as_dvec3()));
            crossings += i32::from(along > 0.0) - i32::from(along < 0.0);
            Some(f64::INFINITY)
        });
        crossings > 0
    }
}
