//! Other characters among the obstacles. They stop a body, and never push it.
//!
//! The half-space of a contact with a character always contains the displacement of the body's own frame. So a
//! character only stops the body's own motion towards it: however the character moves, it neither carries the body off
//! nor presses it into an obstacle. Where walls and characters together leave no room, the solver ignores the
//! characters.

use clamber_world::{CharacterBody, Obstacle, ObstacleId, Others, SweepContact, WorldCapsule};
use glam::DVec3;

use crate::half_spaces::MovePlane;
use crate::mover::{find, path_among};
use crate::slide::TOUCH;
use crate::{IntoOthers, Mover, MoverContact, Path};

/// The characters among the obstacles of a tick, as a movement sees them.
#[derive(Clone, Copy)]
pub(crate) struct Characters<'a> {
    obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    dt: f64,
    /// True if any obstacle is a character.
    any: bool,
    /// The body as a character; `None` if it is not one.
    into: Option<IntoOthers>,
    /// True if walls and characters have left no room, so that the characters are ignored.
    yielding: bool,
}

impl Characters<'_> {
    /// True for a contact with a character.
    pub(crate) fn has(&self, touch: &MoverContact) -> bool {
        self.of(touch).is_some()
    }

    /// The character that a contact is with; `None` for a contact with another obstacle.
    fn of(&self, touch: &MoverContact) -> Option<CharacterBody> {
        let obstacle = self.any.then(|| find(self.obstacles, touch.obstacle))?;
        obstacle?.character()
    }

    /// The offset of a half-space of a contact with a character, lowered by the allowed depth. The half-space contains
    /// the frame's displacement.
    fn offset(&self, path: &Path, half_space: &MovePlane, touch: &MoverContact) -> f64 {
        if self.yielding {
            return f64::NEG_INFINITY;
        }
        let offset = half_space.offset - self.allowed(path, touch);
        offset.min(half_space.normal.dot(path.frame))
    }

    /// Depth to which the body may overlap the character of a contact, metres; 0 for other obstacles.
    pub(crate) fn allowed(&self, path: &Path, touch: &MoverContact) -> f64 {
        let (Some(into), Some(other)) = (self.into, self.of(touch)) else {
            return 0.0;
        };
        if into.carries(&path.body.at(path.start), &other) {
            return f64::INFINITY;
        }
        let least = path.body.radius.min(other.capsule.radius);
        let most = match into.others.between(other.others) {
            Others::Block => return 0.0,
            Others::Push => DEEPEST * least,
            Others::Pass => f64::INFINITY,
        };
        // A body that is this deep has come in from the side.
        let is_deep = path.body.radius - touch.contact.distance > DEEP * least;
        if is_deep || self.has_beside(path, touch, into.up) {
            most
        } else {
            0.0
        }
    }

    /// True for a contact with a character that is beside the body at the start of a movement.
    pub(crate) fn has_beside(&self, path: &Path, touch: &MoverContact, up: DVec3) -> bool {
        let body = path.body.at(path.start);
        self.of(touch)
            .is_some_and(|other| is_beside(&body, &other.capsule, up))
    }

    /// True if a hit along `way` stops the body. A character stops only the body's own motion, relative to the frame.
    pub(crate) fn stop(&self, path: &Path, hit: &SweepContact<MoverContact>, way: DVec3) -> bool {
        if !self.has(&hit.contact) {
            return true;
        }
        let half_space = self.half_space_of_hit(path, hit, way);
        let offset = self.offset(path, &half_space, &hit.contact);
        half_space.normal.dot(way) < offset - TOUCH * path.body.radius
    }

    /// The half-space of a contact that a sweep along `way` found: its plane is where the touched material is at the
    /// tick's end.
    pub(crate) fn half_space_of_hit(
        &self,
        path: &Path,
        hit: &SweepContact<MoverContact>,
        way: DVec3,
    ) -> MovePlane {
        let SweepContact {
            contact: touch,
            fraction,
            ..
        } = hit;
        let (obstacle, contact) = (touch.obstacle, &touch.contact);
        let motion = path_among(self.obstacles, obstacle, &contact.material, self.dt);
        let end = motion.map_or(contact.point, |motion| motion.position);
        let on_axis = path.end_of(way, *fraction, contact.point);
        MovePlane {
            normal: touch.normal,
            offset: touch.normal.dot(end - path.start - on_axis) + path.body.radius,
        }
    }

    /// Depth from which a contact may push the body out, metres, at most `depth`, the actual depth. `way` is the body's
    /// displacement.
    pub(crate) fn depth(&self, path: &Path, touch: &MoverContact, way: DVec3, depth: f64) -> f64 {
        if depth <= 0.0 || !self.has(touch) {
            depth
        } else if self.yielding {
            0.0
        } else {
            let depth = depth - self.allowed(path, touch);
            depth.min(touch.normal.dot(path.frame - way))
        }
    }
}

/// Maximum overlap of two characters that push each other, as a fraction of the smaller radius.
const DEEPEST: f64 = 0.75;

/// Depth, as a fraction of the smaller radius, above which a body counts as having come in from the side. A body that
/// stands on another character does not get this deep.
const DEEP: f64 = 0.5;

/// True if two upright bodies are beside each other, and neither is on top of the other: the lowest point of each is
/// below the highest point of the other's axis.
pub fn is_beside(a: &WorldCapsule, b: &WorldCapsule, up: DVec3) -> bool {
    let [a, b] = [a, b].map(|body| {
        let heights = body.ends.map(|end| end.dot(up));
        let [low, high] = [heights[0].min(heights[1]), heights[0].max(heights[1])];
        (low - body.radius, high)
    });
    a.0 < b.1 && b.0 < a.1
}

impl IntoOthers {
    /// True if the body carries another character: one that is above it and has no greater mass.
    pub(crate) fn carries(&self, body: &WorldCapsule, other: &CharacterBody) -> bool {
        let [highest, lowest] = [body, &other.capsule].map(|body| {
            let [a, b] = body.ends.map(|end| end.dot(self.up));
            (a.max(b), a.min(b) - body.radius)
        });
        other.mass <= self.mass && lowest.1 >= highest.0
    }
}

impl<'a> Mover<'a> {
    pub(crate) fn characters(&self) -> Characters<'a> {
        Characters {
            obstacles: self.obstacles,
            dt: self.dt(),
            any: self.has_characters,
            into: self.into_others,
            yielding: self.memory.characters_yield,
        }
    }

    /// True if there is another character among the obstacles.
    pub fn has_characters(&self) -> bool {
        self.has_characters
    }

    /// True if a contact is with another character ([`Obstacle::character`](clamber_world::Obstacle::character)).
    pub fn is_character(&self, touch: &MoverContact) -> bool {
        self.characters().has(touch)
    }

    /// Adds a contact with its half-space, and the vertical wall that replaces its slope.
    pub(crate) fn add_contact(
        &mut self,
        path: &Path,
        touch: MoverContact,
        half_space: MovePlane,
        wall: Option<MovePlane>,
    ) {
        let characters = self.characters();
        let memory = &mut *self.memory;
        memory.touched.push(touch);
        if !characters.has(&touch) {
            memory.half_spaces.push(half_space);
            memory.walls.extend(wall);
            return;
        }
        let yielding = |half_space: MovePlane| MovePlane {
            offset: characters.offset(path, &half_space, &touch),
            ..half_space
        };
        memory.half_spaces.push(yielding(half_space));
        memory.yielding_walls.extend(wall.map(yielding));
    }

    /// Ignores characters in the rest of a movement. False if none is among its contacts, or if they are ignored
    /// already.
    pub(crate) fn leave_characters_out(&mut self) -> bool {
        let characters = self.characters();
        if !characters.any || characters.yielding {
            return false;
        }
        let memory = &mut *self.memory;
        let contacts = memory.touched.iter().zip(&mut memory.half_spaces);
        for (_, half_space) in contacts.filter(|(touch, _)| characters.has(touch)) {
            half_space.offset = f64::NEG_INFINITY;
            memory.characters_yield = true;
        }
        memory.yielding_walls.clear();
        memory.characters_yield
    }
}
