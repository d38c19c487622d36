//! The interface of a climber to physics engines: the data for its kinematic proxy, and blows by the engine's bodies.

use clamber_world::{ObstacleId, ProxyBody, ProxyTouch};
use glam::DVec3;

use crate::step::slow_speed;
use crate::{Climber, ClimberMode, ContactPhase, Knockback};

/// Fraction of [`slow_speed`] below which an impact is no blow to a climber on its feet or in the air.
const FELT_IMPACT_SHARE: f64 = 0.02;

/// Cosine from up of the direction to a body, above which the body counts as lying on the climber and not as in its
/// way: 60 degrees.
const LYING_ABOVE_COSINE: f64 = 0.5;

impl Climber {
    /// The data of this climber after its step that a physics engine needs, so that dynamic bodies collide with the
    /// climber: [`ClimberProxy`](https://docs.rs/clamber_world) uses it in rapier. `world` is the id of the engine's
    /// obstacle.
    pub fn proxy_body(&self, world: ObstacleId) -> ProxyBody {
        let (config, state) = (self.config(), self.state());
        // A climber that walks or climbs stops in front of obstacles, so its own velocity does not count.
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
            // Every blow makes a climber let its legs swing from its hold, so slower impacts are ignored there.
            gentle: if state.mode.is_holding() {
                slow
            } else {
                slow * FELT_IMPACT_SHARE
            },
            support,
        }
    }

    /// The normal of the surface behind the climber: of its support, or without one, of the ground that it touches, for
    /// example while it tumbles. `None` while it hangs by its hands: a grip or a ledge does not back it.
    fn support_normal(&self) -> Option<DVec3> {
        let (state, up) = (self.state(), self.config().up());
        if matches!(state.mode, ClimberMode::Hanging | ClimberMode::LedgeHanging) {
            return None;
        }
        let support = state.support.map(|support| support.normal_in_world());
        let ground = || {
            let touched = self.contacts().iter().map(|contact| contact.normal);
            let below = touched.filter(|normal| normal.dot(up) > LYING_ABOVE_COSINE);
            below.max_by(|a, b| a.dot(up).total_cmp(&b.dot(up)))
        };
        support.or_else(ground)
    }

    /// Contacts of the climber's own movement in the last step with the obstacle `world` of an engine, without bodies
    /// that lie on the climber: bodies that it pushes or slides along by its own rules.
    pub fn proxy_touches(&self, world: ObstacleId) -> impl Iterator<Item = ProxyTouch> + '_ {
        let up = self.config().up();
        let of_world = self.contacts().iter().filter(move |contact| {
            let is_support = matches!(
                contact.phase,
                ContactPhase::Ground | ContactPhase::Grip | ContactPhase::Ledge
            );
            contact.obstacle == world && !is_support && contact.normal.dot(up) > -LYING_ABOVE_COSINE
        });
        of_world.map(|contact| ProxyTouch {
            material: contact.material,
            position: contact.position,
            normal: contact.normal,
        })
    }

    /// The knockback of an impulse, newton seconds, for
    /// [`StepRules::knockback`](crate::StepRules::knockback): the impulse over the climber's mass. It knocks the
    /// climber down by the same rules as every blow ([`TumbleConfig::knock_speed`](crate::TumbleConfig::knock_speed)),
    /// and hurts as a landing at that speed does ([`HealthConfig::safe_speed`](crate::HealthConfig::safe_speed)).
    /// `None` for an impulse that is zero or not finite.
    pub fn knockback_of(&self, impulse: DVec3, by: Option<ObstacleId>) -> Option<Knockback> {
        let velocity = impulse / self.config().body.mass;
        let speed = velocity.length();
        if speed == 0.0 || !speed.is_finite() {
            return None;
        }
        let damage = self.config().health.map_or(0.0, |health| {
            ((speed - health.safe_speed).max(0.0) * health.fall_damage).min(1.0)
        });
        Some(Knockback {
            velocity,
            damage,
            by,
        })
    }
}
