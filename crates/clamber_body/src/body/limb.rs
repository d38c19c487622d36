//! The state of a hand or foot that a body remembers.

use clamber_animation::Spring;
use clamber_animation::ik::PoleMemory;
use clamber_surface::geometry::{rotation_from_axis_angle, rotation_vector, slerp};
use glam::{DQuat, DVec3};

use super::carry::Carry;
use super::detour::Detour;
use super::hold::Hold;
use crate::figure::Place;

/// Least half time of the way back to the clips' pose for a hand or foot that let go, seconds.
const LET_GO: f64 = 0.07;

/// Speed to which a hand's or foot's velocity is limited when a step begins, metres a second.
const MAX_START_SPEED: f64 = 6.0;

/// Limit of the remembered angular velocity of a hand or foot, radians a second.
const MAX_SPIN: f64 = 20.0;

/// Time constant with which the remembered speed of a hand or foot decays, seconds.
const SPEED_DECAY_TIME: f64 = 0.06;

/// The current action of a hand or foot.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Doing {
    /// Follows the clips' pose.
    #[default]
    Free,
    /// Is on a hold.
    Planted(Hold),
    /// Is on its way to a hold.
    Swinging(Swing),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Swing {
    /// The place where the step began.
    pub(crate) from: Place,
    /// Velocity at the step's beginning, relative to the climber's support.
    velocity: DVec3,
    /// The hold that the step leads to.
    pub(crate) to: Hold,
    /// Seconds since the step's beginning.
    pub(crate) time: f64,
    /// Seconds of the whole step.
    pub(crate) duration: f64,
    /// Displacement of the path's middle, around obstacles.
    bow: DVec3,
}

impl Swing {
    /// The place at the current time: on the quintic that begins with the initial velocity and ends at rest, both
    /// without acceleration (Flash and Hogan 1985, "The coordination of arm movements").
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
    /// The shown place, in world space.
    pub(crate) shown: Place,
    /// Velocity of the shown place, relative to the climber's support.
    pub(crate) velocity: DVec3,
    /// Angular velocity of the shown place, relative to the support, radians a second.
    spin: DVec3,
    /// Velocity of the body, relative to the support.
    pub(crate) carried: DVec3,
    /// Recent top speed, relative to the support, metres a second; it decays over [`SPEED_DECAY_TIME`].
    pub(crate) pace: f64,
    /// Displacement of the path around obstacles.
    pub(crate) detour: Detour,
    /// Difference from the target place after the hand or foot let go; it decays.
    offset: Spring<DVec3>,
    /// The same for the rotation, as a rotation vector.
    turn: Spring<DVec3>,
    /// Half time of `offset` and `turn`, seconds.
    half: f64,
    pub(crate) pole: PoleMemory,
    /// Height of the ground below a foot in the air, above the root, metres.
    pub(crate) ground: Spring<f64>,
    /// Normal of that ground.
    pub(crate) tilt: Spring<DVec3>,
    /// Length of this frame, seconds.
    frame: f64,
    /// Lift of the heel for a leg that is too short, radians.
    pub(crate) heel: f64,
    /// True if the hand or foot waits for its turn to step, or a foot that left the ground early waits to come down.
    pub(crate) waits: bool,
    /// Seconds since the limb's turn came, if it came in this frame; otherwise the whole frame.
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

    /// Moves the memory with the climber's support. `carried` is the body's velocity in the last frame.
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

    /// Starts a step to a hold from the shown place. `bow` displaces the middle of the path.
    pub(crate) fn swing_to(&mut self, to: Hold, duration: f64, bow: DVec3) {
        self.waits = false;
        self.detour = Detour::default();
        self.doing = Doing::Swinging(Swing {
            from: self.shown,
            velocity: self.velocity.clamp_length_max(MAX_START_SPEED),
            to,
            // The last frame showed this place, so the step's time starts within this frame.
            time: self.late.min(self.frame),
            duration,
            bow,
        });
    }

    /// Lets go, and moves on at the current velocity. `clip` is the place in the clips' pose, to which it returns.
    pub(crate) fn let_go(&mut self, clip: &Place) {
        self.doing = Doing::Free;
        self.waits = false;
        self.keep(clip);
    }

    /// Sets the difference from `target` so that the motion continues.
    pub(crate) fn keep(&mut self, target: &Place) {
        let expected = self.shown.position + self.velocity * self.frame;
        self.offset.value = expected - target.position;
        self.offset.velocity = self.velocity - self.carried;
        self.half = LET_GO.max(soft_half(self.offset.value.length()));
        let expected = turn_by(self.spin * self.frame) * self.shown.rotation;
        self.turn.value = rotation_vector(expected * target.rotation.conjugate());
        self.turn.velocity = self.spin;
    }

    /// Stops at `now`, at rest, with the difference from there to `target`.
    pub(crate) fn stop(&mut self, now: &Place, target: &Place) {
        self.half = LET_GO;
        self.offset = Spring::at(now.position - target.position);
        self.turn = Spring::at(rotation_vector(now.rotation * target.rotation.conjugate()));
    }

    /// Ends the difference: the target is reached at once.
    pub(crate) fn settle(&mut self) {
        self.offset = Spring::default();
        self.turn = Spring::default();
    }

    /// The target with the difference added.
    pub(crate) fn kept(&self, target: &Place) -> Place {
        Place {
            position: target.position + self.offset.value,
            rotation: (turn_by(self.turn.value) * target.rotation).normalize(),
        }
    }

    /// [`LimbMemory::kept`], turned about the point at `pivot` from the joint.
    pub(crate) fn kept_about(&self, target: &Place, pivot: DVec3) -> Place {
        let rotation = (turn_by(self.turn.value) * target.rotation).normalize();
        Place::with_point_at(target.point(pivot) + self.offset.value, pivot, rotation)
    }

    /// Length of the difference, metres.
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

    /// Stores the shown place, and its velocities over the frame.
    pub(crate) fn show(&mut self, place: Place, dt: f64) {
        if dt > 0.0 {
            self.velocity = (place.position - self.shown.position) / dt;
            let turned = place.rotation * self.shown.rotation.conjugate();
            self.spin = (rotation_vector(turned) / dt).clamp_length_max(MAX_SPIN);
            self.pace = (self.pace * libm::exp(-dt / SPEED_DECAY_TIME)).max(self.velocity.length());
        }
        self.shown = place;
    }
}

/// Half time for which a critically damped spring starts over a distance `way`, metres, with 144 m/s². At 60 Hz, a
/// frame's displacement then exceeds the last one's by at most 4 cm.
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
