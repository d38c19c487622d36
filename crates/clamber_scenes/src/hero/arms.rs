//! The hero's weapons: which clip shows what a fighter does, and where its hands bring sword and bow.
//!
//! The clips of a stab hold the sword with its blade down. Inverse kinematics then brings the hand to the hilt of the
//! fight's blade, and the drawn tip to the point of the skin that the stab goes to. While the other hand holds on, the
//! raised blade points up, as the fight has it, or the body would hide it; and it comes down at a slant, since the body is
//! between the hand and the skin.

use clamber_animation::ik::{IkError, TwoBoneGoal, orient};
use clamber_animation::{AnimationError, AnimationSet, ClipId, Layer, damp, joint_in_model};
use clamber_body::{Act as BodyAct, Body, Figure, Side, clamber_animation};
use clamber_fight::{Act, Fighter, Target};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};

/// From the grip of the hero's sword to its tip, metres.
const BLADE: f64 = 0.95;

/// The time at which `stab_strike` arrives, seconds: its marker `hit`.
const HIT: f64 = 0.2;

/// Share of a full draw at which the clip `draw` is over and `aim` begins.
const NOCKED: f64 = 0.6;

/// How far the trunk turns for the bow at most, radians.
const MOST_TURN: f64 = 1.2;

/// On a hold the blade comes from so far above for each metre that it goes into the skin.
const SLANT: f64 = 1.3;

/// Times for half of the way of the hands to the blade, and back to their clip, seconds.
const RAISES: f64 = 0.06;
const STRIKES: f64 = 0.025;
const RETURNS: f64 = 0.09;

/// Lengths of fades between clips, seconds: of the blade's quick moves, of others, and of the end.
const QUICK: f64 = 0.06;
const FADE: f64 = 0.14;
const END: f64 = 0.3;

/// What a clip shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Move {
    Raise,
    Hold,
    Strike,
    Swing,
    Draw,
    Aim,
    Loose,
}

impl Move {
    const ALL: [Self; 7] = [
        Self::Raise,
        Self::Hold,
        Self::Strike,
        Self::Swing,
        Self::Draw,
        Self::Aim,
        Self::Loose,
    ];

    const fn clip(self) -> &'static str {
        match self {
            Self::Raise => "stab_raise",
            Self::Hold => "stab_hold",
            Self::Strike => "stab_strike",
            Self::Swing => "swing",
            Self::Draw => "draw",
            Self::Aim => "aim",
            Self::Loose => "loose",
        }
    }

    const fn is_bow(self) -> bool {
        matches!(self, Self::Draw | Self::Aim | Self::Loose)
    }

    /// Length of the fade to it, seconds.
    const fn fade(self) -> f64 {
        match self {
            Self::Strike | Self::Loose => QUICK,
            _ => FADE,
        }
    }
}

/// Where the grip of the sword should be, and where its blade should point, in model space.
#[derive(Clone, Copy, Debug)]
struct Grip {
    place: DVec3,
    /// `None` for where the clip has it.
    along: Option<DVec3>,
}

/// Joints of the hero's equipment; `None` where a hero lacks one.
#[derive(Clone, Copy, Debug)]
struct Joints {
    sword: Option<JointId>,
    sheathed: Option<JointId>,
    bow: Option<JointId>,
}

/// What the hero does with its weapons.
#[derive(Clone, Debug)]
pub(super) struct Arms {
    clips: [Option<ClipId>; Move::ALL.len()],
    joints: Joints,
    /// What is played, and which hands play it.
    shown: Option<(Move, [bool; 2])>,
    /// How much the hands follow the blade, 0 to 1, and where they last followed it to.
    follows: f64,
    grip: Option<Grip>,
    /// How much the trunk turns for the bow, 0 to 1, and the aim in world space.
    aims: f64,
    aim: DVec3,
    /// Seconds since it let an arrow go.
    loosed: f64,
}

impl Arms {
    pub(super) fn new(figure: &Figure) -> Self {
        let (set, skeleton) = (figure.animations(), figure.skeleton());
        Self {
            clips: Move::ALL.map(|one| set.find(one.clip())),
            joints: Joints {
                sword: skeleton.find("sword"),
                sheathed: skeleton.find("sword_sheathed"),
                bow: skeleton.find("bow"),
            },
            shown: None,
            follows: 0.0,
            grip: None,
            aims: 0.0,
            aim: DVec3::ZERO,
            loosed: f64::INFINITY,
        }
    }

    /// Chooses the clip for what a fighter does, before the body is posed. `aim` is where it aims, in world space.
    ///
    /// # Errors
    /// [`AnimationError`] for clips of another figure.
    pub(super) fn play(
        &mut self,
        figure: &Figure,
        body: &mut Body,
        fighter: &Fighter,
        aim: DVec3,
        dt: f64,
    ) -> Result<(), AnimationError> {
        let was_aiming = self.shown.is_some_and(|(shown, _)| shown == Move::Aim);
        self.loosed += dt;
        if was_aiming && matches!(fighter.act(), Act::Ready) {
            self.loosed = 0.0;
        }
        let wanted = self.wanted(figure.animations(), fighter);
        if wanted.is_some_and(|(one, _)| one.is_bow() && one != Move::Loose) {
            self.aim = aim.normalize_or(self.aim);
        }
        let holds = fighter.climber().state().mode.is_holding();
        let shown = wanted.map(|(one, _)| (one, [!holds, true]));
        if shown != self.shown {
            let act = shown.and_then(|(one, hands)| {
                let clip = self.clips[one as usize]?;
                let loops = matches!(one, Move::Hold | Move::Aim);
                let layer = if loops {
                    Layer::new(clip)
                } else {
                    Layer::once(clip)
                };
                let mask = Some(figure.upper_body());
                let layer = Layer { mask, ..layer };
                Some(BodyAct { layer, hands })
            });
            let fade = shown.map_or(END, |(one, _)| one.fade());
            body.set_act(figure, act, fade)?;
            self.shown = shown;
        }
        if let (Some((_, Some(time))), Some(layer)) = (wanted, body.act_mut()) {
            (layer.time, layer.speed) = (time, 0.0);
        }
        Ok(())
    }

    /// What to play, and at which time of the clip; `None` as time for one that plays by itself.
    fn wanted(&self, set: &AnimationSet, fighter: &Fighter) -> Option<(Move, Option<f64>)> {
        let length = |one: Move| {
            let clip = self.clips[one as usize].and_then(|clip| set.clip(clip).ok());
            clip.map_or(0.0, |clip| clip.duration())
        };
        let at = |one: Move, share: f64| {
            let time = share.clamp(0.0, 1.0) * length(one);
            Some((one, Some(time)))
        };
        let sword = fighter.config().sword;
        match fighter.act() {
            Act::Raise { seconds, .. } => at(Move::Raise, seconds / sword?.raise.max(1e-3)),
            Act::Charge { .. } => Some((Move::Hold, None)),
            Act::Strike { seconds, .. } => {
                let share = (seconds / sword?.strike).clamp(0.0, 1.0);
                Some((Move::Strike, Some(share * HIT)))
            }
            Act::Plunge { .. } => Some((Move::Strike, Some(HIT))),
            Act::PullOut { seconds, .. } => {
                let left = (seconds / sword?.pull_out.max(1e-3)).clamp(0.0, 1.0);
                let rest = (length(Move::Strike) - HIT).max(0.0);
                Some((Move::Strike, Some(HIT + (1.0 - left) * rest)))
            }
            Act::Cut { seconds, .. } => {
                let sword = sword?;
                at(
                    Move::Swing,
                    seconds / (sword.wind_up + sword.cut + sword.recover),
                )
            }
            Act::Draw { drawn } if *drawn < NOCKED => at(Move::Draw, drawn / NOCKED),
            Act::Draw { .. } => Some((Move::Aim, None)),
            Act::Ready | Act::Throw { .. } => {
                let is_loosing = self.loosed < length(Move::Loose);
                is_loosing.then_some((Move::Loose, None))
            }
        }
    }

    /// Turns trunk and arms of a posed body to the bow's target and to the blade. `root` is where the model is drawn.
    ///
    /// # Errors
    /// [`IkError`] for poses that cannot be bent.
    pub(super) fn reach(
        &mut self,
        figure: &Figure,
        pose: &mut Pose,
        root: &Similarity,
        fighter: &Fighter,
        dt: f64,
    ) -> Result<(), IkError> {
        self.show_sword(pose);
        self.turn_blade_up(pose, fighter);
        let aims = self.shown.is_some_and(|(one, _)| one.is_bow());
        self.aims = damp(self.aims, f64::from(u8::from(aims)), RETURNS, dt);
        if self.aims > 0.01 {
            self.turn_to_aim(figure, pose, root)?;
        }
        let wanted = self.wanted_grip(root, fighter);
        let goal = f64::from(u8::from(wanted.is_some()));
        let half = if wanted.is_some() { RAISES } else { RETURNS };
        self.follows = damp(self.follows, goal, half, dt);
        if let Some(wanted) = wanted {
            let is_slow = matches!(fighter.act(), Act::Raise { .. } | Act::Charge { .. });
            let half = if is_slow { RAISES } else { STRIKES };
            let share = 1.0 - damp(1.0, 0.0, half, dt);
            self.grip = Some(self.grip.map_or(wanted, |grip| Grip {
                place: grip.place.lerp(wanted.place, share),
                along: wanted.along,
            }));
        }
        match self.grip {
            Some(grip) if self.follows > 0.01 => self.bring(figure, pose, &grip),
            _ => {
                self.grip = None;
                Ok(())
            }
        }
    }

    /// The sword is either in the hand or in its sheath: clips fade between the two by their scale.
    fn show_sword(&self, pose: &mut Pose) {
        let (Some(sword), Some(sheathed)) = (self.joints.sword, self.joints.sheathed) else {
            return;
        };
        let is_out = pose.transforms[sword.index()].scale.x > 0.5;
        let scale = |is_shown: bool| Vec3::splat(f32::from(u8::from(is_shown)));
        pose.transforms[sword.index()].scale = scale(is_out);
        pose.transforms[sheathed.index()].scale = scale(!is_out);
    }

    /// Turns the blade up in a fist that holds it blade down, while it is raised on a hold; a strike turns it down again.
    fn turn_blade_up(&self, pose: &mut Pose, fighter: &Fighter) {
        let (Some(sword), Some(config)) = (self.joints.sword, fighter.config().sword) else {
            return;
        };
        let share = match fighter.act() {
            Act::Raise { .. } | Act::Charge { .. } => 1.0,
            Act::Strike { seconds, .. } => (1.0 - seconds / config.strike).clamp(0.0, 1.0),
            _ => 0.0,
        };
        let holds = fighter.climber().state().mode.is_holding();
        if share > 0.0 && holds {
            let turn = rotation_from_axis_angle(DVec3::X, share * core::f64::consts::PI);
            let own = &mut pose.transforms[sword.index()].rotation;
            *own = (own.as_dquat() * turn).normalize().as_quat();
        }
    }

    /// Where the fight wants the grip: at the hilt while the sword is raised, or so that the tip is in the skin.
    fn wanted_grip(&self, root: &Similarity, fighter: &Fighter) -> Option<Grip> {
        let sword = fighter.config().sword?;
        let in_model = |place: DVec3| root.inverse_transform_point(place);
        let (target, deep) = match fighter.act() {
            Act::Raise { .. } | Act::Charge { .. } => {
                let blade = fighter.blade()?;
                let along = root.rotation.conjugate() * (blade.tip - blade.hilt);
                let holds = fighter.climber().state().mode.is_holding();
                return Some(Grip {
                    place: in_model(blade.hilt),
                    along: along.try_normalize().filter(|_| holds),
                });
            }
            Act::Strike { target, .. } => (target, 0.0),
            Act::PullOut { seconds, target } => {
                let left = (seconds / sword.pull_out.max(1e-3)).min(1.0);
                (target, sword.depth * left)
            }
            Act::Plunge { .. } => {
                let blade = fighter.blade()?;
                let along = (blade.tip - blade.hilt).normalize_or(DVec3::NEG_Y);
                return Some(Grip {
                    place: in_model(blade.hilt),
                    along: Some(root.rotation.conjugate() * along),
                });
            }
            _ => return None,
        };
        let Target::Skin(at) = target else {
            return None;
        };
        let into = at.offset_in_world().normalize_or(DVec3::NEG_Y);
        let climber = fighter.climber();
        let along = if climber.state().mode.is_holding() {
            let up = root.rotation * DVec3::Y;
            let up = (up - into * up.dot(into)).normalize_or(climber.config().up());
            (into - up * SLANT).normalize_or(into)
        } else {
            into
        };
        Some(Grip {
            place: in_model(at.point + along * (deep - BLADE)),
            along: Some(root.rotation.conjugate() * along),
        })
    }

    /// Brings the sword in the right hand to a grip, and the left hand along if it holds the sword as well.
    fn bring(&self, figure: &Figure, pose: &mut Pose, grip: &Grip) -> Result<(), IkError> {
        let (skeleton, humanoid) = (figure.skeleton(), figure.humanoid());
        let arms = [Side::Right, Side::Left].map(|side| humanoid.arm(side));
        let (Some(sword), Some(right), Some(left)) =
            (self.joints.sword, arms[0].end.joint(), arms[1].end.joint())
        else {
            return Ok(());
        };
        let place = |pose: &Pose, joint: JointId| {
            let found = joint_in_model(skeleton, pose, joint);
            found.map(|found| (found.translation, rotation(&found)))
        };
        let (Some((wrist, turn)), Some((left_wrist, left_turn))) =
            (place(pose, right), place(pose, left))
        else {
            return Ok(());
        };
        let both = self.shown.is_some_and(|(_, hands)| hands[0]);
        let own = &pose.transforms[sword.index()];
        let (offset, own_turn) = (own.translation.as_dvec3(), own.rotation.as_dquat());
        let now = wrist + turn * offset;
        let blade = turn * own_turn * DVec3::Y;
        let swung = grip.along.map_or(DQuat::IDENTITY, |along| {
            arc(blade, along, self.follows, core::f64::consts::PI)
        });
        let new_turn = (swung * turn).normalize();
        let held = now.lerp(grip.place, self.follows);
        let goal = TwoBoneGoal {
            soft: 0.97,
            ..TwoBoneGoal::reach(held - new_turn * offset)
        };
        arms[0].ik.solve(skeleton, pose, &goal, None)?;
        orient(skeleton, pose, right, new_turn)?;
        let Some((there, _)) = place(pose, right).filter(|_| both) else {
            return Ok(());
        };
        // The left hand keeps its place on the hilt.
        let beside = there + swung * (left_wrist - wrist);
        let goal = TwoBoneGoal {
            soft: 0.97,
            ..TwoBoneGoal::reach(beside)
        };
        arms[1].ik.solve(skeleton, pose, &goal, None)?;
        orient(skeleton, pose, left, (swung * left_turn).normalize())
    }

    /// Turns the trunk so that the bow points where it aims.
    fn turn_to_aim(
        &self,
        figure: &Figure,
        pose: &mut Pose,
        root: &Similarity,
    ) -> Result<(), IkError> {
        let (skeleton, humanoid) = (figure.skeleton(), figure.humanoid());
        let bow = self.joints.bow.and_then(|bow| turn_of(skeleton, pose, bow));
        let (Some(bow), Some(aim)) = (bow, self.aim.try_normalize()) else {
            return Ok(());
        };
        let wanted = root.rotation.conjugate() * aim;
        let gaze = turn_of(skeleton, pose, humanoid.head);
        let joints = [humanoid.spine.first().copied(), Some(humanoid.chest())];
        for joint in joints.into_iter().flatten() {
            let turn = arc(bow * DVec3::Z, wanted, 0.5 * self.aims, 0.5 * MOST_TURN);
            if let Some(now) = turn_of(skeleton, pose, joint) {
                orient(skeleton, pose, joint, (turn * now).normalize())?;
            }
        }
        // The head looked at the giant already.
        match gaze {
            Some(gaze) => orient(skeleton, pose, humanoid.head, gaze),
            None => Ok(()),
        }
    }

    /// The grip and the tip of the sword in the hand, in model space; `None` while it is in its sheath.
    pub(super) fn sword(&self, skeleton: &Skeleton, pose: &Pose) -> Option<[DVec3; 2]> {
        let sword = self.joints.sword?;
        if pose.transforms[sword.index()].scale.x < 0.5 {
            return None;
        }
        let place = joint_in_model(skeleton, pose, sword)?;
        let tip = place.transform_point3(DVec3::Y * BLADE);
        Some([place.translation, tip])
    }
}

fn turn_of(skeleton: &Skeleton, pose: &Pose, joint: JointId) -> Option<DQuat> {
    // A piece that is hidden has no rotation: its parent's and its own are taken apart from its scale.
    let parent = skeleton.joints()[joint.index()].parent;
    let parent = parent.and_then(|parent| joint_in_model(skeleton, pose, parent));
    let own = pose.transforms[joint.index()].rotation.as_dquat();
    Some(parent.map_or(own, |parent| rotation(&parent) * own))
}

/// The rotation of a joint that is not scaled.
fn rotation(place: &DAffine3) -> DQuat {
    let [x, y] = [place.matrix3.x_axis, place.matrix3.y_axis].map(DVec3::normalize_or_zero);
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y))).normalize()
}

/// A share of the smallest turn from one direction to another, at most `most` radians.
fn arc(from: DVec3, to: DVec3, share: f64, most: f64) -> DQuat {
    let across = from.cross(to);
    let angle = libm::atan2(across.length(), from.dot(to)) * share;
    let axis = across.normalize_or(from.any_orthonormal_vector());
    rotation_from_axis_angle(axis, angle.min(most))
}
