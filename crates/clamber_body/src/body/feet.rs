//! Feet of somebody who stands or walks: they stay where they came down until it is their turn to step.

use clamber_animation::Spring;
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DQuat, DVec3};

use super::context::Context;
use super::event::Plant;
use super::hold::Hold;
use super::limb::{Doing, LimbMemory};
use super::reach::LEG;
use super::root::Root;
use super::stance::arc;
use super::walk::Walk;
use crate::figure::{LimbShape, Place};
use crate::{Extremity, Side};

/// Distance from where it should be at which a foot leaves its place, metres, and angle, radians (Unreal's foot
/// placement: 0.35 m, 45°); and the same for somebody who stands.
const UNPLANT: (f64, f64) = (0.35, 0.785);
const REPLANT: (f64, f64) = (0.13, 0.4);

/// A foot comes down from at most this height without a step of its own, metres.
const LOW: f64 = 0.006;

/// Times of steps that the gait does not ask for, seconds: to another place, and straight down.
const STEP: f64 = 0.26;
const DOWN: f64 = 0.12;

/// Height from which it takes all of the time straight down, metres.
const HIGH: f64 = 0.08;

/// How high such a step goes, metres.
const LIFT: f64 = 0.06;

/// Time for half of a change of the ground's height below a foot in the air, seconds: Unreal's floor spring.
const FLOOR: f64 = 0.05;

/// Steepest ground that soles lie flat on, as the cosine: 50°.
const STEEP: f64 = 0.64;

/// Slopes on which feet do not roll any more, and up to which they roll as in the clip, as cosines: 33° and 8°.
const ROLLS: [f64; 2] = [0.84, 0.99];

/// How far a heel is lifted for a leg that is too short, radians, and how often that is halved to find how far.
const HEEL_UP: f64 = 0.9;
const HALVINGS: usize = 12;

/// Who stands has a foot on the ground if the clip's sole is at most so high, metres, and its top faces up, as a
/// cosine.
const DOWN_TO: f64 = 0.15;
const LEVEL: f64 = 0.8;

/// How fast a heel is lifted at most, radians a second.
const HEEL_SPEED: f64 = 8.0;

/// A foot that is out of reach by more than this share of the leg leaves its place early.
const EARLY: f64 = 1.0;

/// Where the ground is looked for below a foot, metres.
const ABOVE: f64 = 0.6;
const BELOW: f64 = 0.9;

pub(crate) fn step(
    context: &Context<'_>,
    stand: &Root,
    walk: &Walk,
    hips: [DVec3; 2],
    limbs: &mut [LimbMemory; 4],
    plants: &mut Vec<Plant>,
) {
    for side in Side::BOTH {
        let extremity = Extremity::Foot(side);
        let other = &limbs[Extremity::Foot(opposite(side)).index()];
        let other_stands = other.is_planted();
        let mut foot = Foot {
            context,
            stand,
            walk,
            side,
            hip: hips[side.index()],
            shape: context.shape(extremity),
            clip: context.clip_in_world(stand, extremity),
            memory: limbs[extremity.index()],
        };
        foot.step(other_stands, plants);
        foot.lift_heel();
        limbs[extremity.index()] = foot.memory;
    }
}

/// Where a foot is, after [`step`].
pub(crate) fn place(context: &Context<'_>, stand: &Root, limb: &LimbMemory, side: Side) -> Place {
    let extremity = Extremity::Foot(side);
    let clip = context.clip_in_world(stand, extremity);
    match &limb.doing {
        Doing::Free => limb.kept(&over_ground(context, &clip, limb, extremity)),
        Doing::Planted(hold) => on_hold(context, limb, hold, extremity, limb.heel),
        Doing::Swinging(swing) => swing.place(),
    }
}

/// A foot on its hold, with its heel up by an angle beyond its clip's, radians.
fn on_hold(
    context: &Context<'_>,
    limb: &LimbMemory,
    hold: &Hold,
    extremity: Extremity,
    heel: f64,
) -> Place {
    let pitch = pitch(context, extremity, hold);
    // A heel that is lifted takes the toes' place on the ground.
    let pitch = if heel > 0.0 {
        pitch.min(pitch * (1.0 - heel / HEEL_UP)) - heel
    } else {
        pitch
    };
    let rolled = rolled(hold, context.shape(extremity), pitch);
    limb.kept_about(&rolled, hold.touching)
}

struct Foot<'a, 'c> {
    context: &'a Context<'c>,
    stand: &'a Root,
    walk: &'a Walk,
    side: Side,
    /// Where its leg begins.
    hip: DVec3,
    shape: &'a LimbShape,
    /// Where the clip has it, on level ground.
    clip: Place,
    memory: LimbMemory,
}

impl Foot<'_, '_> {
    fn step(&mut self, other_stands: bool, plants: &mut Vec<Plant>) {
        let air = self
            .walk
            .is_going()
            .then(|| self.walk.stride.step(self.side, self.walk.phase));
        let air = air.flatten();
        let stands = air.is_none() && self.is_down();
        self.follow();
        match self.memory.doing {
            Doing::Planted(_) if !stands => self.lift(),
            Doing::Planted(hold) if self.walk.is_going() && self.is_left_behind(&hold) => {
                self.lift();
                self.memory.waits = true;
            }
            Doing::Planted(hold) => {
                let (distance, angle) = self.away(&hold);
                let size = self.context.size();
                let is_far = |(far, turned): (f64, f64)| distance > far * size || angle > turned;
                if is_far(UNPLANT) || !self.walk.is_going() && other_stands && is_far(REPLANT) {
                    match self.find(&self.clip) {
                        Some(hold) => {
                            self.memory
                                .swing_to(hold, STEP, hold.normal() * (LIFT * size))
                        }
                        None => self.lift(),
                    }
                }
            }
            Doing::Swinging(_) if !stands => self.lift(),
            Doing::Swinging(swing) => {
                if swing.time >= swing.duration {
                    self.memory.doing = Doing::Planted(swing.to);
                    self.tell(&swing.to, plants);
                }
            }
            Doing::Free => {}
        }
        if !matches!(self.memory.doing, Doing::Free) {
            return;
        }
        self.look_ahead(air);
        // A foot that left the ground early waits for its turn.
        self.memory.waits &= air.is_none() && self.walk.is_going();
        if stands && !self.memory.waits {
            self.come_down(plants);
        }
    }

    /// True if the clip has the foot on the ground: not while it gets up, or falls down.
    fn is_down(&self) -> bool {
        let clip = &self.context.clip[Extremity::Foot(self.side).index()];
        let height = clip.point(self.shape.contact).y / self.context.size();
        self.walk.is_going() || height < DOWN_TO && (clip.rotation * DVec3::Y).y > LEVEL
    }

    /// Moves on with what it stands on, or steps to.
    fn follow(&mut self) {
        let around = &self.context.around;
        let is_there = match &mut self.memory.doing {
            Doing::Free => true,
            Doing::Planted(hold) => hold.follow(around),
            Doing::Swinging(swing) => swing.to.follow(around),
        };
        if !is_there {
            self.lift();
        }
    }

    fn over_ground(&self) -> Place {
        let extremity = Extremity::Foot(self.side);
        over_ground(self.context, &self.clip, &self.memory, extremity)
    }

    /// Somebody who walks lifts the heel of a foot that stays behind before the leg is too short; down stairs, toes
    /// come first.
    fn lift_heel(&mut self) {
        let extremity = Extremity::Foot(self.side);
        let mut wanted = 0.0;
        if let Doing::Planted(hold) = &self.memory.doing
            && self.walk.is_going()
        {
            let at =
                |heel: f64| on_hold(self.context, &self.memory, hold, extremity, heel).position;
            let reach = LEG * self.shape.length;
            let is_behind = (at(0.0) - self.hip).dot(self.context.motion) < 0.0;
            let is_level = hold.normal().dot(self.context.up) > ROLLS[1];
            if (is_behind || is_level) && at(0.0).distance(self.hip) > reach {
                let (mut low, mut high) = (0.0, HEEL_UP);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if at(middle).distance(self.hip) > reach {
                        low = middle;
                    } else {
                        high = middle;
                    }
                }
                wanted = high;
            }
        }
        let most = HEEL_SPEED * self.context.dt;
        self.memory.heel += (wanted - self.memory.heel).clamp(-most, most);
    }

    /// Leaves the ground, and goes on as the clip does.
    fn lift(&mut self) {
        let hold = match &self.memory.doing {
            Doing::Planted(hold) => Some(*hold),
            _ => None,
        };
        let up = self.context.up;
        if let Some(hold) = hold {
            self.memory.ground = Spring::at((hold.point() - self.stand.position).dot(up));
            self.memory.tilt = Spring::at(hold.normal());
        }
        let target = self.over_ground();
        self.memory.let_go(&target);
    }

    /// How far the ground under the foot is from where the clip has it, along the ground, and the angle about up.
    fn away(&self, hold: &Hold) -> (f64, f64) {
        let up = self.context.up;
        let way = self.clip.point(self.shape.contact) - hold.place().point(self.shape.contact);
        let level = |v: DVec3| v - up * v.dot(up);
        let [is, wanted] = [hold.rotation(), self.clip.rotation].map(|turn| level(turn * DVec3::X));
        let angle = libm::atan2(is.cross(wanted).length(), is.dot(wanted));
        (level(way).length(), angle)
    }

    /// True if the body has walked away from it, so that even on its toes it does not reach.
    fn is_left_behind(&self, hold: &Hold) -> bool {
        let toes = rolled(hold, self.shape, -HEEL_UP).position - self.hip;
        toes.dot(self.context.motion) < 0.0 && toes.length() > EARLY * self.shape.length
    }

    /// Watches the ground below and where it will come down, so that it goes over what is in its way.
    fn look_ahead(&mut self, air: Option<(f64, f64)>) {
        let up = self.context.up;
        let height = |point: DVec3| {
            let contact = self.below(point)?.contact;
            let height = (contact.point - self.stand.position).dot(up);
            Some((height, contact.normal))
        };
        let here = height(self.clip.point(self.shape.contact));
        let ahead = air.and_then(|(_, left)| {
            let landing = self.walk.stride.landing[self.side.index()];
            let motion = self.context.motion;
            let level = motion - up * motion.dot(up);
            let time = left / self.walk.rate.max(1e-6);
            height(self.stand.point(landing) + level * time)
        });
        let (height, normal) = match (here, ahead) {
            (Some(here), Some(ahead)) => (here.0.max(ahead.0), ahead.1),
            (Some(ground), None) | (None, Some(ground)) => ground,
            (None, None) => (0.0, up),
        };
        if self.context.is_fresh {
            self.memory.ground = Spring::at(height);
            self.memory.tilt = Spring::at(normal);
        } else {
            self.memory.ground.step(height, FLOOR, self.context.dt);
            self.memory.tilt.step(normal, FLOOR, self.context.dt);
        }
    }

    fn below(&self, point: DVec3) -> Option<super::hold::Found<'_>> {
        let up = self.context.up;
        let size = self.context.size();
        let level = point - up * (point - self.stand.position).dot(up);
        let from = level + up * (ABOVE * size);
        let found = self
            .context
            .around
            .cast(from, -up, (ABOVE + BELOW) * size)?;
        (found.contact.normal.dot(up) > STEEP).then_some(found)
    }

    /// The ground below the part of a place that comes down first.
    fn find(&self, place: &Place) -> Option<Hold> {
        let along = place.rotation * DVec3::X;
        let touching = if along.dot(self.memory.tilt.value) > 0.0 {
            self.shape.heel
        } else {
            self.shape.ball
        };
        let found = self.below(place.point(touching))?;
        Some(Hold::new(&found, along, found.contact.normal, touching))
    }

    fn come_down(&mut self, plants: &mut Vec<Plant>) {
        let target = self.over_ground();
        let shown = self.memory.kept(&target);
        let Some(hold) = self.find(&shown) else {
            return;
        };
        let size = self.context.size();
        let height = (shown.point(hold.touching) - hold.point()).dot(self.context.up);
        if self.context.is_fresh {
            self.memory.doing = Doing::Planted(hold);
        } else if height < LOW * size {
            let pitch = pitch(self.context, Extremity::Foot(self.side), &hold);
            let now = rolled(&hold, self.shape, pitch);
            // It has come down on the ground below it: only its height and its turn differ.
            let raised = Place {
                position: now.position + self.context.up * height.max(0.0),
                rotation: shown.rotation,
            };
            self.memory.doing = Doing::Planted(hold);
            self.memory.heel = 0.0;
            self.memory.stop(&raised, &now);
            self.tell(&hold, plants);
        } else if height < BELOW * size {
            let share = (height / (HIGH * size)).clamp(0.2, 1.0);
            self.memory.swing_to(hold, DOWN * share, DVec3::ZERO);
        }
    }

    fn tell(&self, hold: &Hold, plants: &mut Vec<Plant>) {
        let extremity = Extremity::Foot(self.side);
        self.context.tell(plants, extremity, hold, self.memory.pace);
    }
}

fn opposite(side: Side) -> Side {
    match side {
        Side::Left => Side::Right,
        Side::Right => Side::Left,
    }
}

/// A place on level ground, taken to the height and the slope of the ground below it.
fn over_ground(
    context: &Context<'_>,
    clip: &Place,
    limb: &LimbMemory,
    extremity: Extremity,
) -> Place {
    let contact = context.shape(extremity).contact;
    let normal = limb.tilt.value.normalize_or(context.up);
    let rotation = (arc(context.up, normal) * clip.rotation).normalize();
    let sole = clip.point(contact) + context.up * limb.ground.value;
    Place::with_point_at(sole, contact, rotation)
}

/// How far the toes are above the heel, radians: as in the clip on level ground, and not at all on steep slopes, where
/// feet go flat.
fn pitch(context: &Context<'_>, extremity: Extremity, hold: &Hold) -> f64 {
    let clip = &context.clip[extremity.index()];
    let pitch = libm::asin((clip.rotation * DVec3::X).y.clamp(-1.0, 1.0));
    let [steep, level] = ROLLS;
    let upright = hold.normal().dot(context.up);
    pitch * ((upright - steep) / (level - steep)).clamp(0.0, 1.0)
}

/// A foot on its hold that rolls over its heel or its ball.
fn rolled(hold: &Hold, shape: &LimbShape, pitch: f64) -> Place {
    let flat = hold.place();
    // Z is to the right: a positive turn raises the toes.
    let turn: DQuat = rotation_from_axis_angle(DVec3::Z, pitch);
    let rotation = flat.rotation * turn;
    let pivot = if pitch > 0.0 { shape.heel } else { shape.ball };
    Place::with_point_at(flat.point(pivot), pivot, rotation)
}
