//! Inertialisation: a change of animation shows at once, and the difference to the last pose decays.
//!
//! The offset from the new pose to the old pose starts with the velocity of the difference between them, so the shown
//! pose keeps its velocity. The offset ends in a given time with velocity and acceleration 0 (Bollo 2018,
//! "Inertialization: High-Performance Animation Transitions in Gears of War", GDC). Only the new pose is sampled; an
//! offset costs one polynomial per joint.
//!
//! Bollo decays the length of an offset and drops the velocity perpendicular to it. Here the polynomial has vectors as
//! coefficients, so position and velocity have no jump in any direction. Bollo also shortens the time of an offset
//! whose velocity leads to 0, so that it does not overshoot 0. Here the time is shortened to no less than [`SHORTEST`]
//! of the fade, because a small offset with a large velocity would otherwise stop within a frame.
//!
//! Bollo's offsets start with acceleration 0 unless they would overshoot 0. If a game restarts such an offset in each
//! frame, it hardly slows down, and the pose flies away. So here a new offset takes over the acceleration of the offset
//! that it interrupts. The jerk at the start of a fade of time T is then -60 x / T^3 - 36 v / T^2 - 9 a / T. The
//! solutions of this differential equation decay.
//!
//! A long fade may interrupt a short one, whose speed and acceleration are large for the longer time. Two bounds keep
//! the new offset small. Its acceleration is at most (12 x + 6 v T) / T^2, the value with which the decay of least jerk
//! starts. And its time is shortened if the offset would go far at the speed that it takes over ([`FURTHER`]). With
//! these bounds, offsets that are restarted at random, with fades between 0.05 s and 3 s, stay within 1.6 times the
//! reach of a single offset. Without the bounds they grow.

use clamber_surface::geometry::rotation_vector;
use clamber_surface::rig::{Pose, Transform};
use glam::{DQuat, DVec3, Vec3};

use crate::pose::{rotation_of, store_rotation};
use crate::spring::rotation_from_vector;

/// Lower bound of an offset's time after Bollo's shortening, as a share of its fade. Smaller values let a small offset
/// with a large velocity stop within a frame.
const SHORTEST: f64 = 0.5;

/// The time of an offset that interrupts another one is at most this many times `size / speed`. `speed` is the speed
/// that it takes over. `size` is the largest of three lengths: the offset's own, the interrupted offset's at its start,
/// and the way of the interrupted offset at its start speed divided by this constant. No unit. Without this bound, a
/// long fade that interrupts a short one carries the pose far away.
const FURTHER: f64 = 3.0;

/// [`FURTHER`] shortens the time of an offset to no less than this, seconds.
const SHORT: f64 = 0.05;

/// Offsets shorter than this (metres, radians or scale) that are also slower than this per second are dropped: they are
/// within the rounding of f32.
const NONE: f64 = 1e-7;

/// An offset that decays to 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Decay {
    /// The offset at the start.
    offset: Vec3,
    /// The velocity of the offset at the start, per second.
    velocity: Vec3,
    /// The acceleration that the offset takes over from the interrupted one, per second squared.
    taken_over: Vec3,
    /// Seconds until the offset is 0.
    time: f32,
}

impl Decay {
    /// The decay of an offset within `time` seconds, or sooner if it would overshoot 0; `None` if offset and velocity
    /// are negligible. `before` is the decay that it interrupts, if any, with the seconds since that decay started.
    pub(crate) fn new(
        offset: DVec3,
        velocity: DVec3,
        time: f64,
        before: Option<(&Self, f64)>,
    ) -> Option<Self> {
        if offset.length() < NONE && velocity.length() < NONE {
            return None;
        }
        let (mut time, mut taken_over) = (time, DVec3::ZERO);
        if let Some((before, elapsed)) =
            before.filter(|(before, elapsed)| !before.is_over(*elapsed))
        {
            let [speed, acceleration] = before.motion_at(elapsed);
            let size = before.size().max(offset.length());
            time = time.min((FURTHER * size / speed.length()).max(SHORT));
            let most = (12.0 * offset.length() + 6.0 * velocity.length() * time) / (time * time);
            taken_over = acceleration.clamp_length_max(most);
        }
        let length_sq = offset.length_squared();
        let closing = -velocity.dot(offset);
        // Bollo's time -5 x / v: with it, the jerk at the end is 0 and the offset falls monotonically.
        let time = if closing > 0.0 && length_sq > 0.0 {
            time.min((5.0 * length_sq / closing).max(SHORTEST * time))
        } else {
            time
        };
        Some(Self {
            offset: offset.as_vec3(),
            velocity: velocity.as_vec3(),
            taken_over: taken_over.as_vec3(),
            time: time as f32,
        })
    }

    /// The offset's length at the start, or its start speed times its time over [`FURTHER`] if that is larger.
    fn size(&self) -> f64 {
        let way = f64::from(self.velocity.length()) * f64::from(self.time);
        f64::from(self.offset.length()).max(way / FURTHER)
    }

    /// The offset `elapsed` seconds after the start.
    pub(crate) fn at(&self, elapsed: f64) -> DVec3 {
        let end = f64::from(self.time);
        if elapsed >= end {
            return DVec3::ZERO;
        }
        let [x, vs, accelerations, c3, c4, c5] = self.coefficients();
        let t = elapsed / end;
        let series = c3 + (c4 + c5 * t) * t;
        x + (vs + (accelerations * 0.5 + series * t) * t) * t
    }

    /// Velocity and acceleration `elapsed` seconds after the start. `elapsed` must be before the end.
    fn motion_at(&self, elapsed: f64) -> [DVec3; 2] {
        let end = f64::from(self.time);
        let [_, vs, accelerations, c3, c4, c5] = self.coefficients();
        let t = elapsed / end;
        let velocity = vs + (accelerations + (c3 * 3.0 + (c4 * 4.0 + c5 * (5.0 * t)) * t) * t) * t;
        let acceleration = accelerations + (c3 * 6.0 + (c4 * 12.0 + c5 * (20.0 * t)) * t) * t;
        [velocity / end, acceleration / (end * end)]
    }

    /// The polynomial's coefficients, in powers of the share of the time that has passed. The coefficient of the second
    /// power is stored doubled, as the acceleration.
    fn coefficients(&self) -> [DVec3; 6] {
        let end = f64::from(self.time);
        let (x, v) = (self.offset.as_dvec3(), self.velocity.as_dvec3());
        // Bollo's start acceleration along the offset, with which it does not overshoot 0.
        let direction = x.normalize_or_zero();
        let along = v.dot(direction).min(0.0);
        let wanted = (-8.0 * along * end - 20.0 * x.length()) / (end * end);
        let mut a = self.taken_over.as_dvec3();
        if wanted > 0.0 {
            a += direction * (wanted - a.dot(direction)).max(0.0);
        }
        let (xs, vs, accelerations) = (x, v * end, a * (end * end));
        let c5 = -(accelerations + vs * 6.0 + xs * 12.0) * 0.5;
        let c4 = (accelerations * 3.0 + vs * 16.0 + xs * 30.0) * 0.5;
        let c3 = -(accelerations * 3.0 + vs * 12.0 + xs * 20.0) * 0.5;
        [xs, vs, accelerations, c3, c4, c5]
    }

    /// Upper bound of the offset's length from its start to its end; infinite if the numbers are not finite.
    fn bound(&self) -> f64 {
        let end = f64::from(self.time);
        let parts =
            [self.offset, self.velocity, self.taken_over].map(|part| part.as_dvec3().length());
        // The sum of the bounds of the polynomial's coefficients, and the acceleration that Bollo's rule adds.
        let bound = 112.0 * parts[0] + 50.0 * parts[1] * end + 4.0 * parts[2] * end * end;
        if bound.is_finite() && end >= 0.0 {
            bound
        } else {
            f64::INFINITY
        }
    }

    fn is_over(&self, elapsed: f64) -> bool {
        elapsed >= f64::from(self.time)
    }
}

/// The remaining offsets to the last pose, for each joint that has one.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Offsets {
    joints: Vec<JointOffset>,
    /// Seconds since the change of animation.
    elapsed: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct JointOffset {
    joint: u32,
    /// Rotation vector in the space of the joint's parent.
    rotation: Option<Decay>,
    translation: Option<Decay>,
    scale: Option<Decay>,
}

/// A pose now, and the same animation's pose one step later.
pub(crate) struct Course<'a> {
    pub(crate) now: &'a Pose,
    pub(crate) then: &'a Pose,
}

impl Offsets {
    /// Replaces all offsets by new ones: from the poses `to`, which play from now on, to the poses `from`, which would
    /// have followed without the change. `step` is the time between the two poses of each course, `time` the length of
    /// the fade, both in seconds. `before` are the offsets that decayed until now.
    pub(crate) fn restart(
        &mut self,
        before: &Self,
        from: &Course<'_>,
        to: &Course<'_>,
        [step, time]: [f64; 2],
    ) {
        self.clear();
        let course = from.now.transforms.iter().zip(&from.then.transforms);
        let goal = to.now.transforms.iter().zip(&to.then.transforms);
        let mut running = before.joints.iter().peekable();
        for (joint, (from, to)) in course.zip(goal).enumerate() {
            let joint = joint as u32;
            let before_it = running.next_if(|offset| offset.joint == joint);
            let decay = |[start, next]: [DVec3; 2], part: fn(&JointOffset) -> &Option<Decay>| {
                let running = before_it.and_then(|offset| part(offset).as_ref());
                let running = running.map(|decay| (decay, before.elapsed));
                Decay::new(start, (next - start) / step, time, running)
            };
            let turns = turns([from.0, from.1], [to.0, to.1]);
            let moves = [
                difference(from.0.translation, to.0.translation),
                difference(from.1.translation, to.1.translation),
            ];
            let grows = grows([from.0, from.1], [to.0, to.1]);
            let offset = JointOffset {
                joint,
                rotation: decay(turns, |offset| &offset.rotation),
                translation: decay(moves, |offset| &offset.translation),
                scale: grows.and_then(|grows| decay(grows, |offset| &offset.scale)),
            };
            let parts = [offset.rotation, offset.translation, offset.scale];
            if parts.iter().any(Option::is_some) {
                self.joints.push(offset);
            }
        }
    }

    pub(crate) fn clear(&mut self) {
        self.joints.clear();
        self.elapsed = 0.0;
    }

    /// Advances the time, and drops offsets that have ended.
    pub(crate) fn advance(&mut self, dt: f64) {
        self.elapsed += dt;
        let elapsed = self.elapsed;
        self.joints.retain(|offset| {
            let parts = [offset.rotation, offset.translation, offset.scale];
            parts.iter().flatten().any(|decay| !decay.is_over(elapsed))
        });
    }

    /// True if no offset is left.
    pub(crate) fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// Upper bound of the length of all offsets until they end, in metres, radians or as a change of scale; infinite if
    /// one of the numbers is not finite.
    pub(crate) fn bound(&self) -> f64 {
        if !(0.0..=f64::MAX).contains(&self.elapsed) {
            return f64::INFINITY;
        }
        let parts = self.joints.iter();
        let parts = parts.flat_map(|offset| [offset.rotation, offset.translation, offset.scale]);
        let bounds = parts.flatten().map(|decay| decay.bound());
        bounds.fold(0.0, f64::max)
    }

    /// Adds to a pose the offsets as they are `shift` seconds from now.
    pub(crate) fn add_to(&self, pose: &mut Pose, shift: f64) {
        let elapsed = self.elapsed + shift;
        for offset in &self.joints {
            let Some(joint) = pose.transforms.get_mut(offset.joint as usize) else {
                continue;
            };
            if let Some(decay) = &offset.rotation {
                let turn = rotation_from_vector(decay.at(elapsed));
                store_rotation(joint, turn * rotation_of(joint));
            }
            if let Some(decay) = &offset.translation {
                joint.translation = (joint.translation.as_dvec3() + decay.at(elapsed)).as_vec3();
            }
            if let Some(decay) = &offset.scale {
                joint.scale = (joint.scale.as_dvec3() + decay.at(elapsed)).as_vec3();
            }
        }
    }
}

fn difference(from: Vec3, to: Vec3) -> DVec3 {
    from.as_dvec3() - to.as_dvec3()
}

/// The rotation vectors from the poses `to` to the poses `from`, now and one step later.
fn turns(from: [&Transform; 2], to: [&Transform; 2]) -> [DVec3; 2] {
    let turn = |k: usize| rotation_of(from[k]) * rotation_of(to[k]).conjugate();
    let start = rotation_vector(turn(0));
    [start, nearest_vector(turn(1), start)]
}

/// The rotation vector of a rotation that is nearest to another vector. Near half a turn, vectors of nearly opposite
/// direction are nearly the same rotation.
fn nearest_vector(rotation: DQuat, to: DVec3) -> DVec3 {
    let vector = rotation_vector(rotation);
    if vector.dot(to) >= 0.0 {
        return vector;
    }
    let angle = vector.length();
    let other = vector * ((angle - core::f64::consts::TAU) / angle);
    if (other - to).length_squared() < (vector - to).length_squared() {
        other
    } else {
        vector
    }
}

/// The differences of scale, now and one step later. `None` if a joint is hidden by scale 0: it appears and disappears
/// at once.
fn grows(from: [&Transform; 2], to: [&Transform; 2]) -> Option<[DVec3; 2]> {
    let is_hidden = |joint: &Transform| joint.scale.abs().min_element() == 0.0;
    if from.into_iter().chain(to).any(is_hidden) {
        return None;
    }
    Some([
        difference(from[0].scale, to[0].scale),
        difference(from[1].scale, to[1].scale),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Position, velocity and acceleration by finite differences.
    fn derivatives(decay: &Decay, at: f64) -> [DVec3; 3] {
        let h = 1e-4;
        let [a, b, c] = [-h, 0.0, h].map(|by| decay.at(at + by));
        [b, (c - a) / (2.0 * h), (a + c - b * 2.0) / (h * h)]
    }

    #[test]
    fn an_offset_starts_as_told_and_ends_at_rest() {
        let mut rng = fastrand::Rng::with_seed(1);
        let mut random = |size: f64| DVec3::from([(); 3].map(|()| (rng.f64() * 2.0 - 1.0) * size));
        for _ in 0..1000 {
            let (x, v) = (random(1.0), random(8.0));
            let decay = Decay::new(x, v, 0.4, None).unwrap();
            let [x0, v0, _] = derivatives(&decay, 0.0);
            assert!(
                (x0 - x).length() < 1e-6 && (v0 - v).length() < 2e-2,
                "{x} {v}: {v0}"
            );
            let end = f64::from(decay.time);
            assert!((0.2 - 1e-6..=0.4 + 1e-6).contains(&end));
            let [x1, v1, a1] = derivatives(&decay, end - 1e-3);
            assert!(
                x1.length() < 1e-5 && v1.length() < 5e-2 && a1.length() < 20.0,
                "{v1} {a1}"
            );
            assert_eq!(decay.at(end), DVec3::ZERO);
        }
    }

    #[test]
    fn an_offset_that_closes_quickly_does_not_shoot_past_zero() {
        // Bollo's shortened time prevents overshoot up to twice the speed at which it begins to shorten.
        for speed in [0.0, 1.0, 5.0, 10.0] {
            let decay = Decay::new(DVec3::X, DVec3::NEG_X * speed, 1.0, None).unwrap();
            for k in 0..=100 {
                let x = decay.at(f64::from(k) * 0.01).x;
                assert!((-1e-6..=1.0 + 1e-6).contains(&x), "{speed}: {x}");
            }
        }
    }

    /// Restarts offsets at random, to goals that are fixed and that move, with fades of many lengths. The offset must
    /// stay about as small as in a single fade. Without the bounds in [`Decay::new`] it grows without limit.
    #[test]
    fn offsets_that_start_anew_stay_near() {
        let goals = [0.0, 1.0, 0.5, 0.5, 1.0, 0.0].map(|x| DVec3::X * x);
        let speeds = [0.0, 0.0, 1.0, -1.0, 3.0, -3.0].map(|v| DVec3::X * v);
        let mut rng = fastrand::Rng::with_seed(5);
        for fades in [
            &[1.0][..],
            &[0.3, 0.6],
            &[0.2, 1.67],
            &[0.3, 2.9],
            &[0.05, 0.2, 0.6, 1.67, 3.0],
        ] {
            // How far the largest difference of speeds carries an offset in the longest fade, plus the distance between
            // the goals.
            let longest = fades.iter().copied().fold(0.0, f64::max);
            let reach = 6.0 * longest * 0.16 + 1.0;
            let mut worst = 0f64;
            for frames in [1, 2, 4, 6, 10, 11, 14, 16, 0] {
                let mut goal = 0;
                let mut running: Option<(Decay, f64)> = None;
                for change in 0..4000 {
                    let [before, next] = [goal, rng.usize(0..goals.len())];
                    let (at, speed) = running.map_or_else(Default::default, |(decay, since)| {
                        let h = 1e-5;
                        (decay.at(since), (decay.at(since + h) - decay.at(since)) / h)
                    });
                    let fade = match frames {
                        0 => fades[rng.usize(0..fades.len())],
                        _ => fades[change % fades.len()],
                    };
                    let decay = Decay::new(
                        at + goals[before] - goals[next],
                        speed + speeds[before] - speeds[next],
                        fade,
                        running.as_ref().map(|(decay, since)| (decay, *since)),
                    );
                    goal = next;
                    let frames = if frames == 0 { rng.u32(1..90) } else { frames };
                    let lasts = f64::from(frames) / 60.0;
                    for frame in 0..=frames {
                        let at =
                            decay.map_or(DVec3::ZERO, |decay| decay.at(f64::from(frame) / 60.0));
                        worst = worst.max((at + goals[goal]).length());
                    }
                    running = decay.map(|decay| (decay, lasts));
                }
            }
            println!("fades of {fades:?}: at most {worst:.2} away, {reach:.2} with a single one");
            assert!(worst < 1.6 * reach, "{fades:?}: {worst}, {reach}");
        }
    }

    /// Random decays, also with accelerations that they took over or that a forged file may contain.
    #[test]
    fn no_offset_is_longer_than_its_bound() {
        let mut rng = fastrand::Rng::with_seed(7);
        let mut nearest = 0f64;
        for _ in 0..3000 {
            let size = libm::exp((rng.f64() - 0.5) * 12.0);
            let mut random =
                |size: f64| Vec3::from([(); 3].map(|()| rng.f32() * 2.0 - 1.0)) * size as f32;
            let decay = Decay {
                offset: random(1.0),
                velocity: random(size),
                taken_over: random(size * size),
                time: 0.05 + 3.0 * rng.f32(),
            };
            let bound = decay.bound();
            for step in 0..100 {
                let at = decay
                    .at(f64::from(decay.time) * f64::from(step) * 0.01)
                    .length();
                assert!(at <= bound, "{decay:?}: {at} > {bound}");
                nearest = nearest.max(at / bound);
            }
        }
        println!("up to {nearest:.3} of the bound");
        let endless = Decay {
            offset: Vec3::ZERO,
            velocity: Vec3::ZERO,
            taken_over: Vec3::NAN,
            time: 1.0,
        };
        assert_eq!(endless.bound(), f64::INFINITY);
    }

    #[test]
    fn nothing_to_decay_is_nothing() {
        assert_eq!(Decay::new(DVec3::ZERO, DVec3::ZERO, 1.0, None), None);
        let mut offsets = Offsets::default();
        let pose = Pose {
            transforms: vec![Transform::IDENTITY; 3],
        };
        let course = Course {
            now: &pose,
            then: &pose,
        };
        offsets.restart(&Offsets::default(), &course, &course, [1e-3, 0.3]);
        assert!(offsets.is_empty());
    }

    #[test]
    fn rotations_near_half_a_turn_have_no_jump() {
        let start = DVec3::X * 3.1;
        let beyond = rotation_from_vector(DVec3::X * 3.2);
        let next = nearest_vector(beyond, start);
        assert!((next - DVec3::X * 3.2).length() < 1e-9, "{next}");
    }
}
