//! Whether a point is inside the creature.
//!
//! A ray from a point inside a closed surface to infinity leaves the surface once more than it enters it (Jordan's
//! theorem; Haines 1994, "Point in Polygon Strategies", Graphics Gems IV, in the plane). The count is wrong if the ray
//! meets an edge or a corner, which all triangles around it count, or if it leaves through a hole. So up to three rays
//! in unrelated directions are counted, and two that agree decide.

use glam::Vec3;

use super::ModelSpace;
use crate::geometry::Ray;

/// Directions of the rays: up, down and to the side, some 77 to 109 degrees apart, so that an open sheet seldom stops
/// two of them. They are far from axes and diagonals, along which the edges of modelled creatures run.
pub(super) const DIRECTIONS: [Vec3; 3] = [
    Vec3::new(0.371, 0.803, 0.467),
    Vec3::new(-0.523, -0.541, 0.659),
    Vec3::new(0.881, -0.331, 0.337),
];

impl ModelSpace<'_> {
    /// True if a point, in model space, is inside the surface: the enabled triangles wind around it at least once.
    /// False for a point that is not finite.
    ///
    /// Two of three rays decide, so one ray through a hole, or exactly through an edge, is outvoted. Near a hole, and
    /// on the surface itself, the result may be either. Mirrored parts count with their outward normals.
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
        instance.visit_ray(&ray, f64::INFINITY, &mut |posed, triangle, _| {
            let [corners] = posed.corners(triangle);
            let outward = instance.outward_normal(corners, posed.part());
            let along = outward.map_or(0.0, |normal| normal.dot(direction.as_dvec3()));
            crossings += i32::from(along > 0.0) - i32::from(along < 0.0);
            Some(f64::INFINITY)
        });
        crossings > 0
    }
}
