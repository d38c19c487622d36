//! Ledges: the first one that a body catches, and how a ledge goes on beside a body that hangs from it.
//!
//! A hanging body is below the edge, at the wall, and its hands lie on the top. Straight ahead of it, rays look for the
//! wall below the edge, and a ball for the hand looks for the top. Where the wall ends, the same search is made farther
//! along. If that fails, the body goes around the corner: its wall is then the nearest surface. At an outer corner this
//! is the corner's vertical edge until the next wall is nearer, so the body turns on a circle.

use clamber_world::WorldCapsule;
use glam::DVec3;

use crate::{Mover, MoverBody, MoverContact, slope};

/// Parameters of [`Mover::find_ledge`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedgeProbe {
    /// The body that is to hang from the ledge.
    pub body: MoverBody,
    /// Unit vector that points up.
    pub up: DVec3,
    /// Level unit vector towards the wall.
    pub facing: DVec3,
    /// Largest height of a ledge above the position, metres.
    pub reach_up: f64,
    /// Largest distance of the wall beyond the body's ball, metres.
    pub reach: f64,
    /// Steepest slope of a ledge's top, radians from level.
    pub max_slope: f64,
}

/// Radius of a hand, as a fraction of the body's radius. A narrower top is no ledge.
const HAND: f64 = 0.15;

/// Distance of the hands beyond the edge, as a fraction of the body's radius.
const BEYOND: f64 = 0.25;

impl LedgeProbe {
    /// Distance along the facing from the body's position to the contact of its hands, while it hangs at the wall,
    /// metres.
    pub fn hands_ahead(&self) -> f64 {
        self.body.radius * (1.0 + HAND + BEYOND)
    }
}

/// A body that hangs from a ledge: the parameters of the queries for how the ledge goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LedgeHold {
    /// The body.
    pub body: MoverBody,
    /// Unit vector that points up.
    pub up: DVec3,
    /// Level unit vector towards the wall.
    pub facing: DVec3,
    /// The point on the ledge's top that the hands hold, in world space. It is as far beyond the edge as in
    /// [`LedgeProbe::hands_ahead`].
    pub held: DVec3,
    /// Steepest slope of a ledge's top, radians from level. Steeper faces are walls.
    pub max_slope: f64,
}

impl LedgeHold {
    /// Height of the hands above a position, metres.
    fn height(&self, position: DVec3) -> f64 {
        (self.held - position).dot(self.up)
    }

    /// Distance along the facing from a position to the wall below the hands, metres.
    fn wall_ahead(&self, position: DVec3) -> f64 {
        (self.held - position).dot(self.facing) - (HAND + BEYOND) * self.body.radius
    }
}

/// A ledge goes on where its top is higher or lower by at most this fraction of the body's radius, and its wall farther
/// ahead or back by at most as much. With a step of more than half the radius, a body that rolls along the wall would
/// have to turn by more than 60 degrees.
const STEP: f64 = 0.5;

/// Tolerance added to [`STEP`], as a fraction of the body's radius, so that a step of exactly that height counts.
const SLACK: f64 = 0.05;

/// Depths below the hands at which the wall is looked for, as fractions of the body's radius. The first is just below
/// the edge; the others are below the edge of a top that rises from it, and of one that is a step lower.
const DEPTHS: [f64; 3] = [0.05, 0.3, STEP + SLACK];

/// Heights above the ledge over which hands reach for its top, as fractions of the body's radius: low, where there is
/// a ceiling, then over a step.
const RISES: [f64; 2] = [0.1, STEP + SLACK];

/// Cosine of the largest angle by which the wall turns from one place to the next: 20 degrees. A sharper edge is a
/// corner.
const STRAIGHT: f64 = 0.94;

/// Distance between places at which a ledge is looked for, as a fraction of the body's radius: less than a hand's
/// width, so that no ledge that is wide enough is missed.
const PLACES: f64 = 0.1;

/// Length of the level part of a unit normal above which a face counts as a wall: the normal is within 60 degrees of
/// level.
const UPRIGHT: f64 = 0.5;

/// Sideways offsets, from the direction straight ahead, at which hands look for the top of a corner, as fractions of
/// the body's radius: enough for a corner of 45 degrees.
const BESIDE: [f64; 5] = [0.0, 0.2, -0.2, 0.45, -0.45];

/// Radius of a finger, as a fraction of the body's radius: it falls into a gap that a hand would cover.
const FINGER: f64 = 0.05;

/// A wall within this multiple of the body's radius touches the body. It must be less than 1.05: that is the distance
/// to the body's own wall in a direction that is just within [`OBLIQUE`] of straight aside.
const TOUCHES: f64 = 1.04;

/// A ledge that a body can hang from.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Ledge {
    /// The contact of a hand with the ledge's top, beyond the edge.
    pub touch: MoverContact,
    /// Level unit vector straight towards the wall.
    pub facing: DVec3,
    /// Point of the wall in world space, straight ahead of the position that the ledge was found from, and at that
    /// height.
    pub wall: DVec3,
}

/// Cosine of the largest angle between the facing and the direction straight towards a wall: 72 degrees.
const OBLIQUE: f64 = 0.309;

impl Mover<'_> {
    /// Finds the ledge in front of a position, with room for the hand on its way there.
    pub fn find_ledge(&mut self, probe: &LedgeProbe, position: DVec3) -> Option<Ledge> {
        let LedgeProbe { body, up, .. } = *probe;
        let hand_radius = HAND * body.radius;
        let reach = body.radius + probe.reach;
        let height = up * probe.reach_up;
        // The first wall in front, at any height within reach.
        let hand = WorldCapsule {
            ends: [position, position + height],
            radius: hand_radius,
        };
        let ahead = self.cast(&hand, probe.facing * (reach / OBLIQUE))?;
        if ahead.started_inside {
            return None;
        }
        let facing = straight_at(&ahead.contact, probe)?;
        let wall = self.cast(&hand, facing * reach)?;
        if wall.started_inside {
            return None;
        }
        let to_wall = reach * wall.fraction + hand_radius;
        let above = WorldCapsule::ball(position + height + up * hand_radius, hand_radius);
        let inward = facing * (to_wall + hand_radius + BEYOND * body.radius);
        if !self.is_free(&above, inward) {
            return None;
        }
        let top = self.cast(&above.moved(inward), -height)?;
        let is_top = !top.started_inside && slope(top.contact.normal, up) <= probe.max_slope;
        is_top.then_some(Ledge {
            touch: top.contact,
            facing,
            wall: position + facing * to_wall,
        })
    }
}

impl Mover<'_> {
    /// The ledge straight ahead of a position at which the body could hang next: at about the height of the one that it
    /// holds, with a wall in about the same place. Both may differ by up to half of the body's radius.
    ///
    /// `None` where the ledge ends, where its wall turns by more than 20 degrees, and for input that is not finite.
    pub fn ledge_ahead(&mut self, hold: &LedgeHold, position: DVec3) -> Option<Ledge> {
        let LedgeHold { up, facing, .. } = *hold;
        let step = (STEP + SLACK) * hold.body.radius;
        let to_wall = hold.wall_ahead(position);
        let height = hold.height(position);
        DEPTHS.into_iter().find_map(|depth| {
            let from = position + up * (height - depth * hold.body.radius);
            let wall = self.cast_ray(from, facing, to_wall + step)?;
            let (toward, is_upright) = toward(wall.contact.normal, up)?;
            let is_wall = is_upright
                && slope(wall.contact.normal, up) > hold.max_slope
                && toward.dot(facing) >= STRAIGHT
                && wall.contact.distance >= to_wall - step;
            let ahead = (wall.contact.point - position).dot(toward);
            is_wall.then(|| self.hand_on(hold, position, toward, ahead))?
        })
    }

    /// The first ledge beside a position that [`Mover::ledge_ahead`] finds and `counts` accepts, up to `way`, metres in
    /// world space: across a gap, or past the edge of a step. `None` if an obstacle is between the position and the
    /// ledge.
    pub fn ledge_beside(
        &mut self,
        hold: &LedgeHold,
        position: DVec3,
        way: DVec3,
        mut counts: impl FnMut(&Ledge) -> bool,
    ) -> Option<Ledge> {
        let LedgeHold { up, facing, .. } = *hold;
        let radius = hold.body.radius;
        // Walls that stand forward by a step are not in the way.
        let before = hold.wall_ahead(position) - (STEP + SLACK + PLACES) * radius;
        let aside = up * (hold.height(position) - DEPTHS[1] * radius) + facing * before;
        let hand = WorldCapsule::ball(position + aside, PLACES * radius);
        let free = self.cast(&hand, way).map_or(1.0, |hit| hit.fraction);
        // With the tolerance, rounding does not add a place to a whole number of places.
        let places = (way.length() / (PLACES * radius) - SLACK).ceil().max(1.0);
        let mut place = 0.0;
        while place < places {
            place += 1.0;
            let share = place / places;
            if share > free {
                return None;
            }
            let ledge = self.ledge_ahead(hold, position + way * share);
            if let Some(ledge) = ledge.filter(&mut counts) {
                return Some(ledge);
            }
        }
        None
    }

    /// The ledge in an inner corner: above the wall that the body touches along `aside`, a level unit vector.
    ///
    /// `None` if there is no such wall, or no ledge on it, or if the ledge that the body holds does not lead there, for
    /// example because of a gap between the walls. Height differences are as in [`Mover::ledge_ahead`].
    pub fn ledge_in_corner(
        &mut self,
        hold: &LedgeHold,
        position: DVec3,
        aside: DVec3,
    ) -> Option<Ledge> {
        let ledge = self.nearest_ledge(hold, position, aside, TOUCHES * hold.body.radius)?;
        self.leads_to(hold, &ledge).then_some(ledge)
    }

    /// The ledge around the corner at a position: the ledge above the nearest of all walls that the body faces, at most
    /// `within` metres away. At an outer corner, the nearest wall is the corner's edge, which the body faces as it goes
    /// around it.
    ///
    /// `None` as for [`Mover::ledge_in_corner`].
    pub fn ledge_around(
        &mut self,
        hold: &LedgeHold,
        position: DVec3,
        within: f64,
    ) -> Option<Ledge> {
        let ledge = self.nearest_ledge(hold, position, hold.facing, within)?;
        self.leads_to(hold, &ledge).then_some(ledge)
    }

    /// The ledge above the nearest of the walls in roughly one direction, at most `within` metres away.
    fn nearest_ledge(
        &mut self,
        hold: &LedgeHold,
        position: DVec3,
        direction: DVec3,
        within: f64,
    ) -> Option<Ledge> {
        let radius = hold.body.radius;
        let height = hold.height(position);
        let below = |depth: f64| hold.up * (height - depth * radius);
        let band = MoverBody {
            axis: [below(DEPTHS[2]), below(DEPTHS[0])],
            radius: HAND * radius,
            margin: 0.0,
        };
        let mut nearest: Option<(f64, DVec3)> = None;
        for touch in self.overlap(&band, position, within - HAND * radius) {
            let Some((toward, true)) = toward(touch.normal, hold.up) else {
                continue;
            };
            let ahead = (touch.contact.point - position).dot(toward);
            let is_nearer = nearest.is_none_or(|(least, _)| ahead < least);
            let is_below = hold.height(touch.contact.point) <= (DEPTHS[2] + SLACK) * radius;
            if is_nearer && is_below && toward.dot(direction) >= OBLIQUE {
                nearest = Some((ahead, toward));
            }
        }
        let (ahead, toward) = nearest?;
        self.hand_on(hold, position, toward, ahead)
    }

    /// True if the ledge that the body holds leads its hands up to the wall of another one.
    fn leads_to(&mut self, hold: &LedgeHold, ledge: &Ledge) -> bool {
        let turn = ledge.facing.dot(hold.facing);
        let aside = (ledge.facing - hold.facing * turn).normalize_or_zero();
        let (closing, radius) = (aside.dot(ledge.facing), hold.body.radius);
        if turn >= STRAIGHT || (ledge.wall - hold.held).dot(ledge.facing) <= 0.0 {
            return true;
        }
        // The place on the edge where the two walls meet.
        let finger = FINGER * radius;
        let to_edge = (HAND + BEYOND) * radius - 2.0 * finger;
        let edge = hold.held - hold.facing * to_edge;
        let along = (ledge.wall - edge).dot(ledge.facing) / closing - 2.0 * finger;
        let there = edge + aside * along;
        let mut rises = RISES.into_iter();
        rises.any(|rise| self.top_below(hold, there, rise, finger).is_some())
    }

    /// The ledge that a hand holds beyond the edge of a wall, `to_wall` metres ahead of a position, with room for the
    /// hand on its way there.
    fn hand_on(
        &mut self,
        hold: &LedgeHold,
        position: DVec3,
        facing: DVec3,
        to_wall: f64,
    ) -> Option<Ledge> {
        let up = hold.up;
        let radius = hold.body.radius;
        let inward = facing * (to_wall + (HAND + BEYOND) * radius);
        let over = position + up * hold.height(position);
        for rise in RISES {
            let above = over + up * ((rise + HAND) * radius);
            let above = WorldCapsule::ball(above, HAND * radius);
            if self.is_free(&above, inward) {
                let mut beside = BESIDE.into_iter();
                let side = facing.cross(up) * radius;
                let touch = beside.find_map(|beside| {
                    let point = over + inward + side * beside;
                    self.top_below(hold, point, rise, HAND * radius)
                })?;
                return Some(Ledge {
                    touch,
                    facing,
                    wall: position + facing * to_wall,
                });
            }
        }
        None
    }

    /// The top under a ball that comes down onto a point at the height of the ledge. It starts `rise` above the point,
    /// a fraction of the body's radius.
    fn top_below(
        &mut self,
        hold: &LedgeHold,
        point: DVec3,
        rise: f64,
        ball: f64,
    ) -> Option<MoverContact> {
        let LedgeHold { body, up, .. } = *hold;
        let above = WorldCapsule::ball(point + up * (rise * body.radius + ball), ball);
        let top = self.cast(&above, -up * ((rise + STEP + SLACK) * body.radius))?;
        let is_top = !top.started_inside && slope(top.contact.normal, up) <= hold.max_slope;
        is_top.then_some(top.contact)
    }
}

/// The level direction into a face with the given normal, and whether the face is upright. `None` for level faces.
fn toward(normal: DVec3, up: DVec3) -> Option<(DVec3, bool)> {
    let level = normal - up * normal.dot(up);
    let toward = (-level).try_normalize()?;
    Some((toward, level.length() >= UPRIGHT))
}

/// The level direction straight towards a wall; `None` if the probe faces the wall too obliquely.
fn straight_at(wall: &MoverContact, probe: &LedgeProbe) -> Option<DVec3> {
    let normal = wall.normal;
    let level = normal - probe.up * normal.dot(probe.up);
    let straight = (-level).normalize_or(probe.facing);
    (straight.dot(probe.facing) >= OBLIQUE).then_some(straight)
}

#[cfg(test)]
mod tests;
