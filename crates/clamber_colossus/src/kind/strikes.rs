use clamber_animation::ik::Chain;
use clamber_animation::joint_in_model;
use clamber_animation::rig::{JointId, Playback};
use glam::DVec3;

use super::{JointBall, Leg, Names};
use crate::brain::{Attack, BrainProblem};

/// An attack of a kind of creature.
#[derive(Clone, Debug)]
pub(crate) struct Strike {
    /// Joints whose skin hurts.
    pub(crate) limb: Vec<JointId>,
    /// Seconds of the clip: from here on it hurts, and until here.
    pub(crate) active: [f64; 2],
    /// What it does to people, and where it aims.
    pub(crate) attack: Attack,
    /// Seconds of the clip when its wave goes out.
    pub(crate) impact: f64,
    /// Where the limb's last joint is when it stops to hurt, in model space.
    pub(crate) spot: DVec3,
    /// The leg that strikes, if one does: its index.
    pub(crate) leg: Option<usize>,
    /// The neck or arm that brings its limb to whom it strikes, if it aims with something else than a leg.
    pub(crate) chain: Option<Chain>,
    /// From its hip to where its ankle comes down, in model space, as the hip moves on while the foot stands there; from
    /// the first joint of a neck to where its end strikes.
    reaches: Vec<DVec3>,
    /// Length of that leg, or neck, that is used.
    length: f64,
    /// Balls in the skin of all joints.
    pub(crate) swept: Vec<Swept>,
}

/// A ball in the skin of a joint, on its way in a clip.
#[derive(Clone, Debug)]
pub(crate) struct Swept {
    pub(crate) radius: f64,
    /// True if it goes to where the attack aims.
    pub(crate) aims: bool,
    /// Its middle in model space, at times that are evenly spread until the limb stops to hurt.
    pub(crate) way: Vec<DVec3>,
}

/// Times at which a body is looked at on its way.
const SWEPT: u32 = 16;

/// A leg that strikes is stretched to this share of its length at most.
const STRETCH: f64 = 0.97;

/// The hip is looked at so often in a second; the foot has left its place when its ankle is further from it than this
/// share of the leg's length.
const LOOKS: f64 = 20.0;
const LEFT: f64 = 0.03;

/// A neck or an arm is so many bones at most: more would bend the body.
const BONES: usize = 3;

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
        let mut reaches = Vec::new();
        let mut length = leg.map_or(0.0, |leg| legs[leg].length);
        let chain = chain_to(names, end, legs).filter(|_| leg.is_none() && attack.aim > 0.0);
        if let Some(chain) = &chain {
            let place = |joint: &JointId| {
                joint_in_model(names.skeleton, &pose, *joint)
                    .map_or(DVec3::ZERO, |frame| frame.translation)
            };
            let places: Vec<DVec3> = chain.joints().iter().map(place).collect();
            length = places
                .windows(2)
                .map(|bone| bone[0].distance(bone[1]))
                .sum();
            reaches.push(spot - places[0]);
        }
        if let Some(leg) = leg.map(|leg| &legs[leg]) {
            let at = |time: f64| {
                let pose = clip
                    .sample(names.clips.rest(), time, Playback::Clamp)
                    .ok()?;
                let place = |joint| Some(joint_in_model(names.skeleton, &pose, joint)?.translation);
                Some([place(leg.hip)?, place(leg.ankle)?])
            };
            // It stands since shortly before it stops to hurt.
            let step = |steps: f64, way: f64| {
                let steps = (steps * LOOKS).max(0.0) as u32;
                (0..=steps).map(move |step| to + way * f64::from(step) / LOOKS)
            };
            let down = at(to).map(|[_, ankle]| ankle);
            let stands = |[hip, ankle]: [DVec3; 2]| {
                let down = down.filter(|down| ankle.distance(*down) <= LEFT * length)?;
                Some(down - hip)
            };
            let before = step(to - from, -1.0).map_while(|time| stands(at(time)?));
            let after = step(clip.duration() - to, 1.0).map_while(|time| stands(at(time)?));
            reaches.extend(before.chain(after));
        }
        let goes = leg.is_some() || chain.is_some();
        let aims = |ball: &JointBall| goes && limb.contains(&ball.joint);
        let new = |ball: &JointBall| Swept {
            radius: ball.radius,
            aims: aims(ball),
            way: Vec::new(),
        };
        let mut swept: Vec<Swept> = balls.iter().map(new).collect();
        for phase in 0..=SWEPT {
            let time = to * f64::from(phase) / f64::from(SWEPT);
            let pose = clip.sample(names.clips.rest(), time, Playback::Clamp);
            let pose = pose.map_err(|_| phases())?;
            for (ball, swept) in balls.iter().zip(&mut swept) {
                let frame = joint_in_model(names.skeleton, &pose, ball.joint);
                let place = frame.map(|frame| frame.transform_point3(ball.middle));
                swept.way.extend(place);
            }
        }
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

    /// How much of a way the spot can be moved along it, as a share: a leg or a neck does not reach everywhere. The way is
    /// in model space.
    pub(crate) fn reach(&self, way: DVec3) -> f64 {
        let length = STRETCH * self.length;
        let share = |from: &DVec3| {
            // Where |from + share * way| is the leg's length.
            let (a, b) = (way.length_squared(), from.dot(way));
            let c = from.length_squared() - length * length;
            let root = (b * b - a * c).max(0.0).sqrt();
            if a > 0.0 { (root - b) / a } else { 1.0 }
        };
        let shares = self.reaches.iter().map(share);
        shares.fold(1.0, f64::min).max(0.0)
    }

    /// The joint at its limb's end.
    pub(crate) fn end(&self) -> Option<JointId> {
        self.limb.last().copied()
    }

    /// True for skin of a joint that hurts.
    pub(crate) fn hurts(&self, joint: JointId) -> bool {
        self.limb.contains(&joint)
    }
}

/// The neck or arm above the end of a limb: joints that no leg hangs from.
fn chain_to(names: &Names<'_>, end: JointId, legs: &[Leg]) -> Option<Chain> {
    let skeleton = names.skeleton;
    let parent = |joint: &JointId| skeleton.joints()[joint.index()].parent;
    let is_free = |joint: &JointId| {
        let holds = |leg: &Leg| skeleton.is_descendant_or_self(leg.hip, *joint);
        parent(joint).is_some() && !legs.iter().any(holds)
    };
    let above = core::iter::successors(Some(end), parent);
    let first = above.take_while(is_free).take(BONES + 1).last()?;
    Chain::new(skeleton, first, end).ok()
}
