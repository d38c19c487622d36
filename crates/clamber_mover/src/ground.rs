//! Support of a body: the ground below it, and the contacts of a movement that hold it up.

use clamber_world::{SweepContact, WorldCapsule};
use glam::DVec3;

use crate::half_spaces::{MovePlane, project_onto_half_spaces};
use crate::{Mover, MoverBody, MoverContact};

/// Parameters of a search for ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundProbe {
    /// The shape that is to stand on the ground. Its position is an argument of the search, for example of
    /// [`Mover::find_ground`].
    pub body: MoverBody,
    /// Unit vector that points up.
    pub up: DVec3,
    /// Steepest slope that counts as ground, radians from level.
    pub max_slope: f64,
    /// Search distance below the feet, metres, not negative.
    pub reach: f64,
}

/// Ground that a body can stand on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// The contact that the body would stand on.
    pub touch: MoverContact,
    /// Position of the body on the ground, in world space.
    pub position: DVec3,
}

/// Minimum search distance below the feet, as a fraction of the margin, however small the reach: far more than the
/// rounding of f32, by which a standing body may be above its ground.
const UNDERFOOT: f64 = 0.1;

/// Slopes on all sides support a body if they shorten a unit step down to less than this length: the sine of 6 degrees.
const SUPPORTED: f64 = 0.1;

/// Contacts underfoot that are farther than the nearest by less than this fraction of the margin count as equally near.
const AS_NEAR: f64 = 0.01;

/// Faces whose slopes differ by less than this, as cosines, count as one face: the rounding of f32 normals.
const ONE_FACE: f64 = 1e-6;

/// Cosine of the largest angle by which the ground may turn under a body that slides over it in a tick: 45 degrees.
const SAME_SIDE: f64 = 0.7;

/// Maximum number of slopes that are considered together.
const WEDGE: usize = 16;

impl GroundProbe {
    fn is_ground(&self, normal: DVec3) -> bool {
        slope(normal, self.up) <= self.max_slope
    }

    /// The least search distance, metres.
    fn least(&self) -> f64 {
        UNDERFOOT * self.body.margin
    }
}

/// Angle between a unit vector and up, radians.
pub fn slope(normal: DVec3, up: DVec3) -> f64 {
    libm::acos(normal.dot(up).clamp(-1.0, 1.0))
}

impl Mover<'_> {
    /// Finds the ground straight below a position, or else the nearest ground beside it. The search distance is the
    /// probe's reach, or a tenth of the body's margin if that is more.
    pub fn find_ground(&mut self, probe: &GroundProbe, position: DVec3) -> Option<Ground> {
        let probe = &GroundProbe {
            reach: probe.reach.max(probe.least()),
            ..*probe
        };
        self.find_ground_below(probe, position)
            .or_else(|| self.find_ground_beside(probe, position))
    }

    /// Finds the ground straight below a position, within the probe's reach: the first contact of the body on its way
    /// down, if its slope counts as ground.
    pub fn find_ground_below(&mut self, probe: &GroundProbe, position: DVec3) -> Option<Ground> {
        let body = &probe.body;
        let down = -probe.up * (probe.reach + body.margin);
        let SweepContact {
            contact: touch,
            fraction,
            ..
        } = self.meet_ground(probe, position, down)?;
        // Raises the body until it just touches the contact that its core has met.
        let rise = (body.radius - touch.contact.distance) / touch.normal.dot(probe.up);
        let position = position + down * fraction + probe.up * rise;
        Some(Ground { touch, position })
    }

    /// The nearest ground, for a body with no ground straight below.
    fn find_ground_beside(&mut self, probe: &GroundProbe, position: DVec3) -> Option<Ground> {
        let body = &probe.body;
        let mut best: Option<MoverContact> = None;
        self.overlap(&body.crouched(), position, probe.reach);
        for touch in self.overlaps() {
            let nearer = best.is_none_or(|best| touch.contact.distance < best.contact.distance);
            if nearer && probe.is_ground(touch.normal) && self.is_ground(touch) {
                best = Some(*touch);
            }
        }
        let best = best?;
        // The nearest point of a triangle may be on an inner edge of a wall and look like a ledge. So the body must
        // meet the ground first in a cast.
        let way = (best.contact.distance - body.core_radius()).max(0.0) + probe.least();
        let toward = -best.normal * way;
        let SweepContact {
            contact: touch,
            fraction,
            ..
        } = self.meet_ground(probe, position, toward)?;
        let position =
            position + toward * fraction + touch.normal * (body.radius - touch.contact.distance);
        Some(Ground { touch, position })
    }

    /// The first contact of the body's core along `way`, if it is ground.
    fn meet_ground(
        &mut self,
        probe: &GroundProbe,
        position: DVec3,
        way: DVec3,
    ) -> Option<SweepContact<MoverContact>> {
        let core = probe.body.core_at(position);
        let hit = self.cast_past_characters(&core, way, probe.up)?;
        let is_level = !hit.started_inside && probe.is_ground(hit.contact.normal);
        (is_level && self.is_ground(&hit.contact)).then_some(hit)
    }

    /// The contact of the last movement that holds the body up: the most level of the contacts that can, if its slope
    /// is at most `max_slope`, radians, or if the contacts together leave the body no way down. `None` if the body is
    /// not held up.
    pub fn holding_up(&self, up: DVec3, max_slope: f64) -> Option<MoverContact> {
        let ground = self.touched().iter().filter(|touch| self.is_ground(touch));
        let best = ground.copied().reduce(|best, touch| {
            if touch.normal.dot(up) > best.normal.dot(up) {
                touch
            } else {
                best
            }
        })?;
        if slope(best.normal, up) <= max_slope {
            return Some(best);
        }
        let mut slopes = [MovePlane {
            normal: up,
            offset: 0.0,
        }; WEDGE];
        let mut count = 0;
        for touch in self.touched() {
            if count < WEDGE && touch.normal.dot(up) > 0.0 {
                slopes[count].normal = touch.normal;
                count += 1;
            }
        }
        let down = project_onto_half_spaces(-up, &slopes[..count]).point;
        (down.length() < SUPPORTED).then_some(best)
    }

    /// The contact that the body has slid to since it touched `met`: the nearest one within the margin of its ball, on
    /// the same obstacle, with a normal within 45 degrees of `met`'s. Among equally near contacts, the one on the most
    /// level face is taken, since rounding must not decide on which of two faces the body stands.
    pub fn still_underfoot(
        &mut self,
        body: &MoverBody,
        position: DVec3,
        up: DVec3,
        met: &MoverContact,
    ) -> Option<MoverContact> {
        let as_near = AS_NEAR * body.margin;
        self.overlap(&body.crouched(), position, body.margin);
        let underfoot = || {
            let is_met = |touch: &&MoverContact| {
                let same_side = touch.normal.dot(met.normal) > SAME_SIDE;
                touch.obstacle == met.obstacle && same_side && self.is_ground(touch)
            };
            self.overlaps().iter().filter(is_met)
        };
        let distances = underfoot().map(|touch| touch.contact.distance);
        let nearest = distances.fold(f64::INFINITY, f64::min);
        let as_near = underfoot().filter(|touch| touch.contact.distance <= nearest + as_near);
        as_near.copied().reduce(|best, touch| {
            let level = |touch: &MoverContact| touch.contact.normal.dot(up);
            let rise = level(&touch) - level(&best);
            let nearer = touch.contact.distance < best.contact.distance;
            if rise > ONE_FACE || rise >= -ONE_FACE && nearer {
                touch
            } else {
                best
            }
        })
    }
}

/// A walk that was blocked, perhaps by a step: the parameters of [`Mover::step_up`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepUp {
    /// The body, the steepest slope of a tread, and the largest height of a step (the probe's reach).
    pub probe: GroundProbe,
    /// Start of the walk, in world space: the position to which the ground has carried the body by the tick's end.
    pub from: DVec3,
    /// Target of the walk, in world space.
    pub target: DVec3,
    /// Position at which the walk was blocked, in world space.
    pub position: DVec3,
}

/// Fraction of a walk that may be missing before the walk counts as blocked.
const BLOCKED: f64 = 0.05;

impl Mover<'_> {
    /// The position of a body after it has climbed the step that blocked it; `None` if there is no such step. Casts the
    /// body's core up, forward and down. (The three casts: Quake's step move, Jolt's WalkStairs.)
    pub fn step_up(&mut self, step: &StepUp) -> Option<DVec3> {
        let StepUp {
            probe,
            from,
            target,
            position,
        } = *step;
        let up = probe.up;
        let level = |v: DVec3| v - up * v.dot(up);
        let wanted = level(target - from);
        let direction = wanted.normalize_or_zero();
        let missing = wanted.length() - level(position - from).dot(direction);
        let height = probe.reach;
        if height == 0.0 || missing <= wanted.length() * BLOCKED {
            return None;
        }
        let core = probe.body.core_at(position);
        // Limits the rise to the room below a ceiling, which would otherwise block every way from there.
        let room = self.obstruction(&core, up * height);
        let rise = room.map_or(height, |hit| {
            (height * hit.fraction - probe.body.margin).max(0.0)
        });
        let rise = up * rise;
        let raised = core.moved(rise);
        let ways = [missing, onto_a_tread(&probe).max(missing)];
        ways.into_iter().find_map(|way| {
            let forward = direction * way;
            let is_free = self.is_free(&raised, forward);
            let over = position + rise + forward;
            is_free.then(|| self.tread_below(&probe, position, over))?
        })
    }

    /// The position of the body on a tread below `over`, if the tread is level enough and higher than `position`, and
    /// the body fits under the obstacles above it.
    fn tread_below(&mut self, probe: &GroundProbe, position: DVec3, over: DVec3) -> Option<DVec3> {
        let down = GroundProbe {
            reach: (over - position).dot(probe.up),
            ..*probe
        };
        let ground = self.find_ground_below(&down, over)?;
        if self.is_character(&ground.touch) {
            // A character is never a step.
            return None;
        }
        let rise = (ground.position - position).dot(probe.up);
        if rise <= probe.body.margin || !self.is_step(&ground.touch) {
            return None;
        }
        // The body stands a margin above the contact that its core has met, so perhaps higher than the core started.
        let lift = (ground.position - over).dot(probe.up);
        let core: WorldCapsule = probe.body.core_at(over);
        let is_free = lift <= 0.0 || self.is_free(&core, probe.up * lift);
        is_free.then_some(ground.position)
    }
}

/// Distance that a ball has to move from where an edge first stops it to where it stands on that edge.
fn onto_a_tread(probe: &GroundProbe) -> f64 {
    probe.body.radius * (1.0 - libm::sin(probe.max_slope)) + probe.body.margin
}
