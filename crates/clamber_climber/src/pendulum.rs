//! A body that hangs by its hands from a point that moves.
//!
//! While the arm is taut, velocity Verlet on the sphere: half a kick of gravity, a turn along the
//! great circle, half a kick (RATTLE of Andersen 1983, whose projection is exact for a sphere). It
//! keeps energy over any time; projecting positions instead loses it at a rate that depends on the
//! tick. The arm pulls and never pushes: it goes slack when its tension would be negative, the body
//! flies, and where the arm ends its speed along it is lost.
//!
//! All in the frame of the pivot, which does not turn. What the pivot's velocity changes by in a
//! tick acts on the body at once, at the tick's start.

use glam::DVec3;

/// Largest angle of a step of the integrator, radians, by the pendulum's own frequency and by its
/// turning: the period is off by a 24th of its square, 0.04 %.
const STEP: f64 = 0.1;

/// Most steps in a tick: enough for 1.5 m and a quarter of a second twice over. Shorter arms are
/// integrated coarsely, which gravity times the length bounds.
const STEPS: f64 = 32.0;

/// How often an arm may go slack or be caught within a tick. More often is rounding.
const EVENTS: usize = 8;

/// An arm short of its length by no more than this share is taut.
const TAUT: f64 = 1e-9;

/// Arms no longer than this, metres, have no direction.
const SHORTEST: f64 = 1e-9;

/// Pieces of a flight that are searched for the arm's end. What leaves and comes back within one
/// was never out by more than a graze.
const PIECES: usize = 8;

/// Halvings of a piece: until its ends are neighbours.
const HALVINGS: usize = 52;

/// A body at the end of an arm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Pendulum {
    /// From the pivot to the body's centre, metres.
    pub arm: DVec3,
    /// Of the body, relative to the pivot, metres a second.
    pub velocity: DVec3,
}

/// What acts on a [`Pendulum`] for a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PendulumTick {
    /// Greatest distance of the body from the pivot, metres. Below a nanometre the body rests at
    /// the pivot.
    pub length: f64,
    /// Metres a second squared.
    pub gravity: DVec3,
    /// By how much the pivot's velocity changes over the tick, metres a second.
    pub pivot_change: DVec3,
    /// Share of the swing's velocity that is lost, per second; a body in flight loses none.
    pub damping: f64,
    /// Seconds.
    pub dt: f64,
}

/// Whether an arm pulls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ArmTension {
    /// The body flies.
    #[default]
    Slack,
    /// The body swings.
    Taut,
}

/// What a tick of a [`Pendulum`] did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PendulumReport {
    /// At the end of the tick.
    pub arm: ArmTension,
    /// Of the arm at the end of the tick, per mass, with the mean of the pivot's pull over the tick:
    /// metres a second squared; 0 if slack.
    pub tension: f64,
    /// Speed along the arm that was lost where a slack arm ended, summed over the tick, metres a
    /// second.
    pub caught: f64,
}

impl Pendulum {
    /// One tick. Afterwards the body is no farther than `length` from the pivot.
    ///
    /// A body that is farther at the start is brought in along the arm. Nothing happens if an
    /// argument or the result is not finite, or `dt` not positive.
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
        if tick.length <= SHORTEST {
            let held = self.velocity + tick.gravity * tick.dt;
            *self = Self::default();
            report.arm = ArmTension::Taut;
            report.tension = held.length() / tick.dt;
            return report;
        }
        let mut pull = 0.0;
        report.arm = self.take_hold(tick, &mut pull);
        let mut left = tick.dt;
        for event in 0..EVENTS {
            if left <= 0.0 {
                break;
            }
            match report.arm {
                ArmTension::Taut => {
                    // The last may not let go any more: the tick has to end.
                    left = self.swing(tick, left, pull, event + 1 == EVENTS);
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

    /// Whether the arm is taut after the pivot's jerk. Then it takes what of the jerk is along it:
    /// `pull` becomes its mean over the tick, which is negative where the pivot follows the body.
    fn take_hold(&mut self, tick: &PendulumTick, pull: &mut f64) -> ArmTension {
        if self.arm.length() < tick.length * (1.0 - TAUT) {
            return ArmTension::Slack;
        }
        self.arm = self.arm.normalize_or_zero() * tick.length;
        let along = self.arm / tick.length;
        let outward = self.velocity.dot(along);
        let swing = self.velocity - along * outward;
        let tension = tick.gravity.dot(along) + swing.length_squared() / tick.length;
        // Less than what the arm holds over a tick: it gives way to the pivot and stays taut.
        if tension + outward / tick.dt < 0.0 {
            // What moves outward is kept in any case.
            if outward > 0.0 {
                self.velocity = swing;
            }
            return ArmTension::Slack;
        }
        self.velocity = swing;
        *pull = outward / tick.dt;
        ArmTension::Taut
    }

    /// Per mass, of a taut arm, without the pivot's pull.
    fn tension(&self, tick: &PendulumTick) -> f64 {
        tick.gravity.dot(self.arm / tick.length) + self.velocity.length_squared() / tick.length
    }

    /// Swings for a time, or until the arm goes slack unless it is `rigid`; gives the time left.
    fn swing(&mut self, tick: &PendulumTick, time: f64, pull: f64, rigid: bool) -> f64 {
        let frequency = libm::sqrt(tick.gravity.length() / tick.length);
        let turning = self.velocity.length() / tick.length;
        let steps = (time * frequency.max(turning) / STEP)
            .ceil()
            .clamp(1.0, STEPS);
        let h = time / steps;
        let damped = libm::exp(-0.5 * tick.damping.max(0.0) * h);
        for step in 0..steps as u32 {
            self.kick(tick, 0.5 * h);
            // Damping around the turn, not around the kicks: at rest in a frame that accelerates
            // the body moves between ticks, and in the middle of them stands still.
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

    /// Gravity, but for its part along the arm.
    fn kick(&mut self, tick: &PendulumTick, h: f64) {
        let along = self.arm / tick.length;
        self.velocity += (tick.gravity - along * tick.gravity.dot(along)) * h;
    }

    /// Along the great circle of the velocity, which is square to the arm.
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

    /// Flies for a time, or until the arm ends; gives the time left.
    fn fly(&mut self, tick: &PendulumTick, time: f64) -> f64 {
        let start = *self;
        let at = |t: f64| start.arm + (start.velocity + tick.gravity * (0.5 * t)) * t;
        // A body that has just let go begins at the end of its arm.
        let most = tick.length * (1.0 + 0.1 * TAUT);
        let beyond = |t: f64| at(t).length() > most;
        let mut flown = time;
        for piece in 1..=PIECES {
            let mut late = time * piece as f64 / PIECES as f64;
            if beyond(late) {
                let mut early = time * (piece - 1) as f64 / PIECES as f64;
                for _ in 0..HALVINGS {
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
            // Also where nothing of the time is left, which does not make it a flight.
            (time - flown).max(f64::MIN_POSITIVE)
        } else {
            0.0
        }
    }

    /// Ends the flight on the sphere; gives the speed lost.
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
