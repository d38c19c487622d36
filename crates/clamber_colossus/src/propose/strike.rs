//! Finds the limb that strikes in a clip, and the time in which it strikes.

use clamber_animation::rig::{Clip, JointId, Playback};
use glam::DVec3;

use super::clips::words;
use super::look::{Look, place, rounded};
use crate::error::ColossusError;

/// Samples of a clip a second.
const SAMPLE_RATE: f64 = 60.0;

/// A limb hurts while it is faster than this share of its speed at the strike.
const FAST_SHARE: f64 = 0.4;
/// Shortest time in which a limb hurts, seconds.
const SHORTEST_STRIKE: f64 = 0.15;

/// Limbs that reach this share of the largest speed count as equally fast.
const EQUALLY_FAST_SHARE: f64 = 0.9;

/// Most joints below the striking joint that hurt as well.
const MOST_JOINTS_BELOW: usize = 3;

/// A limb that strikes in a clip.
pub(super) struct Struck {
    /// Joints whose skin hurts. The last one is the limb's end.
    pub(super) limb: Vec<String>,
    /// Begin and end of the time in which it hurts, seconds of the clip.
    pub(super) active: [f64; 2],
}

/// Heights of a limb above the creature's lowest skin at rest, in heights of the creature.
pub(super) struct Above {
    /// Lowest skin of the limb while it hurts.
    pub(super) lowest: f64,
    /// The limb's end when it stops hurting.
    pub(super) end: f64,
}

/// Words in the names of clips in which a leg strikes.
const LEG_STRIKE_WORDS: [&str; 2] = ["kick", "stomp"];
/// Words in the names of clips in which the head strikes.
const HEAD_STRIKE_WORDS: [&str; 2] = ["bite", "headbutt"];

/// A leg is the striking limb only if it is this many times as fast as all other joints, since most legs only step
/// during an attack. Clips with a word of [`LEG_STRIKE_WORDS`] are exempt.
const LEG_SPEED_RATIO: f64 = 2.0;

/// Which limb of a clip may strike, and how its joints move.
struct Search<'a> {
    look: &'a Look<'a>,
    /// Joints of legs.
    legs: &'a [&'a String],
    /// True for a clip in which a leg strikes.
    kicks: bool,
    /// The head, for a clip in which the head strikes.
    head: Option<JointId>,
    /// Named joints with the middle of their skin at rest.
    middles: Vec<(JointId, DVec3)>,
    /// For each of them, the places of this middle in the clip, at intervals of `step`.
    ways: Vec<Vec<DVec3>>,
    /// Seconds between two places.
    step: f64,
    /// Time of the marker `recovery`, seconds.
    until: f64,
    /// Middle of the creature from back to front.
    depth: f64,
}

/// The limb in the front half of the creature that moves ahead fastest in a clip, before the clip's marker `recovery`
/// if it has one; `None` if no limb moves ahead. `legs` are the joints of legs.
pub(super) fn find(
    look: &Look<'_>,
    clip: &Clip,
    legs: &[&String],
) -> Result<Option<Struck>, ColossusError> {
    let search = Search::new(look, clip, legs)?;
    let Some((index, at)) = search.foremost() else {
        return Ok(None);
    };
    let end = search.middles[index].0;
    let active = search.active(&search.ways[index], at, clip.duration());
    let is_below = |joint: &JointId| look.upward(*joint).skip(1).any(|above| above == end);
    let moves = |joint: &JointId| !look.skin(*joint).is_empty() && look.is_named(*joint);
    let below = look
        .joints()
        .filter(|joint| is_below(joint) && moves(joint));
    let limb = below.take(MOST_JOINTS_BELOW).chain([end]);
    Ok((active[0] < active[1]).then(|| Struck {
        limb: limb.map(|joint| look.name(joint).to_owned()).collect(),
        active,
    }))
}

impl<'a> Search<'a> {
    fn new(look: &'a Look<'a>, clip: &Clip, legs: &'a [&'a String]) -> Result<Self, ColossusError> {
        let name = words(&clip.name);
        let is_of = |words: &[&str]| name.iter().any(|word| words.contains(&word.as_str()));
        let recovery = clip
            .markers()
            .iter()
            .find(|marker| marker.name == "recovery");
        let middles: Vec<(JointId, DVec3)> = look
            .joints()
            .filter(|joint| look.is_named(*joint))
            .filter_map(|joint| Some((joint, look.middle(joint)? + look.place(joint))))
            .collect();
        let count = (clip.duration() * SAMPLE_RATE).ceil().max(1.0) as usize;
        let step = clip.duration() / count as f64;
        let depths = look
            .joints()
            .flat_map(|joint| look.skin(joint))
            .map(|place| place.z);
        let [back, front] = depths.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], z| {
            [low.min(z), high.max(z)]
        });
        Ok(Self {
            look,
            legs,
            kicks: is_of(&LEG_STRIKE_WORDS) && !legs.is_empty(),
            head: look.head().filter(|_| is_of(&HEAD_STRIKE_WORDS)),
            ways: ways(look, clip, &middles, (count, step))?,
            middles,
            step,
            until: recovery.map_or(f64::INFINITY, |marker| marker.time),
            depth: 0.5 * (back + front),
        })
    }

    /// Weight of a joint's speed.
    fn counts(&self, joint: JointId) -> f64 {
        let (look, kicks) = (self.look, self.kicks);
        let is_leg = |joint: JointId| self.legs.iter().any(|leg| *leg == look.name(joint));
        let is_none = kicks && !is_leg(joint)
            || self
                .head
                .is_some_and(|head| look.upward(joint).all(|above| above != head));
        match is_none {
            true => 0.0,
            false if is_leg(joint) && !kicks => 1.0 / LEG_SPEED_RATIO,
            false => 1.0,
        }
    }

    /// How far a joint moves between a sample of the clip and the next one, if it may strike. The striking limb is in
    /// the front half and moves ahead, unlike a tail that swings. A kick or a stomp may go in any direction.
    fn strikes(&self, index: usize, at: usize) -> f64 {
        let (before, after) = (self.ways[index][at], self.ways[index][at + 1]);
        let goes = if self.kicks {
            after.distance(before)
        } else {
            after.z - before.z
        };
        let is_there = self.kicks || before.z > self.depth;
        if is_there && (at as f64) * self.step < self.until {
            self.counts(self.middles[index].0) * goes
        } else {
            0.0
        }
    }

    /// Index of the striking joint, and the sample at which it strikes. Among equally fast joints, as when the whole
    /// body lunges, the foremost one strikes.
    fn foremost(&self) -> Option<(usize, usize)> {
        let mut fastest = (1e-4 * self.look.height, None);
        for (index, way) in self.ways.iter().enumerate() {
            for at in 0..way.len() - 1 {
                let found = self.strikes(index, at);
                if found > fastest.0 {
                    fastest = (found, Some(at));
                }
            }
        }
        let (fastest, Some(at)) = fastest else {
            return None;
        };
        let ways = &self.ways;
        let alike =
            (0..ways.len()).filter(|index| self.strikes(*index, at) > EQUALLY_FAST_SHARE * fastest);
        let foremost = alike.max_by(|a, b| ways[*a][at].z.total_cmp(&ways[*b][at].z));
        Some((foremost?, at))
    }

    /// Begin and end of the time around a sample in which a joint hurts, seconds of a clip of a duration.
    fn active(&self, way: &[DVec3], at: usize, duration: f64) -> [f64; 2] {
        let speed = |at: usize| way[at].distance(way[at + 1]);
        let least = FAST_SHARE * speed(at);
        let before = (0..at).rev().take_while(|at| speed(*at) > least).count();
        let after = (at + 1..way.len() - 1)
            .take_while(|at| speed(*at) > least)
            .count();
        let active = [at - before, at + 1 + after].map(|sample| sample as f64 * self.step);
        let wider = (0.5 * (SHORTEST_STRIKE - (active[1] - active[0]))).max(0.0);
        let active = [active[0] - wider, active[1] + wider].map(|time| time.clamp(0.0, duration));
        active.map(|time| rounded(time, 1e2).min(duration))
    }
}

/// Places of the middles of joints in `count` steps of a clip, `step` seconds apart.
fn ways(
    look: &Look<'_>,
    clip: &Clip,
    middles: &[(JointId, DVec3)],
    (count, step): (usize, f64),
) -> Result<Vec<Vec<DVec3>>, ColossusError> {
    let rest = look.skeleton.palette(&look.skeleton.rest_pose())?;
    let mut ways: Vec<Vec<DVec3>> = vec![Vec::new(); middles.len()];
    for sample in 0..=count {
        let time = sample as f64 * step;
        let mut pose = look.skeleton.rest_pose();
        clip.sample_into(time, Playback::Clamp, &mut pose)?;
        let posed = look.skeleton.palette(&pose)?;
        for ((joint, middle), way) in middles.iter().zip(&mut ways) {
            let frames = rest
                .model_from_joint(*joint)
                .zip(posed.model_from_joint(*joint));
            let at = frames.map(|(rest, posed)| {
                posed.transform_point3(rest.inverse().transform_point3(*middle))
            });
            way.push(at.unwrap_or_else(|| place(look.skeleton, &pose, *joint)));
        }
    }
    Ok(ways)
}

/// Heights of a limb between two times of a clip.
pub(super) fn above(
    look: &Look<'_>,
    clip: &Clip,
    limb: &[String],
    [from, to]: [f64; 2],
) -> Result<Above, ColossusError> {
    let joints = limb.iter().filter_map(|name| look.skeleton.find(name));
    let limb: Vec<JointId> = joints.collect();
    let rest = look.skeleton.palette(&look.skeleton.rest_pose())?;
    let count = ((to - from) * SAMPLE_RATE).ceil().max(1.0) as usize;
    let (mut lowest, mut end) = (f64::INFINITY, 0.0);
    for sample in 0..=count {
        let time = from + (to - from) * sample as f64 / count as f64;
        let mut pose = look.skeleton.rest_pose();
        clip.sample_into(time, Playback::Clamp, &mut pose)?;
        let posed = look.skeleton.palette(&pose)?;
        if let Some(last) = limb.last() {
            end = place(look.skeleton, &pose, *last).y - look.low;
        }
        for joint in &limb {
            let frames = rest
                .model_from_joint(*joint)
                .zip(posed.model_from_joint(*joint));
            let Some((rest, posed)) = frames else {
                continue;
            };
            let moved = posed * rest.inverse();
            let heights = look.skin(*joint).iter();
            let heights = heights.map(|place| moved.transform_point3(*place).y - look.low);
            lowest = heights.fold(lowest, f64::min);
        }
    }
    Ok(Above {
        lowest: look.in_heights(lowest),
        end: look.in_heights(end),
    })
}
