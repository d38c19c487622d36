//! Strikes with limbs: an attack strikes people that the skin of its limb touches in the active phase.

use clamber_animation::Spring;
use clamber_animation::rig::JointId;
use clamber_surface::geometry::{Similarity, WorldCapsule};
use clamber_surface::surface::TargetMotion;
use clamber_world::{Contact, MaterialPoint, Obstacle, SweepContact};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use super::clips::Playing;
use super::report::{AttackPhase, StrikeHit};
use super::room::LEAST_GROUND_NORMAL;
use super::state::{is_far, is_large};
use super::{Creature, Person, Surroundings};
use crate::brain::{StateAction, StateId};
use crate::feet::Carried;
use crate::kind::Strike;

/// Distance from the skin within which a limb strikes, metres. A climber that the limb pushes stays at about this
/// distance.
const STRIKE_DISTANCE: f64 = 0.05;

/// Half time in which a neck or an arm leans towards its target, as a share of the time until the active phase. More
/// than nine tenths of the lean are done by then.
const LEAN_HALF_TIME_SHARE: f64 = 0.3;

/// Lower bound for that time, seconds of the clip.
const SHORTEST_WIND_UP: f64 = 0.15;

/// Half time in which a neck or an arm leans back, seconds for a creature of `GIANT_HEIGHT`.
const LEAN_BACK_HALF_TIME: f64 = 0.4;

/// A lean is over when its offset is below this, in heights of the creature, and its speed is below this a second.
const LEAST_LEAN: f64 = 1e-4;

/// Where the current attack strikes, and the people that it has struck.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Striking {
    /// Ids of the people that the current attack has already struck: by its limb, its beam, or the wave of its limb.
    struck: Vec<u64>,
    /// Vector from the place where the clip strikes to the place where this attack does, in world space.
    aim: DVec3,
    lean: Lean,
}

/// How far a neck or an arm leans towards the target that it strikes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Lean {
    /// Offset from the end of the limb in the clip, in world space.
    spring: Spring<DVec3>,
    /// State whose attack leans; `None` if no limb leans.
    with: Option<StateId>,
}

impl Striking {
    /// Begins an act that has struck nobody, without an aim. A lean of the last attack goes on.
    pub(super) fn begin(&mut self) {
        self.struck.clear();
        self.aim = DVec3::ZERO;
    }

    /// The same attack after the creature was put elsewhere, turned by `turn`.
    pub(super) fn elsewhere(&self, turn: DQuat) -> Self {
        Self {
            struck: self.struck.clone(),
            aim: turn * self.aim,
            lean: Lean::default(),
        }
    }

    pub(super) fn aim(&self) -> DVec3 {
        self.aim
    }

    /// Ids of the people that the current attack has already struck.
    pub(super) fn struck(&self) -> &[u64] {
        &self.struck
    }

    /// Records that the current attack has struck a person.
    pub(super) fn mark_struck(&mut self, person: u64) {
        self.struck.push(person);
    }

    /// Turns the aim and the lean with the ground that carries the creature.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        self.aim = carried.vector(self.aim);
        let lean = &mut self.lean.spring;
        (lean.value, lean.velocity) = (carried.vector(lean.value), carried.vector(lean.velocity));
    }

    /// The same for a creature with another brain. `same` converts a state.
    pub(super) fn carry_over(&self, same: impl Fn(StateId) -> Option<StateId>) -> Self {
        Self {
            lean: match self.lean.with {
                Some(state) if same(state).is_some() => Lean {
                    with: same(state),
                    ..self.lean
                },
                _ => Lean::default(),
            },
            ..self.clone()
        }
    }

    /// True if a brain with `states` states can have this lean.
    pub(super) fn fits(&self, states: usize) -> bool {
        self.lean.with.is_none_or(|state| state.index() < states)
    }

    /// True if aim and lean are numbers that a creature reaches.
    pub(super) fn is_within_range(&self) -> bool {
        let lean = &self.lean.spring;
        !(is_far(lean.value) || is_far(lean.velocity) || is_large(self.aim.length()))
    }
}

impl Creature {
    /// State and phase of the current attack; `None` while the creature does not attack.
    pub fn attack(&self) -> Option<(StateId, AttackPhase)> {
        let Playing::Act(state) = self.state.clips.playing() else {
            return None;
        };
        let Some(StateAction::Attack(_)) = self.kind.brain().act(state) else {
            return None;
        };
        // The clip may still play when the creature already does something else.
        if !self.state.acting.has_begun(state) {
            return None;
        }
        let strike = self.kind.act(state).strike.as_ref()?;
        let time = self.state.clips.time();
        let phase = if time < strike.active[0] {
            AttackPhase::WindUp
        } else if time < strike.active[1] {
            AttackPhase::Active
        } else {
            AttackPhase::Recovery
        };
        Some((state, phase))
    }

    /// Records that the attack has struck a person. No other part of it strikes this person again, nor does the wave
    /// that its limb has sent out.
    pub(super) fn mark_struck(&mut self, person: u64) {
        self.state.striking.mark_struck(person);
        self.state.ranged.mark_struck(person);
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
            if self.state.striking.struck.contains(&person.id) || !person.body.is_valid() {
                continue;
            }
            let body = WorldCapsule {
                radius: person.body.radius + STRIKE_DISTANCE,
                ..person.body
            };
            let hit = self.touch(strike, &body);
            let Some(hit) = hit.filter(|hit| self.reaches(hit, person, around)) else {
                continue;
            };
            let motion = self.surface.motion(&hit.contact.material, dt);
            let velocity = motion.map_or(DVec3::ZERO, |motion| motion.velocity);
            let direction = velocity.try_normalize().unwrap_or(hit.separation_normal);
            self.mark_struck(person.id);
            self.report.blows.push(StrikeHit {
                person: person.id,
                velocity: direction * strike.attack.throw,
                damage: strike.attack.damage,
                place: hit.contact.point,
                state,
            });
        }
    }

    /// True if no rock and no other creature is between a person and the limb: from the person to the joint of the skin
    /// that touches it, and from there along the limb, from joint to joint.
    fn reaches(&self, hit: &SweepContact, person: &Person, around: &Surroundings<'_>) -> bool {
        let Some(joint) = self.joint_at(&hit.contact.material) else {
            return true;
        };
        let joints = self.kind.skeleton().joints();
        let parent = |joint: &JointId| joints.get(joint.0 as usize)?.parent;
        // The root is left out, since it may be anywhere.
        let limb = std::iter::successors(Some(joint), parent);
        let limb = limb.filter(|joint| parent(joint).is_some());
        let world = self.surface.world_from_model();
        let mut from = person.middle();
        let mut skips = person.body.radius;
        for joint in limb {
            let Some(frame) = self.palette.model_from_joint(joint) else {
                return true;
            };
            let to = world.transform_point(frame.translation);
            if !is_free(from, to, skips, around) {
                return false;
            }
            (from, skips) = (to, 0.0);
        }
        true
    }

    /// The joint that moves a point of the skin.
    pub(super) fn joint_at(&self, material: &MaterialPoint) -> Option<JointId> {
        self.surface.mesh().joint_of(material.triangle()?)
    }

    /// First contact of the limb's skin with a body in this tick.
    fn touch(&self, strike: &Strike, body: &WorldCapsule) -> Option<SweepContact> {
        let (center, radius) = self.surface.bounding_ball()?;
        let (middle, size) = body.bounding_ball();
        if middle.distance(center) > radius + size {
            return None;
        }
        let mut is_limb = |hit: &SweepContact| {
            let joint = self.joint_at(&hit.contact.material);
            joint.is_some_and(|joint| strike.hurts(joint))
        };
        let still = [DVec3::ZERO; 2];
        self.surface
            .cast_capsule_where(body, still, TargetMotion::Moving, &mut is_limb)
    }

    /// Leans a neck or an arm towards the target of its attack until the active phase ends, then back.
    pub(super) fn lean(&mut self, world: &Similarity, dt: f64) {
        let kind = std::sync::Arc::clone(&self.kind);
        let chain_of = |state: StateId| kind.act(state).strike.as_ref()?.chain.as_ref();
        let strikes = self
            .attack()
            .filter(|(state, phase)| *phase != AttackPhase::Recovery && chain_of(*state).is_some());
        let (rate, pace) = (self.size.rate.max(1e-3), self.size.pace);
        let least = LEAST_LEAN * self.size.height;
        let aim = self.state.striking.aim;
        let Lean { spring, with } = &mut self.state.striking.lean;
        // A lean ends before another attack leans.
        if let Some((state, _)) = strikes.filter(|_| with.is_none()) {
            *with = Some(state);
        }
        let Some(state) = *with else { return };
        let goes = strikes.is_some_and(|(striking, _)| striking == state);
        let active = kind.act(state).strike.as_ref().map(|strike| strike.active);
        let winds_up = active.map_or(0.0, |[from, _]| from).max(SHORTEST_WIND_UP);
        if goes {
            spring.step(aim, LEAN_HALF_TIME_SHARE * winds_up / rate, dt);
        } else {
            spring.step(DVec3::ZERO, LEAN_BACK_HALF_TIME * pace, dt);
            if spring.value.length() < least && spring.velocity.length() < least {
                self.state.striking.lean = Lean::default();
                return;
            }
        }
        let leans = spring.value;
        let Some(chain) = chain_of(state) else { return };
        let skeleton = kind.skeleton();
        if let Ok(end) = chain.end(skeleton, &self.state.pose) {
            let target = end + world.rotation.conjugate() * leans / self.size.scale;
            // A chain stretches towards a target out of reach. A chain that cannot be bent keeps its pose.
            let _ = chain.solve(skeleton, &mut self.state.pose, target);
        }
    }

    /// Decides where this attack strikes: at the prey, if it is near enough to the place where the clip strikes.
    pub(super) fn aim(&mut self, strike: &Strike) {
        let Some(prey) = self.state.perceived.visible_prey() else {
            return;
        };
        let world = self.state.world_from_model(self.size.scale);
        let way = prey - world.transform_point(strike.spot);
        // A foot comes down at the height of the ground; a neck or an arm also moves up or down to the prey.
        let way = if strike.chain.is_some() {
            way
        } else {
            DVec3::new(way.x, 0.0, way.z)
        };
        let length = way.length();
        // If the prey is too far away, the limb goes as far towards it as it can, which shows the target.
        let aim = if length > strike.attack.aim {
            way * (strike.attack.aim / length)
        } else {
            way
        };
        let in_model = world.rotation.conjugate() * aim / self.size.scale;
        self.state.striking.aim = aim * strike.reach(in_model);
    }
}

/// True if no rock and no other creature is between two places, apart from the first `skips` metres.
fn is_free(from: DVec3, to: DVec3, skips: f64, around: &Surroundings<'_>) -> bool {
    let way = to - from;
    let length = way.length() - skips;
    let Some(along) = way.try_normalize().filter(|_| length > 0.0) else {
        return true;
    };
    let from = from + along * skips;
    // Terrain in which the ray begins is ground, or the ray before has already met it.
    let mut is_rock = |hit: &Contact| hit.normal.y < LEAST_GROUND_NORMAL && hit.distance > 0.0;
    let mut rocks = around.terrain.iter();
    let mut others = around.creatures.iter();
    !rocks.any(|rock| {
        rock.cast_ray_where(from, along, length, &mut is_rock)
            .is_some()
    }) && !others.any(|other| other.cast_ray(from, along, length).is_some())
}
