//! Feet of a standing or walking body: each stays where it came down until it is its turn to step.

use clamber_animation::Spring;
use clamber_surface::geometry::rotation_from_axis_angle;
use glam::{DQuat, DVec3};

use super::context::Context;
use super::event::Plant;
use super::hold::Hold;
use super::limb::{Doing, LimbMemory};
use super::reach::LEG_REACH;
use super::root::Root;
use super::stance::arc;
use super::walk::Walk;
use crate::figure::{LimbShape, Place};
use crate::{Extremity, Side};

/// Distance, metres, and angle, radians, from its place in the clips' pose at which a foot leaves the ground (Unreal's
/// foot placement: 0.35 m, 45°).
const UNPLANT_LIMITS: (f64, f64) = (0.35, 0.785);

/// The same distance and angle for a standing body with the other foot on the ground.
const REPLANT_LIMITS: (f64, f64) = (0.13, 0.4);

/// Height up to which a foot is planted without a step down, metres.
const PLANT_HEIGHT: f64 = 0.006;

/// Duration of a step to another place that the gait does not ask for, seconds.
const CORRECTIVE_STEP_TIME: f64 = 0.26;

/// Duration of a step straight down from [`STEP_DOWN_HEIGHT`], seconds. Lower steps take proportionally less, at least
/// a fifth.
const STEP_DOWN_TIME: f64 = 0.12;

/// Height from which a step straight down takes all of [`STEP_DOWN_TIME`], metres.
const STEP_DOWN_HEIGHT: f64 = 0.08;

/// Height of the path of a step to another place, metres.
const STEP_LIFT: f64 = 0.06;

/// Half time of the spring on the ground's height below a foot in the air, seconds: Unreal's floor spring.
const FLOOR_HALF_TIME: f64 = 0.05;

/// Cosine of the steepest slope that a foot stands on: 50°.
const STEEPEST_FOOT_COSINE: f64 = 0.64;

/// Cosines of the slopes at which feet stop rolling, 33°, and up to which they roll as in the clip, 8°. Between them
/// the roll fades.
const FOOT_ROLL_COSINES: [f64; 2] = [0.84, 0.99];

/// Largest angle by which a heel is lifted for a leg that is too short, radians.
const HEEL_UP: f64 = 0.9;

/// Number of bisections that find the angle of a lifted heel.
const HEEL_BISECTIONS: usize = 12;

/// Height of the clip's sole up to which a foot of a standing body is on the ground, metres.
const DOWN_TO: f64 = 0.15;

/// Least cosine of the tilt of the clip's foot at which a foot of a standing body is on the ground.
const LEVEL_FOOT_COSINE: f64 = 0.8;

/// Largest speed at which a heel is lifted or lowered, radians a second.
const HEEL_SPEED: f64 = 8.0;

/// Distance of the ankle from the hip, with the heel lifted, beyond which a foot leaves its place early, as a share of
/// the leg's length.
const EARLY_LIFT_DISTANCE: f64 = 1.0;

/// Height above the model's origin from which the ground below a foot is looked for, metres.
const RAY_START_HEIGHT: f64 = 0.6;

/// Depth below the model's origin down to which the ground below a foot is looked for, metres.
const RAY_END_DEPTH: f64 = 0.9;

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
        let opposite = Side::BOTH[1 - side.index()];
        let other = &limbs[Extremity::Foot(opposite).index()];
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

/// The place of a foot, after [`step`].
pub(crate) fn place(context: &Context<'_>, stand: &Root, limb: &LimbMemory, side: Side) -> Place {
    let extremity = Extremity::Foot(side);
    let clip = context.clip_in_world(stand, extremity);
    match &limb.doing {
        Doing::Free => limb.kept(&over_ground(context, &clip, limb, extremity)),
        Doing::Planted(hold) => on_hold(context, limb, hold, extremity, limb.heel),
        Doing::Swinging(swing) => swing.place(),
    }
}

/// The place of a planted foot. `heel` is the angle of the heel's lift beyond the clip's, radians.
fn on_hold(
    context: &Context<'_>,
    limb: &LimbMemory,
    hold: &Hold,
    extremity: Extremity,
    heel: f64,
) -> Place {
    let pitch = pitch(context, extremity, hold);
    // Lifting the heel lowers the toes that the clip raises.
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
    /// The leg's upper joint in world space.
    hip: DVec3,
    shape: &'a LimbShape,
    /// The foot's place in the clips' pose, on level ground, in world space.
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
                if is_far(UNPLANT_LIMITS)
                    || !self.walk.is_going() && other_stands && is_far(REPLANT_LIMITS)
                {
                    match self.find(&self.clip) {
                        Some(hold) => self.memory.swing_to(
                            hold,
                            CORRECTIVE_STEP_TIME,
                            hold.normal() * (STEP_LIFT * size),
                        ),
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

    /// True if the clips' pose has the foot on the ground. False while the body gets up or falls down.
    fn is_down(&self) -> bool {
        let clip = &self.context.clip[Extremity::Foot(self.side).index()];
        let height = clip.point(self.shape.contact).y / self.context.size();
        self.walk.is_going() || height < DOWN_TO && (clip.rotation * DVec3::Y).y > LEVEL_FOOT_COSINE
    }

    /// Moves the hold with its material; lifts the foot if the material is gone.
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

    /// Lifts the heel of a walking body's foot before the leg is too short: for a foot behind the hip, and on level
    /// ground also for one ahead, so that toes come first down stairs.
    fn lift_heel(&mut self) {
        let extremity = Extremity::Foot(self.side);
        let mut wanted = 0.0;
        if let Doing::Planted(hold) = &self.memory.doing
            && self.walk.is_going()
        {
            let at =
                |heel: f64| on_hold(self.context, &self.memory, hold, extremity, heel).position;
            let reach = LEG_REACH * self.shape.length;
            let is_behind = (at(0.0) - self.hip).dot(self.context.motion) < 0.0;
            let is_level = hold.normal().dot(self.context.up) > FOOT_ROLL_COSINES[1];
            if (is_behind || is_level) && at(0.0).distance(self.hip) > reach {
                let (mut low, mut high) = (0.0, HEEL_UP);
                for _ in 0..HEEL_BISECTIONS {
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

    /// Takes the foot off the ground, back to the clips' pose.
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

    /// Distance of the foot from its place in the clips' pose along the ground, metres, and angle about up, radians.
    fn away(&self, hold: &Hold) -> (f64, f64) {
        let up = self.context.up;
        let way = self.clip.point(self.shape.contact) - hold.place().point(self.shape.contact);
        let level = |v: DVec3| v - up * v.dot(up);
        let [is, wanted] = [hold.rotation(), self.clip.rotation].map(|turn| level(turn * DVec3::X));
        let angle = libm::atan2(is.cross(wanted).length(), is.dot(wanted));
        (level(way).length(), angle)
    }

    /// True if the foot is behind the hip and out of the leg's reach even on its toes.
    fn is_left_behind(&self, hold: &Hold) -> bool {
        let toes = rolled(hold, self.shape, -HEEL_UP).position - self.hip;
        toes.dot(self.context.motion) < 0.0
            && toes.length() > EARLY_LIFT_DISTANCE * self.shape.length
    }

    /// Adapts the foot's height to the ground below it or at its next landing, whichever is higher, so that it passes
    /// over obstacles.
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
            self.memory
                .ground
                .step(height, FLOOR_HALF_TIME, self.context.dt);
            self.memory
                .tilt
                .step(normal, FLOOR_HALF_TIME, self.context.dt);
        }
    }

    fn below(&self, point: DVec3) -> Option<super::hold::Found<'_>> {
        let up = self.context.up;
        let size = self.context.size();
        let level = point - up * (point - self.stand.position).dot(up);
        let from = level + up * (RAY_START_HEIGHT * size);
        let found =
            self.context
                .around
                .cast(from, -up, (RAY_START_HEIGHT + RAY_END_DEPTH) * size)?;
        (found.contact.normal.dot(up) > STEEPEST_FOOT_COSINE).then_some(found)
    }

    /// A hold on the ground below the heel or the ball of a place, whichever comes down first.
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
        } else if height < PLANT_HEIGHT * size {
            let pitch = pitch(self.context, Extremity::Foot(self.side), &hold);
            let now = rolled(&hold, self.shape, pitch);
            // The foot is straight above its hold, so only its height and its rotation differ.
            let raised = Place {
                position: now.position + self.context.up * height.max(0.0),
                rotation: shown.rotation,
            };
            self.memory.doing = Doing::Planted(hold);
            self.memory.heel = 0.0;
            self.memory.stop(&raised, &now);
            self.tell(&hold, plants);
        } else if height < RAY_END_DEPTH * size {
            let share = (height / (STEP_DOWN_HEIGHT * size)).clamp(0.2, 1.0);
            self.memory
                .swing_to(hold, STEP_DOWN_TIME * share, DVec3::ZERO);
        }
    }

    fn tell(&self, hold: &Hold, plants: &mut Vec<Plant>) {
        let extremity = Extremity::Foot(self.side);
        self.context.tell(plants, extremity, hold, self.memory.pace);
    }
}

/// A place on level ground, moved to the height and the slope of the ground below it.
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

/// Angle of the toes above the heel, radians: the clip's on level ground, 0 on steep slopes, where feet are flat.
fn pitch(context: &Context<'_>, extremity: Extremity, hold: &Hold) -> f64 {
    let clip = &context.clip[extremity.index()];
    let pitch = libm::asin((clip.rotation * DVec3::X).y.clamp(-1.0, 1.0));
    let [steep, level] = FOOT_ROLL_COSINES;
    let upright = hold.normal().dot(context.up);
    pitch * ((upright - steep) / (level - steep)).clamp(0.0, 1.0)
}

/// The place of a foot on its hold, rolled over its heel if `pitch` is positive, else over its ball.
fn rolled(hold: &Hold, shape: &LimbShape, pitch: f64) -> Place {
    let flat = hold.place();
    // Z points to the right, so a positive turn raises the toes.
    let turn: DQuat = rotation_from_axis_angle(DVec3::Z, pitch);
    let rotation = flat.rotation * turn;
    let pivot = if pitch > 0.0 { shape.heel } else { shape.ball };
    Place::with_point_at(flat.point(pivot), pivot, rotation)
}
