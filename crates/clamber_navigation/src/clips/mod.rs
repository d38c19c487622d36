//! Measures how hard each clip shakes each patch, and how it tilts it.

use clamber_surface::mesh::Rig;
use clamber_surface::rig::{Clip, Palette, Playback, Pose};
use clamber_surface::surface::SurfaceError;
use glam::{DVec3, Vec3};

use crate::graph::Patch;
use crate::progress::{Stage, Tell};
use crate::{GraphConfig, NavigationError};

/// Length of a slice of a clip, seconds. Clips and forecasts are stored in slices. Shorter slices take more memory.
pub(crate) const SLICE_SECONDS: f64 = 0.5;

/// Length of the ticks in which clips are played, seconds.
pub(crate) const TICK: f64 = 1.0 / 60.0;

/// The most slices times patches of all clips. At three bytes each they take 300 MB.
const MOST_SLICES_OF_PATCHES: f64 = 1e8;

/// The most slices of a clip, some 14 hours.
const MOST_SLICES_OF_CLIP: f64 = 1e5;

/// Progress is reported once in this many ticks.
const TICKS_PER_REPORT: usize = 256;

/// Shakes are stored in steps of this size, metres per second squared. The largest stored value stands for all larger
/// ones.
const SHAKE_STEP: f64 = 0.25;

/// Shakes from this on are stored as infinite, metres per second squared.
pub(crate) const HARDEST: f64 = 255.0 * SHAKE_STEP;

/// Size of the steps in which tilts are stored, as cosines of the slope.
pub(crate) const COSINE_STEP: f64 = 1.0 / 127.0;

/// A clip's slices.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ClipSlices {
    pub(crate) name: String,
    /// The number of its first slice among the slices of all clips.
    first: usize,
    /// Number of slices.
    pub(crate) count: usize,
    /// True if the clip can be played as a loop.
    pub(crate) loops: bool,
}

/// The shake and tilt of a patch in a slice of a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moment {
    /// The hardest shake at the ends of ticks, metres per second squared, rounded up; infinite from [`HARDEST`] on.
    pub(crate) shake: f64,
    /// The mean excess of the shake over the threshold up to which holding on costs no more, metres per second squared.
    pub(crate) excess: f64,
    /// The lowest cosine of the slope.
    pub(crate) upright: f64,
}

/// Shakes and tilts of all patches in all clips of a creature.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ClipFacts {
    pub(crate) clips: Vec<ClipSlices>,
    /// Number of patches.
    patches: usize,
    /// Shake, excess and slope of each patch in each slice: `slice * patches + patch`.
    moments: Vec<[u8; 3]>,
}

impl ClipFacts {
    /// Plays each clip of a creature from its beginning to its end. Loops are played through their seam as well.
    pub(crate) fn measure(
        rig: &Rig,
        config: &GraphConfig,
        patches: &[Patch],
        tell: &mut Tell<'_>,
    ) -> Result<Self, NavigationError> {
        let mut facts = Self {
            clips: Vec::new(),
            patches: patches.len(),
            moments: Vec::new(),
        };
        for (done, clip) in rig.clips.iter().enumerate() {
            tell.now(Stage::Clips, done, rig.clips.len())?;
            let mut tell = || tell.now(Stage::Clips, done, rig.clips.len());
            facts.play(clip, rig, config, patches, &mut tell)?;
        }
        Ok(facts)
    }

    fn play(
        &mut self,
        clip: &Clip,
        rig: &Rig,
        config: &GraphConfig,
        patches: &[Patch],
        tell: &mut dyn FnMut() -> Result<(), NavigationError>,
    ) -> Result<(), NavigationError> {
        let rate = config.clip_rate;
        let lasts = clip.duration() / rate;
        let slices = lasts / SLICE_SECONDS + 1.0;
        let all = self.moments.len() as f64 + slices * patches.len() as f64;
        if !(slices <= MOST_SLICES_OF_CLIP && all <= MOST_SLICES_OF_PATCHES) {
            return Err(NavigationError::TooLong {
                clip: clip.name.clone(),
                seconds: lasts,
            });
        }
        let count = ((lasts / SLICE_SECONDS).ceil() as usize).max(1);
        let last = self.clips.last();
        let first = last.map_or(0, |last| last.first + last.count);
        let per_slice = (SLICE_SECONDS / TICK).round() as usize;
        let ticks = ((lasts / TICK).ceil() as usize).max(1);
        let rules = Rules::new(config);
        let seats: Vec<Seat> = patches.iter().map(|patch| Seat::new(rig, patch)).collect();
        let mut riders = vec![Rider::default(); patches.len()];
        let mut played = Played::new(rig, clip)?;
        // Before its beginning, a loop plays its end.
        let loops = played.is_loop(&seats, lasts, rate, tell)?;
        let lead = if loops { ticks.min(LEAD_TICKS) } else { 0 };
        self.clips.push(ClipSlices {
            name: clip.name.clone(),
            first,
            count,
            loops,
        });
        for tick in 0..=ticks + lead {
            if tick.is_multiple_of(TICKS_PER_REPORT) {
                tell()?;
            }
            let seconds = (tick as f64 - lead as f64) * TICK;
            let time = if lead > 0 {
                (seconds * rate).rem_euclid(clip.duration().max(f64::MIN_POSITIVE))
            } else {
                (seconds * rate).min(clip.duration())
            };
            let skin = played.at(time)?;
            for (rider, seat) in riders.iter_mut().zip(&seats) {
                rider.tick(seat.at(skin), tick, &rules);
            }
            let Some(tick) = tick.checked_sub(lead) else {
                continue;
            };
            if tick == 0 && lead > 0 {
                // Discard the shakes before the clip's beginning. They only set up the riders' motion.
                riders.iter_mut().for_each(|rider| {
                    rider.moment(&rules);
                });
            }
            let is_full = (tick + 1).is_multiple_of(per_slice);
            let wanted = (first + count) * patches.len();
            if (tick == ticks || is_full) && self.moments.len() < wanted {
                let moments = riders.iter_mut().map(|rider| rider.moment(&rules));
                self.moments.extend(moments);
            }
        }
        Ok(())
    }

    /// The number, among the slices of all clips, of a clip's slice. A slice beyond the clip's end wraps around to its
    /// beginning.
    pub(crate) fn slice(&self, clip: usize, slice: usize) -> Option<usize> {
        let clip = self.clips.get(clip)?;
        Some(clip.first + slice % clip.count)
    }

    /// The clip of a slice, by the slice's number among the slices of all clips.
    pub(crate) fn clip_of(&self, slice: usize) -> usize {
        let after = self.clips.partition_point(|clip| clip.first <= slice);
        after.saturating_sub(1)
    }

    /// True if `next` follows on `slice` within a clip, or over a loop's seam. The last slice of a loop is shorter than
    /// the others, so a forecast may leave it out.
    pub(crate) fn goes_on(&self, slice: usize, next: usize) -> bool {
        self.clips.get(self.clip_of(slice)).is_some_and(|clip| {
            let left = (clip.first + clip.count).saturating_sub(slice + 1);
            let begins_anew = clip.loops && left <= 1 && next == clip.first;
            begins_anew || left > 0 && next == slice + 1
        })
    }

    /// Length of a clip in whole slices, seconds.
    pub(crate) fn seconds(&self, clip: usize) -> f64 {
        self.clips
            .get(clip)
            .map_or(SLICE_SECONDS, |clip| clip.count as f64 * SLICE_SECONDS)
    }

    /// The shake and tilt of a patch in a slice, by the slice's number among the slices of all clips.
    pub(crate) fn at(&self, slice: usize, patch: usize) -> Moment {
        let moment = self.moments.get(slice * self.patches + patch);
        let [shake, excess, upright] = moment.copied().unwrap_or([0, 0, 254]);
        Moment {
            shake: if shake == u8::MAX {
                f64::INFINITY
            } else {
                f64::from(shake) * SHAKE_STEP
            },
            excess: f64::from(excess) * SHAKE_STEP,
            upright: f64::from(upright) * COSINE_STEP - 1.0,
        }
    }

    /// True if all slices of all clips are there for this many patches.
    #[cfg(feature = "cache")]
    pub(crate) fn is_sound(&self, patches: usize) -> bool {
        let slices = self.clips.iter().try_fold(0usize, |first, clip| {
            let is_next = clip.first == first && clip.count > 0;
            first.checked_add(clip.count).filter(|_| is_next)
        });
        let wanted = slices.and_then(|slices| slices.checked_mul(patches));
        self.patches == patches && wanted == Some(self.moments.len())
    }

    /// The first clip with a name.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        self.clips.iter().position(|clip| clip.name == name)
    }
}

/// Number of ticks for which a loop is played before its beginning: several times as long as shakes last, so that its
/// first slice starts with the shake of a running loop.
const LEAD_TICKS: usize = 60;

/// A clip is no loop if some skin moves at the seam more than this many times as fast as anywhere within the clip, and
/// faster than [`SLOW_SEAM_SPEED`].
const SEAM_JUMP_FACTOR: f64 = 1.5;
/// Skin slower than this at the seam never rules out a loop, heights of the creature per second.
const SLOW_SEAM_SPEED: f64 = 0.01;

/// Speeds within a clip are measured in one of this many ticks, to save time.
const SPEED_SAMPLE_TICKS: usize = 4;

/// A clip, and the skin in its present pose.
struct Played<'a> {
    rig: &'a Rig,
    clip: &'a Clip,
    pose: Pose,
    palette: Palette,
    /// The skinned positions of the vertices, in model space.
    skin: Vec<Vec3>,
}

impl<'a> Played<'a> {
    fn new(rig: &'a Rig, clip: &'a Clip) -> Result<Self, NavigationError> {
        let pose = rig.skeleton.rest_pose();
        Ok(Self {
            palette: rig.skeleton.palette(&pose)?,
            rig,
            clip,
            pose,
            skin: Vec::new(),
        })
    }

    /// The skin at a time of the clip, in model space.
    fn at(&mut self, time: f64) -> Result<&[Vec3], NavigationError> {
        let rig = self.rig;
        self.clip
            .sample_into(time, Playback::Clamp, &mut self.pose)?;
        rig.skeleton.palette_into(&self.pose, &mut self.palette)?;
        clamber_surface::skin::skin_into(&rig.collider, self.palette.matrices(), &mut self.skin)
            .map_err(SurfaceError::from)?;
        Ok(&self.skin)
    }

    fn places(&mut self, seats: &[Seat], time: f64) -> Result<Vec<DVec3>, NavigationError> {
        let skin = self.at(time)?;
        Ok(seats.iter().map(|seat| seat.at(skin).0).collect())
    }

    /// True if no seat is much faster from the clip's end to its beginning than within the clip.
    fn is_loop(
        &mut self,
        seats: &[Seat],
        lasts: f64,
        rate: f64,
        tell: &mut dyn FnMut() -> Result<(), NavigationError>,
    ) -> Result<bool, NavigationError> {
        let duration = self.clip.duration();
        let ticks = (lasts / TICK) as usize;
        let mut within = vec![0.0f64; seats.len()];
        for tick in (1..=ticks).step_by(SPEED_SAMPLE_TICKS) {
            if tick % TICKS_PER_REPORT < SPEED_SAMPLE_TICKS {
                tell()?;
            }
            let time = |tick: usize| (tick as f64 * TICK * rate).min(duration);
            let before = self.places(seats, time(tick - 1))?;
            let now = self.places(seats, time(tick))?;
            for ((fastest, a), b) in within.iter_mut().zip(&before).zip(&now) {
                *fastest = fastest.max(a.distance(*b));
            }
        }
        // A tick whose middle is the seam.
        let half = (0.5 * TICK * rate).min(duration);
        let end = self.places(seats, duration - half)?;
        let start = self.places(seats, half)?;
        let tall = end.iter().map(|place| place.y);
        let [low, high] = tall.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
            [low.min(y), high.max(y)]
        });
        let slow = SLOW_SEAM_SPEED * (high - low).max(0.0) * TICK;
        let mut seams = end.iter().zip(&start).zip(&within);
        Ok(seams.all(|((a, b), within)| a.distance(*b) <= (SEAM_JUMP_FACTOR * within).max(slow)))
    }
}

/// The numbers that a rider's shakes depend on, in model space, whose units are `scale` metres.
struct Rules {
    /// The direction up in model space.
    up: DVec3,
    /// Metres per model unit.
    scale: f64,
    /// Share of the shake that the low-pass filter keeps from tick to tick.
    kept: f64,
    /// Shake up to which holding on costs no more, model units per second squared.
    threshold: f64,
}

impl Rules {
    fn new(config: &GraphConfig) -> Self {
        let place = config.world_from_model;
        let threshold = config
            .climber
            .stamina
            .map(|stamina| stamina.shake_threshold);
        Self {
            up: place.rotation.conjugate() * config.climber.up(),
            scale: place.scale,
            kept: libm::exp(-TICK / config.climber.shake_time),
            threshold: threshold.unwrap_or(f64::INFINITY) / place.scale,
        }
    }
}

/// The middle of a patch as a point of the skin.
struct Seat {
    vertices: [usize; 3],
    barycentric: [f64; 3],
}

impl Seat {
    fn new(rig: &Rig, patch: &Patch) -> Self {
        let vertices = rig.collider.triangles().get(patch.triangle.index());
        Self {
            vertices: vertices.map_or([0; 3], |vertices| vertices.map(|vertex| vertex.index())),
            barycentric: patch.barycentric,
        }
    }

    /// The point's position in a pose of the skin, and a vector along the normal there, in model space.
    fn at(&self, skin: &[Vec3]) -> (DVec3, DVec3) {
        let [a, b, c] = self.vertices.map(|vertex| skin[vertex].as_dvec3());
        let [u, v, w] = self.barycentric;
        (a * u + b * v + c * w, (b - a).cross(c - a))
    }
}

/// A climber that rides on a patch, in model space.
#[derive(Clone, Copy, Debug, Default)]
struct Rider {
    place: DVec3,
    velocity: DVec3,
    shake: DVec3,
    /// The square of the hardest shake since the last moment.
    hardest: f64,
    /// Sum over the ticks of the shake's excess over the threshold.
    excess: f64,
    /// Number of ticks since the last moment.
    ticks: f64,
    /// The lowest cosine of the slope since the last moment.
    lowest: f64,
}

impl Rider {
    fn tick(&mut self, (place, normal): (DVec3, DVec3), tick: usize, rules: &Rules) {
        let velocity = (place - self.place) / TICK;
        // A velocity is known from the second tick on, an acceleration from the third.
        if tick > 1 {
            let change = (velocity - self.velocity) / TICK;
            self.shake = self.shake * rules.kept + change * (1.0 - rules.kept);
        }
        (self.place, self.velocity) = (place, velocity);
        let squared = self.shake.length_squared();
        self.hardest = self.hardest.max(squared);
        if squared > rules.threshold * rules.threshold {
            self.excess += squared.sqrt() - rules.threshold;
        }
        let upright = normal.dot(rules.up) / normal.length();
        if self.ticks == 0.0 || upright < self.lowest {
            self.lowest = upright;
        }
        self.ticks += 1.0;
    }

    /// The stored shake and tilt since the last call.
    fn moment(&mut self, rules: &Rules) -> [u8; 3] {
        let steps = |value: f64| value * rules.scale / SHAKE_STEP;
        let hardest = steps(self.hardest.sqrt()).ceil().clamp(0.0, 255.0);
        let mean = steps(self.excess / self.ticks.max(1.0))
            .round()
            .clamp(0.0, 255.0);
        let upright = ((self.lowest + 1.0) / COSINE_STEP)
            .floor()
            .clamp(0.0, 254.0);
        (self.hardest, self.excess, self.ticks) = (0.0, 0.0, 0.0);
        [hardest as u8, mean as u8, upright as u8]
    }
}
