//! What physics engines need to know of a climber, and what their bodies do to it.

use clamber_world::{ObstacleId, ProxyBody, ProxyTouch};
use glam::DVec3;

use crate::step::slow_speed;
use crate::{Blow, Climber, ClimberMode, ContactPhase};

/// An impact slower than this share of [`slow_speed`] is no blow to a climber on its feet or in the air.
const FELT: f64 = 0.02;

/// A body counts as lying on the climber, not as being in its way, if the cosine from up of the direction to it is
/// above this: 60 degrees.
const ABOVE: f64 = 0.5;

impl Climber {
    /// What a physics engine needs to know of this climber after its step, so that dynamic bodies collide with it:
    /// [`ClimberProxy`](https://docs.rs/clamber_world) does in rapier. `world` is the id of the engine's obstacle.
    pub fn proxy_body(&self, world: ObstacleId) -> ProxyBody {
        let (config, state) = (self.config(), self.state());
        // Walking and climbing stop in front of what is in the way.
        let is_driven = state.mode.is_holding()
            || state.mode == ClimberMode::Standing && !state.standing.shoved;
        let attachment = state.support.map(|support| support.attachment);
        let support = attachment
            .filter(|on| on.obstacle == world)
            .map(|on| on.material);
        let slow = slow_speed(config);
        ProxyBody {
            capsule: self.body(),
            margin: config.body.margin,
            mass: config.body.mass,
            velocity: state.velocity,
            drift: if is_driven {
                state.base_velocity
            } else {
                state.velocity
            },
            frame_velocity: state.base_velocity,
            up: config.up(),
            support_normal: self.support_normal(),
            // A hold is let go for legs to swing, which every nudge would do.
            gentle: if state.mode.is_holding() {
                slow
            } else {
                slow * FELT
            },
            support,
        }
    }

    /// The normal of what backs it: of its support, or of the ground that it touches without one, as when it tumbles.
    /// What it hangs from does not back it.
    fn support_normal(&self) -> Option<DVec3> {
        let (state, up) = (self.state(), self.config().up());
        if matches!(state.mode, ClimberMode::Hanging | ClimberMode::LedgeHanging) {
            return None;
        }
        let support = state.support.map(|support| support.normal_in_world());
        let ground = || {
            let touched = self.contacts().iter().map(|contact| contact.normal);
            let below = touched.filter(|normal| normal.dot(up) > ABOVE);
            below.max_by(|a, b| a.dot(up).total_cmp(&b.dot(up)))
        };
        support.or_else(ground)
    }

    /// What the climber touched by itself in the last step in an engine's world, without what lies on it: bodies that
    /// it pushes or slides along by its own rules.
    pub fn proxy_touches(&self, world: ObstacleId) -> impl Iterator<Item = ProxyTouch> + '_ {
        let up = self.config().up();
        let of_world = self.contacts().iter().filter(move |contact| {
            let is_support = matches!(
                contact.phase,
                ContactPhase::Ground | ContactPhase::Grip | ContactPhase::Ledge
            );
            contact.obstacle == world && !is_support && contact.normal.dot(up) > -ABOVE
        });
        of_world.map(|contact| ProxyTouch {
            material: contact.material,
            position: contact.position,
            normal: contact.normal,
        })
    }

    /// The blow of an impulse, newton seconds, for [`ClimberInput::blow`](crate::ClimberInput::blow): the impulse over
    /// the climber's mass. It knocks the climber down by the same rules as every blow
    /// ([`TumbleConfig::knock_speed`](crate::TumbleConfig::knock_speed)), and hurts as a landing at that speed does
    /// ([`HealthConfig::safe_speed`](crate::HealthConfig::safe_speed)). `None` for an impulse that is zero or not
    /// finite.
    pub fn blow_of(&self, impulse: DVec3, by: Option<ObstacleId>) -> Option<Blow> {
        let velocity = impulse / self.config().body.mass;
        let speed = velocity.length();
        if speed == 0.0 || !speed.is_finite() {
            return None;
        }
        let damage = self.config().health.map_or(0.0, |health| {
            ((speed - health.safe_speed).max(0.0) * health.fall_damage).min(1.0)
        });
        Some(Blow {
            velocity,
            damage,
            by,
        })
    }
}
