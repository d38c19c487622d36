use clamber_world::{
    Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact, WorldCapsule,
};
use glam::DVec3;

use crate::CanGrip;
use crate::planes::Plane;
use crate::surroundings::Surroundings;

/// Memory that a step needs; it keeps nothing from tick to tick.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    contacts: Vec<Contact>,
    pub(super) touches: Vec<Touch>,
    pub(super) planes: Vec<Plane>,
    /// Steep slopes once more, as walls: for who walks.
    pub(super) uprights: Vec<Plane>,
    pub(super) touched: Vec<Touch>,
    surroundings: Surroundings,
}

/// Contacts of a query and planes of a movement that there is room for from the first tick on, so that hardly a later one
/// has to make more: within its reach a climber on the giant of 20 m finds up to 42. Together 19 KB.
const CONTACTS: usize = 64;
const PLANES: usize = 32;

impl Scratch {
    fn make_room(&mut self) {
        self.contacts.clear();
        self.contacts.reserve(CONTACTS);
        self.touches.clear();
        self.touches.reserve(CONTACTS);
        self.planes.clear();
        self.planes.reserve(PLANES);
        self.uprights.clear();
        self.uprights.reserve(PLANES);
        self.touched.clear();
        self.touched.reserve(PLANES);
    }
}

/// A contact, what it belongs to, and where from it is looked at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub(crate) obstacle: ObstacleId,
    pub(crate) contact: Contact,
    /// Unit vector from the obstacle to the body's axis.
    pub(crate) away: DVec3,
}

/// One tick's view of the world.
pub(crate) struct World<'a> {
    obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    can_grip: &'a CanGrip<'a>,
    pub(crate) dt: f64,
    /// Whose axis is nearer than this to skin that it is behind was pressed there, metres.
    sunk: f64,
    pub(super) scratch: &'a mut Scratch,
}

/// A body whose axis is less than this share of its core's radius below a skin was pressed there, and comes out where it
/// went in. No body that was not crushed is so deep. Deeper, the nearest way out counts: one may climb on both sides of thin skin.
const SUNK: f64 = 0.5;

/// What is so much farther than the nearest contact, metres, is as near: triangles around a vertex.
const AS_NEAR: f64 = 1e-4;

/// Turns contacts of one obstacle, from a first one on, that look into it outward, if its nearest ones are such, and nearer
/// than a length. Others that look into it are none then: from outside they are not met.
fn turn_back(touches: &mut Vec<Touch>, first: usize, shallow: f64) {
    let looks_in = |touch: &Touch| touch.away.dot(touch.contact.normal) < 0.0;
    let distances = touches[first..].iter().map(|touch| touch.contact.distance);
    let nearest = distances.fold(f64::INFINITY, f64::min);
    if !(0.0..shallow).contains(&nearest) {
        return;
    }
    let mut turned = false;
    for touch in &mut touches[first..] {
        let contact = touch.contact;
        if contact.distance <= nearest + AS_NEAR && looks_in(touch) {
            touch.away = contact.normal;
            touch.contact.distance = -contact.distance;
            turned = true;
        }
    }
    if turned {
        let mut index = 0;
        touches.retain(|touch| {
            index += 1;
            index <= first || !looks_in(touch)
        });
    }
}

impl<'a> World<'a> {
    pub(crate) fn new(
        obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
        can_grip: &'a CanGrip<'a>,
        (dt, hard_radius): (f64, f64),
        scratch: &'a mut Scratch,
    ) -> Self {
        scratch.surroundings.forget();
        scratch.make_room();
        Self {
            obstacles,
            can_grip,
            dt,
            sunk: SUNK * hard_radius,
            scratch,
        }
    }

    pub(crate) fn can_grip(&self, touch: &Touch) -> bool {
        (self.can_grip)(touch.obstacle, &touch.contact)
    }

    /// How a material point moves; `None` if it is no more, or makes no sense.
    pub(crate) fn motion(
        &self,
        obstacle: ObstacleId,
        point: &MaterialPoint,
    ) -> Option<PointMotion> {
        let (_, obstacle) = self.obstacles.iter().find(|(id, _)| *id == obstacle)?;
        obstacle.motion(point, self.dt).filter(|motion| {
            motion.position.is_finite()
                && motion.previous_position.is_finite()
                && motion.velocity.is_finite()
                && motion.turn.is_finite()
                && motion.frame.is_none_or(|frame| frame.is_finite())
        })
    }

    pub(crate) fn velocity_of(&self, touch: &Touch) -> DVec3 {
        self.motion(touch.obstacle, &touch.contact.material)
            .map_or(DVec3::ZERO, |motion| motion.velocity)
    }

    /// How much an impulse of 1 N s speeds it up.
    pub(crate) fn push_response(
        &self,
        obstacle: ObstacleId,
        point: &MaterialPoint,
        direction: DVec3,
    ) -> f64 {
        let found = self.obstacles.iter().find(|(id, _)| *id == obstacle);
        let response = found.map_or(0.0, |(_, obstacle)| {
            obstacle.push_response(point, direction)
        });
        if response > 0.0 && response.is_finite() {
            response
        } else {
            0.0
        }
    }

    /// Everything within a capsule, by ascending obstacle and material.
    pub(crate) fn touching(&mut self, capsule: &WorldCapsule) -> &[Touch] {
        let scratch = &mut *self.scratch;
        scratch.touches.clear();
        let (middle, reach) = capsule.bounding_ball();
        let near = scratch.surroundings.near(self.obstacles, middle, reach);
        for (id, obstacle) in near {
            let first = scratch.touches.len();
            scratch.contacts.clear();
            obstacle.overlap_capsule(capsule, &mut scratch.contacts);
            for contact in &scratch.contacts {
                let away = contact.away(capsule.nearest_on_axis(contact.point));
                if contact.point.is_finite() && contact.distance.is_finite() && away.is_finite() {
                    scratch.touches.push(Touch {
                        obstacle: id,
                        contact: *contact,
                        away,
                    });
                }
            }
            turn_back(&mut scratch.touches, first, self.sunk);
        }
        &scratch.touches
    }

    /// Whether a contact of a body that began inside looks into what it is in, and not from deep: pushing out finds the
    /// way that it went in.
    pub(super) fn is_sunk(&self, touch: &Touch) -> bool {
        let looks_in = touch.away.dot(touch.contact.normal) < 0.0;
        looks_in && touch.contact.distance < self.sunk
    }

    /// What the last [`World::touching`] found.
    pub(crate) fn found(&self) -> &[Touch] {
        &self.scratch.touches
    }

    /// The first contact over the tick, with everything on its own way.
    pub(crate) fn sweep(
        &mut self,
        capsule: &WorldCapsule,
        displacement: DVec3,
    ) -> Option<(Touch, SweepContact)> {
        self.first(capsule, displacement, |obstacle| {
            obstacle.sweep_capsule(capsule, displacement)
        })
    }

    /// The first contact with everything as it stands now.
    pub(crate) fn cast(
        &mut self,
        capsule: &WorldCapsule,
        displacement: DVec3,
    ) -> Option<(Touch, SweepContact)> {
        self.first(capsule, displacement, |obstacle| {
            obstacle.cast_capsule(capsule, displacement)
        })
    }

    fn first(
        &mut self,
        capsule: &WorldCapsule,
        displacement: DVec3,
        ask: impl Fn(&dyn Obstacle) -> Option<SweepContact>,
    ) -> Option<(Touch, SweepContact)> {
        let (middle, reach) = capsule.bounding_ball();
        let half = displacement * 0.5;
        let (middle, reach) = (middle + half, reach + half.length());
        let near = self
            .scratch
            .surroundings
            .near(self.obstacles, middle, reach);
        let mut first: Option<(Touch, SweepContact)> = None;
        for (id, obstacle) in near {
            let Some(hit) = ask(obstacle) else {
                continue;
            };
            let sound = (0.0..=1.0).contains(&hit.time)
                && hit.contact.point.is_finite()
                && hit.away.is_finite()
                && hit.contact.distance.is_finite();
            // In ascending order of ids: the first of equals stays.
            if sound && first.is_none_or(|(_, best)| hit.time < best.time) {
                let touch = Touch {
                    obstacle: id,
                    contact: hit.contact,
                    away: hit.away,
                };
                first = Some((touch, hit));
            }
        }
        first
    }
}
