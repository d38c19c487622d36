use clamber_animation::ik::Chain;
use clamber_animation::joint_in_model;
use clamber_animation::rig::{Clip, JointId, Playback, Pose};
use glam::DVec3;

use super::{JointBall, Leg, Names};
use crate::brain::{Attack, BrainProblem};

/// The strike of an attack of a kind of creature.
#[derive(Clone, Debug)]
pub(crate) struct Strike {
    /// Joints whose skin hurts.
    pub(crate) limb: Vec<JointId>,
    /// Begin and end of the time in which the limb hurts: the markers `active` and `recovery`, seconds of the clip.
    pub(crate) active: [f64; 2],
    /// The attack in the brain's file.
    pub(crate) attack: Attack,
    /// Time at which its wave goes out: the marker `impact` or else `recovery`, seconds of the clip.
    pub(crate) impact: f64,
    /// Place of the limb's last joint at `recovery`, in model space.
    pub(crate) spot: DVec3,
    /// Index of the leg that strikes; `None` if the limb is no leg.
    pub(crate) leg: Option<usize>,
    /// The neck or arm that moves the limb's end to the prey; `None` if a leg strikes, or if the attack does not aim.
    pub(crate) chain: Option<Chain>,
    /// Vectors that the leg or the chain has to span, in model space. For a leg they lead from the hip to the place
    /// where the ankle comes down, at several times, since the hip moves on while the foot stands. For a chain, one
    /// vector leads from its first joint to `spot`.
    reaches: Vec<DVec3>,
    /// Length of the leg or the chain.
    length: f64,
    /// Balls around the skin of all joints; empty if the strike is only the goal of a walk.
    pub(crate) swept: Vec<Swept>,
}

/// The path of a ball around a joint's skin in a clip.
#[derive(Clone, Debug)]
pub(crate) struct Swept {
    pub(crate) radius: f64,
    /// True if the ball moves to where the attack aims.
    pub(crate) aims: bool,
    /// Places of its centre in model space, at times that are evenly spread from the clip's beginning to `recovery`.
    pub(crate) way: Vec<DVec3>,
}

/// Number of steps in which the path of a ball is sampled.
const SWEEP_STEPS: u32 = 16;

/// Largest length to which a striking leg, neck or arm is stretched, as a share of its length.
const MAX_STRETCH: f64 = 0.97;

/// Samples of the hip and the ankle of a striking leg a second.
const SAMPLE_RATE: f64 = 20.0;
/// A foot has left its place when its ankle is further from it than this share of the leg's length.
const LEFT_PLACE_DISTANCE: f64 = 0.03;

/// Most bones of a neck or an arm that aims: with more bones the body would bend as well.
const MOST_BONES: usize = 3;

impl Strike {
    pub(crate) fn new(
        names: &Names<'_>,
        attack: &Attack,
        limb: Vec<JointId>,
        legs: &[Leg],
        balls: &[JointBall],
    ) -> Result<Self, BrainProblem> {
        let id = names.clip(&attack.clip)?;
        let phases = || BrainProblem::Phases {
            clip: attack.clip.clone(),
        };
        let clip = names.clips.clip(id).map_err(|_| phases())?;
        let marker = |name: &str| {
            clip.markers()
                .iter()
                .find(|marker| marker.name == name)
                .map(|marker| marker.time)
        };
        let (Some(from), Some(to)) = (marker("active"), marker("recovery")) else {
            return Err(phases());
        };
        if from >= to || limb.is_empty() {
            return Err(phases());
        }
        let end = limb[limb.len() - 1];
        let pose = clip
            .sample(names.clips.rest(), to, Playback::Clamp)
            .map_err(|_| phases())?;
        let spot = joint_in_model(names.skeleton, &pose, end)
            .map_or(DVec3::ZERO, |frame| frame.translation);
        let leg = legs.iter().position(|leg| limb.contains(&leg.ankle));
        let timed = Timed { names, clip, to };
        let chain = chain_to(names, end, legs).filter(|_| leg.is_none() && attack.aim > 0.0);
        let (reaches, length) = match (leg.map(|leg| &legs[leg]), &chain) {
            (Some(leg), _) => (timed.reaches_of_leg(leg, from), leg.length),
            (None, Some(chain)) => timed.reach_of_chain(chain, &pose, spot),
            (None, None) => (Vec::new(), 0.0),
        };
        let goes = leg.is_some() || chain.is_some();
        let aims = |ball: &JointBall| goes && limb.contains(&ball.joint);
        let swept = timed.swept(balls, aims).ok_or_else(phases)?;
        Ok(Self {
            swept,
            reaches,
            length,
            limb,
            active: [from, to],
            impact: marker("impact").unwrap_or(to),
            attack: attack.clone(),
            spot,
            leg,
            chain,
        })
    }

    /// The share of a displacement of the spot, in model space, that the leg or the chain can reach: from 0 to 1.
    pub(crate) fn reach(&self, way: DVec3) -> f64 {
        let length = MAX_STRETCH * self.length;
        let share = |from: &DVec3| {
            // The share at which |from + share * way| is the leg's length.
            let (a, b) = (way.length_squared(), from.dot(way));
            let c = from.length_squared() - length * length;
            let root = (b * b - a * c).max(0.0).sqrt();
            if a > 0.0 { (root - b) / a } else { 1.0 }
        };
        let shares = self.reaches.iter().map(share);
        shares.fold(1.0, f64::min).max(0.0)
    }

    /// The joint at the end of the limb.
    pub(crate) fn end(&self) -> Option<JointId> {
        self.limb.last().copied()
    }

    /// True if skin of this joint hurts.
    pub(crate) fn hurts(&self, joint: JointId) -> bool {
        self.limb.contains(&joint)
    }
}

/// A clip with the time at which its strike is over.
struct Timed<'a> {
    names: &'a Names<'a>,
    clip: &'a Clip,
    /// Time of the marker `recovery`, seconds.
    to: f64,
}

impl Timed<'_> {
    /// The vector that a chain has to span, and the chain's length. `pose` is the clip's pose at `to`.
    fn reach_of_chain(&self, chain: &Chain, pose: &Pose, spot: DVec3) -> (Vec<DVec3>, f64) {
        let place = |joint: &JointId| {
            joint_in_model(self.names.skeleton, pose, *joint)
                .map_or(DVec3::ZERO, |frame| frame.translation)
        };
        let places: Vec<DVec3> = chain.joints().iter().map(place).collect();
        let length = places
            .windows(2)
            .map(|bone| bone[0].distance(bone[1]))
            .sum();
        (vec![spot - places[0]], length)
    }

    /// The vectors that a leg has to span, from the hip to the place where the ankle comes down. The foot stands from
    /// some time before `to`, but not before `from`, until some time after it.
    fn reaches_of_leg(&self, leg: &Leg, from: f64) -> Vec<DVec3> {
        let Self { names, clip, to } = *self;
        let at = |time: f64| {
            let pose = clip
                .sample(names.clips.rest(), time, Playback::Clamp)
                .ok()?;
            let place = |joint| Some(joint_in_model(names.skeleton, &pose, joint)?.translation);
            Some([place(leg.hip)?, place(leg.ankle)?])
        };
        let step = |steps: f64, way: f64| {
            let steps = (steps * SAMPLE_RATE).max(0.0) as u32;
            (0..=steps).map(move |step| to + way * f64::from(step) / SAMPLE_RATE)
        };
        let down = at(to).map(|[_, ankle]| ankle);
        let stands = |[hip, ankle]: [DVec3; 2]| {
            let down =
                down.filter(|down| ankle.distance(*down) <= LEFT_PLACE_DISTANCE * leg.length)?;
            Some(down - hip)
        };
        let before = step(to - from, -1.0).map_while(|time| stands(at(time)?));
        let after = step(clip.duration() - to, 1.0).map_while(|time| stands(at(time)?));
        before.chain(after).collect()
    }

    /// The paths of balls from the clip's beginning to `to`; `None` if the clip cannot be sampled.
    fn swept(&self, balls: &[JointBall], aims: impl Fn(&JointBall) -> bool) -> Option<Vec<Swept>> {
        let new = |ball: &JointBall| Swept {
            radius: ball.radius,
            aims: aims(ball),
            way: Vec::new(),
        };
        let mut swept: Vec<Swept> = balls.iter().map(new).collect();
        for phase in 0..=SWEEP_STEPS {
            let time = self.to * f64::from(phase) / f64::from(SWEEP_STEPS);
            let rest = self.names.clips.rest();
            let pose = self.clip.sample(rest, time, Playback::Clamp).ok()?;
            for (ball, swept) in balls.iter().zip(&mut swept) {
                let frame = joint_in_model(self.names.skeleton, &pose, ball.joint);
                let place = frame.map(|frame| frame.transform_point3(ball.middle));
                swept.way.extend(place);
            }
        }
        Some(swept)
    }
}

/// The neck or arm above the end of a limb: at most [`MOST_BONES`] bones, from joints that no leg hangs from.
fn chain_to(names: &Names<'_>, end: JointId, legs: &[Leg]) -> Option<Chain> {
    let skeleton = names.skeleton;
    let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
    let is_free = |joint: &JointId| {
        let holds = |leg: &Leg| skeleton.is_descendant_or_self(leg.hip, *joint);
        parent(joint).is_some() && !legs.iter().any(holds)
    };
    let above = core::iter::successors(Some(end), parent);
    let first = above.take_while(is_free).take(MOST_BONES + 1).last()?;
    Chain::new(skeleton, first, end).ok()
}
