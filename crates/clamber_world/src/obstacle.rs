use clamber_surface::mesh::SurfaceTag;
use glam::{DQuat, DVec3};

/// Which obstacle of a scene; chosen by the caller, the same from tick to tick.
///
/// Of equal distances the smaller id wins, so results do not depend on the order in which obstacles
/// are handed over. An id names one obstacle for as long as a climber may remember it: a game that reuses slots puts a
/// generation into the upper 32 bits, as the bits of Bevy's `Entity` have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ObstacleId(pub u64);

/// A point of an obstacle's material. Only the obstacle that made it can read it.
///
/// A small plain value: two of them are the same point if their bits are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

/// All points within a radius of a segment, in world space: what a character is to the world. A ball where both ends are
/// one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldCapsule {
    /// Ends of the segment.
    pub ends: [DVec3; 2],
    /// Metres, not negative.
    pub radius: f64,
}

/// [`WorldCapsule::sweep_tolerance`].
pub(crate) fn sweep_tolerance(radius: f64) -> f64 {
    (radius * 2.5e-4).max(1e-6)
}

impl WorldCapsule {
    /// A ball.
    pub const fn ball(center: DVec3, radius: f64) -> Self {
        Self {
            ends: [center, center],
            radius,
        }
    }

    /// Both ends are one point.
    pub fn is_ball(&self) -> bool {
        self.ends[0] == self.ends[1]
    }

    /// The same, somewhere else.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        self.with_ends_moved([by; 2])
    }

    /// With each end somewhere else.
    #[must_use]
    pub fn with_ends_moved(&self, by: [DVec3; 2]) -> Self {
        Self {
            ends: [self.ends[0] + by[0], self.ends[1] + by[1]],
            ..*self
        }
    }

    /// How far from touching a sweep or cast of it may stop, metres: a share of its radius below what one sees, 0.1 mm
    /// for a ball of 0.4 m. For thin capsules no less than the steps of f32 some metres out.
    pub fn sweep_tolerance(&self) -> f64 {
        sweep_tolerance(self.radius)
    }

    /// With another radius.
    #[must_use]
    pub const fn with_radius(&self, radius: f64) -> Self {
        Self { radius, ..*self }
    }

    /// The point of the segment nearest to a point.
    pub fn nearest_on_axis(&self, point: DVec3) -> DVec3 {
        let [a, b] = self.ends;
        a + (b - a) * self.share_of_axis(point)
    }

    /// Where the point of the segment nearest to a point lies, as a share of the way from the first end to the second.
    pub fn share_of_axis(&self, point: DVec3) -> f64 {
        let [a, b] = self.ends;
        let axis = b - a;
        let along = (point - a).dot(axis);
        let length_sq = axis.length_squared();
        if along > 0.0 && length_sq > 0.0 {
            (along / length_sq).min(1.0)
        } else {
            0.0
        }
    }

    /// Centre and radius of a ball around it.
    pub fn bounding_ball(&self) -> (DVec3, f64) {
        let [a, b] = self.ends;
        ((a + b) * 0.5, (b - a).length() * 0.5 + self.radius)
    }
}

/// Where a capsule on its way first touches an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepContact {
    /// Share of the tick, and so of each displacement, when they touch, 0..=1.
    pub time: f64,
    /// What is touched, where and how it is at that time; its distance is from the capsule's segment.
    pub contact: Contact,
    /// Unit vector from there towards the capsule's segment.
    pub away: DVec3,
    /// They overlap at the start already; the time is 0.
    pub started_inside: bool,
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
    /// It may have been put here (a teleport) since the last tick rather than moved. What stands still and cannot tell
    /// says true. A point that is elsewhere than it was, without having been placed, belongs to another obstacle.
    pub placed: bool,
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

impl PointMotion {
    /// Whether all numbers that a character is carried by are finite.
    pub fn is_finite(&self) -> bool {
        let vectors = [self.position, self.previous_position, self.velocity];
        vectors.iter().all(|v| v.is_finite())
            && self.turn.is_finite()
            && self.frame.is_none_or(|frame| frame.is_finite())
    }
}

/// Something that a character can stand on, hit, or be carried by.
///
/// All queries are in world space and take `&self`. All but [`Obstacle::sweep_capsule`] see the pose of this tick. A
/// point or direction that is not finite finds nothing, and neither does a length that is NaN or negative; lengths may be
/// infinite, but for those of capsules that move.
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

    /// Appends what lies within a capsule: for each triangle or convex body its point nearest to the capsule's segment,
    /// by ascending [`MaterialPoint::key`]. Distances are from the segment.
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>);

    /// [`Obstacle::overlap_capsule`] for a ball.
    fn overlap_sphere(&self, center: DVec3, radius: f64, contacts: &mut Vec<Contact>) {
        self.overlap_capsule(&WorldCapsule::ball(center, radius), contacts);
    }

    /// The first contact of a capsule that moves by `displacement`, with the obstacle standing still as it stands now.
    /// Never later than the true one, at a distance of at most the capsule's radius and 0.1 mm; on skin, and a 4,000th of
    /// the radius.
    fn cast_capsule(&self, capsule: &WorldCapsule, displacement: DVec3) -> Option<SweepContact>;

    /// The first contact of a capsule over the tick that ends now, while the obstacle moves from where it stood a tick
    /// ago to where it stands now. `capsule` is the capsule at the tick's start; each of its ends goes straight by its own
    /// displacement, so that it may turn, as the legs of one who swings.
    fn sweep_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
    ) -> Option<SweepContact>;

    /// [`Obstacle::sweep_capsule`] among the contacts that count: of each triangle and solid that may be the first to be
    /// touched its contact is shown to `counts`, in no order. A body that is pressed into one thing still meets the others.
    ///
    /// The default shows the first contact alone, which is right for a single solid.
    fn sweep_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        self.sweep_capsule(capsule, displacements)
            .filter(|contact| counts(contact))
    }

    /// The speed, metres a second, that an impulse of 1 N s along a unit `direction` gives to a material point; 0 for
    /// what cannot be pushed.
    fn push_response(&self, point: &MaterialPoint, direction: DVec3) -> f64 {
        let _ = (point, direction);
        0.0
    }

    /// Which of the obstacle's bodies a material point belongs to, where it is made of several that move apart: a collider
    /// of a rapier world. Contacts of one body are looked at together. The default says that it is one body.
    fn body_of(&self, point: &MaterialPoint) -> u64 {
        let _ = point;
        0
    }

    /// The motion of a material point over the tick of `dt` seconds that ends now; `None` if the
    /// material is no longer there, or queries no longer see it.
    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion>;
}
