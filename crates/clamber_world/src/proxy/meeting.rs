use glam::DVec3;

use super::{ProxyBody, ProxyTouch};

/// Cosine of the largest angle between down and the direction to a body that counts as ground below the climber: 60
/// degrees. The climber stands and lands on such a body by its own rules.
const BELOW: f64 = 0.5;

/// A touched body that approaches the climber faster than this fraction of [`ProxyBody::gentle`] still collides with
/// it.
const APPROACHES: f64 = 0.1;

/// Least part of a velocity along a contact that counts as slip, as a fraction of the velocity. Less is rounding,
/// because engines calculate in f32.
const SLIPS: f64 = 1e-6;

/// A collision of a dynamic body with a climber in a step of a physics engine that treats the climber as an immovable
/// body. All vectors are in world space, velocities in metres a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyMeeting {
    /// Unit normal of the contact, from the climber to the body.
    pub normal: DVec3,
    /// Velocity of the body's touched point before the step.
    pub before: DVec3,
    /// The velocity of the point that gravity and forces would have given it in the step without the climber.
    pub free: DVec3,
    /// Velocity of the point after the step.
    pub after: DVec3,
    /// Displacement of the point in the step, metres, beyond its way at the velocity `free`.
    pub shifted: DVec3,
    /// Coefficient of friction of the contact, or an upper bound of it.
    pub friction: f64,
}

/// The shares of a body and a climber in a [`ProxyMeeting`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyShare {
    /// The impulse to give to the body at the touched point, newton seconds. It gives back the impulse that a climber
    /// of its mass does not take.
    pub body: DVec3,
    /// The impulse that the climber gets, newton seconds, for `Climber::knockback_of`; `None` if the impact is too slow
    /// to be felt.
    pub climber: Option<DVec3>,
    /// Displacement to give to the body, metres. It undoes the part of the engine's displacement that the climber's own
    /// motion caused, because the climber pushes by its own rules.
    pub shift: DVec3,
}

/// The approach of a body and a climber at a contact, metres a second along the normal.
struct Approach {
    /// The fraction of the approach that the body's motion causes; the climber's own motion causes the rest.
    share: f64,
    /// How much the engine changed the body's velocity, measured against the velocity without the climber.
    taken: f64,
    /// The part of `taken` that only cancels the forces of the step, which press the body into the climber in every
    /// step.
    pressed: f64,
    /// The part of the change of velocity at an immovable climber that the body's motion causes.
    brought: f64,
}

impl ProxyBody {
    /// True if a body is ground below the climber, on which the climber lands by its own rules. `normal` is the unit
    /// vector from the climber to the body.
    pub fn is_below(&self, normal: DVec3) -> bool {
        normal.dot(self.up) < -BELOW
    }

    /// True if a touched body must not collide with the climber, because the climber walks into it. A body that comes
    /// by itself strikes the climber instead. `velocity` is the velocity of the body's touched point, metres a second.
    pub fn pushes_by_itself(&self, touch: &ProxyTouch, velocity: DVec3) -> bool {
        (velocity - self.frame_velocity).dot(touch.normal) <= APPROACHES * self.gentle
    }

    /// Shares a meeting by mass. `response` returns the change of the velocity of the body's touched point, metres a
    /// second, for an impulse there, newton seconds; it is linear. `None` if no impulse moves the body, or if a number
    /// is not finite.
    ///
    /// A fraction w / (w + k / M) is left of the impulse by which the engine stops the body. w is the body's change of
    /// velocity along a unit impulse in that direction, and M is the climber's mass. k is the fraction of the climber's
    /// mobility that its support leaves: 1 in the air, 0 straight into the ground, and in between the squared sine of
    /// the angle between the impulse and the support's normal. Without friction, the result is the impulse of an
    /// inelastic impact of both. With friction, too, the two together gain no energy. The support takes the part that
    /// would change the climber's velocity by more than the approach.
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
        let approach = self.approach(meeting);
        let contact = Contact::new(meeting, self.drift, response)?;
        let whole = contact.along_normal(approach.taken);
        let is_felt = approach.taken > approach.pressed && approach.brought > self.gentle;
        let felt = contact.along_normal(approach.brought) * self.part_of(&contact);
        let kept = if is_felt {
            felt + contact.along_normal(approach.pressed) * approach.share
        } else {
            // Too slow to be felt: the body rests on the climber.
            whole * approach.share
        };
        let (normal, along) = (contact.normal, contact.along);
        let friction = along * (contact.friction * whole);
        // Friction is shared in proportion to the impulse along the normal. A body that leaves the climber by itself
        // gets no impulse.
        let (body, dragging) = if whole > 0.0 {
            let share = |part: f64| (part / whole).min(1.0);
            let back = normal * (kept - whole) - friction * (1.0 - share(kept));
            (back, friction * share(felt))
        } else {
            (DVec3::ZERO, DVec3::ZERO)
        };
        // The support takes the part that would change the climber's velocity by more than the approach.
        let borne = (self.mass * approach.brought / felt).min(1.0);
        let climber = (normal * felt + dragging) * borne;
        let pushed = [normal, along].map(|axis| axis * meeting.shifted.dot(axis).max(0.0));
        let shift = (pushed[0] + pushed[1]) * (approach.share - 1.0);
        let share = ProxyShare {
            body,
            climber: is_felt.then_some(-climber),
            shift,
        };
        let is_finite = whole.is_finite()
            && body.is_finite()
            && shift.is_finite()
            && (climber.is_finite() || !is_felt);
        is_finite.then_some(share)
    }

    fn approach(&self, meeting: &ProxyMeeting) -> Approach {
        let normal = meeting.normal;
        let taken = (meeting.after - meeting.free).dot(normal);
        let changed = (meeting.after - meeting.before).dot(normal);
        let closing = |velocity: DVec3| (velocity - meeting.free).dot(normal);
        let at_proxy = closing(self.drift);
        let by_body = closing(self.frame_velocity).min(closing(self.velocity));
        // The climber lands on a body below it by its own rules. A body that overlaps the layer around the climber
        // because of the climber's own motion is not pushed out.
        let share = if self.is_below(normal) || at_proxy <= 0.0 {
            0.0
        } else {
            (by_body / at_proxy).clamp(0.0, 1.0)
        };
        // If a gap is left, the engine removes only a part of the approach in this step, and the rest in the next one;
        // here, the impact is weighed as a whole. A body that bounces changes its velocity by up to twice its approach.
        // The rest of the change pushes overlapping bodies apart.
        let met = (self.drift - meeting.before).dot(normal);
        let whole = changed.min(2.0 * met).max(met);
        Approach {
            share,
            taken,
            pressed: (taken - changed).max(0.0),
            brought: whole * share,
        }
    }

    /// The fraction of an impulse that is left if not only the body gives way, but the climber as well.
    fn part_of(&self, contact: &Contact) -> f64 {
        let impulse = contact.impulse();
        let squared = impulse.length_squared();
        // The climber's mobility along the impulse. The support leaves only a fraction of it: none straight into the
        // support.
        let into = self.support_normal.map_or(0.0, |support| {
            let into = impulse.dot(support).max(0.0);
            into * into / squared
        });
        let mobility = (1.0 - into).max(0.0) / self.mass;
        contact.mobility / (contact.mobility + mobility)
    }
}

/// The response of a body to the impulse of an engine at a contact.
struct Contact {
    normal: DVec3,
    /// The direction of friction: a unit vector, or zero if the contact does not slip.
    along: DVec3,
    /// The impulse along `along`, for each newton second along the normal.
    friction: f64,
    /// The body's change of velocity along the normal, metres a second, for a newton second along it with its friction.
    stiffness: f64,
    /// The body's change of velocity along the whole impulse, for each newton second of it.
    mobility: f64,
}

impl Contact {
    /// Finds the impulse from the change of the body's velocity. `None` if the impulse does not move the body.
    fn new(
        meeting: &ProxyMeeting,
        drift: DVec3,
        response: impl Fn(DVec3) -> DVec3,
    ) -> Option<Self> {
        let normal = meeting.normal;
        let change = meeting.after - meeting.free;
        let along = slip_direction(drift - meeting.free, normal);
        let [by_normal, by_friction] = [normal, along].map(response);
        // If the body turns, each of the two impulses also changes the velocity in the direction of the other.
        let [n, t] = [by_normal, by_friction].map(|by| [by.dot(normal), by.dot(along)]);
        let [in_normal, in_slip] = [change.dot(normal), change.dot(along)];
        let pressing = in_normal * t[1] - in_slip * t[0];
        let dragging = in_slip * n[0] - in_normal * n[1];
        let friction = (dragging / pressing).min(meeting.friction).max(0.0);
        let friction = if pressing > 0.0 && friction.is_finite() {
            friction
        } else {
            0.0
        };
        let impulse = normal + along * friction;
        let answer = by_normal + by_friction * friction;
        let stiffness = answer.dot(normal);
        let mobility = answer.dot(impulse) / impulse.length_squared();
        let is_sound = stiffness > 0.0 && mobility > 0.0 && !meeting.friction.is_nan();
        is_sound.then_some(Self {
            normal,
            along,
            friction,
            stiffness,
            mobility,
        })
    }

    /// The impulse along the normal that changes the velocity there by `velocity`.
    fn along_normal(&self, velocity: f64) -> f64 {
        velocity / self.stiffness
    }

    fn impulse(&self) -> DVec3 {
        self.normal + self.along * self.friction
    }
}

/// The direction in which a velocity slips along a contact; zero if it does not slip, beyond rounding.
fn slip_direction(velocity: DVec3, normal: DVec3) -> DVec3 {
    let slip = velocity.reject_from_normalized(normal);
    if slip.length() > SLIPS * velocity.length() {
        slip.normalize_or_zero()
    } else {
        DVec3::ZERO
    }
}

#[cfg(test)]
mod tests;
