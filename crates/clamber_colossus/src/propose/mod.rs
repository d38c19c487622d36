//! Proposes a brain file for a creature from elsewhere, from its own file alone. The proposal is a start that its user
//! edits.

mod clips;
mod legs;
mod look;
mod states;
mod strike;

use clamber_animation::SeamProbe;
use clamber_animation::rig::JointId;
use clamber_surface::mesh::{Rig, SurfaceKind};
use glam::DVec3;

use crate::brain::{Brain, BrainFile, StateFile};
use crate::error::ColossusError;
use crate::kind::{
    BodyFile, ClipFile, CreatureKind, Facing, FurFile, GaitFile, HUMAN_HEIGHT, HeadFile, LegFile,
    Times, WeakPointFile,
};
use clips::Clips;
use look::{Look, rounded};

/// Length of a tick, seconds. The proposal does not depend on it.
const TICK: f64 = 1.0 / 60.0;

/// Proposed rate of turning on the spot, degrees a second at the height for which the clips were made.
const PROPOSED_TURN_RATE: f64 = 90.0;
/// Proposed rate of turning while walking, degrees a second at the height for which the clips were made.
const PROPOSED_STEER_RATE: f64 = 40.0;

/// If the measured speed of the feet is below this, in heights a second of the clip, [`PROPOSED_WALK_SPEED`] is
/// proposed.
const SLOWEST_MEASURED_WALK: f64 = 0.1;
/// Proposed speed of a walk if the feet give none, heights a second of the clip.
const PROPOSED_WALK_SPEED: f64 = 0.4;

/// Proposed `aim` of an attack, in heights.
const PROPOSED_AIM: f64 = 0.1;

/// A limb that stays higher than this share of a human's height passes over people, and gets a shock wave.
const HIGH_LIMB_SHARE: f64 = 0.8;

/// Proposed `within` of a walk to the prey before an attack, in heights.
const PROPOSED_WITHIN: f64 = 0.15;
/// If [`PROPOSED_WITHIN`] is more than this in metres, the limb is taken to pass beside people, and gets a shock wave.
const BESIDE_PEOPLE_DISTANCE: f64 = 5.0;

/// Proposed radius of a limb's shock wave beyond the height of the limb's end, in heights.
const PROPOSED_WAVE_RADIUS: f64 = 0.3;

/// Proposed radius of the weak point, in heights.
const PROPOSED_WEAK_RADIUS: f64 = 0.05;
/// Proposed hit points of the weak point: three charged stabs of a sword.
const HIT_POINTS: f64 = 3.0;

impl BrainFile {
    /// Proposes a brain for a creature from elsewhere. With it the creature looks about, wanders, sleeps, notices
    /// people, walks to them, attacks and shakes off riders, as far as its clips go. It dies when its weak point is
    /// used up.
    ///
    /// The creature is `height` metres tall, from 0.001 to 100,000. Clips are told apart by their names, such as `Walk`
    /// and `Attack_Headbutt`. Legs are pairs of chains of joints whose ends move the lowest skin. The limb of an attack
    /// is the one that moves ahead fastest in its clip, and it hurts while it is fast. If it passes over people or
    /// beside them, it sends out a shock wave. All skin is fur unless the file has some fur, and the weak point is on
    /// top of the head. Proposals that do not fit the creature are left out, so that [`CreatureKind::new`] accepts the
    /// brain. The result is a start, to be edited: `clamber inspect --propose-brain` writes it as text.
    ///
    /// # Errors
    /// The errors of [`CreatureKind::new`] for a brain that names nothing of the creature, with this height.
    pub fn propose(rig: &Rig, height: f64) -> Result<Self, ColossusError> {
        let mut proposal = Proposal {
            rig,
            clips: Clips::of(&rig.clips),
            body: BodyFile {
                height: Some(height),
                made_for: Some(HUMAN_HEIGHT),
                ..BodyFile::default()
            },
        };
        // This refuses parts that do not fit each other.
        proposal.kind()?;
        proposal.walk()?;
        proposal.repeat()?;
        let attack = proposal.attack()?;
        proposal.head()?;
        proposal.skin()?;
        let fits = |file: &BrainFile| -> Result<CreatureKind, ColossusError> {
            CreatureKind::new(rig, Brain::new(file.clone(), TICK)?)
        };
        let file = states::file(&proposal, attack.as_ref())?;
        if fits(&file).is_ok() {
            return Ok(file);
        }
        // The attack may not fit: the file's own markers may be in the wrong order. This leaves the attack out.
        let file = states::file(&proposal, None)?;
        fits(&file)?;
        Ok(file)
    }
}

/// A proposal under construction. At any time its body fits the creature.
struct Proposal<'a> {
    rig: &'a Rig,
    clips: Clips,
    body: BodyFile,
}

/// An attack that a creature seems to have.
struct Strikes {
    clip: String,
    limb: Vec<String>,
    /// Radius of its shock wave, in heights, if the limb passes over people on the ground or beside them.
    wave: Option<f64>,
}

impl Proposal<'_> {
    /// Height of the creature, metres.
    fn height(&self) -> f64 {
        self.body.height.unwrap_or(1.0)
    }

    /// The creature with the body that is proposed so far.
    fn kind(&self) -> Result<CreatureKind, ColossusError> {
        self.kind_with(self.body.clone())
    }

    fn kind_with(&self, body: BodyFile) -> Result<CreatureKind, ColossusError> {
        let file = BrainFile {
            body,
            start: "stands".to_owned(),
            states: [("stands".to_owned(), StateFile::default())].into(),
            ..BrainFile::default()
        };
        CreatureKind::new(self.rig, Brain::new(file, TICK)?)
    }

    /// Makes a change to the body, unless the creature does not fit the changed body.
    fn take(&mut self, change: impl FnOnce(&mut BodyFile)) -> Option<CreatureKind> {
        let mut body = self.body.clone();
        change(&mut body);
        let kind = self.kind_with(body.clone()).ok()?;
        self.body = body;
        Some(kind)
    }

    /// Proposes legs, a gait, and a direction to look in, which is the direction of the walk.
    fn walk(&mut self) -> Result<(), ColossusError> {
        let (Some(idle), Some(walk)) = (self.clips.idle.clone(), self.clips.walk.clone()) else {
            return Ok(());
        };
        let kind = self.kind()?;
        let legs: Vec<LegFile> = legs::find(&Look::at(&kind)?);
        let fits = legs.into_iter().filter(|leg| {
            let legs = vec![leg.clone()];
            let body = BodyFile {
                legs,
                ..self.body.clone()
            };
            self.kind_with(body).is_ok()
        });
        let legs: Vec<LegFile> = fits.collect();
        if legs.len() > 1 {
            self.take(|body| body.legs = legs);
        }
        // Without legs, only a clip with `walk` in its name is a walk: a fan may have a clip `fanRunning`.
        if self.body.legs.is_empty() && !walk.to_lowercase().contains("walk") {
            return Ok(());
        }
        let gait = GaitFile {
            idle,
            walk,
            speed: Some(PROPOSED_WALK_SPEED),
            turn: None,
            turn_deg: PROPOSED_TURN_RATE,
            steer_deg: PROPOSED_STEER_RATE,
        };
        let kind = self.take(|body| body.gait = Some(gait.clone()));
        if let Some(aside) = kind.and_then(|kind| kind.walks_aside()) {
            let facing = match aside {
                45.0..135.0 => Facing::PlusX,
                -135.0..-45.0 => Facing::MinusX,
                -45.0..45.0 => Facing::PlusZ,
                _ => Facing::MinusZ,
            };
            let turned = self.take(|body| body.facing = facing);
            // Feet that stand in no part of the clip do not tell its direction.
            let ahead = turned.and_then(|kind| kind.walks_aside());
            if ahead.is_none_or(|aside| aside.abs() > 45.0) {
                self.body.facing = Facing::PlusZ;
            }
        }
        // Prefers the measured speed of the feet.
        let measured = GaitFile {
            speed: None,
            ..gait.clone()
        };
        let kind = self.take(|body| body.gait = Some(measured));
        let speed = kind.and_then(|kind| Some(kind.walking_speed()? / kind.height()));
        if speed.is_some_and(|speed| speed < SLOWEST_MEASURED_WALK) {
            self.take(|body| body.gait = Some(gait));
        }
        Ok(())
    }

    /// Proposes `close` for clips that are played in a loop but do not end as they begin.
    fn repeat(&mut self) -> Result<(), ColossusError> {
        let kind = self.kind()?;
        let probe = SeamProbe::new(kind.skeleton(), kind.mesh(), kind.height());
        let mut played: Vec<String> = self.clips.idle.iter().cloned().collect();
        played.extend(self.body.gait.iter().map(|gait| gait.walk.clone()));
        played.dedup();
        for name in played {
            let Some(clip) = kind.clips().clips().iter().find(|clip| clip.name == name) else {
                continue;
            };
            // A clip that cannot be posed at some time is not closed.
            let Some(seam) = probe.measure(clip).ok().filter(|seam| !seam.is_loop()) else {
                continue;
            };
            // The skin returns at its largest speed within the clip.
            let seconds = seam.speed * TICK / seam.within.max(1e-6);
            let close = rounded(seconds.clamp(0.04, 1.0), 1e2);
            self.take(|body| body.clips.entry(name).or_default().close = Some(close));
        }
        Ok(())
    }

    /// Proposes an attack, with the times at which its limb hurts.
    fn attack(&mut self) -> Result<Option<Strikes>, ColossusError> {
        let kind = self.kind()?;
        let look = Look::at(&kind)?;
        let name = self.clips.attack.clone();
        let clips = kind.clips().clips();
        let clip = clips.iter().find(|clip| Some(&clip.name) == name.as_ref());
        let (Some(name), Some(clip)) = (name, clip) else {
            return Ok(None);
        };
        let feet: Vec<&String> = self.body.legs.iter().flat_map(|leg| &leg.joints).collect();
        let Some(found) = strike::find(&look, clip, &feet).ok().flatten() else {
            return Ok(None);
        };
        let marker = |name: &str| {
            let mut all = clip.markers().iter();
            all.find(|marker| marker.name == name)
                .map(|marker| marker.time)
        };
        let own = marker("active").zip(marker("recovery"));
        let [from, to] = own.map_or(found.active, |(from, to)| [from, to]);
        let Ok(above) = strike::above(&look, clip, &found.limb, [from, to]) else {
            return Ok(None);
        };
        let passes_over = above.lowest * self.height() > HIGH_LIMB_SHARE * HUMAN_HEIGHT;
        let passes_by = PROPOSED_WITHIN * self.height() > BESIDE_PEOPLE_DISTANCE;
        let strikes = Strikes {
            clip: name.clone(),
            limb: found.limb,
            wave: (passes_over || passes_by).then_some(above.end + PROPOSED_WAVE_RADIUS),
        };
        if own.is_some() {
            return Ok(Some(strikes));
        }
        let [from, to] = [from, to].map(Times::One);
        let marks = |body: &mut BodyFile| {
            let ClipFile { markers, .. } = body.clips.entry(name).or_default();
            markers.insert("active".to_owned(), from);
            markers.insert("recovery".to_owned(), to);
        };
        Ok(self.take(marks).map(|_| strikes))
    }

    /// Proposes a head and a neck.
    fn head(&mut self) -> Result<(), ColossusError> {
        let kind = self.kind()?;
        let look = Look::at(&kind)?;
        let Some(head) = look.head() else {
            return Ok(());
        };
        let is_neck = |joint: &JointId| {
            look.is_named(*joint) && look.name(*joint).to_lowercase().contains("neck")
        };
        let neck: Vec<JointId> = look
            .upward(head)
            .skip(1)
            .take_while(is_neck)
            .take(2)
            .collect();
        let all = [head].into_iter().chain(neck);
        let joints: Vec<JointId> = all.collect();
        let shares = joints.iter().enumerate().map(|(index, joint)| {
            let share = if index + 1 < joints.len() { 0.5 } else { 1.0 };
            (look.name(*joint).to_owned(), share)
        });
        let middle = look.middle(head).unwrap_or_default();
        let file = HeadFile {
            joints: shares.collect(),
            eye: [0.0, look.in_heights(middle.y), look.in_heights(middle.z)],
            limits_deg: [60.0, 30.0],
        };
        self.take(|body| body.head = Some(file));
        Ok(())
    }

    /// Proposes fur, and a weak point on top of the head, or without a head at the highest skin.
    fn skin(&mut self) -> Result<(), ColossusError> {
        let mut tags = self.rig.collider.tags().iter();
        if !tags.any(|tag| tag.kind == SurfaceKind::Fur) {
            let joints = vec!["*".to_owned()];
            self.body.fur = FurFile {
                joints,
                ..FurFile::default()
            };
        }
        if self.rig.weak_points.iter().any(|point| point.major) {
            return Ok(());
        }
        let kind = self.kind()?;
        let look = Look::at(&kind)?;
        // Prefers a point between the ears to one on an ear.
        let is_middle = |joint: JointId, place: &DVec3| {
            (place.x - look.place(joint).x).abs() < PROPOSED_WEAK_RADIUS * look.height
        };
        let top = |joint: JointId| {
            let skin = || look.skin(joint).iter();
            let higher = |a: &&DVec3, b: &&DVec3| a.y.total_cmp(&b.y);
            let middle = skin()
                .filter(|place| is_middle(joint, place))
                .max_by(higher);
            let top = middle.or_else(|| skin().max_by(higher))?;
            Some((joint, *top))
        };
        let highest = || {
            let named = look.joints().filter(|joint| look.is_named(*joint));
            let tops = named.filter_map(top);
            tops.max_by(|a, b| a.1.y.total_cmp(&b.1.y))
        };
        let Some((joint, top)) = look.head().and_then(top).or_else(highest) else {
            return Ok(());
        };
        let at = top - look.place(joint);
        let weak = WeakPointFile {
            name: "weak point".to_owned(),
            joint: look.name(joint).to_owned(),
            at: at.to_array().map(|x| look.in_heights(x)),
            radius: PROPOSED_WEAK_RADIUS,
            hit_points: HIT_POINTS,
            major: true,
            order: None,
        };
        self.take(|body| body.weak_points.push(weak));
        Ok(())
    }
}
