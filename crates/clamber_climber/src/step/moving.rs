//! Moving the body, and recording its contacts.

use clamber_mover::{Begin, Moved, MoverContact, Path};
use glam::DVec3;

use super::Tick;
use super::carrying::Carried;
use crate::{ClimberContact, ClimberEvent, ClimberMode, ContactPhase};

/// Distance, as a fraction of the radius, within which contacts with the same key count as one, if their normals differ
/// by at most the angle of [`ONE_FACE`]. A movement may find a contact twice.
const ONE_CONTACT: f64 = 0.25;

/// Cosine of the largest angle between the normals of contacts on one face: 8 degrees, since skin bends.
const ONE_FACE: f64 = 0.99;

/// Whether the climber or only its support moves the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Intent {
    /// Only its support: the climber stays in place on it.
    Stay,
    /// The climber itself.
    Go,
}

impl Tick<'_> {
    /// The path of the body, in its current shape, from its position a tick ago to a target. The target is shifted by
    /// the displacement with which the climber gives way to other climbers. The path's frame is the support.
    pub(super) fn path(&self, target: DVec3) -> Path {
        let body = self.body();
        let target = target + self.parting;
        let crushed = self.before.crushed;
        match &self.carried {
            Some(carried) => Path {
                crushed,
                begin: if carried.swept {
                    Begin::Start
                } else {
                    Begin::Target
                },
                frame: carried.position - carried.start,
                ..Path::new(body, carried.start, target)
            },
            None => Path {
                crushed,
                frame: self.state.base_velocity * self.dt(),
                ..Path::new(body, self.state.position, target)
            },
        }
    }

    /// Moves the body along a path. The caller sets the state's position.
    pub(super) fn slide(&mut self, path: &Path, intent: Intent) -> Moved {
        let wanted = (path.target - path.start) / self.dt();
        self.slide_at(path, intent, wanted)
    }

    /// [`Tick::slide`] with a velocity for judging contacts that is not the mean over the tick.
    pub(super) fn slide_at(&mut self, path: &Path, intent: Intent, wanted: DVec3) -> Moved {
        let mut moved = self.mover.slide(path);
        if self.is_free() {
            // A crushed body keeps to the frame of the obstacles that crush it, not to the frame of a support that it
            // left.
            let frame = self.touched_velocity().map(|velocity| velocity * self.dt());
            if let Some(frame) = frame
                && moved.missing_room > path.body.margin
                && frame != path.frame
            {
                moved = self.mover.slide(&Path { frame, ..*path });
            }
            self.update_frame();
        }
        self.note(path, intent, wanted, moved)
    }

    /// [`Tick::slide`], or `None` if the body has no room or its way is not clear. Then no result is recorded.
    pub(super) fn slide_if_there_is_room(&mut self, path: &Path) -> Option<Moved> {
        let wanted = (path.target - path.start) / self.dt();
        let moved = self.mover.slide(path);
        let has_room = moved.is_clear && moved.missing_room <= path.body.margin;
        has_room.then(|| self.note(path, Intent::Go, wanted, moved))
    }

    /// Records the result of a movement: in the report, the contacts, the pushes, and whether the body is crushed.
    fn note(&mut self, path: &Path, intent: Intent, wanted: DVec3, moved: Moved) -> Moved {
        self.motion.is_done = true;
        self.motion.is_lost |= !path.target.is_finite();
        self.report.pushed_out += moved.position - path.target;
        self.report.penetration = moved.penetration;
        self.report.rounds += moved.rounds;
        self.report.is_clear &= moved.is_clear;
        self.state.crushed = moved.missing_room > path.body.margin;
        if self.state.crushed {
            // Only the ball is kept, which needs the least room.
            self.state.crouched = true;
            self.event(ClimberEvent::Crushed {
                depth: moved.missing_room - path.body.margin,
            });
        }
        self.list_contacts(wanted, intent);
        self.push_aside(wanted);
        moved
    }

    /// Clips a velocity by the contacts of the last movement, relative to the support. A crushed climber gets the
    /// support's velocity: between obstacles that close in on it, every other velocity leads into one of them.
    pub(super) fn clipped(&self, velocity: DVec3) -> DVec3 {
        let base = self.state.base_velocity;
        if self.state.crushed {
            return base;
        }
        self.mover
            .clip_velocity_with(velocity, base, None, |touch, velocity| {
                self.velocity_after_hit(touch, velocity)
            })
    }

    /// Clips the velocity that a movement would have had without contacts, after its hits have changed it.
    pub(super) fn clipped_after_hits(&self, velocity: DVec3) -> DVec3 {
        self.clipped(velocity + self.motion.recoil)
    }

    /// Carries the body on at its velocity, in ticks in which no mode has moved it.
    pub(super) fn coast(&mut self) {
        if let Some(carried) = self.carried {
            let moved = self.slide(&self.path(carried.position), Intent::Stay);
            self.keep_support(&carried, moved.position);
        } else {
            let target = self.state.position + self.state.velocity * self.dt();
            let moved = self.slide(&self.path(target), Intent::Stay);
            self.state.position = moved.position;
            self.state.velocity = self.clipped_after_hits(self.state.velocity);
        }
    }

    fn list_contacts(&mut self, wanted: DVec3, intent: Intent) {
        for index in 0..self.mover.touched().len() {
            let touch = self.mover.touched()[index];
            let phase = match (intent, touch.swept) {
                (Intent::Stay, _) => ContactPhase::Carried,
                (Intent::Go, true) => ContactPhase::Swept,
                (Intent::Go, false) => ContactPhase::Overlapped,
            };
            let closing = -(wanted - self.mover.velocity_of(&touch)).dot(touch.normal);
            self.list(&touch, closing, phase);
        }
    }

    fn list(&mut self, touch: &MoverContact, closing_speed: f64, phase: ContactPhase) {
        let (obstacle, contact) = (touch.obstacle, &touch.contact);
        let apart = ONE_CONTACT * self.config.body.radius;
        let is_known = self.contacts.iter().any(|known| {
            let same = (known.obstacle, known.material.key) == (obstacle, contact.material.key);
            // A collider may be a whole mesh, whose faces cannot be told apart by its key.
            let is_near = known.position.distance(contact.point) <= apart;
            let is_face = known.normal.dot(touch.normal) > ONE_FACE;
            same && known.phase == phase && is_near && is_face
        });
        if !is_known {
            self.contacts.push(ClimberContact {
                obstacle,
                material: contact.material,
                tag: contact.tag,
                position: contact.point,
                normal: touch.normal,
                closing_speed,
                phase,
            });
        }
    }

    /// Adds the support to the contacts.
    pub(super) fn list_support(&mut self) {
        let Some(support) = &self.state.support else {
            return;
        };
        let phase = match self.state.mode {
            ClimberMode::Holding | ClimberMode::Hanging => ContactPhase::Grip,
            ClimberMode::LedgeHanging => ContactPhase::Ledge,
            _ => ContactPhase::Ground,
        };
        let attachment = &support.attachment;
        self.contacts.push(ClimberContact {
            obstacle: attachment.obstacle,
            material: attachment.material,
            tag: support.tag,
            position: attachment.point,
            normal: support.normal_in_world(),
            closing_speed: 0.0,
            phase,
        });
    }

    /// Keeps the support at a position, and clips the wanted velocity by the contacts.
    pub(super) fn settle(&mut self, carried: &Carried, position: DVec3, wanted: DVec3) {
        self.keep_support(carried, position);
        self.state.velocity = self.clipped(wanted);
    }
}

/// A vector moved towards another one by at most a length. (glam's `move_towards` arrives from 1e-4 away, which is far
/// for a small body.)
pub(super) fn towards(from: DVec3, to: DVec3, most: f64) -> DVec3 {
    let way = to - from;
    let length = way.length();
    if length <= most {
        to
    } else {
        from + way / length * most
    }
}
