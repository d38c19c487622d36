//! Whom an attack strikes: whoever the skin of its limb touches while it hurts.

use clamber_surface::geometry::{Similarity, WorldCapsule};
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::TargetMotion;
use clamber_world::{Obstacle, SweepContact};
use glam::DVec3;

use super::report::{AttackPhase, Blow};
use super::state::{Lean, Playing};
use super::{Creature, Surroundings};
use crate::brain::{Act, StateId};
use crate::kind::Strike;

/// A limb strikes whoever is this close to its skin, metres: a climber that it pushes stays at about that distance.
const REACH: f64 = 0.05;

/// A neck has half of its way to whom it bites behind it after this share of the time until it hurts, which is no less
/// than `QUICKEST` seconds of the clip: nine tenths are behind it then. A giant's goes back in `RETURNS` seconds.
const SETTLED: f64 = 0.3;
const QUICKEST: f64 = 0.15;
const RETURNS: f64 = 0.4;

/// It is back when it is nearer than this, in heights of the creature.
const LEAST: f64 = 1e-4;

impl Creature {
    /// The attack that it is at, and where in it; `None` while it does not attack.
    pub fn attack(&self) -> Option<(StateId, AttackPhase)> {
        let Playing::Act(state) = self.state.playing else {
            return None;
        };
        let Some(Act::Attack(_)) = self.kind.brain().act(state) else {
            return None;
        };
        // Its clip may still be seen when the creature does something else by now.
        if self.state.acting != Some(state) {
            return None;
        }
        let strike = self.kind.act(state).strike.as_ref()?;
        let layer = self.state.animator.layers().first();
        let time = layer.map_or(0.0, |layer| layer.time);
        let phase = if time < strike.active[0] {
            AttackPhase::WindUp
        } else if time < strike.active[1] {
            AttackPhase::Active
        } else {
            AttackPhase::Recovery
        };
        Some((state, phase))
    }

    pub(super) fn strike(&mut self, around: &Surroundings<'_>, dt: f64) {
        let Some((state, AttackPhase::Active)) = self.attack() else {
            return;
        };
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(strike) = &kind.act(state).strike else {
            return;
        };
        if !strike.attack.limb_strikes() {
            return;
        }
        for person in around.people {
            if self.state.struck.contains(&person.id) || !person.body.is_valid() {
                continue;
            }
            let body = WorldCapsule {
                radius: person.body.radius + REACH,
                ..person.body
            };
            let Some(hit) = self.touch(strike, &body) else {
                continue;
            };
            let motion = self.surface.motion(&hit.contact.material, dt);
            let velocity = motion.map_or(DVec3::ZERO, |motion| motion.velocity);
            let direction = velocity.try_normalize().unwrap_or(hit.separation_normal);
            self.state.struck.push(person.id);
            self.report.blows.push(Blow {
                person: person.id,
                velocity: direction * strike.attack.throw,
                damage: strike.attack.damage,
                place: hit.contact.point,
                state,
            });
        }
    }

    /// The first touch of the limb's skin with a body in this tick.
    fn touch(&self, strike: &Strike, body: &WorldCapsule) -> Option<SweepContact> {
        let (center, radius) = self.surface.bounding_ball()?;
        let middle = 0.5 * (body.ends[0] + body.ends[1]);
        let size = body.radius + 0.5 * body.ends[0].distance(body.ends[1]);
        if middle.distance(center) > radius + size {
            return None;
        }
        let mesh = self.surface.mesh();
        let mut is_limb = |hit: &SweepContact| {
            let triangle = u32::try_from(hit.contact.material.key).ok().map(TriangleId);
            let joint = triangle.and_then(|triangle| mesh.joint_of(triangle));
            joint.is_some_and(|joint| strike.hurts(joint))
        };
        let still = [DVec3::ZERO; 2];
        self.surface
            .cast_capsule_where(body, still, TargetMotion::Moving, &mut is_limb)
    }

    /// Brings a neck or an arm to where its attack aims, until it stops to hurt, and back.
    pub(super) fn lean(&mut self, world: &Similarity, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let chain_of = |state: StateId| kind.act(state).strike.as_ref()?.chain.as_ref();
        let strikes = self
            .attack()
            .filter(|(state, phase)| *phase != AttackPhase::Recovery && chain_of(*state).is_some());
        let (rate, pace) = (self.size.rate.max(1e-3), self.size.pace);
        let least = LEAST * self.size.height;
        let aim = self.state.aim;
        let Lean { spring, with } = &mut self.state.lean;
        // What it leans with goes back before something else is used.
        if let Some((state, _)) = strikes.filter(|_| with.is_none()) {
            *with = Some(state);
        }
        let Some(state) = *with else { return };
        let goes = strikes.is_some_and(|(striking, _)| striking == state);
        let active = kind.act(state).strike.as_ref().map(|strike| strike.active);
        let winds_up = active.map_or(0.0, |[from, _]| from).max(QUICKEST);
        if goes {
            spring.step(aim, SETTLED * winds_up / rate, dt);
        } else {
            spring.step(DVec3::ZERO, RETURNS * pace, dt);
            if spring.value.length() < least && spring.velocity.length() < least {
                self.state.lean = Lean::default();
                return;
            }
        }
        let leans = spring.value;
        let Some(chain) = chain_of(state) else { return };
        let skeleton = kind.skeleton();
        if let Ok(end) = chain.end(skeleton, &self.state.pose) {
            let target = end + world.rotation.conjugate() * leans / self.size.scale;
            // What cannot be reached is gone for as far as it goes; what cannot be bent stays.
            let _ = chain.solve(skeleton, &mut self.state.pose, target);
        }
    }

    /// Decides where this attack strikes: at its prey, if that is near enough to where the clip does.
    pub(super) fn aim(&mut self, strike: &Strike) {
        let Some((_, prey)) = self.state.prey.filter(|_| self.state.unseen == 0) else {
            return;
        };
        let world = self.state.world_from_model(self.size.scale);
        let way = prey - world.transform_point(strike.spot);
        // A foot comes down on the ground where it is; a mouth goes down to whom it bites.
        let way = if strike.chain.is_some() {
            way
        } else {
            DVec3::new(way.x, 0.0, way.z)
        };
        let length = way.length();
        // Further away than it can aim, it goes as far as it can: it shows what it means.
        let aim = if length > strike.attack.aim {
            way * (strike.attack.aim / length)
        } else {
            way
        };
        let in_model = world.rotation.conjugate() * aim / self.size.scale;
        self.state.aim = aim * strike.reach(in_model);
    }
}
