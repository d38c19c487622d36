//! Ranged attacks: waves, shots and beams.
//!
//! Ranged attacks strike people that do not ride the creature and are not hidden from the attack by terrain or, from a
//! shot or a beam, by another creature.

mod beam;
mod line;
mod shot;
mod wave;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::report::AttackPhase;
use super::state::{FARTHEST_COORDINATE, is_far};
use super::{Creature, Surroundings};
use crate::brain::{Attack, Shot, StateAction, StateId, Wave, WaveOf};
use crate::feet::Carried;
use crate::kind::CreatureKind;
use beam::Ray;
use shot::ShotState;
use wave::WaveState;

pub use shot::ActiveShot;
pub use wave::ActiveWave;

/// Largest number of waves, and of shots, at a time. One more removes the oldest one.
const MOST_AT_A_TIME: usize = 64;

/// Distance from terrain at which a ray begins, metres, so that it does not hit this terrain.
const RAY_START_DISTANCE: f64 = 1e-3;

/// The waves, shots and beam of a creature, and their target.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Ranged {
    /// Target of a shot or a beam, in world space.
    mark: DVec3,
    /// The beam of the last tick.
    beam: Option<Ray>,
    /// Parts of the current attack that have left the creature.
    is_out: Out,
    /// Number of the current attack.
    attack: u32,
    waves: Vec<WaveState>,
    shots: Vec<ShotState>,
    /// Number of the next shot.
    next_shot: u64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
struct Out {
    wave: bool,
    shot: bool,
    beam: bool,
}

impl Ranged {
    /// Begins the next attack: none of its parts has left the creature.
    pub(super) fn begin(&mut self) {
        (self.is_out, self.beam) = (Out::default(), None);
        self.attack = self.attack.wrapping_add(1);
    }

    /// Records that the attack has struck a person, so that the wave of its limb does not strike this person again.
    pub(super) fn mark_struck(&mut self, person: u64) {
        let attack = self.attack;
        let own = |wave: &&mut WaveState| wave.of == WaveOf::Limb && wave.attack == attack;
        self.waves
            .iter_mut()
            .filter(own)
            .for_each(|wave| wave.struck.push(person));
    }

    /// Sets a new target after the creature was put elsewhere, and ends its beam. Waves and shots stay where they are.
    pub(super) fn be_put(&mut self, mark: DVec3) {
        (self.mark, self.beam) = (reachable(mark), None);
    }

    /// Moves the target, the beam and the waves of limbs with the ground that carries the creature. Shots, and the
    /// waves into which they burst, stay.
    pub(super) fn be_carried(&mut self, carried: &Carried) {
        self.mark = carried.level_place(self.mark);
        if let Some(beam) = &mut self.beam {
            beam.from = carried.place(beam.from);
            beam.direction = carried.vector(beam.direction);
        }
        for wave in self.waves.iter_mut().filter(|wave| wave.of == WaveOf::Limb) {
            wave.place = carried.place(wave.place);
        }
    }

    /// True if a creature of this kind can have these waves, shots and beam.
    pub(super) fn fits(&self, kind: &CreatureKind) -> bool {
        !is_far(self.mark)
            && self.beam.is_none_or(|beam| {
                !is_far(beam.from) && (beam.direction.length() - 1.0).abs() < 1e-6
            })
            && self.next_shot <= u64::MAX / 2
            && self.waves.len().max(self.shots.len()) <= MOST_AT_A_TIME
            && self.waves.iter().all(|wave| {
                !is_far(wave.place)
                    && (0.0..=FARTHEST_COORDINATE).contains(&wave.reach)
                    && wave_of(kind, wave).is_some()
            })
            && self.shots.is_sorted_by(|a, b| a.number < b.number)
            && self.shots.iter().all(|shot| {
                !is_far(shot.place)
                    && shot.number < self.next_shot
                    && shot::is_reached(shot.velocity)
                    && shot_of(kind, shot).is_some()
            })
    }

    /// Converts the waves and shots for a creature with another brain, whose states `same` finds. Drops each wave and
    /// shot whose attack is not in that brain.
    pub(super) fn carry_over(
        &self,
        to: &CreatureKind,
        same: impl Fn(StateId) -> Option<StateId>,
    ) -> Self {
        let mut carried = self.clone();
        let goes_on = |state: &mut StateId| same(*state).map(|now| *state = now).is_some();
        let waves = &mut carried.waves;
        waves.retain_mut(|wave| goes_on(&mut wave.state) && wave_of(to, wave).is_some());
        let shots = &mut carried.shots;
        shots.retain_mut(|shot| goes_on(&mut shot.state) && shot_of(to, shot).is_some());
        carried
    }
}

impl Creature {
    /// Sets the target of the shot or beam of an attack that begins: the visible prey, or else a place ahead.
    pub(super) fn mark_prey(&mut self) {
        let seen = self.state.perceived.visible_prey();
        let ahead = || self.state.position() + self.state.heading() * self.size.height;
        let mark = seen.unwrap_or_else(ahead);
        self.state.ranged.mark = reachable(mark);
    }

    /// Advances all waves and shots by a tick, whether their attacks still last or not.
    pub(super) fn go_on_from_afar(&mut self, around: &Surroundings<'_>, dt: f64) {
        if self.state.ranged.waves.is_empty() && self.state.ranged.shots.is_empty() {
            return;
        }
        let kind = std::sync::Arc::clone(&self.kind);
        let mut waves = std::mem::take(&mut self.state.ranged.waves);
        waves.retain_mut(|wave| {
            wave_of(&kind, wave).is_some_and(|file| self.spread(wave, file, around, dt))
        });
        // Set before the shots fly, since a shot that bursts appends a wave.
        self.state.ranged.waves = waves;
        let mut shots = std::mem::take(&mut self.state.ranged.shots);
        shots.retain_mut(|shot| {
            shot_of(&kind, shot).is_some_and(|file| self.fly(shot, file, around, dt))
        });
        self.state.ranged.shots = shots;
    }

    /// Releases the shot and the wave of the current attack when they are due, and moves its beam.
    pub(super) fn strike_from_afar(&mut self, around: &Surroundings<'_>, dt: f64) {
        let Some((state, phase)) = self.attack() else {
            return;
        };
        let kind = std::sync::Arc::clone(&self.kind);
        let Some(strike) = &kind.act(state).strike else {
            return;
        };
        let attack = &strike.attack;
        if attack.wave.is_none() && attack.shot.is_none() && attack.beam.is_none() {
            return;
        }
        let joint = strike.end();
        let frame = joint.and_then(|joint| self.palette.model_from_joint(joint));
        let world = self.surface.world_from_model();
        let end = frame.map(|frame| world.transform_point(frame.translation));
        let Some(end) = end.filter(|end| !is_far(*end)) else {
            return;
        };
        self.follow_prey(attack, phase, dt);
        if let Some(shot) = &attack.shot
            && phase != AttackPhase::WindUp
            && !self.state.ranged.is_out.shot
        {
            self.state.ranged.is_out.shot = true;
            self.shoot(state, end, shot);
        }
        if let Some(beam) = &attack.beam
            && (phase == AttackPhase::Active
                || phase == AttackPhase::Recovery && !self.state.ranged.is_out.beam)
        {
            self.state.ranged.is_out.beam = true;
            self.shine(state, end, beam, around);
        } else {
            self.state.ranged.beam = None;
        }
        let time = self.state.clips.time();
        if let Some(wave) = &attack.wave
            && time >= strike.impact
            && !self.state.ranged.is_out.wave
        {
            self.state.ranged.is_out.wave = true;
            self.send_wave(state, end, wave, around, dt);
        }
    }

    fn follow_prey(&mut self, attack: &Attack, phase: AttackPhase, dt: f64) {
        let still_aims = match phase {
            AttackPhase::WindUp => true,
            AttackPhase::Active => attack.beam.is_some(),
            AttackPhase::Recovery => false,
        };
        let prey = self.state.perceived.visible_prey();
        if let (true, Some(place)) = (still_aims, prey) {
            let way = place - self.state.ranged.mark;
            let mark = self.state.ranged.mark + way.clamp_length_max(attack.follows * dt);
            self.state.ranged.mark = reachable(mark);
        }
    }
}

/// The nearest place that a creature's attacks can reach.
fn reachable(place: DVec3) -> DVec3 {
    place.clamp(
        DVec3::splat(-FARTHEST_COORDINATE),
        DVec3::splat(FARTHEST_COORDINATE),
    )
}

/// The attack of a state; `None` if its act is no attack.
fn attack_of(kind: &CreatureKind, state: StateId) -> Option<&Attack> {
    match kind.brain().act(state) {
        Some(StateAction::Attack(attack)) => Some(attack),
        _ => None,
    }
}

/// The wave's description in its attack; `None` if the attack has no such wave.
fn wave_of<'a>(kind: &'a CreatureKind, wave: &WaveState) -> Option<&'a Wave> {
    attack_of(kind, wave.state)?.wave_of(wave.of)
}

/// The shot's description in its attack; `None` if the attack has no shot.
fn shot_of<'a>(kind: &'a CreatureKind, shot: &ShotState) -> Option<&'a Shot> {
    attack_of(kind, shot.state)?.shot.as_ref()
}

/// Moves a place by a length in a direction, or half way to the terrain in that direction.
fn moved_off(place: DVec3, out: DVec3, by: f64, around: &Surroundings<'_>) -> DVec3 {
    let hits = around.terrain.iter();
    let hits = hits.filter_map(|one| one.cast_ray(place + out * RAY_START_DISTANCE, out, by));
    let free = hits.map(|hit| 0.5 * hit.distance).fold(by, f64::min);
    place + out * free
}

#[cfg(test)]
mod tests {
    use clamber_world::{HalfSpace, Obstacle};

    use super::*;

    #[test]
    fn a_place_is_not_moved_into_what_is_opposite() {
        let ground = HalfSpace::below(0.0);
        let Some(roof) = HalfSpace::behind(DVec3::Y * 0.3, DVec3::NEG_Y) else {
            unreachable!("it has a direction");
        };
        let moved = |terrain: &[&dyn Obstacle]| {
            let around = Surroundings {
                terrain,
                ..Surroundings::default()
            };
            moved_off(DVec3::ZERO, DVec3::Y, 0.5, &around).y
        };
        assert!((moved(&[&ground]) - 0.5).abs() < 1e-9);
        let between = moved(&[&ground, &roof]);
        assert!((between - 0.15).abs() < 2e-3, "{between}");
    }
}
