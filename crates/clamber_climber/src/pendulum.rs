//! A pendulum: a body that hangs by its hands from a moving pivot.
//!
//! While the arm is taut, the integrator is velocity Verlet on the sphere: half a kick of gravity, a turn along the
//! great circle, half a kick (RATTLE of Andersen 1983, whose projection is exact for a sphere). It conserves energy
//! over any time; projecting positions instead loses energy at a rate that depends on the tick. The arm pulls and never
//! pushes. It goes slack when its tension would be negative; then the body flies until the arm is at full length, where
//! its speed along the arm is lost.
//!
//! All vectors are in the frame of the pivot, which does not turn. The change of the pivot's velocity over a tick acts
//! on the body as an impulse at the tick's start.

use glam::DVec3;

/// Largest angle of a step of the integrator, radians, both as phase at the pendulum's natural frequency and as angle
/// turned. The error of the period is 1/24 of its square, 0.04 %.
const MAX_STEP_ANGLE: f64 = 0.1;

/// Maximum number of steps in a tick: twice what an arm of 1.5 m needs for a tick of 0.25 s. Shorter arms are
/// integrated more coarsely; gravity times the length bounds their error.
const MAX_STEPS: f64 = 32.0;

/// Maximum number of times that an arm goes slack or becomes taut within a tick. More changes than this are rounding.
const MAX_ARM_EVENTS: usize = 8;

/// Share of its full length by which an arm may be shorter and still count as taut.
const TAUT_TOLERANCE: f64 = 1e-9;

/// Length up to which an arm has no direction, metres.
const SHORTEST_ARM: f64 = 1e-9;

/// Number of pieces of a flight that are searched for the time at which the arm is at full length. A body that leaves
/// the sphere and returns within one piece was barely outside.
const FLIGHT_PIECES: usize = 8;

/// Number of bisections of a piece, until its ends are neighbouring numbers.
const PIECE_BISECTIONS: usize = 52;

/// A body at the end of an arm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pendulum {
    /// Vector from the pivot to the body's centre, metres.
    pub arm: DVec3,
    /// Velocity of the body relative to the pivot, metres a second.
    pub velocity: DVec3,
}

/// The input of a [`Pendulum`]'s tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PendulumTick {
    /// Greatest distance of the body from the pivot, metres. Below a nanometre the body rests at the pivot.
    pub length: f64,
    /// Gravity, metres a second squared.
    pub gravity: DVec3,
    /// Change of the pivot's velocity over the tick, metres a second.
    pub pivot_change: DVec3,
    /// Damping rate of the swing's velocity, per second. A body in flight is not damped.
    pub damping: f64,
    /// Length of the tick, seconds.
    pub dt: f64,
}

/// Whether an arm is taut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ArmTension {
    /// The arm does not pull: the body flies.
    #[default]
    Slack,
    /// The arm pulls: the body swings.
    Taut,
}

/// The result of a [`Pendulum`]'s tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PendulumReport {
    /// Whether the arm is taut at the end of the tick.
    pub arm: ArmTension,
    /// Tension of the arm per mass, metres a second squared: at the end of the tick, plus the mean
    /// pull of the pivot over the tick. 0 if slack.
    pub tension: f64,
    /// Speed along the arm that was lost when a slack arm became taut, summed over the tick, metres a second.
    pub caught: f64,
}

impl Pendulum {
    /// Advances the pendulum by one tick. Afterwards the body is at most `length` from the pivot.
    ///
    /// A body that is farther away at the start is pulled in along the arm. The pendulum is unchanged if an argument or
    /// the result is not finite, or `dt` is not positive.
    pub(crate) fn step(&mut self, tick: &PendulumTick) -> PendulumReport {
        let mut next = *self;
        let report = next.integrate(tick);
        let finite =
            next.arm.is_finite() && next.velocity.is_finite() && report.tension.is_finite();
        if !(finite && tick.dt > 0.0 && tick.dt.is_finite() && tick.length.is_finite()) {
            return PendulumReport::default();
        }
        *self = next;
        report
    }

    fn integrate(&mut self, tick: &PendulumTick) -> PendulumReport {
        let mut report = PendulumReport::default();
        self.velocity -= tick.pivot_change;
        if tick.length <= SHORTEST_ARM {
            let held = self.velocity + tick.gravity * tick.dt;
            *self = Self::default();
            report.arm = ArmTension::Taut;
            report.tension = held.length() / tick.dt;
            return report;
        }
        let mut pull = 0.0;
        report.arm = self.take_hold(tick, &mut pull);
        let mut left = tick.dt;
        for event in 0..MAX_ARM_EVENTS {
            if left <= 0.0 {
                break;
            }
            match report.arm {
                ArmTension::Taut => {
                    // The last swing may not go slack any more, so that the tick ends.
                    left = self.swing(tick, left, pull, event + 1 == MAX_ARM_EVENTS);
                    if left > 0.0 {
                        report.arm = ArmTension::Slack;
                        pull = 0.0;
                    }
                }
                ArmTension::Slack => {
                    left = self.fly(tick, left);
                    if left > 0.0 {
                        report.caught += self.catch(tick.length);
                        report.arm = ArmTension::Taut;
                    }
                }
            }
        }
        if report.arm == ArmTension::Taut {
            report.tension = (self.tension(tick) + pull).max(0.0);
        }
        report
    }

    /// Whether the arm is taut after the pivot's impulse. A taut arm takes up the component along
    /// it: `pull` becomes the mean of this over the tick, negative if the pivot follows the body.
    fn take_hold(&mut self, tick: &PendulumTick, pull: &mut f64) -> ArmTension {
        if self.arm.length() < tick.length * (1.0 - TAUT_TOLERANCE) {
            return ArmTension::Slack;
        }
        self.arm = self.arm.normalize_or_zero() * tick.length;
        let along = self.arm / tick.length;
        let outward = self.velocity.dot(along);
        let swing = self.velocity - along * outward;
        let tension = tick.gravity.dot(along) + swing.length_squared() / tick.length;
        // The arm stays taut while an inward impulse is less than the arm's pull over the tick.
        if tension + outward / tick.dt < 0.0 {
            // The arm stops an outward motion in any case.
            if outward > 0.0 {
                self.velocity = swing;
            }
            return ArmTension::Slack;
        }
        self.velocity = swing;
        *pull = outward / tick.dt;
        ArmTension::Taut
    }

    /// Tension of a taut arm per mass, without the pivot's pull.
    fn tension(&self, tick: &PendulumTick) -> f64 {
        tick.gravity.dot(self.arm / tick.length) + self.velocity.length_squared() / tick.length
    }

    /// Swings for a time, or until an arm that is not `rigid` goes slack. Returns the time left.
    fn swing(&mut self, tick: &PendulumTick, time: f64, pull: f64, rigid: bool) -> f64 {
        let frequency = libm::sqrt(tick.gravity.length() / tick.length);
        let turning = self.velocity.length() / tick.length;
        let steps = (time * frequency.max(turning) / MAX_STEP_ANGLE)
            .ceil()
            .clamp(1.0, MAX_STEPS);
        let h = time / steps;
        let damped = libm::exp(-0.5 * tick.damping.max(0.0) * h);
        for step in 0..steps as u32 {
            self.kick(tick, 0.5 * h);
            // Damping around the turn, not around the kicks: a body at rest in an accelerating frame
            // has a velocity between ticks, but none in the middle of a tick.
            self.velocity *= damped;
            self.turn(tick.length, h);
            self.velocity *= damped;
            self.kick(tick, 0.5 * h);
            if !rigid && self.tension(tick) + pull < 0.0 {
                return time - h * f64::from(step + 1);
            }
        }
        0.0
    }

    /// Adds gravity for a time, without its component along the arm.
    fn kick(&mut self, tick: &PendulumTick, h: f64) {
        let along = self.arm / tick.length;
        self.velocity += (tick.gravity - along * tick.gravity.dot(along)) * h;
    }

    /// Turns the arm along the great circle of the velocity, which is perpendicular to the arm.
    fn turn(&mut self, length: f64, h: f64) {
        let speed = self.velocity.length();
        if speed == 0.0 {
            return;
        }
        let (along, ahead) = (self.arm / length, self.velocity / speed);
        let (sin, cos) = libm::sincos(speed * h / length);
        let turned = (along * cos + ahead * sin).normalize_or(along);
        let velocity = (ahead * cos - along * sin) * speed;
        self.arm = turned * length;
        self.velocity = velocity - turned * velocity.dot(turned);
    }

    /// Flies for a time, or until the arm is at full length. Returns the time left.
    fn fly(&mut self, tick: &PendulumTick, time: f64) -> f64 {
        let start = *self;
        let at = |t: f64| start.arm + (start.velocity + tick.gravity * (0.5 * t)) * t;
        // A body whose arm has just gone slack begins at the arm's full length.
        let most = tick.length * (1.0 + 0.1 * TAUT_TOLERANCE);
        let beyond = |t: f64| at(t).length() > most;
        let mut flown = time;
        for piece in 1..=FLIGHT_PIECES {
            let mut late = time * piece as f64 / FLIGHT_PIECES as f64;
            if beyond(late) {
                let mut early = time * (piece - 1) as f64 / FLIGHT_PIECES as f64;
                for _ in 0..PIECE_BISECTIONS {
                    let middle = 0.5 * (early + late);
                    if beyond(middle) {
                        late = middle;
                    } else {
                        early = middle;
                    }
                }
                flown = early;
                break;
            }
        }
        self.arm = at(flown);
        self.velocity = start.velocity + tick.gravity * flown;
        if flown < time {
            // More than zero even if no time is left, so that the flight counts as ended.
            (time - flown).max(f64::MIN_POSITIVE)
        } else {
            0.0
        }
    }

    /// Ends the flight on the sphere. Returns the speed lost.
    fn catch(&mut self, length: f64) -> f64 {
        let along = self.arm.normalize_or_zero();
        let outward = self.velocity.dot(along);
        self.arm = along * length;
        self.velocity -= along * outward;
        outward.max(0.0)
    }
}

#[cfg(test)]
mod tests;
