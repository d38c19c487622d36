//! Moves a body out of a creature whose skin has appeared around it.

use clamber_surface::surface::{Anchor, SkinnedSurface};
use glam::{DQuat, DVec3};
use rapier3d::math::Pose;

use super::inner_capsule::InnerCapsule;
use crate::WorldCapsule;

/// Largest depth of any part of the core's segment below the skin at which a body is put out, as a fraction of the
/// inner radius: a part of the body still shows. A larger value would move bodies visibly far. With a smaller one,
/// bodies that seem to lie on a creature would fall through it.
const DEPTH: f64 = 1.0;

/// Time in which a body is put out by its inner radius, seconds. In a shorter time, the body would push other bodies
/// away hard.
const TIME: f64 = 0.2;

/// Multiple of the time that the way out takes. A body that is not out by then is let through, because something holds
/// it.
const PATIENCE: f64 = 2.0;

/// If skin is nearer to the core's segment than this fraction of the inner radius, the skin's normal is the way out:
/// the direction to the skin would be little more than rounding.
const NEAR: f64 = 0.05;

/// A body faster than this multiple of the speed at which it is put out keeps its own speed.
const OWN: f64 = 1.01;

/// A straight way out of a creature, from the skin that was nearest to the body.
#[derive(Clone, Copy, Debug)]
pub(super) struct PutOut {
    /// The point of the skin, and the frame of its material when the body was found.
    anchor: Anchor,
    /// Unit vector out of the creature, in that frame.
    way: DVec3,
    /// Distance of the core's lowest end from the skin along the way, at the end of the last tick, metres: negative
    /// below the skin.
    height: f64,
    /// Remaining time, seconds.
    left: f64,
}

/// The changes that a tick makes to a body on its way out, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Leg {
    /// Displacement in this tick, metres.
    pub(super) shift: DVec3,
    /// Displacement that would put the body in front of the skin at once, metres.
    pub(super) rest: DVec3,
    /// Change of the body's velocity, metres a second.
    pub(super) push: DVec3,
    pub(super) state: State,
}

/// How skin got to its current place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Skin {
    Moved,
    Placed,
}

/// How far a body on its way out has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    OnTheWay,
    /// The shift puts the body in front of the skin.
    Out,
    /// The body has not come out in time.
    Held,
}

impl PutOut {
    /// The way out of a creature for a body, and about where the middle of its core will be outside. `core` is the
    /// core's segment at the end of the tick, in world space, inside the creature. `None` if the body is too deep.
    pub(super) fn new(
        surface: &SkinnedSurface,
        core: &WorldCapsule,
        radius: f64,
    ) -> Option<(Self, DVec3)> {
        let hit = surface
            .in_world()
            .closest_to_capsule(core, radius * DEPTH)?;
        let nearest = core.nearest_on_axis(hit.point);
        // The segment is inside, so the direction to the skin is the way out, unless the segment passes through the
        // skin.
        let normal = if hit.distance > radius * NEAR {
            (hit.point - nearest) / hit.distance
        } else {
            hit.normal
        };
        let height = lowest(&core.ends, hit.point, normal);
        if height < -radius * DEPTH {
            return None;
        }
        let anchor = surface.anchor_at(&hit).ok()?;
        let way = frame(surface, &anchor).conjugate() * normal;
        let length = radius - height;
        let put_out = Self {
            anchor,
            way,
            height,
            left: PATIENCE * length * TIME / radius,
        };
        Some((
            put_out,
            (core.ends[0] + core.ends[1]) * 0.5 + normal * length,
        ))
    }

    /// The same way, with no more time than `before` has left: for a creature that is placed again and again.
    pub(super) fn instead_of(self, before: &Self) -> Self {
        Self {
            left: self.left.min(before.left),
            ..self
        }
    }

    /// Goes on over a tick of `dt` seconds, which took the body to the pose `end` with a velocity. `None` if the skin
    /// at which the way begins is gone.
    ///
    /// The body moves out at a constant speed, relative to the skin. Sideways it moves freely. When it is out, it gets
    /// the skin's velocity along the way, so that it does not jump, unless it was faster by itself, as a piece that is
    /// blown off is. If `skin` was placed in this tick, its motion is unknown, so the body waits.
    pub(super) fn go_on(
        &mut self,
        (surface, skin): (&SkinnedSurface, Skin),
        core: &InnerCapsule,
        (end, velocity): (&Pose, DVec3),
        origin: DVec3,
        dt: f64,
    ) -> Option<Leg> {
        let motion = surface.in_world().motion(&self.anchor, dt).ok()?;
        let normal = motion.frame * self.way;
        let ends = core.ends_at(end).map(|end| end + origin);
        let height = lowest(&ends, motion.position, normal);
        let rest = normal * (core.radius - height).max(0.0);
        self.left -= dt;
        let waited = if self.left > 0.0 {
            State::OnTheWay
        } else {
            State::Held
        };
        if skin == Skin::Placed {
            self.height = height;
            return Some(Leg {
                shift: DVec3::ZERO,
                rest,
                push: DVec3::ZERO,
                state: waited,
            });
        }
        let speed = core.radius / TIME;
        let wanted = (self.height + speed * dt).min(core.radius);
        // Gravity may have taken the body back by more than this tick's way.
        let shift = (wanted - height).max(0.0);
        self.height = wanted.max(height);
        let state = if self.height >= core.radius {
            State::Out
        } else {
            waited
        };
        let ahead = (velocity - motion.velocity).dot(normal);
        let wanted = match state {
            State::Out if ahead > speed * OWN => ahead,
            State::Out => 0.0,
            State::OnTheWay | State::Held => ahead.max(speed),
        };
        Some(Leg {
            shift: normal * shift,
            rest,
            push: normal * (wanted - ahead),
            state,
        })
    }
}

/// Height of the lower end of a segment over the plane at `point`.
fn lowest(ends: &[DVec3; 2], point: DVec3, normal: DVec3) -> f64 {
    let [a, b] = ends.map(|end| (end - point).dot(normal));
    a.min(b)
}

/// Rotation of the material around a new anchor from rest to now, in world space.
fn frame(surface: &SkinnedSurface, anchor: &Anchor) -> DQuat {
    (surface.world_from_model().rotation * anchor.frame.as_dquat()).normalize()
}
