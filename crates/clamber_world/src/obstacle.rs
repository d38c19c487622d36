use clamber_surface::mesh::SurfaceTag;
use glam::{DQuat, DVec3};

/// Which obstacle of a scene; chosen by the caller, the same from tick to tick.
///
/// Of equal distances the smaller id wins, so results do not depend on the order in which obstacles
/// are handed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ObstacleId(pub u32);

/// A point of an obstacle's material. Only the obstacle that made it can read it.
///
/// A small plain value: two of them are the same point if their bits are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialPoint {
    /// What the point lies on: a triangle of a surface, a collider of a rapier world.
    pub key: u64,
    /// Where on it: barycentric coordinates on a surface, local coordinates on a body.
    pub coordinates: [f64; 3],
}

/// Where a query touched an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// In world space.
    pub point: DVec3,
    /// Unit normal that points out of the obstacle.
    pub normal: DVec3,
    /// From the query's point or the ray's origin. Negative only inside a solid body: the way out
    /// is along `normal`, so far.
    pub distance: f64,
    /// The same point, as part of the obstacle.
    pub material: MaterialPoint,
    /// What the obstacle is made of there.
    pub tag: SurfaceTag,
}

impl Contact {
    /// Unit vector from the contact towards `center`, the point that the query was made for; the
    /// normal where the two coincide, and inside a solid body.
    pub fn away(&self, center: DVec3) -> DVec3 {
        if self.distance > 0.0 {
            (center - self.point).normalize_or(self.normal)
        } else {
            self.normal
        }
    }
}

/// How a material point moves over the tick that ends now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMotion {
    /// Where it is now, in world space.
    pub position: DVec3,
    /// Where it was a tick ago.
    pub previous_position: DVec3,
    /// Displacement over the tick, per second: never an instantaneous velocity.
    pub velocity: DVec3,
    /// Rotation of the material around the point, from the obstacle's rest to now. `None` where
    /// the material has collapsed and has no direction of its own: the last one known stands.
    pub frame: Option<DQuat>,
    /// Rotation of the frame over the tick.
    pub turn: DQuat,
    /// Area of the skin there now over a tick ago; 1 on rigid bodies.
    pub area_ratio: f64,
    /// Largest and smallest stretch of the skin over the tick; 1 on rigid bodies.
    pub stretches: [f64; 2],
}

/// Something that a character can stand on, hit, or be carried by.
///
/// All queries are in world space, see the pose of this tick, and take `&self`. A point or direction
/// that is not finite finds nothing, and neither does a length that is NaN or negative; lengths may
/// be infinite.
pub trait Obstacle {
    /// Centre and radius of a ball in world space that holds all that queries of this tick can touch; `None` for what
    /// has no bounds, or does not know them. What is out of its reach is not asked.
    fn bounds(&self) -> Option<(DVec3, f64)> {
        None
    }

    /// The first point along a ray from `origin`, up to `max_distance`. `direction` may have any
    /// length but zero; distances are in metres along it.
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact>;

    /// The point nearest to `point`, up to `max_distance`.
    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact>;

    /// Appends what lies within `radius` of `center`: for each triangle or convex body its point
    /// nearest to the centre, by ascending [`MaterialPoint::key`].
    fn overlap_sphere(&self, center: DVec3, radius: f64, contacts: &mut Vec<Contact>);

    /// The motion of a material point over the tick of `dt` seconds that ends now; `None` if the
    /// material is no longer there, or queries no longer see it.
    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion>;
}
