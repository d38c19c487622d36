use bevy_app::{AnimationSystems, App, FixedUpdate, Plugin};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{InternedScheduleLabel, ScheduleLabel};
use bevy_reflect::prelude::*;
use bevy_time::Time;
use bevy_transform::components::Transform;
use clamber_surface::rig::{Playback, RigError};
use thiserror::Error;

use super::assets::{RigJoints, transform};
use crate::ClamberSystems;

/// Plays a clip on the joints of a spawned rig: put it on the root, beside its [`RigJoints`].
///
/// What no channel of the clip moves stands as at rest. A clip that the rig does not have, or a time that is not
/// finite, moves nothing, and gives a line in the log.
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
pub struct RigPlayer {
    /// Name of the clip.
    pub clip: String,
    /// Seconds since the clip's first key frame, of the pose that the joints have.
    pub time: f64,
    /// Seconds of the clip in a second of the schedule's `Time`: 0 holds it, negative plays it backwards.
    pub speed: f64,
    /// Whether it starts anew at its end, or holds its last pose.
    pub looped: bool,
}

impl RigPlayer {
    /// A clip from its start, at its own speed, again and again.
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
    /// In a schedule of the fixed loop: colliders should then be `SkinnedCollider::each_tick()`. Or once a frame,
    /// as in `PostUpdate`, for `SkinnedCollider::default()`.
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
}

/// Why a player moves nothing.
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
                tracing::warn!("{entity} plays nothing: {error}");
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

/// Moves a player on, and takes the pose there.
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
