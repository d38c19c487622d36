use bevy_app::{AnimationSystems, App, FixedUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_reflect::prelude::*;
use bevy_time::{Fixed, Time};
use bevy_transform::components::Transform;
use clamber_surface::rig::{Playback, RigError};
use thiserror::Error;

use super::assets::{RigJoints, transform};
use crate::ClamberSystems;
use crate::needs::need_resource;

/// Plays a clip on the joints of a spawned rig. Insert it on the root, beside [`RigJoints`].
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
}

impl RigPlayer {
    /// Plays a clip from its start, at its own speed, in a loop.
    pub fn new(clip: impl Into<String>) -> Self {
        Self {
            clip: clip.into(),
            time: 0.0,
            speed: 1.0,
            looped: true,
        }
    }
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
    Rig(#[from] RigError),
}

fn play(
    time: Res<Time>,
    mut players: Query<(Entity, &mut RigPlayer, &mut RigJoints)>,
    mut transforms: Query<&mut Transform>,
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
        for (joint, local) in joints.joints.iter().zip(&joints.pose.transforms) {
            // A joint that the app has despawned needs no pose.
            if let Ok(mut found) = transforms.get_mut(*joint) {
                found.set_if_neq(transform(local));
            }
        }
    }
}

/// Advances a player's time, and samples the pose there.
fn pose(player: &mut RigPlayer, joints: &mut RigJoints, dt: f64) -> Result<(), PlayError> {
    let clip = joints.rig.clip(&player.clip);
    let clip = clip.ok_or_else(|| PlayError::NoClip(player.clip.clone()))?;
    let time = player.time + player.speed * dt;
    let duration = clip.duration();
    let (time, playback) = if player.looped && duration > 0.0 {
        (time.rem_euclid(duration), Playback::Loop)
    } else {
        (time.clamp(0.0, duration), Playback::Clamp)
    };
    let transforms = &mut joints.pose.transforms;
    transforms.clone_from(&joints.rest.transforms);
    clip.sample_into(time, playback, &mut joints.pose)?;
    player.time = time;
    Ok(())
}
