use bevy_app::{AnimationSystems, App, FixedUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_reflect::prelude::*;
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use clamber_animation::{AnimationError, AnimationEvent, Animator, ClipId, Layer, PoseBuffers};
use clamber_surface::rig::{Playback, Pose};
use thiserror::Error;

use super::assets::{RigJoints, transform};
use crate::ClamberSystems;
use crate::needs::need_resource;
use crate::tell::tell;

/// Plays a clip on the joints of a spawned rig. Insert it on the root, beside [`RigJoints`].
///
/// Where [`RigPlayer::clip`] becomes another, the creature passes into it within [`RigPlayer::fade`] seconds, with the
/// velocity that it had: `*player = RigPlayer::new("swipe")`. Markers of the clip are told by [`RigMarkerPassed`].
///
/// Joints and properties that no channel of the clip moves stay as in the rest pose. If the rig does not have the clip,
/// or the time is not finite, nothing moves and a warning is logged.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
pub struct RigPlayer {
    /// Name of the clip.
    pub clip: String,
    /// Time of the current pose in the clip, seconds since its first key frame.
    pub time: f64,
    /// Seconds of the clip per second of the schedule's `Time`: 0 holds the pose, negative plays backwards.
    pub speed: f64,
    /// True to repeat the clip, false to stop at its end, or at its start when it plays backwards.
    pub looped: bool,
    /// Seconds within which the creature passes into the clip from the one before; 0 cuts.
    pub fade: f64,
}

/// How long a player fades unless it is told, seconds.
const FADE: f64 = 0.3;

impl RigPlayer {
    /// Plays a clip from its start, at its own speed, in a loop. Passes into it within 0.3 s.
    pub fn new(clip: impl Into<String>) -> Self {
        Self {
            clip: clip.into(),
            time: 0.0,
            speed: 1.0,
            looped: true,
            fade: FADE,
        }
    }
}

/// A [`RigPlayer`] has come past a marker of its clip: a foot is planted, a blow hits.
///
/// Triggered on the creature's root, and written as a message. Clips get their markers from the extras of glTF
/// animations; see `clamber_gltf`.
#[derive(EntityEvent, Message, Clone, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, PartialEq)]
pub struct RigMarkerPassed {
    /// The creature's root.
    pub entity: Entity,
    /// Name of the marker.
    pub marker: String,
}

/// The memory of a creature's player beside the component.
#[derive(Clone, Debug, Default)]
pub(super) struct Played {
    /// The clip of the last pose.
    clip: Option<ClipId>,
    animator: Animator,
    pose: Pose,
    buffers: PoseBuffers,
    events: Vec<AnimationEvent>,
}

/// Plays [`RigPlayer`]s, in [`ClamberSystems::Animate`].
#[derive(Clone, Copy, Debug)]
pub struct RigPlayerPlugin {
    schedule: InternedScheduleLabel,
}

impl RigPlayerPlugin {
    /// Plays clips in this schedule.
    ///
    /// Use `SkinnedCollider::each_tick()` with a schedule of the fixed loop, and `SkinnedCollider::default()` with one
    /// that runs once a frame, such as `PostUpdate`.
    pub fn in_schedule(schedule: impl ScheduleLabel) -> Self {
        Self {
            schedule: schedule.intern(),
        }
    }
}

impl Default for RigPlayerPlugin {
    /// In [`FixedUpdate`].
    fn default() -> Self {
        Self::in_schedule(FixedUpdate)
    }
}

impl Plugin for RigPlayerPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<RigPlayer>()
            .add_message::<RigMarkerPassed>()
            .configure_sets(
                self.schedule,
                ClamberSystems::Animate
                    .in_set(AnimationSystems)
                    .before(ClamberSystems::Pose),
            )
            .add_systems(self.schedule, play.in_set(ClamberSystems::Animate));
    }

    fn finish(&self, app: &mut App) {
        let me = "clamber's RigPlayerPlugin";
        need_resource::<Time<Fixed>>(app, me, "TimePlugin of bevy_time");
    }
}

/// Why a player cannot play its clip.
#[derive(Debug, Error)]
enum PlayError {
    #[error("the rig has no clip {0:?}")]
    NoClip(String),
    #[error(transparent)]
    Animation(#[from] AnimationError),
}

pub(crate) fn play(
    time: Res<Time>,
    mut players: Query<(Entity, &mut RigPlayer, &mut RigJoints)>,
    mut transforms: Query<&mut Transform>,
    mut commands: Commands,
) {
    for (entity, mut player, mut joints) in &mut players {
        let told = !player.is_changed();
        let joints = joints.bypass_change_detection();
        let player = player.bypass_change_detection();
        if let Err(error) = pose(player, joints, time.delta_secs_f64()) {
            if !told {
                tracing::warn!("{entity} cannot play its clip: {error}");
            }
            continue;
        }
        for marker in passed(joints) {
            tell(&mut commands, RigMarkerPassed { entity, marker });
        }
        for (joint, local) in joints.joints.iter().zip(&joints.played.pose.transforms) {
            // A joint that the app has despawned needs no pose.
            if let Ok(mut found) = transforms.get_mut(*joint) {
                found.set_if_neq(transform(local));
            }
        }
    }
}

/// Advances a player's time, and samples the pose there.
fn pose(player: &mut RigPlayer, joints: &mut RigJoints, dt: f64) -> Result<(), PlayError> {
    let played = &mut joints.played;
    played.events.clear();
    let set = joints.animations.as_ref().map_err(Clone::clone)?;
    let clip = set.find(&player.clip);
    let clip = clip.ok_or_else(|| PlayError::NoClip(player.clip.clone()))?;
    let layer = Layer {
        time: player.time,
        speed: player.speed,
        playback: if player.looped {
            Playback::Loop
        } else {
            Playback::Clamp
        },
        ..Layer::new(clip)
    };
    if played.clip == Some(clip) {
        played.animator.layers_mut().fill(layer);
    } else {
        let fade = if played.clip.is_some() {
            player.fade
        } else {
            0.0
        };
        played.animator.change(set, fade, |layers| {
            layers.clear();
            layers.push(layer);
        })?;
        played.clip = Some(clip);
    }
    played.animator.advance(set, dt, &mut played.events)?;
    played
        .animator
        .pose_into(set, &mut played.pose, &mut played.buffers)?;
    if let Some(layer) = played.animator.layers().first() {
        player.time = layer.time;
    }
    Ok(())
}

/// Names of the markers that were passed.
fn passed(joints: &RigJoints) -> impl Iterator<Item = String> {
    joints.played.events.iter().filter_map(|event| {
        let AnimationEvent::Marker { clip, marker, .. } = event else {
            return None;
        };
        let clip = joints.animations.as_ref().ok()?.clip(*clip).ok()?;
        Some(clip.markers().get(*marker)?.name.clone())
    })
}
