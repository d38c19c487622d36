use super::pose_clock::check_time;
use super::{Pose, PoseClock, PoseHistory, PoseMotion, RigError};
use crate::geometry::{Similarity, slerp};

/// A pose for each tick, where poses are made less often than ticks, or at other times.
///
/// A surface that gets a new pose only in every third tick stands still in two ticks, and moves at three times its
/// speed in the next. Riders feel that, and are shaken off. A track blends the last two poses instead, so that the skin
/// moves evenly: one interval between poses late, by the rules of [`PoseClock`]. Poses may come in any rhythm, late, or
/// be missed. A skin without a new pose stands still, and is then teleported to where it should be, so no rider is
/// shaken off.
///
/// Local transforms are blended as by [`Pose::blend`]: a limb keeps its length, and no joint may turn by half a turn or
/// more between two poses. A local translation, scale or angle that accelerates by `a` is off by at most `a h²/8` at
/// intervals of `h`.
///
/// The track is a plain value, as large as a few poses. To roll back, clone it, or serialise it (feature `serde`). A
/// steady tick allocates nothing.
///
/// ```
/// use clamber_surface::geometry::{Affine, Similarity};
/// use clamber_surface::rig::{Joint, PoseMotion, PoseTrack, Skeleton, Transform};
///
/// const DT: f64 = 1.0 / 60.0;
/// let joint = Joint {
///     name: "back".into(),
///     parent: None,
///     rest: Transform::IDENTITY,
///     inverse_bind: Affine::IDENTITY,
/// };
/// let skeleton = Skeleton::new(vec![joint])?;
/// let (mut pose, mut track) = (skeleton.rest_pose(), PoseTrack::default());
/// let mut before = 0.0;
/// for tick in 0..60u8 {
///     let now = f64::from(tick) * DT;
///     if tick % 3 == 0 {
///         pose.transforms[0].translation.y = f32::from(tick) * 0.01;
///         track.record(now, &pose, Similarity::IDENTITY)?;
///     }
///     match track.tick(now, DT)? {
///         PoseMotion::Moved => {} // surface.advance(&palette, *track.world_from_model())?
///         PoseMotion::Teleported => {} // surface.teleport(&palette, *track.world_from_model())?
///     }
///     let y = track.pose().transforms[0].translation.y;
///     assert!(tick <= 3 || (y - before - 0.01).abs() < 1e-6); // evenly
///     before = y;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "StoredPoseTrack"))]
pub struct PoseTrack {
    clock: PoseClock,
    history: PoseHistory<Posed>,
    /// The pose and the place of the last tick.
    seen: Posed,
    /// Time of the first pose since the track began or was restarted.
    start: Option<f64>,
    /// Time of the last tick.
    ticked: Option<f64>,
}

/// Smallest share of a tick that must lie after the first pose for the tick to be motion: all of it, up to rounding.
const WHOLE: f64 = 0.99;

/// The joints of a creature, and its place in the world.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Posed {
    pose: Pose,
    world_from_model: Similarity,
}

impl PoseTrack {
    /// Adds a pose of this time, seconds, and the creature's place in the world then. Call it before the
    /// [`PoseTrack::tick`] of that time, or later if the pose is late. For a creature that is moved in every tick, pass
    /// [`Similarity::IDENTITY`], and give its place to the surface.
    ///
    /// # Errors
    /// [`RigError::JointCount`] if the pose does not have as many joints as the last one. [`RigError::NotFinite`] if
    /// the time or a transform is not finite, or a rotation has length zero. [`RigError::WorldFromModel`] if
    /// `world_from_model` is not [valid](Similarity::is_valid). [`RigError::TimeGoesBack`] if the time is before the
    /// last pose. The track is unchanged then.
    pub fn record(
        &mut self,
        time: f64,
        pose: &Pose,
        world_from_model: Similarity,
    ) -> Result<(), RigError> {
        check_time("the pose's time", time, self.clock.newest())?;
        if let Some((last, _)) = self.history.last() {
            pose.check_joint_count(last.pose.transforms.len())?;
        }
        let posed = self.copy(pose, world_from_model)?;
        self.clock.record(time)?;
        self.history.record(time, posed, PoseMotion::Moved)?;
        self.start.get_or_insert(time);
        Ok(())
    }

    /// Forgets all poses, and starts anew with one: for a teleport, or a creature that starts to be posed again. Its
    /// time may be earlier, and it may be of another skeleton.
    ///
    /// The next tick sees this pose, and the creature does not move before the time of the next pose is due.
    ///
    /// # Errors
    /// As [`PoseTrack::record`], apart from joints and times before the last. The track is unchanged then.
    pub fn restart(
        &mut self,
        time: f64,
        pose: &Pose,
        world_from_model: Similarity,
    ) -> Result<(), RigError> {
        check_time("the pose's time", time, None)?;
        let posed = self.copy(pose, world_from_model)?;
        self.clock.restart(time)?;
        self.history.restart(time, posed)?;
        self.start = Some(time);
        self.ticked = None;
        Ok(())
    }

    /// Makes a tick of `dt` seconds that ends at `now`: computes [`PoseTrack::pose`] and
    /// [`PoseTrack::world_from_model`]. Returns whether the surface is to be advanced or teleported there.
    ///
    /// # Errors
    /// [`RigError::NoPose`] before the first pose. [`RigError::NotFinite`] if a number is not finite,
    /// [`RigError::TimeGoesBack`] if the tick is before the last one, or `dt` negative. The track is unchanged then.
    pub fn tick(&mut self, now: f64, dt: f64) -> Result<PoseMotion, RigError> {
        let start = self.start.ok_or(RigError::NoPose)?;
        check_time("the tick's time", now, self.ticked)?;
        let mut motion = self.clock.tick(now, dt)?;
        self.ticked = Some(now);
        let time = self.clock.time();
        if time < start + dt * WHOLE {
            // The motion before the first pose is not known, and a velocity that jumps would shake riders off.
            motion = PoseMotion::Teleported;
        }
        let at = self.history.advance(time);
        if let Some((from, to)) = self.history.poses(at) {
            self.seen.set(&from.pose, from.world_from_model);
            if let Some(to) = to {
                self.seen.blend_in(to, at.fraction)?;
            }
        }
        Ok(motion.and(at.motion))
    }

    /// The pose that the last tick sees; an empty one before the first.
    pub fn pose(&self) -> &Pose {
        &self.seen.pose
    }

    /// The creature's place in the last tick; the identity before the first tick.
    pub fn world_from_model(&self) -> &Similarity {
        &self.seen.world_from_model
    }

    /// The clock, which knows the time whose pose the last tick sees, and the lag.
    pub fn clock(&self) -> &PoseClock {
        &self.clock
    }

    /// A copy of a pose that is valid.
    fn copy(&mut self, pose: &Pose, world_from_model: Similarity) -> Result<Posed, RigError> {
        pose.validate()?;
        if !world_from_model.is_valid() {
            return Err(RigError::WorldFromModel);
        }
        let mut posed = self.history.buffer();
        posed.set(pose, world_from_model);
        Ok(posed)
    }
}

impl Posed {
    /// Keeps its memory.
    fn set(&mut self, pose: &Pose, world_from_model: Similarity) {
        self.pose.transforms.clone_from(&pose.transforms);
        self.world_from_model = world_from_model;
    }

    fn blend_in(&mut self, to: &Self, fraction: f64) -> Result<(), RigError> {
        self.pose.blend_in(&to.pose, fraction)?;
        let (a, b) = (self.world_from_model, to.world_from_model);
        if a != b {
            let (a, b) = (a.normalized(), b.normalized());
            self.world_from_model = Similarity {
                rotation: slerp(a.rotation, b.rotation, fraction),
                scale: a.scale + (b.scale - a.scale) * fraction,
                translation: a.translation + (b.translation - a.translation) * fraction,
            };
        }
        Ok(())
    }
}

impl Default for Posed {
    fn default() -> Self {
        Self {
            pose: Pose::default(),
            world_from_model: Similarity::IDENTITY,
        }
    }
}

/// A deserialised track that is still to be checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct StoredPoseTrack {
    clock: PoseClock,
    history: PoseHistory<Posed>,
    seen: Posed,
    start: Option<f64>,
    ticked: Option<f64>,
}

#[cfg(feature = "serde")]
impl TryFrom<StoredPoseTrack> for PoseTrack {
    type Error = RigError;

    fn try_from(stored: StoredPoseTrack) -> Result<Self, RigError> {
        let StoredPoseTrack {
            clock,
            history,
            seen,
            start,
            ticked,
        } = stored;
        let times = [start, ticked];
        let is_finite = times.into_iter().flatten().all(f64::is_finite);
        if !is_finite || !clock.is_finite() {
            let what = "a time of the stored track".into();
            return Err(RigError::NotFinite { what });
        }
        history.check_times()?;
        let expected = history.last().map(|(last, _)| last.pose.transforms.len());
        for posed in history.iter() {
            if let Some(expected) = expected {
                posed.pose.check_joint_count(expected)?;
            }
        }
        for posed in history.iter().chain([&seen]) {
            posed.pose.validate()?;
            if !posed.world_from_model.is_valid() {
                return Err(RigError::WorldFromModel);
            }
        }
        Ok(Self {
            clock,
            history,
            seen,
            start,
            ticked,
        })
    }
}

#[cfg(test)]
mod tests;
