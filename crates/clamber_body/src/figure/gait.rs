//! Measures from the locomotion clips, once, when each foot is on the ground and how far a cycle goes.

use clamber_animation::{AnimationError, AnimationSet};
use clamber_surface::rig::{Playback, Pose, Skeleton};
use glam::DVec3;

use super::{BodyClip, Clips, Extremity, LimbShape};
use crate::Side;

/// The locomotion clips, in the order of their weights.
pub(crate) const STRIDES: [BodyClip; 5] = [
    BodyClip::Walk,
    BodyClip::Run,
    BodyClip::WalkBack,
    BodyClip::StrafeLeft,
    BodyClip::StrafeRight,
];

/// Number of phases at which a clip is sampled. Phases of contact are exact to one sample.
const PHASE_SAMPLES: usize = 96;

/// Height of a sole above its lowest point, as a share of the leg's length, below which a foot can be on the ground.
const CONTACT_HEIGHT: f64 = 0.04;

/// Level speed of a sole over ground, as a share of the gait's speed, below which a foot can be on the ground. Unreal's
/// foot placement has 0.6 m/s for a walk.
const CONTACT_SPEED: f64 = 0.45;

/// Length of a cycle, and of the way in a second, as a share of the leg's length, for a clip without a ground speed.
const DEFAULT_STRIDE: f64 = 1.6;

/// Phases at which the left and the right foot come down, as shares of a cycle, where the clip does not tell.
const DEFAULT_DOWN_PHASES: [f64; 2] = [0.0, 0.5];

/// Phases at which the left and the right foot leave the ground, as shares of a cycle, where the clip does not tell.
const DEFAULT_UP_PHASES: [f64; 2] = [0.6, 0.1];

/// One cycle of a gait, in which each foot steps once. Phases are shares of the cycle; the left foot comes down at
/// phase 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stride {
    /// Metres per cycle.
    pub(crate) length: f64,
    /// Speed for which the clip was made, metres a second.
    pub(crate) speed: f64,
    /// Phases at which the left and the right foot come down.
    pub(crate) down: [f64; 2],
    /// Phases at which the left and the right foot leave the ground.
    pub(crate) up: [f64; 2],
    /// Positions of the left and the right sole when the foot comes down, metres in model space.
    pub(crate) landing: [DVec3; 2],
    /// Start of phase 0, as a share of the clip's length.
    pub(crate) start: f64,
}

#[derive(Clone, Debug)]
pub(crate) struct Gait {
    strides: [Stride; STRIDES.len()],
}

impl Gait {
    pub(crate) fn new(
        skeleton: &Skeleton,
        set: &AnimationSet,
        clips: &Clips,
        limbs: &[LimbShape; 4],
        facing: DVec3,
        scale: f64,
    ) -> Result<Self, AnimationError> {
        let left = DVec3::Y.cross(facing);
        let ways = [facing, facing, -facing, left, -left];
        let mut strides = Vec::with_capacity(STRIDES.len());
        for (clip, way) in STRIDES.into_iter().zip(ways) {
            let clip = set.clip(clips.get(clip))?;
            let speed = clip.ground_speed().map(|speed| speed * scale);
            let mut soles = [[DVec3::ZERO; PHASE_SAMPLES]; 2];
            let mut heights = [[0.0; PHASE_SAMPLES]; 2];
            let mut pose = Pose::default();
            for index in 0..PHASE_SAMPLES {
                pose.transforms.clone_from(&set.rest().transforms);
                let time = clip.duration() * index as f64 / PHASE_SAMPLES as f64;
                clip.sample_into(time, Playback::Loop, &mut pose)?;
                for side in Side::BOTH {
                    let shape = &limbs[Extremity::Foot(side).index()];
                    let Some(place) = shape.place(skeleton, &pose, scale) else {
                        continue;
                    };
                    soles[side.index()][index] = place.point(shape.contact);
                    let ends = [shape.heel, shape.ball].map(|point| place.point(point).y);
                    heights[side.index()][index] = ends[0].min(ends[1]);
                }
            }
            let leg = limbs[2].length;
            strides.push(measure(&soles, &heights, way, clip.duration(), speed, leg));
        }
        let strides = core::array::from_fn(|index| strides[index]);
        Ok(Self { strides })
    }

    pub(crate) fn strides(&self) -> &[Stride; STRIDES.len()] {
        &self.strides
    }

    /// The stride of a mix of clips; the shares sum to 1.
    pub(crate) fn mixed(&self, shares: &[f64; STRIDES.len()]) -> Stride {
        let mut mixed = Stride {
            length: 0.0,
            speed: 0.0,
            down: [0.0; 2],
            up: [0.0; 2],
            landing: [DVec3::ZERO; 2],
            start: 0.0,
        };
        let mut turns = [[0.0; 2]; 4];
        for (stride, share) in self.strides.iter().zip(shares) {
            mixed.length += stride.length * share;
            mixed.speed += stride.speed * share;
            for side in 0..2 {
                mixed.landing[side] += stride.landing[side] * *share;
                for (turn, phase) in [(side, stride.down[side]), (2 + side, stride.up[side])] {
                    let (sin, cos) = libm::sincos(core::f64::consts::TAU * phase);
                    turns[turn][0] += cos * share;
                    turns[turn][1] += sin * share;
                }
            }
        }
        let phase = |turn: [f64; 2]| {
            (libm::atan2(turn[1], turn[0]) / core::f64::consts::TAU).rem_euclid(1.0)
        };
        mixed.down = [phase(turns[0]), phase(turns[1])];
        mixed.up = [phase(turns[2]), phase(turns[3])];
        mixed
    }
}

impl Stride {
    /// Progress of a foot's step at a phase, 0 to 1, and the share of the cycle until the foot comes down. `None` while
    /// the foot is on the ground.
    pub(crate) fn step(&self, side: Side, phase: f64) -> Option<(f64, f64)> {
        let (down, up) = (self.down[side.index()], self.up[side.index()]);
        let air = (down - up).rem_euclid(1.0);
        let since = (phase - up).rem_euclid(1.0);
        (since < air).then(|| (since / air, air - since))
    }
}

fn measure(
    soles: &[[DVec3; PHASE_SAMPLES]; 2],
    heights: &[[f64; PHASE_SAMPLES]; 2],
    way: DVec3,
    duration: f64,
    speed: Option<f64>,
    leg: f64,
) -> Stride {
    let mut stride = Stride {
        length: speed.map_or(DEFAULT_STRIDE * leg, |speed| speed * duration),
        speed: speed.unwrap_or(DEFAULT_STRIDE * leg),
        down: DEFAULT_DOWN_PHASES,
        up: DEFAULT_UP_PHASES,
        landing: [0, 1].map(|side| soles[side][0]),
        start: 0.0,
    };
    let Some(speed) = speed.filter(|speed| *speed > 0.0 && duration > 0.0) else {
        return stride;
    };
    let step = duration / PHASE_SAMPLES as f64;
    for side in 0..2 {
        let floor = heights[side].iter().copied().fold(f64::INFINITY, f64::min);
        let stands: [bool; PHASE_SAMPLES] = core::array::from_fn(|index| {
            let moved = soles[side][(index + 1) % PHASE_SAMPLES] - soles[side][index];
            let over_ground = moved / step + way * speed;
            let level = DVec3::new(over_ground.x, 0.0, over_ground.z).length();
            heights[side][index] - floor < CONTACT_HEIGHT * leg && level < CONTACT_SPEED * speed
        });
        if let Some((first, count)) = longest(&stands) {
            stride.down[side] = first as f64 / PHASE_SAMPLES as f64;
            stride.up[side] = ((first + count) % PHASE_SAMPLES) as f64 / PHASE_SAMPLES as f64;
            stride.landing[side] = soles[side][first];
        }
    }
    stride.start = stride.down[0];
    for phase in stride.down.iter_mut().chain(&mut stride.up) {
        *phase = (*phase - stride.start).rem_euclid(1.0);
    }
    stride
}

/// The first index and the length of the longest run of `true` in a circle. `None` if all values are equal.
fn longest(circle: &[bool; PHASE_SAMPLES]) -> Option<(usize, usize)> {
    let starts = (0..PHASE_SAMPLES)
        .filter(|&k| circle[k] && !circle[(k + PHASE_SAMPLES - 1) % PHASE_SAMPLES]);
    let run = |start: usize| {
        (0..PHASE_SAMPLES)
            .take_while(|k| circle[(start + k) % PHASE_SAMPLES])
            .count()
    };
    starts
        .map(|start| (start, run(start)))
        .max_by_key(|(start, count)| (*count, PHASE_SAMPLES - start))
}
