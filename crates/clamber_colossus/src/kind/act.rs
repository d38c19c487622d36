//! The data of the acts of a brain's states.

use clamber_animation::ClipId;
use clamber_animation::rig::{Playback, WeakPoint};

use super::{Contacts, Gait, JointBall, Leg, Names, Strike};
use crate::brain::{Attack, Brain, BrainProblem, StateAction, StateId};
use crate::error::ColossusError;

/// The clip of a state's act, and its strike.
#[derive(Clone, Debug, Default)]
pub(crate) struct CompiledAct {
    pub(crate) clip: Option<ClipId>,
    pub(crate) strike: Option<Strike>,
    /// Per leg, when it stands in the clip.
    pub(crate) contacts: Vec<Contacts>,
}

/// The data of the acts of all states, in the order of the states.
pub(super) fn compile_all(
    brain: &Brain,
    names: &Names<'_>,
    legs: &[Leg],
    gait: Option<&Gait>,
    weak_points: &[WeakPoint],
    balls: &[JointBall],
) -> Result<Vec<CompiledAct>, ColossusError> {
    let states = brain.states();
    states
        .map(|state| compile(brain, state, names, legs, gait, weak_points, balls))
        .collect()
}

/// Compiles the act of a state.
fn compile(
    brain: &Brain,
    state: StateId,
    names: &Names<'_>,
    legs: &[Leg],
    gait: Option<&Gait>,
    weak_points: &[WeakPoint],
    balls: &[JointBall],
) -> Result<CompiledAct, ColossusError> {
    let here = |problem| brain.error_in(state, problem);
    for name in brain.exposes(state) {
        if !weak_points.iter().any(|point| point.name == *name) {
            let known = weak_points.iter().map(|point| &point.name);
            return Err(here(BrainProblem::unknown("weak point", name, known)).into());
        }
    }
    let Some(act) = brain.act(state) else {
        return Ok(CompiledAct::default());
    };
    let clip = act
        .clip()
        .map(|name| names.clip(name))
        .transpose()
        .map_err(here)?;
    let strike = match act {
        StateAction::Attack(attack) => Some(strike(names, attack, legs, balls).map_err(here)?),
        StateAction::Walk(walk) => match &walk.strike {
            Some(clip) => {
                let (owner, attack) = attack_with(brain, clip)
                    .ok_or_else(|| here(BrainProblem::NoAttack { clip: clip.clone() }))?;
                let there = |problem| brain.error_in(owner, problem);
                // A walk does not strike, so it needs no balls.
                Some(strike(names, attack, legs, &[]).map_err(there)?)
            }
            None => None,
        },
        _ => None,
    };
    if matches!(act, StateAction::Walk(_) | StateAction::Turn(_)) && gait.is_none() {
        return Err(here(BrainProblem::NoGait).into());
    }
    let mut contacts = Vec::new();
    if let Some(clip) = clip {
        let playback = match act {
            StateAction::Play(_) => Playback::Loop,
            _ => Playback::Clamp,
        };
        for leg in legs {
            contacts.push(leg.contacts(names, names.clips.clip(clip)?, playback, [0.0; 2])?);
        }
    }
    Ok(CompiledAct {
        clip,
        strike,
        contacts,
    })
}

/// Compiles the strike of an attack.
fn strike(
    names: &Names<'_>,
    attack: &Attack,
    legs: &[Leg],
    balls: &[JointBall],
) -> Result<Strike, BrainProblem> {
    let mut limb = Vec::new();
    for pattern in &attack.limb {
        limb.extend(names.joints(pattern)?);
    }
    Strike::new(names, attack, limb, legs, balls)
}

/// The first state whose attack plays a clip, and its attack.
fn attack_with<'a>(brain: &'a Brain, clip: &str) -> Option<(StateId, &'a Attack)> {
    brain.states().find_map(|state| match brain.act(state) {
        Some(StateAction::Attack(attack)) if attack.clip == clip => Some((state, attack.as_ref())),
        _ => None,
    })
}
