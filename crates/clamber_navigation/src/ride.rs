//! Predicts how long an idle climber stays on a creature.

use clamber_climber::{Climber, ClimberConfig, ClimberMode, Shake, Support};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use crate::NavigationError;
use crate::future::{FutureSkin, PoseForecast, check_step};

/// Why a climber is thrown off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum ThrowOff {
    /// The ground falls away from under the climber's feet.
    Thrown,
    /// A shake knocks the climber down.
    Knocked,
    /// The ground gets too steep to stand on.
    Slipped,
    /// The climber's stamina is used up, and its grip opens.
    Exhausted,
}

/// When and why a climber is thrown off a creature: a prediction of [`FutureSkin::ride`] for a climber that stands on
/// the creature or holds on to it, and does nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RideEnd {
    /// Seconds from now until the climber is thrown off.
    pub seconds: f64,
    /// Why the climber is thrown off.
    pub cause: ThrowOff,
}

/// The prediction of [`FutureSkin::ride`] for an idle climber on a creature: its fall, its stay, or no answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ride {
    /// The climber is thrown off.
    Ends(RideEnd),
    /// The climber stays on for the whole time that was asked for.
    Stays,
    /// Unknown: the future is not known that far, the climber is not on the creature, or the future does not begin with
    /// the creature's present pose.
    Unknown,
}

impl Ride {
    /// When and why the climber is thrown off; `None` if it stays on, or if the prediction is unknown.
    pub fn end(self) -> Option<RideEnd> {
        match self {
            Self::Ends(end) => Some(end),
            _ => None,
        }
    }
}

/// The state of a climber that rides on a creature, from tick to tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rider {
    pub(crate) holds: bool,
    pub(crate) stamina: f64,
    pub(crate) shake: Shake,
    /// Velocity of the climber's support, metres per second.
    pub(crate) velocity: Option<DVec3>,
}

impl Rider {
    /// Advances the rider by a tick in which its support moves at `velocity`. `normal` is the support's normal after
    /// the tick. Returns the reason if the rider is thrown off.
    ///
    /// The rules are `clamber_climber`'s rules for a climber whose only input is its grip. The acceleration of its
    /// support is low-pass filtered. Shakes cost stamina by the integral of their excess over a threshold, by the
    /// trapezoidal rule.
    pub(crate) fn tick(
        &mut self,
        config: &ClimberConfig,
        velocity: DVec3,
        normal: DVec3,
        dt: f64,
    ) -> Option<ThrowOff> {
        let before = self.shake;
        let change = self
            .velocity
            .map_or(DVec3::ZERO, |before| velocity - before);
        self.velocity = Some(velocity);
        self.shake.step(change, config.shake_time, dt);
        let shake = self.shake.acceleration;
        if !self.holds {
            let away = -shake.dot(normal) + config.gravity.dot(normal);
            if away > config.ground.throw_acceleration {
                return Some(ThrowOff::Thrown);
            }
            let knock = config
                .tumble
                .map_or(f64::INFINITY, |tumble| tumble.knock_acceleration);
            if shake.length() > knock {
                return Some(ThrowOff::Knocked);
            }
            let slope = libm::acos(normal.dot(config.up()).clamp(-1.0, 1.0));
            if slope > config.ground.release_slope() {
                return Some(ThrowOff::Slipped);
            }
        }
        let stamina = config.stamina?;
        let beyond = self.shake.excess(&before, stamina.shake_threshold, dt);
        if self.holds {
            self.stamina -= stamina.hold_drain * dt + stamina.shake_drain * beyond;
            if self.stamina <= 0.0 {
                self.stamina = 0.0;
                return Some(ThrowOff::Exhausted);
            }
        } else if beyond == 0.0 {
            self.stamina = (self.stamina + stamina.refill * dt).min(1.0);
        }
        None
    }
}

impl FutureSkin {
    /// Predicts how long a climber that stands on this creature or holds on to it stays there, within `most` seconds,
    /// if it does nothing else. It keeps its grip if it grips now. `creature` is the creature's obstacle id, `dt` the
    /// length of a tick, seconds. A million ticks at most are predicted.
    ///
    /// The future has to begin with the creature's present pose: a clip that begins has to fade in, as it does on the
    /// creature. The example `plans` shows how.
    ///
    /// Each tick skins three vertices. The prediction ignores parts of the creature that push the climber off, such as
    /// an arm.
    ///
    /// # Errors
    /// [`NavigationError::Surface`] if a pose does not fit the skin, [`NavigationError::OutOfRange`] if `dt` is not
    /// positive and finite.
    pub fn ride(
        &mut self,
        climber: &Climber,
        creature: ObstacleId,
        forecast: &mut dyn PoseForecast,
        dt: f64,
        most: f64,
    ) -> Result<Ride, NavigationError> {
        check_step(dt)?;
        let (state, config) = (climber.state(), climber.config());
        let on_it = |support: &Support| support.attachment.obstacle == creature;
        let Some(support) = state.support.filter(on_it) else {
            return Ok(Ride::Unknown);
        };
        let mut rider = Rider {
            holds: state.mode != ClimberMode::Standing,
            stamina: state.stamina,
            shake: Shake {
                acceleration: state.shake,
            },
            velocity: state.support_velocity,
        };
        let mut attachment = support.attachment;
        if !self.place(forecast, 0.0)? {
            return Ok(Ride::Unknown);
        }
        let ticks = (most / dt).clamp(0.0, 1e6) as u64;
        for tick in 1..=ticks {
            let seconds = tick as f64 * dt;
            if !self.advance(forecast, seconds)? {
                return Ok(Ride::Unknown);
            }
            let slack = 0.1 * config.body.radius;
            let Some(followed) = attachment.follow(self.surface() as &dyn Obstacle, dt, slack)
            else {
                return Ok(Ride::Unknown);
            };
            let normal = attachment.frame * support.normal;
            let end = rider.tick(config, followed.motion.velocity, normal, dt);
            if let Some(cause) = end {
                return Ok(Ride::Ends(RideEnd { seconds, cause }));
            }
        }
        Ok(Ride::Stays)
    }

    /// The hardest shake that a climber feels at its present place on this creature within `most` seconds, metres per
    /// second squared. If it is not on the creature, whose obstacle id is `creature`, or if the future is not known,
    /// the shake that it feels now.
    ///
    /// `dt` is the time between two samples, seconds. A tenth of a second is enough for a giant: it misses only shorter
    /// shakes. A bot needs half a second ahead to take hold.
    ///
    /// # Errors
    /// [`NavigationError::Surface`] if a pose does not fit the skin, [`NavigationError::OutOfRange`] if `dt` is not
    /// positive and finite.
    pub fn shake_ahead(
        &mut self,
        climber: &Climber,
        creature: ObstacleId,
        forecast: &mut dyn PoseForecast,
        dt: f64,
        most: f64,
    ) -> Result<f64, NavigationError> {
        check_step(dt)?;
        let (state, config) = (climber.state(), climber.config());
        let now = state.shake.length();
        let on_it = |support: &Support| support.attachment.obstacle == creature;
        let Some(support) = state.support.filter(on_it) else {
            return Ok(now);
        };
        let mut rider = Rider {
            holds: true,
            stamina: 1.0,
            shake: Shake {
                acceleration: state.shake,
            },
            velocity: state.support_velocity,
        };
        let mut hardest = now;
        let mut before = None;
        let looks = (most / dt).clamp(0.0, 1e4) as u64;
        for look in 0..=looks {
            if !self.place(forecast, look as f64 * dt)? {
                break;
            }
            let material = &support.attachment.material;
            let Some(motion) = self.surface().motion(material, dt) else {
                break;
            };
            if let Some(before) = before.replace(motion.position) {
                rider.tick(
                    config,
                    (motion.position - before) / dt,
                    support.normal_in_world(),
                    dt,
                );
                hardest = hardest.max(rider.shake.acceleration.length());
            }
        }
        Ok(hardest)
    }
}
