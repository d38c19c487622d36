use clamber_surface::geometry::WorldCapsule;
use clamber_surface::mesh::SurfaceTag;
use clamber_surface::surface::TargetMotion;
use glam::{DQuat, DVec3};

/// How far queries look where nothing says how large an obstacle is, metres. Along it f64 still tells 0.2 nm apart.
const FARTHEST: f64 = 1e6;

/// How far from a point an obstacle of these bounds reaches.
fn farthest(bounds: Option<(DVec3, f64)>, from: DVec3) -> f64 {
    bounds.map_or(FARTHEST, |(center, radius)| from.distance(center) + radius)
}

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
    /// Unit normal that points out of the obstacle. `RapierTerrain::cast_ray`, and that of avian's terrain, turns the
    /// normal of a triangle that is hit from behind towards the ray's origin.
    pub normal: DVec3,
    /// Metres, from the query's point, the ray's origin or the capsule's segment. Negative only inside a solid body:
    /// its magnitude is the way out along `normal`.
    pub distance: f64,
    /// The same point, as part of the obstacle.
    pub material: MaterialPoint,
    /// What the obstacle is made of there.
    pub tag: SurfaceTag,
}

impl Contact {
    /// Unit vector from the contact towards `center`, the point that the query was made for; the
    /// normal where the two coincide, and inside a solid body.
    pub fn separation_normal(&self, center: DVec3) -> DVec3 {
        if self.distance > 0.0 {
            (center - self.point).normalize_or(self.normal)
        } else {
            self.normal
        }
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
    pub separation_normal: DVec3,
    /// They overlap at the start already; the time is 0.
    pub started_inside: bool,
}

/// How a material point moves over the tick that ends now.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PointMotion {
    /// Where it is now, in world space.
    pub position: DVec3,
    /// Where it was a tick ago.
    pub previous_position: DVec3,
    /// Displacement over the tick, per second: never an instantaneous velocity.
    pub velocity: DVec3,
    /// True if the point may have been teleported. An obstacle that cannot tell a teleport from rest sets it when the
    /// point did not move. Never true for a point that moved.
    pub placed: bool,
    /// Rotation of the material around the point, from the obstacle's rest to now: of a rigid body, its rotation. `None`
    /// where the material has collapsed and has no direction of its own: the last one known stands.
    pub frame: Option<DQuat>,
    /// Rotation of the frame over the tick, in world space: `now * before⁻¹`.
    pub turn: DQuat,
    /// Area of the skin there now over a tick ago; 1 on rigid bodies.
    pub area_ratio: f64,
    /// Largest and smallest stretch of the skin over the tick; 1 on rigid bodies.
    pub stretches: [f64; 2],
}

impl PointMotion {
    /// The motion of material that neither turns nor stretches, over a tick of `dt` seconds. The velocity is zero
    /// unless `dt` is positive. A point that did not move is taken for one that may have been [`placed`](Self::placed);
    /// an obstacle that knows better says so there. For what turns there is
    /// [`RigidPose::motion_since`](crate::RigidPose::motion_since).
    pub fn translated(previous_position: DVec3, position: DVec3, dt: f64) -> Self {
        let way = position - previous_position;
        Self {
            position,
            previous_position,
            velocity: if dt > 0.0 { way / dt } else { DVec3::ZERO },
            placed: way == DVec3::ZERO,
            frame: Some(DQuat::IDENTITY),
            turn: DQuat::IDENTITY,
            area_ratio: 1.0,
            stretches: [1.0, 1.0],
        }
    }

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
/// Three methods make an obstacle: [`overlap_capsule`](Obstacle::overlap_capsule),
/// [`cast_capsule`](Obstacle::cast_capsule) and [`motion`](Obstacle::motion). The others have defaults made of these, for
/// an obstacle to answer faster or better where it can.
///
/// All queries are in world space and take `&self`. They see the obstacle as it stands now, except a cast with
/// [`TargetMotion::Moving`]. A point or direction that is not finite finds nothing, and neither does a length that is
/// NaN or negative. Ray lengths and the distances of closest-point queries may be infinite; radii and displacements are
/// finite.
pub trait Obstacle {
    /// Appends what lies within a capsule: for each triangle or convex body its point nearest to the capsule's segment,
    /// by ascending [`MaterialPoint::key`]. Distances are from the segment.
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>);

    /// The first contact of a capsule, each of whose ends goes straight by its own displacement, so that it may turn, as the
    /// legs of a climber that swings.
    ///
    /// With [`TargetMotion::Still`] the obstacle stands as it stands now. With [`TargetMotion::Moving`] it moves meanwhile
    /// from where it stood a tick ago to where it stands now: `capsule` is the capsule at the tick's start.
    ///
    /// The time is never later than the first contact. At that time the capsule is at most
    /// [`WorldCapsule::sweep_tolerance`] from touching. A capsule that starts as near, does not overlap, and only moves away
    /// may be left out. A contact that the obstacle's solver cannot decide, as
    /// [`SweepHit::undecided`](clamber_surface::surface::SweepHit::undecided) on skin, is reported as well, and may be
    /// farther away. Of several overlaps at the start, the one nearest to the capsule's segment is given, at time 0.
    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact>;

    /// The motion of a material point over the tick of `dt` seconds that ends now; `None` if the
    /// material is no longer there, or queries no longer see it.
    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion>;

    /// Centre and radius of a ball in world space, metres, that holds everything that queries of this tick can touch.
    /// `None` if it is unbounded or unknown. Queries outside the ball skip the obstacle.
    fn bounds(&self) -> Option<(DVec3, f64)> {
        None
    }

    /// [`Obstacle::cast_capsule`] among chosen contacts. `counts` is called, in any order, with the contact of each
    /// triangle or solid that could be the first; contacts for which it returns false are passed over. So a body that
    /// is pressed into one thing still meets the others.
    ///
    /// The default calls `counts` with the first contact alone, which is right for a single solid.
    fn cast_capsule_where(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        self.cast_capsule(capsule, displacements, target)
            .filter(|contact| counts(contact))
    }

    /// The first point along a ray from `origin`, up to `max_distance`. `direction` may have any
    /// length but zero; distances are in metres along it. A ray that starts inside a solid hits at distance 0; its
    /// normal need not point out.
    ///
    /// The default casts a ball of no radius. Its distance is short by at most 1 micrometre over the sine of the angle
    /// between ray and surface, and a ray that passes within a micrometre counts as a hit. Without
    /// [`Obstacle::bounds`] it looks no farther than 1,000 km.
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        if max_distance.is_nan() || max_distance < 0.0 || !origin.is_finite() {
            return None;
        }
        let length = max_distance.min(farthest(self.bounds(), origin));
        let way = direction.try_normalize()? * length;
        let ball = WorldCapsule::ball(origin, 0.0);
        let hit = self.cast_capsule(&ball, [way; 2], TargetMotion::Still)?;
        let distance = hit.time * length;
        Some(Contact {
            distance,
            ..hit.contact
        })
    }

    /// The point nearest to `point`, up to `max_distance`.
    ///
    /// The default looks through all that a ball of that radius overlaps. Without [`Obstacle::bounds`] it looks no farther
    /// than 1,000 km.
    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let mut contacts = Vec::new();
        // A comparison, since `f64::min` passes over NaN.
        let farthest = farthest(self.bounds(), point);
        let reach = if max_distance > farthest {
            farthest
        } else {
            max_distance
        };
        self.overlap_sphere(point, reach, &mut contacts);
        let nearer = |a: &Contact, b: &Contact| a.distance.total_cmp(&b.distance);
        contacts.into_iter().min_by(nearer)
    }

    /// [`Obstacle::overlap_capsule`] for a ball.
    fn overlap_sphere(&self, center: DVec3, radius: f64, contacts: &mut Vec<Contact>) {
        self.overlap_capsule(&WorldCapsule::ball(center, radius), contacts);
    }

    /// The speed, metres a second, that an impulse of 1 N s along a unit `direction` gives to a material point; 0 for
    /// what cannot be pushed.
    fn push_response(&self, point: &MaterialPoint, direction: DVec3) -> f64 {
        let _ = (point, direction);
        0.0
    }

    /// Id of the rigid body that owns the point; each collider of a rapier world counts as one. Contacts of one body
    /// are judged together when a character is pressed through a surface. The default is one body, 0.
    fn body_of(&self, point: &MaterialPoint) -> u64 {
        let _ = point;
        0
    }
}

#[cfg(test)]
mod tests;
