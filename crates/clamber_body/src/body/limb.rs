//! What a body remembers of a hand or a foot.

use clamber_animation::Spring;
use clamber_animation::ik::PoleMemory;
use clamber_surface::geometry::{rotation_from_axis_angle, rotation_vector, slerp};
use glam::{DQuat, DVec3};

use super::carry::Carry;
use super::detour::Detour;
use super::hold::Hold;
use crate::figure::Place;

/// How long an extremity that was let go takes for half of the way back to its clip at least, seconds.
const LET_GO: f64 = 0.07;

/// The fastest that a hand or foot still is when it turns to something else, metres a second.
const FASTEST: f64 = 6.0;

/// The fastest turn of a hand or foot that goes on when it turns to something else, radians a second.
const SPINS: f64 = 20.0;

/// Over which time the speed of an extremity is remembered, seconds.
const PACE: f64 = 0.06;

/// What a hand or foot does.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Doing {
    /// As its clip.
    #[default]
    Free,
    /// Is on something.
    Planted(Hold),
    /// Is on its way to something.
    Swinging(Swing),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Swing {
    pub(crate) from: Place,
    /// How fast it was then, relative to what carries the body.
    velocity: DVec3,
    pub(crate) to: Hold,
    pub(crate) time: f64,
    pub(crate) duration: f64,
    /// How far and to where it goes around in the middle of its way.
    bow: DVec3,
}

impl Swing {
    /// Where it is: on the quintic that begins with its velocity and ends at rest, both without acceleration (Flash and
    /// Hogan 1985, "The coordination of arm movements").
    pub(crate) fn place(&self) -> Place {
        let t = (self.time / self.duration).clamp(0.0, 1.0);
        let share = t * t * t * (10.0 + t * (6.0 * t - 15.0));
        let to = self.to.place();
        let run = self.velocity * (self.duration * t * (1.0 + t * t * (t * (8.0 - 3.0 * t) - 6.0)));
        let bow = self.bow * (16.0 * (t * (1.0 - t)) * (t * (1.0 - t)));
        Place {
            position: self.from.position.lerp(to.position, share) + run + bow,
            rotation: slerp(self.from.rotation, to.rotation, share),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct LimbMemory {
    pub(crate) doing: Doing,
    /// Where it was shown, in world space, and how fast relative to what carries the body.
    pub(crate) shown: Place,
    pub(crate) velocity: DVec3,
    /// How fast it turned relative to the same, radians a second.
    spin: DVec3,
    /// How fast the body moved, relative to the same.
    pub(crate) carried: DVec3,
    /// How fast it was lately.
    pub(crate) pace: f64,
    /// Of its way around things.
    pub(crate) detour: Detour,
    /// Difference from its clip after it was let go.
    offset: Spring<DVec3>,
    turn: Spring<DVec3>,
    /// Time for half of it, seconds.
    half: f64,
    pub(crate) pole: PoleMemory,
    /// Height of the ground below a foot that steps, above the root.
    pub(crate) ground: Spring<f64>,
    /// Normal of that ground.
    pub(crate) tilt: Spring<DVec3>,
    /// Length of this frame, seconds.
    frame: f64,
    /// How far a heel is lifted because its leg is too short, radians.
    pub(crate) heel: f64,
    /// It should move to another place or, for a foot that left the ground early, come down, and waits for its turn.
    pub(crate) waits: bool,
    /// Seconds since its turn came, if that was in this frame; the whole frame otherwise.
    pub(crate) late: f64,
}

impl LimbMemory {
    pub(crate) fn at(place: Place) -> Self {
        Self {
            doing: Doing::Free,
            shown: place,
            velocity: DVec3::ZERO,
            spin: DVec3::ZERO,
            carried: DVec3::ZERO,
            pace: 0.0,
            detour: Detour::default(),
            offset: Spring::default(),
            turn: Spring::default(),
            half: LET_GO,
            pole: PoleMemory::default(),
            ground: Spring::default(),
            tilt: Spring::default(),
            frame: 0.0,
            heel: 0.0,
            waits: false,
            late: 0.0,
        }
    }

    /// `carried` is the body's own velocity before.
    pub(crate) fn carry(&mut self, carry: &Carry, carried: DVec3) {
        self.carried = carry.vector(carried);
        self.shown = carry.place(&self.shown);
        self.velocity = carry.vector(self.velocity);
        self.spin = carry.vector(self.spin);
        self.detour.carry(carry);
        for spring in [&mut self.offset, &mut self.turn, &mut self.tilt] {
            spring.value = carry.vector(spring.value);
            spring.velocity = carry.vector(spring.velocity);
        }
        if let Doing::Swinging(swing) = &mut self.doing {
            swing.from = carry.place(&swing.from);
            swing.velocity = carry.vector(swing.velocity);
            swing.bow = carry.vector(swing.bow);
        }
    }

    pub(crate) fn hold(&self) -> Option<&Hold> {
        match &self.doing {
            Doing::Planted(hold) => Some(hold),
            _ => None,
        }
    }

    pub(crate) fn is_planted(&self) -> bool {
        matches!(self.doing, Doing::Planted(_))
    }

    pub(crate) fn is_swinging(&self) -> bool {
        matches!(self.doing, Doing::Swinging(_))
    }

    /// Starts towards a hold from where it is; `bow` is how far and to where it goes around in the middle of its way.
    pub(crate) fn swing_to(&mut self, to: Hold, duration: f64, bow: DVec3) {
        self.waits = false;
        self.detour = Detour::default();
        self.doing = Doing::Swinging(Swing {
            from: self.shown,
            velocity: self.velocity.clamp_length_max(FASTEST),
            to,
            // It was shown before this frame.
            time: self.late.min(self.frame),
            duration,
            bow,
        });
    }

    /// Lets go, and keeps on moving as it does; `clip` is where its clip has it.
    pub(crate) fn let_go(&mut self, clip: &Place) {
        self.doing = Doing::Free;
        self.waits = false;
        self.keep(clip);
    }

    /// Begins a difference from `target` so that the next place continues the last.
    pub(crate) fn keep(&mut self, target: &Place) {
        let expected = self.shown.position + self.velocity * self.frame;
        self.offset.value = expected - target.position;
        self.offset.velocity = self.velocity - self.carried;
        self.half = LET_GO.max(soft_half(self.offset.value.length()));
        let expected = turn_by(self.spin * self.frame) * self.shown.rotation;
        self.turn.value = rotation_vector(expected * target.rotation.conjugate());
        self.turn.velocity = self.spin;
    }

    /// Comes down where it is now, and is at rest: what is left is the difference to `target`.
    pub(crate) fn stop(&mut self, now: &Place, target: &Place) {
        self.half = LET_GO;
        self.offset = Spring::at(now.position - target.position);
        self.turn = Spring::at(rotation_vector(now.rotation * target.rotation.conjugate()));
    }

    /// Ends the difference: it is where it should be.
    pub(crate) fn settle(&mut self) {
        self.offset = Spring::default();
        self.turn = Spring::default();
    }

    /// A target with what is left of the difference.
    pub(crate) fn kept(&self, target: &Place) -> Place {
        Place {
            position: target.position + self.offset.value,
            rotation: (turn_by(self.turn.value) * target.rotation).normalize(),
        }
    }

    /// [`LimbMemory::kept`], turned about a point of the hand or foot, at `pivot` from its joint.
    pub(crate) fn kept_about(&self, target: &Place, pivot: DVec3) -> Place {
        let rotation = (turn_by(self.turn.value) * target.rotation).normalize();
        Place::with_point_at(target.point(pivot) + self.offset.value, pivot, rotation)
    }

    /// How far it still is from its target, metres.
    pub(crate) fn kept_distance(&self) -> f64 {
        self.offset.value.length()
    }

    pub(crate) fn advance(&mut self, dt: f64) {
        self.frame = dt;
        self.late = dt;
        self.offset.step(DVec3::ZERO, self.half, dt);
        self.turn.step(DVec3::ZERO, self.half, dt);
        if let Doing::Swinging(swing) = &mut self.doing {
            swing.time += dt;
        }
    }

    /// Remembers where it is shown.
    pub(crate) fn show(&mut self, place: Place, dt: f64) {
        if dt > 0.0 {
            self.velocity = (place.position - self.shown.position) / dt;
            let turned = place.rotation * self.shown.rotation.conjugate();
            self.spin = (rotation_vector(turned) / dt).clamp_length_max(SPINS);
            self.pace = (self.pace * libm::exp(-dt / PACE)).max(self.velocity.length());
        }
        self.shown = place;
    }
}

/// Time for half of a way for which a critically damped spring does not start with more than 144 metres a second
/// squared: 4 cm a sixtieth beyond the last one.
pub(crate) fn soft_half(way: f64) -> f64 {
    0.14 * way.sqrt()
}

fn turn_by(vector: DVec3) -> DQuat {
    let angle = vector.length();
    if angle < 1e-9 {
        DQuat::IDENTITY
    } else {
        rotation_from_axis_angle(vector / angle, angle)
    }
}
