use std::ops::Range;

use clamber_world::{
    Attachment, Contact, MaterialPoint, Obstacle, ObstacleId, Others, PointMotion, SweepContact,
    TargetMotion, WorldCapsule, WorldPath,
};
use glam::DVec3;

use crate::characters::is_beside;
use crate::filters::{ContactFilter, ContactFilters, accepts};
use crate::half_spaces::MovePlane;
use crate::surroundings::Surroundings;
use crate::touch::met;
use crate::{IntoOthers, MoverBody, MoverContact, MoverError};

/// Memory that movers reuse, so that a steady tick allocates nothing. It carries no state from tick to tick.
#[derive(Clone, Debug, Default)]
pub struct MoverMemory {
    contacts: Vec<Contact>,
    /// Contacts that the core started inside of, or that crush it. Sweeps ignore them. Each is in its state at the
    /// start of the tick.
    pub(crate) passed: Vec<MoverContact>,
    /// Room that the wanted movement lacks between the half-spaces, metres. It is not updated once the body is crushed.
    pub(crate) lacking: f64,
    pub(crate) overlaps: Vec<MoverContact>,
    pub(crate) half_spaces: Vec<MovePlane>,
    /// Vertical walls that replace steep slopes. The slopes themselves are in `half_spaces`.
    pub(crate) walls: Vec<MovePlane>,
    /// Like `walls`, for contacts with other characters.
    pub(crate) yielding_walls: Vec<MovePlane>,
    /// True if walls and other characters left no room in the last movement, so that characters were ignored.
    pub(crate) characters_yield: bool,
    pub(crate) touched: Vec<MoverContact>,
    /// Velocities of the contacts in `touched`, at the same indices.
    pub(crate) velocities: Vec<Option<DVec3>>,
    surroundings: Surroundings,
}

/// Initial capacity for the contacts of a query, so that later ticks hardly ever allocate: a climber on the giant of 20
/// m has up to 42 contacts within its reach. Together with [`HALF_SPACES`], a mover's memory takes 19 KB.
const CONTACTS: usize = 64;

/// Initial capacity for the half-spaces of a movement, so that later ticks hardly ever allocate.
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
        let walls = [&mut self.walls, &mut self.yielding_walls];
        for half_spaces in walls.into_iter().chain([&mut self.half_spaces]) {
            half_spaces.clear();
            half_spaces.reserve(HALF_SPACES);
        }
    }
}

/// A ray counts as endless if half its length is at least this, metres: squares of longer lengths overflow.
const LONGEST: f64 = 1e150;

/// The obstacles of one tick, with functions to move a body among them and to query its surroundings.
///
/// Obstacles must already be in their state at the end of the tick. Between calls, a mover keeps only its results
/// [`Mover::overlaps`] and [`Mover::touched`].
pub struct Mover<'a> {
    pub(crate) obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    dt: f64,
    pub(crate) filters: ContactFilters<'a>,
    /// True if there is another character among the obstacles.
    pub(crate) has_characters: bool,
    /// The body as a character among others.
    pub(crate) into_others: Option<IntoOthers>,
    pub(crate) memory: &'a mut MoverMemory,
}

/// A body whose axis is behind a face by less than this fraction of its core's radius was pressed through the face, and
/// is pushed back to the side from which it came. Only a crushed body gets this deep. A deeper body leaves on the
/// nearest side, since a climber may be on either side of thin skin.
const PRESSED: f64 = 0.5;

/// An axis nearer to a contact than this fraction of the radius counts as on the face, and the separation normal is the
/// face's normal: the direction between axis and contact is rounding.
const ON_FACE: f64 = 1e-5;

/// Contacts farther than the nearest by less than this fraction of the core's radius count as equally near, for example
/// the contacts with the triangles around a vertex.
const AS_NEAR: f64 = 2.5e-4;

impl<'a> Mover<'a> {
    /// A mover for a tick of `dt` seconds. Obstacles may be in any order; if two have the same id, the first is used.
    ///
    /// # Errors
    /// [`MoverError::OutOfRange`] if `dt` is not positive and finite.
    #[inline]
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
        let mut all = obstacles.iter();
        let has_characters = all.any(|(_, obstacle)| obstacle.character().is_some());
        Ok(Self {
            obstacles,
            dt,
            filters: ContactFilters::default(),
            has_characters,
            into_others: None,
            memory,
        })
    }

    /// Sets the filters that decide which contacts block the body, hold it up, and are stepped onto.
    #[must_use]
    pub fn with_filters(self, filters: ContactFilters<'a>) -> Self {
        Self { filters, ..self }
    }

    /// Makes the body a character among others. Without this call, other characters stop the body.
    #[must_use]
    pub fn with_character(self, body: IntoOthers) -> Self {
        Self {
            into_others: Some(body),
            ..self
        }
    }

    /// Length of the tick, seconds.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// The obstacle with this id; `None` if it is not in this tick's list.
    pub fn obstacle(&self, id: ObstacleId) -> Option<&'a dyn Obstacle> {
        find(self.obstacles, id)
    }

    /// Motion of a material point over the tick. `None` if the obstacle or the material is gone, or if the motion is
    /// not finite.
    pub fn motion(&self, obstacle: ObstacleId, point: &MaterialPoint) -> Option<PointMotion> {
        motion_among(self.obstacles, obstacle, point, self.dt)
    }

    /// Positions of the material at a contact at the start and at the end of the tick. It is the part of
    /// [`Mover::motion`] that needs no frame, and takes a fraction of the time.
    pub fn path_of(&self, touch: &MoverContact) -> Option<WorldPath> {
        path_among(
            self.obstacles,
            touch.obstacle,
            &touch.contact.material,
            self.dt,
        )
    }

    /// Fixes a point at `place`, in world space, to the material of a contact. Call [`Attachment::follow`] in later
    /// ticks.
    pub fn attach(&self, touch: &MoverContact, place: DVec3) -> Attachment {
        let motion = self.motion(touch.obstacle, &touch.contact.material);
        Attachment::with_motion(touch.obstacle, &touch.contact, motion.as_ref(), place)
    }

    /// Speed that a material point gains along a unit `direction`, metres a second, from an impulse of 1 N s in this
    /// direction. 0 if the point cannot be pushed.
    pub fn inverse_effective_mass(
        &self,
        obstacle: ObstacleId,
        point: &MaterialPoint,
        direction: DVec3,
    ) -> f64 {
        let obstacle = self.obstacle(obstacle);
        let response = obstacle.map_or(0.0, |obstacle| {
            obstacle.inverse_effective_mass(point, direction)
        });
        if response > 0.0 && response.is_finite() {
            response
        } else {
            0.0
        }
    }

    /// All contacts within `reach` metres of the body's surface at a position, by ascending obstacle and material.
    ///
    /// If the body was pressed through a surface, only the nearest of the contacts that face inward are kept. They are
    /// turned outward and get a negative distance.
    pub fn overlap(&mut self, body: &MoverBody, position: DVec3, reach: f64) -> &[MoverContact] {
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
                if !accepts(self.filters.solid, id, obstacle, contact) {
                    continue;
                }
                let normal = if contact.distance.abs() < ON_FACE * body.radius {
                    contact.normal
                } else {
                    contact.separation_normal(capsule.nearest_on_axis(contact.point))
                };
                if contact.point.is_finite() && contact.distance.is_finite() && normal.is_finite() {
                    memory.overlaps.push(MoverContact {
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
    /// and [`Mover::find_grip`] also overwrite it.
    pub fn overlaps(&self) -> &[MoverContact] {
        &self.memory.overlaps
    }

    /// The first contact over the tick of a capsule whose ends move by `ways`, while the obstacles move as well.
    /// `capsule` is the capsule at the start of the tick.
    pub fn sweep(
        &mut self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
    ) -> Option<SweepContact<MoverContact>> {
        self.first_solid(capsule, ways, TargetMotion::Moving)
    }

    /// [`Mover::sweep`] restricted to the contacts that `counts` accepts. `counts` is called, in any order, with the
    /// contacts that could be the first; those for which it returns false are ignored.
    pub fn sweep_where(
        &mut self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        mut counts: impl FnMut(&SweepContact<MoverContact>) -> bool,
    ) -> Option<SweepContact<MoverContact>> {
        let solid = self.filters.solid;
        self.first(capsule, ways, |id, obstacle| {
            let mut counts = |sweep: &SweepContact| {
                accepts(solid, id, obstacle, &sweep.contact) && counts(&met(id, sweep))
            };
            obstacle.cast_capsule_where(capsule, ways, TargetMotion::Moving, &mut counts)
        })
    }

    /// [`Mover::sweep_where`] without the contacts that the capsule starts inside of.
    pub(crate) fn sweep_past_overlaps(
        &mut self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        mut counts: impl FnMut(&SweepContact<MoverContact>) -> bool,
    ) -> Option<SweepContact<MoverContact>> {
        let solid = self.filters.solid;
        self.first(capsule, ways, |id, obstacle| {
            let mut counts = |sweep: &SweepContact| {
                accepts(solid, id, obstacle, &sweep.contact) && counts(&met(id, sweep))
            };
            let moving = TargetMotion::Moving;
            obstacle.cast_capsule_past_overlaps(capsule, ways, moving, &mut counts)
        })
    }

    /// True if the body's core meets no obstacle when it is swept over the tick from `start` to `end`, both shifted by
    /// `correction`, while the obstacles move as well. Use it after a step up or a snap to the ground, which consider
    /// only the end of the tick. Overlaps at the start are ignored, and so are other characters, since characters move
    /// apart. Also true for input that is not finite.
    pub fn is_clear_with(
        &mut self,
        body: &MoverBody,
        [start, end]: [DVec3; 2],
        correction: DVec3,
    ) -> bool {
        let core = body.core_at(start + correction);
        let characters = self.characters();
        self.sweep_past_overlaps(&core, [end - start; 2], |hit| !characters.has(&hit.contact))
            .is_none()
    }

    /// The first contact of a capsule that moves by `way`, metres in world space. The obstacles do not move: they are
    /// in their state at the end of the tick. `None` if the capsule meets no obstacle, and for input that is not
    /// finite.
    pub fn cast(
        &mut self,
        capsule: &WorldCapsule,
        way: DVec3,
    ) -> Option<SweepContact<MoverContact>> {
        self.first_solid(capsule, [way; 2], TargetMotion::Still)
    }

    /// The first contact along a ray, against obstacles in their current state. `length` is in metres and may be
    /// infinite; `direction` may have any length but zero.
    pub fn cast_ray(
        &mut self,
        origin: DVec3,
        direction: DVec3,
        length: f64,
    ) -> Option<MoverContact> {
        if length.is_nan() || length < 0.0 {
            return None;
        }
        let direction = direction.try_normalize()?;
        let half = length * 0.5;
        // No middle can be computed for an endless ray, or for one so long that its squared length overflows.
        let (middle, reach) = if half < LONGEST {
            (origin + direction * half, half)
        } else {
            (origin, f64::INFINITY)
        };
        let solid = self.filters.solid;
        let surroundings = &mut self.memory.surroundings;
        let near = surroundings.near(self.obstacles, middle, reach);
        let mut first: Option<MoverContact> = None;
        for (id, obstacle) in near {
            let contact = match solid {
                None => obstacle.cast_ray(origin, direction, length),
                Some(is_solid) => {
                    let mut counts = |contact: &Contact| is_solid(id, obstacle, contact);
                    obstacle.cast_ray_where(origin, direction, length, &mut counts)
                }
            };
            let Some(contact) = contact else {
                continue;
            };
            let nearer = |best: MoverContact| contact.distance < best.contact.distance;
            if contact.distance.is_finite() && first.is_none_or(nearer) {
                first = Some(MoverContact {
                    obstacle: id,
                    contact,
                    normal: -direction,
                    swept: true,
                });
            }
        }
        if reach == f64::INFINITY {
            // Otherwise the cache would hold all obstacles as near for the rest of the tick.
            surroundings.forget();
        }
        first
    }

    /// True if a capsule that moves by `way` meets no obstacle, with obstacles in their current state. Also true for
    /// input that is not finite. Characters that the capsule starts inside of do not block it, nor do characters that
    /// it passes or carries ([`Mover::with_character`]).
    pub fn is_free(&mut self, capsule: &WorldCapsule, way: DVec3) -> bool {
        self.obstruction(capsule, way).is_none()
    }

    /// The first contact that blocks a capsule along `way`, by the rules of [`Mover::is_free`].
    pub(crate) fn obstruction(
        &mut self,
        capsule: &WorldCapsule,
        way: DVec3,
    ) -> Option<SweepContact<MoverContact>> {
        if !self.has_characters {
            return self.cast(capsule, way);
        }
        let (solid, into) = (self.filters.solid, self.into_others);
        self.first(capsule, [way; 2], |id, obstacle| {
            let other = obstacle.character();
            let leaves_room = into.zip(other).is_some_and(|(into, other)| {
                into.others.between(other.others) == Others::Pass || into.carries(capsule, &other)
            });
            let mut counts = |sweep: &SweepContact| {
                let is_inside = other.is_some() && sweep.started_inside;
                !leaves_room && !is_inside && accepts(solid, id, obstacle, &sweep.contact)
            };
            obstacle.cast_capsule_where(capsule, [way; 2], TargetMotion::Still, &mut counts)
        })
    }

    /// [`Mover::cast`] that ignores characters which the capsule is inside of, is beside, or carries.
    pub(crate) fn cast_past_characters(
        &mut self,
        capsule: &WorldCapsule,
        way: DVec3,
        up: DVec3,
    ) -> Option<SweepContact<MoverContact>> {
        if !self.has_characters {
            return self.cast(capsule, way);
        }
        let (solid, into) = (self.filters.solid, self.into_others);
        self.first(capsule, [way; 2], |id, obstacle| {
            let other = obstacle.character();
            let is_beside = other.is_some_and(|other| {
                let there = other.capsule.moved(other.way);
                is_beside(capsule, &there, up)
                    || into.is_some_and(|into| into.carries(capsule, &other))
            });
            let mut counts = |sweep: &SweepContact| {
                let is_passed = is_beside || other.is_some() && sweep.started_inside;
                !is_passed && accepts(solid, id, obstacle, &sweep.contact)
            };
            obstacle.cast_capsule_where(capsule, [way; 2], TargetMotion::Still, &mut counts)
        })
    }

    fn first_solid(
        &mut self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact<MoverContact>> {
        let solid = self.filters.solid;
        self.first(capsule, ways, |id, obstacle| {
            let Some(is_solid) = solid else {
                return obstacle.cast_capsule(capsule, ways, target);
            };
            let mut counts = |sweep: &SweepContact| is_solid(id, obstacle, &sweep.contact);
            obstacle.cast_capsule_where(capsule, ways, target, &mut counts)
        })
    }

    fn first(
        &mut self,
        capsule: &WorldCapsule,
        ways: [DVec3; 2],
        mut ask: impl FnMut(ObstacleId, &dyn Obstacle) -> Option<SweepContact>,
    ) -> Option<SweepContact<MoverContact>> {
        // Bounding ball of the whole sweep: the capsule's ball, moved by half the mean displacement of the ends. Its
        // radius grows by the length of that half, and by the distance of each end's displacement from the mean.
        let (middle, reach) = capsule.bounding_ball();
        let half = (ways[0] + ways[1]) * 0.25;
        let turn = (ways[1] - ways[0]).length() * 0.5;
        let (middle, reach) = (middle + half, reach + half.length() + turn);
        let near = self.memory.surroundings.near(self.obstacles, middle, reach);
        let mut first: Option<SweepContact<MoverContact>> = None;
        for (id, obstacle) in near {
            let Some(hit) = ask(id, obstacle) else {
                continue;
            };
            let hit = met(id, &hit);
            let is_sound = (0.0..=1.0).contains(&hit.fraction) && hit.contact.is_finite();
            // Obstacles come by ascending id. If times are equal, the lowest id is kept.
            if is_sound && first.is_none_or(|best| hit.fraction < best.fraction) {
                first = Some(hit);
            }
        }
        first
    }

    /// True if a contact can hold a body up, by [`ContactFilters::ground`].
    pub(crate) fn is_ground(&self, touch: &MoverContact) -> bool {
        self.is_accepted(self.filters.ground, touch)
    }

    /// True if walking may climb onto a contact, by [`ContactFilters::step`].
    pub(crate) fn is_step(&self, touch: &MoverContact) -> bool {
        self.is_accepted(self.filters.step, touch)
    }

    fn is_accepted(&self, filter: Option<&ContactFilter<'_>>, touch: &MoverContact) -> bool {
        let obstacle = filter.and_then(|_| self.obstacle(touch.obstacle));
        obstacle.is_none_or(|obstacle| accepts(filter, touch.obstacle, obstacle, &touch.contact))
    }

    /// True if the body was pressed through a contact's face, but not deep: it is then pushed back to the side from
    /// which it came.
    pub(crate) fn is_pressed_into(body: &MoverBody, touch: &MoverContact) -> bool {
        touch.faces_inward() && touch.contact.distance < PRESSED * body.core_radius()
    }
}

pub(crate) fn find<'a>(
    obstacles: &[(ObstacleId, &'a dyn Obstacle)],
    id: ObstacleId,
) -> Option<&'a dyn Obstacle> {
    let found = obstacles.iter().find(|(known, _)| *known == id);
    found.map(|(_, obstacle)| *obstacle)
}

/// Same as [`Mover::motion`].
fn motion_among(
    obstacles: &[(ObstacleId, &dyn Obstacle)],
    id: ObstacleId,
    point: &MaterialPoint,
    dt: f64,
) -> Option<PointMotion> {
    let motion = find(obstacles, id)?.motion(point, dt)?;
    motion.is_finite().then_some(motion)
}

/// Positions of a material point at the start and at the end of the tick.
pub(crate) fn path_among(
    obstacles: &[(ObstacleId, &dyn Obstacle)],
    id: ObstacleId,
    point: &MaterialPoint,
    dt: f64,
) -> Option<WorldPath> {
    let path = find(obstacles, id)?.path(point, dt)?;
    path.is_finite().then_some(path)
}

/// Applies [`turn_outward`] to the contacts of one obstacle, from index `first` on, body by body: the depth in one body
/// is unrelated to the depth in another.
fn turn_outward_by_body(
    obstacle: &dyn Obstacle,
    touches: &mut Vec<MoverContact>,
    first: usize,
    limits: [f64; 2],
) {
    // From the end, so that dropped contacts do not shift those that are still to be handled.
    let mut end = touches.len();
    while end > first {
        let body = obstacle.rigid_body_id(&touches[end - 1].contact.material);
        let same = touches[first..end].iter().rev();
        let count = same
            .take_while(|touch| obstacle.rigid_body_id(&touch.contact.material) == body)
            .count();
        turn_outward(touches, end - count..end, limits);
        end -= count;
    }
}

/// Turns the nearest contacts of one body outward if they face inward and are nearer than `pressed`. The body's other
/// inward contacts are then dropped, since a body outside does not meet them.
fn turn_outward(
    touches: &mut Vec<MoverContact>,
    of_body: Range<usize>,
    [pressed, as_near]: [f64; 2],
) {
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
