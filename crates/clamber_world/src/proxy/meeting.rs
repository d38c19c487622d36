use glam::DVec3;

use super::{ProxyBody, ProxyTouch};

/// A body is ground below the climber, on which it stands and lands by its own rules, where the cosine from down of the
/// direction to it is above this: 60 degrees.
const BELOW: f64 = 0.5;

/// A touched body that approaches the climber faster than this share of the gentle speed still collides with it.
const APPROACHES: f64 = 0.1;

/// What of a velocity slips along a contact is rounding below this share of it: engines calculate in f32.
const SLIPS: f64 = 1e-6;

/// How a dynamic body met a climber in a step of a physics engine that takes the climber for an immovable body. All
/// vectors are in world space, velocities in metres a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyMeeting {
    /// Unit normal of the contact, from the climber to the body.
    pub normal: DVec3,
    /// Velocity of the body's touched point before the step.
    pub before: DVec3,
    /// What gravity and forces would have made of it in the step without the climber.
    pub free: DVec3,
    /// What it is after the step.
    pub after: DVec3,
    /// How far the point went in the step, metres, beyond its way at the velocity `free`.
    pub shifted: DVec3,
    /// Coefficient of friction of the contact, or an upper bound of it.
    pub friction: f64,
}

/// What a body and a climber take of a [`ProxyMeeting`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyShare {
    /// The impulse to give to the body at the touched point, newton seconds: it takes back what a climber of its mass
    /// does not take.
    pub body: DVec3,
    /// The impulse that the climber gets, newton seconds, for `Climber::blow_of`; `None` if it is too slow to be felt.
    pub climber: Option<DVec3>,
    /// How far to move the body, metres: it takes back the way by which the engine moved it where the climber's own
    /// motion has made that way, since the climber pushes by its own rules.
    pub shift: DVec3,
}

/// How a body whose velocity changed at the contact met the climber, metres a second along the normal.
struct Approach {
    /// The share of the approach that the body has brought; the climber's own motion brought the rest.
    share: f64,
    /// How much of the velocity that the body would have without the climber the engine took.
    taken: f64,
    /// The part of it that forces press into the climber in every step.
    pressed: f64,
    /// How much an immovable climber would take of what the body has brought.
    brought: f64,
}

impl ProxyBody {
    /// True if a body is ground below the climber, on which it lands by its own rules. `normal` is the unit vector from
    /// the climber to the body.
    pub fn is_below(&self, normal: DVec3) -> bool {
        normal.dot(self.up) < -BELOW
    }

    /// True if a touched body is not to collide with the climber, which walks into it: one that comes by itself strikes
    /// the climber. `velocity` is that of the body's touched point, metres a second.
    pub fn pushes_by_itself(&self, touch: &ProxyTouch, velocity: DVec3) -> bool {
        (velocity - self.frame_velocity).dot(touch.normal) <= APPROACHES * self.gentle
    }

    /// Shares a meeting by mass. `response` is the change of the velocity of the body's touched point, metres a second,
    /// for an impulse there, newton seconds: linear in it. `None` if the body does not move, or if a number is not
    /// finite.
    ///
    /// A body with the response w to a unit impulse along the normal and the approach v, and a climber of mass M, share
    /// the impulse of an inelastic impact, v / (w + k / M). k is the share of the climber's mobility along the normal
    /// that its support leaves: 1 in the air, 0 straight into the ground, the squared sine of the angle between them. The
    /// support takes what would change the climber's velocity by more than v.
    ///
    /// ```
    /// use clamber_world::{ProxyBody, ProxyMeeting, WorldCapsule};
    /// use glam::DVec3;
    ///
    /// let floating = ProxyBody {
    ///     capsule: WorldCapsule::ball(DVec3::ZERO, 0.4),
    ///     margin: 0.01,
    ///     mass: 80.0,
    ///     velocity: DVec3::ZERO,
    ///     drift: DVec3::ZERO,
    ///     frame_velocity: DVec3::ZERO,
    ///     up: DVec3::Y,
    ///     support_normal: None,
    ///     gentle: 0.01,
    ///     support: None,
    /// };
    /// // 20 kg that came at 5 m/s, and that the engine stopped.
    /// let meeting = ProxyMeeting {
    ///     normal: DVec3::X,
    ///     before: DVec3::X * -5.0,
    ///     free: DVec3::X * -5.0,
    ///     after: DVec3::ZERO,
    ///     shifted: DVec3::ZERO,
    ///     friction: 0.5,
    /// };
    /// let share = floating.share(&meeting, |impulse| impulse / 20.0).unwrap();
    /// // Both go on at 1 m/s.
    /// assert!((share.climber.unwrap() / 80.0 - DVec3::X * -1.0).length() < 1e-12);
    /// assert!((meeting.after + share.body / 20.0 - DVec3::X * -1.0).length() < 1e-12);
    /// ```
    pub fn share(
        &self,
        meeting: &ProxyMeeting,
        response: impl Fn(DVec3) -> DVec3,
    ) -> Option<ProxyShare> {
        let normal = meeting.normal;
        let approach = self.approach(meeting);
        let along_normal = response(normal);
        let stiffness = along_normal.dot(normal);
        let whole = approach.taken / stiffness;
        if !whole.is_finite() {
            return None;
        }
        let is_felt = approach.taken > approach.pressed && approach.brought > self.gentle;
        let felt = approach.brought / (stiffness + self.mobility(normal) / self.mass);
        let kept = if is_felt {
            felt + approach.pressed * approach.share / stiffness
        } else {
            // Too slow to be felt: it rests on the climber.
            whole * approach.share
        };
        let along = slip_direction(self.drift - meeting.free, normal);
        let dragged = meeting.after - meeting.free - along_normal * whole;
        let most = whole.max(0.0) * meeting.friction;
        let friction = friction(dragged, along, response).clamp_length_max(most);
        // What leaves the climber on its own takes that along.
        let (body, dragging) = if whole > 0.0 {
            let share = |part: f64| (part / whole).min(1.0);
            let back = normal * (kept - whole) - friction * (1.0 - share(kept));
            (back, friction * share(felt))
        } else {
            (DVec3::ZERO, DVec3::ZERO)
        };
        // The support takes the rest.
        let borne = (self.mass * approach.brought / felt).min(1.0);
        let climber = (normal * felt + dragging) * borne;
        let pushed = [normal, along].map(|axis| axis * meeting.shifted.dot(axis).max(0.0));
        let shift = (pushed[0] + pushed[1]) * (approach.share - 1.0);
        let share = ProxyShare {
            body,
            climber: is_felt.then_some(-climber),
            shift,
        };
        let is_finite = body.is_finite() && shift.is_finite() && (climber.is_finite() || !is_felt);
        is_finite.then_some(share)
    }

    fn approach(&self, meeting: &ProxyMeeting) -> Approach {
        let normal = meeting.normal;
        let taken = (meeting.after - meeting.free).dot(normal);
        let changed = (meeting.after - meeting.before).dot(normal);
        let closing = |velocity: DVec3| (velocity - meeting.free).dot(normal);
        let at_proxy = closing(self.drift);
        let by_body = closing(self.frame_velocity).min(closing(self.velocity));
        // It lands on what is below it by its own rules. And what overlaps the layer around it because of its own
        // motion is not pushed out.
        let share = if self.is_below(normal) || at_proxy <= 0.0 {
            0.0
        } else {
            (by_body / at_proxy).clamp(0.0, 1.0)
        };
        // Where a gap is left, the engine takes a part only, and the rest in the next step. An impact is weighed as a
        // whole. What bounces changes by up to twice its approach; the rest pushes overlapping bodies apart.
        let met = (self.drift - meeting.before).dot(normal);
        let whole = changed.min(2.0 * met).max(met);
        Approach {
            share,
            taken,
            pressed: (taken - changed).max(0.0),
            brought: whole * share,
        }
    }

    /// The share of the climber's mobility that its support leaves it along a normal, away from the body: 0 straight
    /// into the support.
    fn mobility(&self, normal: DVec3) -> f64 {
        let into = self
            .support_normal
            .map_or(0.0, |support| normal.dot(support).max(0.0));
        (1.0 - into * into).max(0.0)
    }
}

/// The direction in which a velocity slips along a contact; zero if it does not, beyond rounding.
fn slip_direction(velocity: DVec3, normal: DVec3) -> DVec3 {
    let slip = velocity.reject_from_normalized(normal);
    if slip.length() > SLIPS * velocity.length() {
        slip.normalize_or_zero()
    } else {
        DVec3::ZERO
    }
}

/// The impulse of the engine's friction: of the change of the body's velocity, what follows the climber's slip, whose
/// direction is given; zero if there is none.
fn friction(change: DVec3, along: DVec3, response: impl Fn(DVec3) -> DVec3) -> DVec3 {
    let impulse = change.dot(along) / response(along).dot(along);
    if impulse > 0.0 && impulse.is_finite() {
        along * impulse
    } else {
        DVec3::ZERO
    }
}

#[cfg(test)]
mod tests;
