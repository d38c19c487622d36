use clamber_animation::joint_in_model;
use clamber_animation::rig::{Clip, JointId, Playback, Pose};
use clamber_surface::mesh::ColliderMesh;
use glam::{DAffine3, DQuat, DVec3};

use super::file::LegFile;
use super::limb::Limb;
use super::sole::SoleShape;
use super::{Names, RestSkin};
use crate::brain::whole;
use crate::error::ColossusError;

/// Height above its lowest point in a clip up to which a foot may stand, as a share of the leg's length.
const STANDS_BELOW: f64 = 0.012;
/// Largest speed of a standing foot's ball against the ground, as a share of `sqrt(g * leg)`: 0.6 m/s on a human's leg,
/// as in Unreal's foot placement. By Froude's law the share is the same at any size.
const STANDS_SLOWER: f64 = 0.2;

/// A foot's joint that is higher above the lowest skin than this share of the leg's length is not the ball of the foot.
const HIGH_BALL_JOINT: f64 = 0.2;

/// Samples a second in which a clip is searched for contacts.
const CONTACT_SAMPLE_RATE: f64 = 60.0;

/// Most samples of a clip, an hour at [`CONTACT_SAMPLE_RATE`]: a file may claim that a clip lasts for years.
const MOST_SAMPLES: f64 = 216_000.0;

/// A leg of a kind of creature, in the model's units.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pub(crate) limb: Limb,
    pub(crate) hip: JointId,
    pub(crate) ankle: JointId,
    /// The joint of the ball of the foot, toe or ankle, and the ball's place in the joint's space. The ball is at the
    /// joint's origin, unless the joint is far above the ground, as in a leg that ends in its last bone.
    pub(crate) ball: JointId,
    ball_at: DVec3,
    /// Place of the ball at rest, in model space.
    pub(crate) stands_at: DVec3,
    /// Length of both bones together, at rest.
    pub(crate) length: f64,
    /// Rotation of the ankle at rest, in model space, when the sole is level; and the vector from the ball to the
    /// ankle, in the ankle's space.
    pub(crate) level: DQuat,
    pub(crate) from_ball: DVec3,
    pub(crate) sole: SoleShape,
}

/// Spans of time in which a foot stands in a clip, seconds, in ascending order. In a loop the last span may end after
/// the clip's end, in the next round.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Contacts {
    spans: Vec<[f64; 2]>,
    /// Places of the ball, in model space, at times that are evenly spread from the clip's beginning to its end.
    balls: Vec<DVec3>,
    duration: f64,
    loops: bool,
}

impl Leg {
    pub(crate) fn new(
        names: &Names<'_>,
        mesh: &ColliderMesh,
        skin: &RestSkin,
        file: &LegFile,
    ) -> Result<Self, ColossusError> {
        let toe = file.toe.as_ref().map(|name| names.joint(name));
        let toe = toe.transpose().map_err(whole)?;
        let limb = Limb::new(names, file, toe)?;
        let ankle = limb.foot;
        let ball = toe.unwrap_or(ankle);
        let skeleton = names.skeleton;
        let rest = skeleton.rest_pose();
        let place = |joint| {
            joint_in_model(skeleton, &rest, joint).map_or(DVec3::ZERO, |frame| frame.translation)
        };
        let mut at = place(ball);
        let length = limb.length([limb.hip, limb.knee, ankle].map(place));
        let level = joint_in_model(skeleton, &rest, ankle)
            .map_or(DQuat::IDENTITY, |frame| rotation_of(&frame));
        let sole = |at| SoleShape::new((skeleton, mesh, skin), ankle, at, length);
        let mut found = sole(at);
        let mut ball_at = DVec3::ZERO;
        if let Some(high) = found
            .as_ref()
            .filter(|sole| sole.ball_height > HIGH_BALL_JOINT * length)
        {
            at += high.middle();
            let frame = joint_in_model(skeleton, &rest, ball).unwrap_or_default();
            ball_at = frame.inverse().transform_point3(at);
            found = sole(at);
        }
        let Some(sole) = found else {
            let name = &skeleton.joints()[ankle.index()].name;
            let fault = format!("no skin moves with its foot `{name}`");
            return Err(names.limb_fault("leg", file.joints.iter(), fault).into());
        };
        Ok(Self {
            hip: limb.hip,
            limb,
            ankle,
            ball,
            ball_at,
            level,
            stands_at: at,
            from_ball: level.conjugate() * (place(ankle) - at),
            length,
            sole,
        })
    }

    /// Place of the ball of the foot in model space, when the ball's joint has this frame in model space.
    pub(crate) fn ball_in(&self, frame: &DAffine3) -> DVec3 {
        frame.transform_point3(self.ball_at)
    }

    /// Places of the ball of the foot, in model space, at times that are evenly spread from the beginning of a clip to
    /// its end, and the time between two of them.
    fn balls(
        &self,
        names: &Names<'_>,
        clip: &Clip,
        playback: Playback,
    ) -> Result<(Vec<DVec3>, f64), ColossusError> {
        let duration = clip.duration();
        let count = (duration * CONTACT_SAMPLE_RATE)
            .round()
            .clamp(1.0, MOST_SAMPLES) as usize;
        let mut pose = Pose::default();
        let mut at = |time: f64| -> Result<DVec3, ColossusError> {
            pose.transforms.clone_from(&names.clips.rest().transforms);
            clip.sample_into(time, playback, &mut pose)?;
            let frame = joint_in_model(names.skeleton, &pose, self.ball);
            Ok(frame.map_or(DVec3::ZERO, |frame| self.ball_in(&frame)))
        };
        let step = duration / count as f64;
        let places: Result<Vec<DVec3>, ColossusError> =
            (0..=count).map(|sample| at(sample as f64 * step)).collect();
        Ok((places?, step))
    }

    /// Level velocity of the ground below a walk on the spot, the model's units a second: the median velocity of the
    /// ball where it is low enough to stand.
    pub(crate) fn ground(&self, names: &Names<'_>, clip: &Clip) -> Result<DVec3, ColossusError> {
        let (places, step) = self.balls(names, clip, Playback::Loop)?;
        let lowest = places.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let pairs = places.iter().zip(&places[1..]);
        let low = pairs.filter(|(a, b)| 0.5 * (a.y + b.y) < lowest + STANDS_BELOW * self.length);
        let ways: Vec<DVec3> = low.map(|(a, b)| (*b - *a) / step.max(1e-9)).collect();
        let median = |axis: fn(&DVec3) -> f64| {
            let mut all: Vec<f64> = ways.iter().map(axis).collect();
            all.sort_by(f64::total_cmp);
            all.get(all.len() / 2).copied().unwrap_or(0.0)
        };
        Ok(DVec3::new(median(|way| way.x), 0.0, median(|way| way.z)))
    }

    /// When the foot stands in a clip. `speed` is the speed of the ground below the model, along -Z, in the model's
    /// units a second. `turn` is the rate at which the model turns, radians a second.
    pub(crate) fn contacts(
        &self,
        names: &Names<'_>,
        clip: &Clip,
        playback: Playback,
        [speed, turn]: [f64; 2],
    ) -> Result<Contacts, ColossusError> {
        let loops = playback == Playback::Loop;
        let (places, step) = self.balls(names, clip, playback)?;
        let (duration, count) = (clip.duration(), places.len() - 1);
        let lowest = places.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let most = STANDS_SLOWER * (names.gravity * self.length).sqrt();
        let stands = |sample: usize| {
            let (a, b) = (places[sample], places[sample + 1]);
            let way = (b - a) / step.max(1e-9);
            let middle = 0.5 * (a + b);
            // Velocity of the ground below a model that walks along +Z and turns about +Y.
            let ground = DVec3::new(-turn * middle.z, 0.0, turn * middle.x) - DVec3::Z * speed;
            let slip = DVec3::new(way.x - ground.x, 0.0, way.z - ground.z).length();
            middle.y < lowest + STANDS_BELOW * self.length && slip < most
        };
        let mut spans: Vec<[f64; 2]> = Vec::new();
        for sample in 0..count {
            if !stands(sample) {
                continue;
            }
            let (from, to) = (sample as f64 * step, (sample + 1) as f64 * step);
            match spans.last_mut() {
                // Gaps of a few samples are noise, as are spans of a few samples.
                Some(last) if from - last[1] <= 4.5 * step => last[1] = to,
                _ => spans.push([from, to]),
            }
        }
        spans.retain(|[from, to]| to - from > 6.0 * step || duration < 12.0 * step);
        let joins = spans.len() > 1
            && spans[0][0] <= 1.5 * step
            && spans[spans.len() - 1][1] >= duration - 1.5 * step;
        if loops && joins {
            let first = spans.remove(0);
            if let Some(last) = spans.last_mut() {
                last[1] = duration + first[1];
            }
        }
        Ok(Contacts {
            spans,
            balls: places,
            duration,
            loops,
        })
    }
}

/// The rotation of a frame, without its scale.
pub(crate) fn rotation_of(frame: &DAffine3) -> DQuat {
    frame.to_scale_rotation_translation().1
}

impl Contacts {
    /// Seconds for which the foot still stands at a time; `None` if it does not stand.
    pub(crate) fn left(&self, time: f64) -> Option<f64> {
        let times = [time, time + self.duration];
        let times = &times[..if self.loops { 2 } else { 1 }];
        let left = times.iter().flat_map(|time| {
            let spans = self
                .spans
                .iter()
                .filter(|[from, to]| (*from..*to).contains(time));
            spans.map(|[_, to]| *to - *time)
        });
        left.max_by(f64::total_cmp)
    }

    /// Seconds for which the foot still stands at a time: 0 if it does not stand, infinite if it is not lifted before
    /// the end of a clip that is played once, since the last pose is held.
    pub(crate) fn stands_for(&self, time: f64) -> f64 {
        let is_held = !self.loops && !self.lifts_after(time);
        let left = self.left(time).unwrap_or(0.0);
        if is_held && self.stands(time) {
            f64::INFINITY
        } else {
            left
        }
    }

    /// True if the foot stands at a time, and is lifted before the clip ends.
    pub(crate) fn lifts_after(&self, time: f64) -> bool {
        let end = self.duration - 2.0 / CONTACT_SAMPLE_RATE;
        self.left(time).is_some_and(|left| time + left < end)
    }

    /// True if the foot stands at a time.
    pub(crate) fn stands(&self, time: f64) -> bool {
        let inside = |time: f64| {
            self.spans
                .iter()
                .any(|[from, to]| (*from..*to).contains(&time))
        };
        if !self.loops {
            return inside(time.clamp(0.0, (self.duration - 1e-9).max(0.0)));
        }
        inside(time) || inside(time + self.duration)
    }

    /// Seconds from a time until the foot stands next, and the place of its ball then, in model space; `None` if it
    /// does not stand again.
    pub(crate) fn next(&self, time: f64) -> Option<(f64, DVec3)> {
        let ahead = |from: f64| {
            let wait = from - time;
            if self.loops && self.duration > 0.0 {
                wait.rem_euclid(self.duration)
            } else {
                wait
            }
        };
        let waits = self.spans.iter().map(|[from, _]| ahead(*from));
        waits
            .zip(&self.spans)
            .filter(|(wait, _)| *wait >= 0.0)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(wait, [from, _])| (wait, self.ball(*from)))
    }

    /// Place of the ball at a time of the clip, in model space, to the nearest sample.
    pub(crate) fn ball(&self, time: f64) -> DVec3 {
        let last = self.balls.len().saturating_sub(1);
        let index = (time / self.duration.max(1e-9) * last as f64).round() as usize;
        self.balls.get(index.min(last)).copied().unwrap_or_default()
    }

    /// Length of the clip, seconds.
    pub(crate) fn duration(&self) -> f64 {
        self.duration
    }
}
