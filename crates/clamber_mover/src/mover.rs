use std::ops::Range;

use clamber_world::{
    Attachment, Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion, SweepContact,
    TargetMotion, WorldCapsule,
};
use glam::DVec3;

use crate::half_spaces::HalfSpace;
use crate::surroundings::Surroundings;
use crate::{Hit, MoverBody, MoverError, Touch};

/// Memory that movers reuse, so that a steady tick allocates nothing. It carries nothing from tick to tick.
#[derive(Clone, Debug, Default)]
pub struct MoverMemory {
    contacts: Vec<Contact>,
    /// What the core began inside of, or is crushed by: sweeps look past it. Each as it was when the tick began.
    pub(crate) passed: Vec<Touch>,
    /// By how much the half-spaces leave too little room for what the body wants; no more once it is crushed.
    pub(crate) lacking: f64,
    pub(crate) overlaps: Vec<Touch>,
    pub(crate) half_spaces: Vec<HalfSpace>,
    /// Steep slopes once more, as vertical walls.
    pub(crate) walls: Vec<HalfSpace>,
    pub(crate) touched: Vec<Touch>,
    /// Of what is touched, each at the same index.
    pub(crate) velocities: Vec<Option<DVec3>>,
    surroundings: Surroundings,
}

/// Room for contacts of a query and half-spaces of a movement from the first tick on, so that later ticks hardly ever
/// need more: within its reach a climber on the giant of 20 m finds up to 42 contacts. Together 19 KB.
const CONTACTS: usize = 64;
const HALF_SPACES: usize = 32;

impl MoverMemory {
    fn make_room(&mut self) {
        self.surroundings.forget();
        self.contacts.clear();
        self.contacts.reserve(CONTACTS);
        for touches in [&mut self.overlaps, &mut self.touched, &mut self.passed] {
            touches.clear();
            touches.reserve(CONTACTS);
        }
        self.velocities.clear();
        self.velocities.reserve(CONTACTS);
        for half_spaces in [&mut self.half_spaces, &mut self.walls] {
            half_spaces.clear();
            half_spaces.reserve(HALF_SPACES);
        }
    }
}

/// Half of a ray from whose length on it counts as endless, metres.
const LONGEST: f64 = 1e150;

/// One tick's view of the world, through which a body is moved and looks around.
///
/// Obstacles already stand where they are at the tick's end. Nothing here remembers anything from one call to the next
/// but the [`Mover::overlaps`] and [`Mover::touched`] of the last one.
pub struct Mover<'a> {
    pub(crate) obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    dt: f64,
    pub(crate) memory: &'a mut MoverMemory,
}

/// A body whose axis is less than this share of its core's radius behind a face was pressed through it, and comes out
/// where it went in; only a crushed body gets this deep. A body that is deeper takes the nearest way out: one may climb
/// on both sides of thin skin.
const PRESSED: f64 = 0.5;

/// An axis nearer to a contact than this share of the radius lies on the face: its direction from there is rounding.
const ON_FACE: f64 = 1e-5;

/// Contacts farther than the nearest by less than this share of the core's radius are as near: triangles around a vertex.
const AS_NEAR: f64 = 2.5e-4;

impl<'a> Mover<'a> {
    /// A tick of `dt` seconds. Obstacles may come in any order; of two with the same id the first counts.
    ///
    /// # Errors
    /// [`MoverError::OutOfRange`] if `dt` is not positive and finite.
    pub fn new(
        obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
        dt: f64,
        memory: &'a mut MoverMemory,
    ) -> Result<Self, MoverError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(MoverError::OutOfRange {
                name: "dt",
                range: "positive and finite",
                found: dt,
            });
        }
        memory.make_room();
        Ok(Self {
            obstacles,
            dt,
            memory,
        })
    }

    /// Length of the tick, seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// An obstacle of this tick.
    pub fn obstacle(&self, id: ObstacleId) -> Option<&'a dyn Obstacle> {
        find(self.obstacles, id)
    }

    /// How a material point moves over the tick; `None` if it is gone, or its motion is not finite.
    pub fn motion(&self, obstacle: ObstacleId, point: &MaterialPoint) -> Option<PointMotion> {
        motion_among(self.obstacles, obstacle, point, self.dt)
    }

    /// Fixes something at `place`, in world space, to the material of a contact. [`Attachment::follow`] it in later ticks.
    pub fn attach(&self, touch: &Touch, place: DVec3) -> Attachment {
        let motion = self.motion(touch.obstacle, &touch.contact.material);
        Attachment::with_motion(touch.obstacle, &touch.contact, motion.as_ref(), place)
    }

    /// The speed, metres a second, that an impulse of 1 N s along a unit `direction` gives to a material point; 0 for
    /// what cannot be pushed.
    pub fn push_response(
        &self,
        obstacle: ObstacleId,
        point: &MaterialPoint,
        direction: DVec3,
    ) -> f64 {
        let obstacle = self.obstacle(obstacle);
        let response = obstacle.map_or(0.0, |obstacle| obstacle.push_response(point, direction));
        if response > 0.0 && response.is_finite() {
            response
        } else {
            0.0
        }
    }

    /// Everything within `reach` of the body's surface at a position, by ascending obstacle and material.
    ///
    /// Of a surface that the body was pressed through, only the nearest of the contacts that face inward are kept:
    /// turned outward, with a negative distance.
    pub fn overlap(&mut self, body: &MoverBody, position: DVec3, reach: f64) -> &[Touch] {
        let capsule = body.at(position).with_radius(body.radius + reach);
        let pressed = PRESSED * body.core_radius();
        let as_near = AS_NEAR * body.core_radius();
        let memory = &mut *self.memory;
        memory.overlaps.clear();
        let (middle, radius) = capsule.bounding_ball();
        let near = memory.surroundings.near(self.obstacles, middle, radius);
        for (id, obstacle) in near {
            let first = memory.overlaps.len();
            memory.contacts.clear();
            obstacle.overlap_capsule(&capsule, &mut memory.contacts);
            for contact in &memory.contacts {
                let normal = if contact.distance.abs() < ON_FACE * body.radius {
                    contact.normal
                } else {
                    contact.separation_normal(capsule.nearest_on_axis(contact.point))
                };
                if contact.point.is_finite() && contact.distance.is_finite() && normal.is_finite() {
                    memory.overlaps.push(Touch {
                        obstacle: id,
                        contact: *contact,
                        normal,
                        swept: false,
                    });
                }
            }
            turn_outward_by_body(obstacle, &mut memory.overlaps, first, [pressed, as_near]);
        }
        &memory.overlaps
    }

    /// The result of the last [`Mover::overlap`]. [`Mover::slide`], [`Mover::find_ground`], [`Mover::still_underfoot`]
    /// and [`Mover::find_grip`] overwrite it as well.
    pub fn overlaps(&self) -> &[Touch] {
        &self.memory.overlaps
    }

    /// The first contact of a capsule whose ends move by `ways` over the tick, with every obstacle on its own way.
    pub fn sweep(&mut self, capsule: &WorldCapsule, ways: [DVec3; 2]) -> Option<Hit> {
        self.first(capsule, ways, |_, obstacle| {
            obstacle.cast_capsule(capsule, ways, TargetMotion::Moving)
        })
    }

    /// [`Mover::sweep`] among chosen contacts: `counts` is called, in any order, with those that could be the first,
    /// and the ones for which it returns false are passed over.
    pub fn sweep_where(
        &mut self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        mut counts: impl FnMut(&Hit) -> bool,
    ) -> Option<Hit> {
        self.first(capsule, ways, |id, obstacle| {
            let mut counts = |sweep: &SweepContact| counts(&Hit::new(id, sweep));
            obstacle.cast_capsule_where(capsule, ways, TargetMotion::Moving, &mut counts)
        })
    }

    /// Sweeps the path from `start` to `end`, shifted by `correction`, against moving obstacles: for a step up or a
    /// snap to the ground, which see only the tick's end. True if nothing is met, and for input that is not finite.
    /// Overlaps at the start do not count.
    pub fn is_clear_with(
        &mut self,
        body: &MoverBody,
        [start, end]: [DVec3; 2],
        correction: DVec3,
    ) -> bool {
        let core = body.core_at(start + correction);
        self.sweep_where(&core, [end - start; 2], |hit| !hit.started_inside)
            .is_none()
    }

    /// The first contact of a capsule that moves by `way`, with every obstacle as it stands now.
    pub fn cast(&mut self, capsule: &WorldCapsule, way: DVec3) -> Option<Hit> {
        self.first(capsule, [way; 2], |_, obstacle| {
            obstacle.cast_capsule(capsule, [way; 2], TargetMotion::Still)
        })
    }

    /// The first contact along a ray, up to a length in metres, which may be infinite, with every obstacle as it stands
    /// now. `direction` may have any length but zero.
    pub fn cast_ray(&mut self, origin: DVec3, direction: DVec3, length: f64) -> Option<Touch> {
        if length.is_nan() || length < 0.0 {
            return None;
        }
        let direction = direction.try_normalize()?;
        let half = length * 0.5;
        // An endless ray has no middle, and neither has one whose squares overflow.
        let (middle, reach) = if half < LONGEST {
            (origin + direction * half, half)
        } else {
            (origin, f64::INFINITY)
        };
        let surroundings = &mut self.memory.surroundings;
        let near = surroundings.near(self.obstacles, middle, reach);
        let mut first: Option<Touch> = None;
        for (id, obstacle) in near {
            let Some(contact) = obstacle.cast_ray(origin, direction, length) else {
                continue;
            };
            let nearer = |best: Touch| contact.distance < best.contact.distance;
            if contact.distance.is_finite() && first.is_none_or(nearer) {
                first = Some(Touch {
                    obstacle: id,
                    contact,
                    normal: -direction,
                    swept: true,
                });
            }
        }
        if reach == f64::INFINITY {
            // Else everything was near for the rest of the tick.
            surroundings.forget();
        }
        first
    }

    /// True if a capsule that moves by `way` meets nothing, with every obstacle as it stands now. True for input that
    /// is not finite.
    pub fn is_free(&mut self, capsule: &WorldCapsule, way: DVec3) -> bool {
        self.cast(capsule, way).is_none()
    }

    fn first(
        &mut self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        mut ask: impl FnMut(ObstacleId, &dyn Obstacle) -> Option<SweepContact>,
    ) -> Option<Hit> {
        // A ball that goes by the mean of both holds the capsule, if it is larger by how far they are from the mean.
        let (middle, reach) = capsule.bounding_ball();
        let half = (ways[0] + ways[1]) * 0.25;
        let turn = (ways[1] - ways[0]).length() * 0.5;
        let (middle, reach) = (middle + half, reach + half.length() + turn);
        let near = self.memory.surroundings.near(self.obstacles, middle, reach);
        let mut first: Option<Hit> = None;
        for (id, obstacle) in near {
            let Some(hit) = ask(id, obstacle) else {
                continue;
            };
            let hit = Hit::new(id, &hit);
            let is_sound = (0.0..=1.0).contains(&hit.time) && hit.touch.is_finite();
            // In ascending order of ids: the first of equals stays.
            if is_sound && first.is_none_or(|best| hit.time < best.time) {
                first = Some(hit);
            }
        }
        first
    }

    /// A body that began inside something is only pressed into it, and not deep: pushing out finds the way it went in.
    pub(crate) fn is_pressed_into(body: &MoverBody, touch: &Touch) -> bool {
        touch.faces_inward() && touch.contact.distance < PRESSED * body.core_radius()
    }
}

fn find<'a>(
    obstacles: &[(ObstacleId, &'a dyn Obstacle)],
    id: ObstacleId,
) -> Option<&'a dyn Obstacle> {
    let found = obstacles.iter().find(|(known, _)| *known == id);
    found.map(|(_, obstacle)| *obstacle)
}

/// [`Mover::motion`].
pub(crate) fn motion_among(
    obstacles: &[(ObstacleId, &dyn Obstacle)],
    id: ObstacleId,
    point: &MaterialPoint,
    dt: f64,
) -> Option<PointMotion> {
    let motion = find(obstacles, id)?.motion(point, dt)?;
    motion.is_finite().then_some(motion)
}

/// Looks at the contacts of one obstacle, from index `first` on, body by body: how deep the climber is in one says nothing
/// of another.
fn turn_outward_by_body(
    obstacle: &dyn Obstacle,
    touches: &mut Vec<Touch>,
    first: usize,
    limits: [f64; 2],
) {
    // From the end, so that contacts that are dropped move none that is still to be looked at.
    let mut end = touches.len();
    while end > first {
        let body = obstacle.body_of(&touches[end - 1].contact.material);
        let same = touches[first..end].iter().rev();
        let count = same
            .take_while(|touch| obstacle.body_of(&touch.contact.material) == body)
            .count();
        turn_outward(touches, end - count..end, limits);
        end -= count;
    }
}

/// Turns the nearest contacts of one body outward if they face inward and are nearer than `pressed`. The body's other
/// inward contacts are dropped then: from outside they are not met.
fn turn_outward(touches: &mut Vec<Touch>, of_body: Range<usize>, [pressed, as_near]: [f64; 2]) {
    let distances = touches[of_body.clone()]
        .iter()
        .map(|touch| touch.contact.distance);
    let nearest = distances.fold(f64::INFINITY, f64::min);
    if !(0.0..pressed).contains(&nearest) {
        return;
    }
    let mut turned = false;
    for touch in &mut touches[of_body.clone()] {
        if touch.contact.distance <= nearest + as_near && touch.faces_inward() {
            touch.normal = touch.contact.normal;
            touch.contact.distance = -touch.contact.distance;
            turned = true;
        }
    }
    if turned {
        let mut index = 0;
        touches.retain(|touch| {
            index += 1;
            !of_body.contains(&(index - 1)) || !touch.faces_inward()
        });
    }
}

#[cfg(test)]
mod tests;
