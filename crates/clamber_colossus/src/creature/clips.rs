//! The clips of a creature: the gait and the acts play on the lowest layer.

use clamber_animation::rig::Playback;
use clamber_animation::{AnimationEvent, Animator, ClipId, Layer, LayerKind, RootDelta};
use serde::{Deserialize, Serialize};

use super::Creature;
use crate::brain::StateId;
use crate::error::ColossusError;
use crate::kind::CreatureKind;

/// The clips as they play.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Clips {
    animator: Animator,
    playing: Playing,
}

/// The clip that the creature plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Playing {
    /// The clip of standing.
    Idle,
    /// The clip of walking.
    Walk,
    /// The clip of turning to the left (0) or to the right (1).
    Turn(u8),
    /// The clip of a state's act.
    Act(StateId),
}

/// Markers that the clips passed in the last step: index of the clip, and of the marker in the clip.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct PassedMarkers(Vec<[u32; 2]>);

impl PassedMarkers {
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    pub(super) fn push(&mut self, clip: ClipId, marker: usize) {
        self.0.push([clip.0, marker as u32]);
    }

    /// Names of the markers.
    pub(super) fn names<'a>(&self, kind: &'a CreatureKind) -> Vec<&'a str> {
        let names = self.0.iter().filter_map(|[clip, marker]| {
            let clip = kind.clips().clip(ClipId(*clip)).ok()?;
            clip.markers()
                .get(*marker as usize)
                .map(|marker| marker.name.as_str())
        });
        names.collect()
    }
}

impl Clips {
    /// The clip of standing, and the breathing layer if there is one. `rate` is the playback rate of all clips.
    pub(super) fn new(kind: &CreatureKind, rate: f64) -> Self {
        let mut layers = Vec::new();
        if let Some(gait) = kind.gait() {
            layers.push(Layer::new(gait.idle));
        } else if !kind.clips().clips().is_empty() {
            layers.push(Layer::new(ClipId(0)));
        }
        if let Some(breathe) = kind.breathe() {
            layers.push(Layer {
                kind: LayerKind::Additive,
                playback: Playback::Loop,
                ..Layer::new(breathe)
            });
        }
        let mut animator = Animator::new(layers);
        // Cannot fail, since the rate is finite.
        let _ = animator.set_rate(rate);
        Self {
            animator,
            playing: Playing::Idle,
        }
    }

    pub(super) fn animator(&self) -> &Animator {
        &self.animator
    }

    pub(super) fn playing(&self) -> Playing {
        self.playing
    }

    /// Time of the lowest layer, seconds; 0 without layers.
    pub(super) fn time(&self) -> f64 {
        let layer = self.animator.layers().first();
        layer.map_or(0.0, |layer| layer.time)
    }

    /// Time of the lowest layer, seconds, and the speed at which it plays; 0 without layers.
    pub(super) fn time_and_speed(&self) -> (f64, f64) {
        let layer = self.animator.layers().first();
        layer.map_or((0.0, 0.0), |layer| {
            (layer.time, layer.speed * self.animator.rate())
        })
    }

    /// Takes the clip that plays as the clip of standing.
    pub(super) fn stand(&mut self) {
        self.playing = Playing::Idle;
    }

    /// Sets the speed of the lowest layer.
    pub(super) fn set_speed(&mut self, speed: f64) {
        if let Some(layer) = self.animator.layers_mut().first_mut() {
            layer.speed = speed;
        }
    }

    /// Stops the clips at their current times.
    pub(super) fn stop(&mut self) {
        for layer in self.animator.layers_mut() {
            layer.speed = 0.0;
        }
    }

    /// Lets stopped clips go on.
    pub(super) fn go_on(&mut self) {
        for layer in self.animator.layers_mut() {
            if layer.speed == 0.0 {
                layer.speed = 1.0;
            }
        }
    }

    /// Advances the clips by a tick. Returns the motion of their root.
    pub(super) fn advance(
        &mut self,
        kind: &CreatureKind,
        dt: f64,
        events: &mut Vec<AnimationEvent>,
    ) -> Result<RootDelta, ColossusError> {
        Ok(self.animator.advance(kind.clips(), dt, events)?)
    }

    /// Plays a clip on the lowest layer from a time on, at a speed. The fade has to know the speed of the new clip.
    fn change(
        &mut self,
        kind: &CreatureKind,
        (clip, playback): (ClipId, Playback),
        [time, speed]: [f64; 2],
        fade: f64,
    ) -> Result<(), ColossusError> {
        self.animator.change(kind.clips(), fade, |layers| {
            // The breathing layer is off while a clip plays once.
            let breath = if playback == Playback::Loop { 1.0 } else { 0.0 };
            for layer in layers.iter_mut() {
                layer.speed = 1.0;
                if layer.kind == LayerKind::Additive {
                    layer.weight = breath;
                }
            }
            if let Some(layer) = layers.first_mut() {
                (layer.clip, layer.playback) = (clip, playback);
                (layer.time, layer.speed) = (time, speed);
            }
        })?;
        Ok(())
    }

    /// The same for a creature with another brain. `same` converts a state.
    pub(super) fn carry_over(&self, same: impl Fn(StateId) -> Option<StateId>) -> Self {
        Self {
            animator: self.animator.clone(),
            playing: match self.playing {
                Playing::Act(state) => same(state).map_or(Playing::Idle, Playing::Act),
                other => other,
            },
        }
    }

    /// True if a brain with `states` states can play this clip.
    pub(super) fn fits(&self, states: usize) -> bool {
        !matches!(self.playing, Playing::Act(state) if state.index() >= states)
    }
}

impl Creature {
    /// Begins the clip of a state's act.
    pub(super) fn begin(
        &mut self,
        state: StateId,
        playback: Playback,
    ) -> Result<(), ColossusError> {
        let Some(clip) = self.kind.act(state).clip else {
            return Ok(());
        };
        let clips = &mut self.state.clips;
        clips.playing = Playing::Act(state);
        let fade = self.kind.brain().fade(state);
        clips.change(&self.kind, (clip, playback), [0.0, 1.0], fade)
    }

    /// Plays a clip of the gait, unless it already plays.
    pub(super) fn play(
        &mut self,
        playing: Playing,
        speed: f64,
        fade: f64,
    ) -> Result<(), ColossusError> {
        let Some(gait) = self.kind.gait() else {
            return Ok(());
        };
        let clip = match (playing, gait.turn) {
            (Playing::Walk, _) => gait.walk,
            (Playing::Turn(side), Some(turn)) => turn[usize::from(side.min(1))],
            _ => gait.idle,
        };
        // After a change of the brain, a clip that is not in this gait may still play.
        let layer = self.state.animator().layers().first();
        let is_played =
            matches!(playing, Playing::Act(_)) || layer.is_some_and(|layer| layer.clip == clip);
        if self.state.clips.playing == playing && is_played {
            return Ok(());
        }
        self.state.clips.playing = playing;
        let time = self.step_in();
        let clip = (clip, Playback::Loop);
        self.state
            .clips
            .change(&self.kind, clip, [time, speed], fade)
    }

    /// True if the clip of a state's act does not play any more, or is over.
    pub(super) fn is_played(&self, state: StateId) -> bool {
        let layer = self.state.animator().layers().first();
        let is_over = layer.is_none_or(|layer| {
            let clip = self.kind.clips().clip(layer.clip);
            clip.is_ok_and(|clip| layer.time >= clip.duration())
        });
        self.state.clips.playing != Playing::Act(state) || is_over
    }
}
