//! Clips: key-framed channels with glTF 2.0's three interpolations (specification, appendix C).

use glam::{DQuat, DVec3, Quat, Vec3};

use super::transform::{lerp, rotation_f32, rotation_f64, unit_rotation};
use super::{JointId, Marker, Pose, RigError, Transform};
use crate::geometry::{round_to_f32, slerp, widen};

/// How a channel interpolates between key frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Holds each value until the next key frame.
    Step,
    /// Linear; rotations by spherical interpolation along the shorter arc.
    Linear,
    /// Cubic Hermite spline with three values per key frame: in-tangent, value, out-tangent. Tangents are per
    /// second. Rotations are normalised afterwards.
    CubicSpline,
}

/// The values of a channel, by the property of the joint's transform that they set.
#[derive(Clone, Debug, PartialEq)]
pub enum Keyframes {
    /// Translations, in units of the parent.
    Translation(Vec<Vec3>),
    /// Rotations. Values may have any finite length except zero; tangents may have any finite length.
    Rotation(Vec<Quat>),
    /// Scales per axis.
    Scale(Vec<Vec3>),
}

/// One property of one joint over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    joint: JointId,
    interpolation: Interpolation,
    times: Vec<f32>,
    values: Keyframes,
}

impl Channel {
    /// Makes a channel from key frames. `times` are in seconds, at least one, and do not decrease. There is one
    /// value per time, or three per time for [`Interpolation::CubicSpline`].
    ///
    /// # Errors
    /// [`RigError::KeyframeCount`] if there are no times, or the number of values does not fit;
    /// [`RigError::NotFinite`] if a number is not finite, or a rotation value has length zero;
    /// [`RigError::TimesNotSorted`] if the times decrease.
    pub fn new(
        joint: JointId,
        interpolation: Interpolation,
        times: Vec<f32>,
        values: Keyframes,
    ) -> Result<Self, RigError> {
        let per_time = match interpolation {
            Interpolation::CubicSpline => 3,
            Interpolation::Step | Interpolation::Linear => 1,
        };
        let (found, finite) = match &values {
            Keyframes::Translation(v) | Keyframes::Scale(v) => {
                (v.len(), v.iter().all(|x| x.is_finite()))
            }
            Keyframes::Rotation(v) => {
                let is_value = |k: usize| per_time == 1 || k % 3 == 1;
                let usable = |(k, q): (usize, &Quat)| {
                    let length = rotation_f64(*q).length_squared();
                    length.is_finite() && (length > 0.0 || !is_value(k))
                };
                (v.len(), v.iter().enumerate().all(usable))
            }
        };
        // Saturating: three times a huge count must not wrap around to the count found.
        let expected = times.len().saturating_mul(per_time);
        if times.is_empty() || found != expected {
            return Err(RigError::KeyframeCount {
                times: times.len(),
                expected,
                found,
            });
        }
        if !finite || times.iter().any(|t| !t.is_finite()) {
            return Err(RigError::NotFinite {
                what: format!("a key frame of joint {joint}"),
            });
        }
        if let Some(index) = (1..times.len()).find(|&k| times[k] < times[k - 1]) {
            return Err(RigError::TimesNotSorted { index });
        }
        Ok(Self {
            joint,
            interpolation,
            times,
            values,
        })
    }

    /// The joint that the channel moves.
    pub fn joint(&self) -> JointId {
        self.joint
    }

    /// How the channel interpolates between key frames.
    pub fn interpolation(&self) -> Interpolation {
        self.interpolation
    }

    /// The times of the key frames in seconds, not decreasing.
    pub fn times(&self) -> &[f32] {
        &self.times
    }

    /// The values: one per time, or three per time for [`Interpolation::CubicSpline`].
    pub fn values(&self) -> &Keyframes {
        &self.values
    }

    /// The times of the first and the last key frame, in seconds.
    pub fn span(&self) -> (f32, f32) {
        (self.times[0], self.times[self.times.len() - 1])
    }

    /// Writes the value at `time` (clamped to the channel's own key frames) into its joint's transform.
    fn sample_into(&self, time: f64, transform: &mut Transform) {
        let at = self.locate(time);
        match &self.values {
            Keyframes::Translation(values) => {
                transform.translation = round_to_f32(self.vector(values, at));
            }
            Keyframes::Scale(values) => {
                transform.scale = round_to_f32(self.vector(values, at));
            }
            Keyframes::Rotation(values) => {
                transform.rotation = rotation_f32(self.rotation(values, at));
            }
        }
    }

    /// The key frame at or before `time`, and where in the interval after that key frame the time is.
    fn locate(&self, time: f64) -> Moment {
        let after = self.times.partition_point(|t| f64::from(*t) <= time);
        let last = self.times.len() - 1;
        if after == 0 || after > last {
            return Moment {
                key: after.min(last),
                part: 0.0,
                interval: 0.0,
            };
        }
        let (start, end) = (
            f64::from(self.times[after - 1]),
            f64::from(self.times[after]),
        );
        // end > time >= start: the interval is never empty.
        Moment {
            key: after - 1,
            part: (time - start) / (end - start),
            interval: end - start,
        }
    }

    fn vector(&self, values: &[Vec3], at: Moment) -> DVec3 {
        let next = |key: usize| key + usize::from(at.interval > 0.0);
        match self.interpolation {
            Interpolation::Step => widen(values[at.key]),
            Interpolation::Linear => lerp(values[at.key], values[next(at.key)], at.part),
            Interpolation::CubicSpline => {
                let [v0, b0, a1, v1] = hermite_indices(at.key, next(at.key));
                let [w0, wb, wa, w1] = at.hermite_weights();
                widen(values[v0]) * w0
                    + widen(values[b0]) * wb
                    + widen(values[v1]) * w1
                    + widen(values[a1]) * wa
            }
        }
    }

    fn rotation(&self, values: &[Quat], at: Moment) -> DQuat {
        let next = |key: usize| key + usize::from(at.interval > 0.0);
        let value = |index: usize| rotation_f64(values[index]);
        let unit = |index: usize| unit_rotation(values[index]);
        match self.interpolation {
            Interpolation::Step => unit(at.key),
            Interpolation::Linear => slerp(unit(at.key), unit(next(at.key)), at.part),
            Interpolation::CubicSpline => {
                let [v0, b0, a1, v1] = hermite_indices(at.key, next(at.key));
                let [w0, wb, wa, w1] = at.hermite_weights();
                let sum = value(v0) * w0 + value(b0) * wb + value(v1) * w1 + value(a1) * wa;
                // Opposite values can cancel in the middle; then the nearer one is used.
                if sum.length_squared() > 1e-24 {
                    sum.normalize()
                } else {
                    unit(if at.part < 0.5 { v0 } else { v1 })
                }
            }
        }
    }
}

/// A time between two key frames.
#[derive(Clone, Copy)]
struct Moment {
    key: usize,
    /// Share of the interval that has passed: 0 at the key frame, 1 at the next one.
    part: f64,
    /// Seconds between the two key frames; 0 at the channel's ends and beyond them.
    interval: f64,
}

impl Moment {
    /// Weights of value, out-tangent, next in-tangent and next value.
    fn hermite_weights(self) -> [f64; 4] {
        let t = self.part;
        let (t2, t3) = (t * t, t * t * t);
        [
            2.0 * t3 - 3.0 * t2 + 1.0,
            self.interval * (t3 - 2.0 * t2 + t),
            self.interval * (t3 - t2),
            -2.0 * t3 + 3.0 * t2,
        ]
    }
}

/// The indices of value, out-tangent, next in-tangent and next value.
fn hermite_indices(key: usize, next: usize) -> [usize; 4] {
    [3 * key + 1, 3 * key + 2, 3 * next, 3 * next + 1]
}

/// How a clip continues outside its duration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Playback {
    /// Repeats from the first key frame, at negative times too.
    Loop,
    /// Holds the first and the last key frame.
    Clamp,
}

/// A named animation: channels that together move some joints of a skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// Name of the clip, as its file or the caller gives it.
    pub name: String,
    channels: Vec<Channel>,
    markers: Vec<Marker>,
    ground_speed: Option<f64>,
    start: f64,
    end: f64,
}

impl Clip {
    /// A clip that lasts from the first to the last key frame of all its channels. A clip without channels has
    /// duration 0 and moves nothing.
    pub fn new(name: impl Into<String>, channels: Vec<Channel>) -> Self {
        let (mut start, mut end) = (f64::INFINITY, f64::NEG_INFINITY);
        for channel in &channels {
            let (first, last) = channel.span();
            start = start.min(f64::from(first));
            end = end.max(f64::from(last));
        }
        if channels.is_empty() {
            (start, end) = (0.0, 0.0);
        }
        Self {
            name: name.into(),
            channels,
            markers: Vec::new(),
            ground_speed: None,
            start,
            end,
        }
    }

    /// The same clip with markers in place of those that it has. They are sorted by time; those of the same time keep
    /// their order.
    ///
    /// # Errors
    /// [`RigError::MarkerOutOfRange`] if a marker's time is not from 0 to the clip's duration.
    pub fn with_markers(mut self, mut markers: Vec<Marker>) -> Result<Self, RigError> {
        let duration = self.duration();
        let is_out = |marker: &&Marker| !(0.0..=duration).contains(&marker.time);
        if let Some(Marker { name, time }) = markers.iter().find(is_out).cloned() {
            return Err(RigError::MarkerOutOfRange {
                name,
                time,
                duration,
            });
        }
        markers.sort_by(|a, b| a.time.total_cmp(&b.time));
        self.markers = markers;
        Ok(self)
    }

    /// The same clip with another [ground speed](Self::ground_speed); `None` if it has none.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] if the speed is not finite.
    pub fn with_ground_speed(mut self, speed: Option<f64>) -> Result<Self, RigError> {
        if speed.is_some_and(|speed| !speed.is_finite()) {
            return Err(RigError::NotFinite {
                what: format!("the ground speed of clip {}", self.name),
            });
        }
        self.ground_speed = speed;
        Ok(self)
    }

    /// Named moments, by ascending time.
    pub fn markers(&self) -> &[Marker] {
        &self.markers
    }

    /// The speed over ground for which the clip was made, in the units of the model a second, so that feet on the
    /// ground do not slide. `None` if the clip does not say.
    pub fn ground_speed(&self) -> Option<f64> {
        self.ground_speed
    }

    /// The channels, in the order in which the clip was given them.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Seconds from the first to the last key frame; 0 for a clip with a single key frame or no channels.
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }

    /// The pose at `time` seconds after the clip's first key frame. Joints and properties that no
    /// channel moves stay as they are in `rest`.
    ///
    /// # Errors
    /// As [`Clip::sample_into`].
    pub fn sample(&self, rest: &Pose, time: f64, playback: Playback) -> Result<Pose, RigError> {
        let mut pose = rest.clone();
        self.sample_into(time, playback, &mut pose)?;
        Ok(pose)
    }

    /// [`Clip::sample`] into an existing pose: writes only the properties that a channel moves. Allocates nothing.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] if `time` is not finite, [`RigError::JointOutOfRange`] if the pose has too few
    /// joints. The pose is unchanged then.
    pub fn sample_into(
        &self,
        time: f64,
        playback: Playback,
        pose: &mut Pose,
    ) -> Result<(), RigError> {
        self.check_time(time)?;
        let joints = pose.transforms.len();
        if let Some(bad) = self.channels.iter().find(|c| c.joint.0 as usize >= joints) {
            return Err(RigError::JointOutOfRange {
                joint: bad.joint,
                joints,
            });
        }
        let time = self.start + self.within(time, playback);
        for channel in &self.channels {
            channel.sample_into(time, &mut pose.transforms[channel.joint.index()]);
        }
        Ok(())
    }

    /// The transform of one joint at `time`, relative to its parent, as [`Clip::sample`] has it in its pose. `rest` is
    /// kept where no channel moves the joint.
    ///
    /// # Errors
    /// [`RigError::NotFinite`] if `time` is not finite.
    pub fn sample_joint(
        &self,
        joint: JointId,
        rest: Transform,
        time: f64,
        playback: Playback,
    ) -> Result<Transform, RigError> {
        self.check_time(time)?;
        let time = self.start + self.within(time, playback);
        let mut transform = rest;
        for channel in self.channels.iter().filter(|c| c.joint == joint) {
            channel.sample_into(time, &mut transform);
        }
        Ok(transform)
    }

    fn check_time(&self, time: f64) -> Result<(), RigError> {
        if time.is_finite() {
            return Ok(());
        }
        Err(RigError::NotFinite {
            what: format!("time {time} in clip {}", self.name),
        })
    }

    /// A time within the clip, 0 to its duration.
    fn within(&self, time: f64, playback: Playback) -> f64 {
        let duration = self.duration();
        match playback {
            Playback::Loop if duration > 0.0 => time.rem_euclid(duration),
            Playback::Loop => 0.0,
            Playback::Clamp => time.clamp(0.0, duration),
        }
    }
}

#[cfg(test)]
mod tests;
