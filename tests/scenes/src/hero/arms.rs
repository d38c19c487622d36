//! The hero's weapons: which clip shows what a fighter does, and where its hands bring sword and bow.
//!
//! The clips of a stab hold the sword with its blade down. Inverse kinematics then brings the hand to the hilt of the
//! fight's blade, and the drawn tip to the point of the skin that the stab goes to. While the other hand holds on, the
//! raised blade points up, as the fight has it, or the body would hide it; and it comes down at a slant, since the body
//! is between the hand and the skin.

mod bend;
mod moves;

use bend::Hands;
use clamber_body::clamber_animation::ik::IkError;
use clamber_body::clamber_animation::{AnimationError, Layer, damp, joint_in_model};
use clamber_body::{Act as BodyAct, Body, Figure};
use clamber_fight::{Act, Fighter, Target};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_surface::rig::{JointId, Pose, Skeleton};
use glam::{DVec3, Vec3};
use moves::{Move, Moves};

/// From the grip of the hero's sword to its tip, metres.
const BLADE: f64 = 0.95;

/// On a hold the blade comes from so far above for each metre that it goes into the skin.
const SLANT: f64 = 1.3;

/// Times for half of the way of the hands to the blade, and back to their clip, seconds.
const RAISES: f64 = 0.06;
const STRIKES: f64 = 0.025;
const RETURNS: f64 = 0.09;

/// Length of the fade from the last clip to none, seconds.
const END: f64 = 0.3;

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
    moves: Moves,
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
            moves: Moves::find(set),
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

    /// Chooses the clip for what a fighter does, before the body is posed. `aim` is where it aims, in world space, and
    /// whether it has just let something go.
    ///
    /// # Errors
    /// [`AnimationError`] for clips of another figure.
    pub(super) fn play(
        &mut self,
        figure: &Figure,
        body: &mut Body,
        fighter: &Fighter,
        (aim, has_shot): (DVec3, bool),
        dt: f64,
    ) -> Result<(), AnimationError> {
        let was_aiming = self.shown.is_some_and(|(shown, _)| shown == Move::Aim);
        self.loosed += dt;
        if was_aiming && has_shot {
            self.loosed = 0.0;
        }
        let wanted = self.moves.of(figure.animations(), fighter, self.loosed);
        if wanted.is_some_and(|(one, _)| one.is_bow() && one != Move::Loose) {
            self.aim = aim.normalize_or(self.aim);
        }
        let holds = fighter.climber().state().mode.is_holding();
        let shown = wanted.map(|(one, _)| (one, [!holds, true]));
        if shown != self.shown {
            let act = shown.and_then(|(one, hands)| {
                let clip = self.moves.get(one)?;
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
        if let (true, Some(bow), Some(aim)) =
            (self.aims > 0.01, self.joints.bow, self.aim.try_normalize())
        {
            let wanted = root.rotation.conjugate() * aim;
            bend::turn_trunk(figure, pose, bow, wanted, self.aims)?;
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
        match (self.grip, self.joints.sword) {
            (Some(grip), Some(sword)) if self.follows > 0.01 => {
                let both = self.shown.is_some_and(|(_, hands)| hands[0]);
                let share = self.follows;
                let hands = Hands { sword, both, share };
                bend::bring(figure, pose, hands, &grip)
            }
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

    /// Turns the blade up in a fist that holds it blade down, while it is raised on a hold; a strike turns it down
    /// again.
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
