use glam::DVec3;
use parry3d::bounding_volume::Aabb;
use parry3d::shape::Shape;

use super::sweep::sweep_shape_where;
use super::swept_bounds::{SweptBounds, is_usable, is_usable_radius};
use super::{ShapeContact, Tick, sweep_shape};
use crate::{Contact, SweepContact, WorldCapsule};

/// Finds the first contact of a moving capsule among many shapes. The order of the shapes does not matter.
///
/// Descend the engine's tree where [`FirstContact::may_meet`] accepts a box, and pass each shape found there to
/// [`FirstContact::meet`]. Boxes, poses and the capsule are in the engine's own space.
///
/// ```
/// use clamber_world::WorldCapsule;
/// use clamber_world::RigidPose;
/// use clamber_world::shapes::{FirstContact, Tick};
/// use clamber_world::parry3d::shape::Ball;
/// use glam::{DQuat, DVec3};
///
/// let falling = WorldCapsule::ball(DVec3::Y * 3.0, 0.5);
/// let mut first = FirstContact::new(&falling, [DVec3::NEG_Y * 4.0; 2]).unwrap();
/// let pose = RigidPose { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };
/// first.meet(&Ball::new(0.5), &Tick::still(pose), 7);
/// let contact = first.contact(DVec3::ZERO).unwrap();
/// assert!((contact.fraction - 0.5).abs() < 1e-4);
/// assert_eq!(contact.contact.material.key, 7);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct FirstContact {
    capsule: WorldCapsule,
    displacements: [DVec3; 2],
    bounds: SweptBounds,
    first: Option<SweepContact>,
}

impl FirstContact {
    /// A search without shapes so far. Each end of the capsule moves by its own displacement. `None` if a coordinate is
    /// not finite or beyond 2^100, or if the radius is negative.
    pub fn new(capsule: &WorldCapsule, displacements: [DVec3; 2]) -> Option<Self> {
        let radius = capsule.radius;
        let end = capsule.with_ends_moved(displacements).ends;
        let places = [capsule.ends, end, displacements];
        let usable = places.iter().all(|[a, b]| is_usable(*a) && is_usable(*b));
        if !usable || !is_usable_radius(radius) {
            return None;
        }
        let path = clamber_surface::geometry::MovingCapsule {
            start: capsule.ends,
            end,
            radius,
        };
        Some(Self {
            capsule: *capsule,
            displacements,
            bounds: SweptBounds::new(&path, radius + 2.0 * capsule.sweep_tolerance()),
            first: None,
        })
    }

    /// Bounding box of the capsule's whole path, enlarged by the tolerance.
    pub fn bounds(&self) -> Aabb {
        self.bounds.bounds()
    }

    /// True if a shape that stays within this box may be touched no later than the first contact so far.
    pub fn may_meet(&self, bounds: &Aabb) -> bool {
        self.bounds.meets(bounds, self.limit())
    }

    /// Tests a shape of a body whose poses are `tick`, and keeps the contact if it is the first so far. `key` becomes
    /// the contact's [`MaterialPoint::key`](crate::MaterialPoint::key).
    pub fn meet(&mut self, shape: &dyn Shape, tick: &Tick, key: u64) {
        let sweep = tick.sweep(&self.capsule, self.displacements);
        if let Some(touch) = sweep_shape(shape, &sweep, self.limit()) {
            self.offer(tick.contact(&touch, key));
        }
    }

    /// [`FirstContact::meet`] restricted to the contacts for which `counts` returns true. `counts` gets them in the
    /// engine's space, with the default tag.
    pub fn meet_where(
        &mut self,
        shape: &dyn Shape,
        tick: &Tick,
        key: u64,
        counts: &mut dyn FnMut(&SweepContact) -> bool,
    ) {
        let sweep = tick.sweep(&self.capsule, self.displacements);
        let mut counts = |touch: &SweepContact<ShapeContact>| counts(&tick.contact(touch, key));
        if let Some(touch) = sweep_shape_where(shape, &sweep, self.limit(), &mut counts) {
            self.offer(tick.contact(&touch, key));
        }
    }

    fn offer(&mut self, contact: SweepContact) {
        let earlier = |first: &SweepContact| precedes(&contact, first);
        if self.first.as_ref().is_none_or(earlier) {
            self.first = Some(contact);
        }
    }

    /// The first contact, in world space; `None` if no shape is touched. `origin` is the world position of the engine's
    /// origin. The tag is the default; the caller sets it.
    pub fn contact(&self, origin: DVec3) -> Option<SweepContact> {
        self.first.map(|first| SweepContact {
            contact: Contact {
                point: first.contact.point + origin,
                ..first.contact
            },
            ..first
        })
    }

    fn limit(&self) -> f64 {
        self.first.map_or(1.0, |first| first.fraction)
    }
}

/// Orders by time, then distance, then key, then local coordinates and normal.
fn precedes(contact: &SweepContact, other: &SweepContact) -> bool {
    let key = |sweep: &SweepContact| {
        let Contact {
            distance, material, ..
        } = sweep.contact;
        let first = (sweep.fraction, distance, material.key);
        (
            first,
            material.coordinates,
            sweep.separation_normal.to_array(),
        )
    };
    key(contact) < key(other)
}
