use crate::Others;
use clamber_surface::geometry::WorldCapsule;
use clamber_surface::mesh::SurfaceTag;
use clamber_surface::surface::{TargetMotion, WorldPath};
use glam::{DQuat, DVec3};

/// Search distance for an obstacle without bounds, metres. At this distance f64 still resolves 0.2 nm.
const FARTHEST: f64 = 1e6;

/// Distance from a point to the far side of the bounds; [`FARTHEST`] without bounds.
fn farthest(bounds: Option<(DVec3, f64)>, from: DVec3) -> f64 {
    bounds.map_or(FARTHEST, |(center, radius)| from.distance(center) + radius)
}

/// Identifies an obstacle of a scene. The caller chooses it; it stays the same from tick to tick.
///
/// At equal distances the smaller id wins, so results do not depend on the order in which obstacles are passed. An id
/// must not pass to another obstacle while a climber may remember it. A game that reuses slots puts a generation into
/// the upper 32 bits, as in the bits of Bevy's `Entity`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct ObstacleId(pub u64);

/// A point of an obstacle's material. Only that obstacle can interpret its numbers; on a surface,
/// [`MaterialPoint::triangle`] is the triangle.
///
/// A small plain value. Two values from one obstacle are the same point if their bits are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct MaterialPoint {
    /// The part of the obstacle that the point lies on: a triangle of a surface, a collider of a rapier world.
    pub key: u64,
    /// Position on that part: barycentric coordinates on a surface, local coordinates on a body.
    pub coordinates: [f64; 3],
}

/// A contact of a query with an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Point of the obstacle, in world space.
    pub point: DVec3,
    /// Unit normal that points out of the obstacle, in world space. Ray casts against rapier's and avian's terrain are
    /// an exception: where the ray hits a triangle from behind, they turn its normal towards the ray's origin.
    pub normal: DVec3,
    /// Distance from the query's point, the ray's origin or the capsule's segment, metres. Negative only inside a solid
    /// body, where a translation by its magnitude along `normal` leads out.
    pub distance: f64,
    /// The obstacle's material at `point`. In later ticks, [`Obstacle::motion`] gives its new position.
    pub material: MaterialPoint,
    /// The obstacle's tag at the point.
    pub tag: SurfaceTag,
}

impl Contact {
    /// Unit vector from the contact towards `center`, the point that the query was made for. Where the two coincide,
    /// and inside a solid body, it is the normal.
    pub fn separation_normal(&self, center: DVec3) -> DVec3 {
        if self.distance > 0.0 {
            (center - self.point).normalize_or(self.normal)
        } else {
            self.normal
        }
    }
}

/// The first contact of a moving capsule, and the fraction of the motion until then.
///
/// An [`Obstacle`] returns it with a [`Contact`]. [`sweep_shape`](crate::shapes::sweep_shape) returns it with a
/// [`ShapeContact`](crate::shapes::ShapeContact), which has no material and no tag. The mover of `clamber_mover`
/// returns it with a `MoverContact`, which adds to the [`Contact`] the id of the obstacle, the separation normal, and
/// whether a sweep found it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepContact<C = Contact> {
    /// Fraction of the motion, and so of each displacement, until the contact, 0..=1.
    pub fraction: f64,
    /// The contact at that fraction of the motion. Its distance is measured from the capsule's segment: about the
    /// radius if the capsule gets there by its motion, less if they overlap at the start.
    pub contact: C,
    /// Unit vector from the contact's point towards the capsule's segment. Where the segment crosses a triangle or is
    /// inside a solid, it is the contact's normal.
    pub separation_normal: DVec3,
    /// True if they overlap at the start; the fraction is then 0.
    pub started_inside: bool,
}

/// Motion of a material point over the tick that ends now.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct PointMotion {
    /// Current position, in world space.
    pub position: DVec3,
    /// Position a tick ago, in world space.
    pub previous_position: DVec3,
    /// Displacement over the tick divided by the tick's length, metres a second. Not an instantaneous velocity.
    pub velocity: DVec3,
    /// True if the point may have been teleported. An obstacle that cannot tell a teleport from rest sets it when the
    /// point did not move. Never true for a point that moved.
    pub was_teleported: bool,
    /// Rotation of the material at the point, from the obstacle's rest pose to now; for a rigid body, its rotation.
    /// `None` where the material has collapsed and has no direction of its own. The last known frame then stays valid.
    pub frame: Option<DQuat>,
    /// Rotation of the frame over the tick, in world space: `now * before⁻¹`.
    pub turn: DQuat,
    /// Area of the skin at the point now, divided by its area a tick ago; 1 on rigid bodies.
    pub area_ratio: f64,
    /// Largest and smallest stretch factor of the skin over the tick; 1 on rigid bodies.
    pub stretches: [f64; 2],
}

impl PointMotion {
    /// The motion of material that neither turns nor stretches, over a tick of `dt` seconds. The velocity is zero
    /// unless `dt` is positive. [`was_teleported`](Self::was_teleported) is set if the point did not move; an obstacle
    /// that can tell rest from a teleport corrects it. For material that turns, use
    /// [`RigidPose::motion_since`](crate::RigidPose::motion_since).
    pub fn translated(previous_position: DVec3, position: DVec3, dt: f64) -> Self {
        let way = position - previous_position;
        Self {
            position,
            previous_position,
            velocity: if dt > 0.0 { way / dt } else { DVec3::ZERO },
            was_teleported: way == DVec3::ZERO,
            frame: Some(DQuat::IDENTITY),
            turn: DQuat::IDENTITY,
            area_ratio: 1.0,
            stretches: [1.0, 1.0],
        }
    }

    /// True if the positions, the velocity and the rotations are finite. The area ratio and the stretches are not
    /// checked.
    pub fn is_finite(&self) -> bool {
        // Zero times a number is zero, unless the number is infinite or NaN: one test for all of them.
        let vectors = self.position * 0.0 + self.previous_position * 0.0 + self.velocity * 0.0;
        vectors == DVec3::ZERO
            && self.turn.is_finite()
            && self.frame.is_none_or(|frame| frame.is_finite())
    }
}

/// The body of a character that is an obstacle to others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CharacterBody {
    /// The character's capsule at the start of the tick, in world space.
    pub capsule: WorldCapsule,
    /// Displacement by the character's support in the tick, metres.
    pub way: DVec3,
    /// Mass, kg.
    pub mass: f64,
    /// The character's own velocity, relative to its support, metres a second.
    pub own_velocity: DVec3,
    /// How the character behaves when it runs into the side of another one.
    pub others: Others,
    /// The lowest of the characters that this one stands on or holds, if any: it carries all of them. It cannot hold
    /// this one, because two characters that hold each other would have no support.
    pub carried_by: Option<ObstacleId>,
}

/// An object that a character can stand on, hit, or be carried by.
///
/// Three methods are required: [`overlap_capsule`](Obstacle::overlap_capsule), [`cast_capsule`](Obstacle::cast_capsule)
/// and [`motion`](Obstacle::motion). The others have default implementations, most of them on top of these three.
/// Override a default where the obstacle has a faster or better answer.
///
/// All queries are in world space and take `&self`. They see the obstacle in its current state, except a cast with
/// [`TargetMotion::Moving`]. A query with a point or direction that is not finite finds nothing, and so does a query
/// with a length that is NaN or negative. Ray lengths and the distances of closest-point queries may be infinite. Radii
/// and displacements must be finite.
pub trait Obstacle {
    /// Appends the contacts with everything that overlaps a capsule: for each triangle or convex body, its point
    /// nearest to the capsule's segment. Contacts are in ascending order of [`MaterialPoint::key`]; distances are from
    /// the segment.
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>);

    /// The first contact of a moving capsule. Each of its ends moves in a straight line by its own displacement, so the
    /// capsule may turn, like the legs of a swinging climber.
    ///
    /// With [`TargetMotion::Still`] the obstacle stays as it is now. With [`TargetMotion::Moving`] it moves from its
    /// state a tick ago to its current state during the cast, and `capsule` is the capsule at the start of the tick.
    ///
    /// The reported time is never later than the first contact. At that time the capsule is at most
    /// [`WorldCapsule::sweep_tolerance`] from touching. A capsule that starts within the tolerance without overlapping,
    /// and only moves away, need not be reported. A contact that the obstacle's solver cannot decide (on skin,
    /// [`SweepHit::undecided`](clamber_surface::surface::SweepHit::undecided)) is also reported, and may be farther
    /// away. If the capsule overlaps at the start, the time is 0; of several such overlaps, the one nearest to the
    /// capsule's segment is reported.
    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact>;

    /// The motion of a material point over the tick of `dt` seconds that ends now. `None` if the material no longer
    /// exists or is hidden from queries.
    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion>;

    /// The positions and the velocity of [`motion`](Obstacle::motion): where a material point was a tick of `dt`
    /// seconds ago, and is now. By default, computed by `motion`. Override it where these cost less than the whole
    /// motion. `None` if any of them is not finite, and where there is no motion.
    fn path(&self, point: &MaterialPoint, dt: f64) -> Option<WorldPath> {
        let motion = self.motion(point, dt)?;
        motion.is_finite().then_some(WorldPath {
            position: motion.position,
            previous_position: motion.previous_position,
            velocity: motion.velocity,
        })
    }

    /// True if it is known, for less than [`motion`](Obstacle::motion) costs, that the material at a point has not
    /// moved in the tick that ends now. False if it has moved, or may have. Always false by default.
    fn rests(&self, point: &MaterialPoint) -> bool {
        let _ = point;
        false
    }

    /// Centre and radius of a ball in world space, metres, that contains everything that queries of this tick can
    /// touch. `None` if the obstacle is unbounded or its size is unknown. Queries outside the ball skip the obstacle.
    fn bounds(&self) -> Option<(DVec3, f64)> {
        None
    }

    /// [`Obstacle::cast_capsule`] restricted to the contacts that `counts` accepts. `counts` is called, in any order,
    /// with the contact of each triangle or solid that could be the first; a contact for which it returns false is
    /// ignored. A body that is pressed into one solid uses this to find its contacts with the others.
    ///
    /// The default calls `counts` with the first contact only, which is right for a single solid.
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

    /// [`cast_capsule_where`](Obstacle::cast_capsule_where) among the contacts that did not
    /// [start inside](SweepContact::started_inside). Override it where overlaps can be left out more cheaply than one
    /// by one.
    fn cast_capsule_past_overlaps(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) -> Option<SweepContact> {
        let mut counts = |contact: &SweepContact| !contact.started_inside && counts(contact);
        self.cast_capsule_where(capsule, displacements, target, &mut counts)
    }

    /// The first contact along a ray from `origin`, up to `max_distance` metres. `direction` may have any length but
    /// zero, and does not scale distances. A ray that starts inside a solid hits at distance 0; the normal of that
    /// contact need not point out.
    ///
    /// The default casts a ball of radius 0. Its distance is short by at most 1 micrometre over the sine of the angle
    /// between ray and surface. A ray that passes within a micrometre of the surface counts as a hit. Without
    /// [`Obstacle::bounds`] the search ends at 1,000 km.
    fn cast_ray(&self, origin: DVec3, direction: DVec3, max_distance: f64) -> Option<Contact> {
        if max_distance.is_nan() || max_distance < 0.0 || !origin.is_finite() {
            return None;
        }
        let length = max_distance.min(farthest(self.bounds(), origin));
        let way = direction.try_normalize()? * length;
        let ball = WorldCapsule::ball(origin, 0.0);
        let hit = self.cast_capsule(&ball, [way; 2], TargetMotion::Still)?;
        let distance = hit.fraction * length;
        Some(Contact {
            distance,
            ..hit.contact
        })
    }

    /// [`Obstacle::cast_ray`] restricted to the contacts that `counts` accepts. `counts` is called, in any order, with
    /// contacts that could be the first.
    ///
    /// The default asks `cast_ray` and, if `counts` refuses its contact, casts a ball of radius 0, as the default
    /// `cast_ray` does.
    fn cast_ray_where(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_distance: f64,
        counts: &mut dyn FnMut(&Contact) -> bool,
    ) -> Option<Contact> {
        let first = self.cast_ray(origin, direction, max_distance)?;
        if counts(&first) {
            return Some(first);
        }
        let length = max_distance.min(farthest(self.bounds(), origin));
        let way = direction.try_normalize()? * length;
        let at = |sweep: &SweepContact| Contact {
            distance: sweep.fraction * length,
            ..sweep.contact
        };
        let ball = WorldCapsule::ball(origin, 0.0);
        let mut counts = |sweep: &SweepContact| counts(&at(sweep));
        let still = TargetMotion::Still;
        let hit = self.cast_capsule_where(&ball, [way; 2], still, &mut counts)?;
        Some(at(&hit))
    }

    /// The obstacle's point nearest to `point`, up to `max_distance` metres.
    ///
    /// The default collects all overlaps of a ball of that radius, and so allocates. Without [`Obstacle::bounds`] the
    /// search ends at 1,000 km.
    fn closest_point(&self, point: DVec3, max_distance: f64) -> Option<Contact> {
        let mut contacts = Vec::new();
        // Not `f64::min`, which ignores NaN.
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

    /// The speed along a unit `direction`, metres a second, that an impulse of 1 N s in this direction gives to a
    /// material point. 0 if the point cannot be pushed.
    fn inverse_effective_mass(&self, point: &MaterialPoint, direction: DVec3) -> f64 {
        let _ = (point, direction);
        0.0
    }

    /// The character's body, if the obstacle is another character. Such an obstacle stops bodies, but it neither pushes
    /// them nor presses them into other obstacles: a body that overlaps it can still move with its own support, and
    /// walls have priority. Two characters that overlap move apart.
    fn character(&self) -> Option<CharacterBody> {
        None
    }

    /// Id of the rigid body that owns the point; in a rapier world, each collider counts as a body. When a character is
    /// pressed through a surface, the contacts of one body are judged together. The default treats the obstacle as one
    /// body, 0.
    fn rigid_body_id(&self, point: &MaterialPoint) -> u64 {
        let _ = point;
        0
    }
}

#[cfg(test)]
mod tests;
