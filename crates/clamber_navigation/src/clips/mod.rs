//! How hard each clip shakes each patch, and how it tilts it.

use clamber_surface::rig::{Clip, Palette, Playback, Pose};
use clamber_surface::surface::SurfaceError;
use glam::{DVec3, Vec3};

use crate::graph::Patch;
use crate::progress::{Stage, Tell};
use crate::{GraphConfig, GraphSource, NavigationError};

/// Length of a slice of a clip, seconds.
pub(crate) const SLICE: f64 = 0.5;

/// The clips are played in ticks of this length, seconds.
pub(crate) const TICK: f64 = 1.0 / 60.0;

/// Slices times patches of all clips: 300 MB.
const MOST: f64 = 1e8;

/// Slices of a clip, some 14 hours.
const LONGEST: f64 = 1e5;

/// Whoever watches is told every so many ticks.
const TELLS: usize = 256;

/// Shakes are stored in steps of this size, metres a second squared; the largest stands for all larger ones.
const STEP: f64 = 0.25;

/// The hardest shake that is told apart from harder ones, metres a second squared.
pub(crate) const HARDEST: f64 = 255.0 * STEP;

/// Tilts are stored in steps of this size, in cosines.
pub(crate) const COSINE: f64 = 1.0 / 127.0;

/// A clip, by its slices.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ClipSlices {
    pub(crate) name: String,
    first: usize,
    pub(crate) count: usize,
    /// It ends as it begins.
    pub(crate) loops: bool,
}

/// A patch in a slice of a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moment {
    /// The hardest shake at the ends of ticks, metres a second squared, rounded up; infinite from [`HARDEST`] on.
    pub(crate) shake: f64,
    /// By how much the shake exceeds what holding on costs no more for, on average, metres a second squared.
    pub(crate) excess: f64,
    /// The lowest cosine of the slope.
    pub(crate) upright: f64,
}

/// All clips of a creature.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct ClipFacts {
    pub(crate) clips: Vec<ClipSlices>,
    /// How fast they are played.
    rate: f64,
    patches: usize,
    /// Shake, excess and slope of each patch in each slice: `slice * patches + patch`.
    moments: Vec<[u8; 3]>,
}

impl ClipFacts {
    /// Plays all clips of a creature, each from its beginning to its end; what is a loop, through its seam as well.
    pub(crate) fn measure(
        source: &GraphSource<'_>,
        config: &GraphConfig,
        patches: &[Patch],
        tell: &mut Tell<'_>,
    ) -> Result<Self, NavigationError> {
        let mut facts = Self {
            clips: Vec::new(),
            rate: source.rate,
            patches: patches.len(),
            moments: Vec::new(),
        };
        for (done, clip) in source.clips.iter().enumerate() {
            tell.now(Stage::Clips, done, source.clips.len())?;
            let mut tell = || tell.now(Stage::Clips, done, source.clips.len());
            facts.play(clip, source, config, patches, &mut tell)?;
        }
        Ok(facts)
    }

    fn play(
        &mut self,
        clip: &Clip,
        source: &GraphSource<'_>,
        config: &GraphConfig,
        patches: &[Patch],
        tell: &mut dyn FnMut() -> Result<(), NavigationError>,
    ) -> Result<(), NavigationError> {
        let lasts = clip.duration() / self.rate;
        let slices = lasts / SLICE + 1.0;
        let all = self.moments.len() as f64 + slices * patches.len() as f64;
        if !(slices <= LONGEST && all <= MOST) {
            return Err(NavigationError::TooLong {
                clip: clip.name.clone(),
                seconds: lasts,
            });
        }
        let count = ((lasts / SLICE).ceil() as usize).max(1);
        let last = self.clips.last();
        let first = last.map_or(0, |last| last.first + last.count);
        let per_slice = (SLICE / TICK).round() as usize;
        let ticks = ((lasts / TICK).ceil() as usize).max(1);
        let rules = Rules::new(source, config);
        let seats: Vec<Seat> = patches
            .iter()
            .map(|patch| Seat::new(source, patch))
            .collect();
        let mut riders = vec![Rider::default(); patches.len()];
        let mut played = Played::new(source, clip)?;
        // What comes before the beginning of a loop is its end.
        let loops = played.is_loop(&seats, lasts, self.rate, tell)?;
        let lead = if loops { ticks.min(LEAD) } else { 0 };
        self.clips.push(ClipSlices {
            name: clip.name.clone(),
            first,
            count,
            loops,
        });
        for tick in 0..=ticks + lead {
            if tick.is_multiple_of(TELLS) {
                tell()?;
            }
            let seconds = (tick as f64 - lead as f64) * TICK;
            let time = if lead > 0 {
                (seconds * self.rate).rem_euclid(clip.duration().max(f64::MIN_POSITIVE))
            } else {
                (seconds * self.rate).min(clip.duration())
            };
            let skin = played.at(time)?;
            for (rider, seat) in riders.iter_mut().zip(&seats) {
                rider.tick(seat.at(skin), tick, &rules);
            }
            let Some(tick) = tick.checked_sub(lead) else {
                continue;
            };
            if tick == 0 && lead > 0 {
                // Only the motion counts that it has had.
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

    /// How fast the clips are played.
    pub(crate) fn rate(&self) -> f64 {
        self.rate
    }

    /// The number of a slice of a clip among those of all clips; the clip goes on from its beginning.
    pub(crate) fn slice(&self, clip: usize, slice: usize) -> Option<usize> {
        let clip = self.clips.get(clip)?;
        Some(clip.first + slice % clip.count)
    }

    /// The clip of a slice, by its number among those of all clips.
    pub(crate) fn clip_of(&self, slice: usize) -> usize {
        let after = self.clips.partition_point(|clip| clip.first <= slice);
        after.saturating_sub(1)
    }

    /// True if a slice follows on another one within a clip. The last slice of a loop is shorter than others, so that it
    /// may be passed over.
    pub(crate) fn goes_on(&self, slice: usize, next: usize) -> bool {
        self.clips.get(self.clip_of(slice)).is_some_and(|clip| {
            let left = (clip.first + clip.count).saturating_sub(slice + 1);
            let begins_anew = clip.loops && left <= 1 && next == clip.first;
            begins_anew || left > 0 && next == slice + 1
        })
    }

    /// How long a clip is, in whole slices, seconds.
    pub(crate) fn seconds(&self, clip: usize) -> f64 {
        self.clips
            .get(clip)
            .map_or(SLICE, |clip| clip.count as f64 * SLICE)
    }

    /// A patch in a slice, of those of all clips.
    pub(crate) fn at(&self, slice: usize, patch: usize) -> Moment {
        let moment = self.moments.get(slice * self.patches + patch);
        let [shake, excess, upright] = moment.copied().unwrap_or([0, 0, 254]);
        Moment {
            shake: if shake == u8::MAX {
                f64::INFINITY
            } else {
                f64::from(shake) * STEP
            },
            excess: f64::from(excess) * STEP,
            upright: f64::from(upright) * COSINE - 1.0,
        }
    }

    /// True if it knows every slice of every clip for so many patches.
    #[cfg(feature = "cache")]
    pub(crate) fn is_sound(&self, patches: usize) -> bool {
        let slices = self.clips.iter().try_fold(0usize, |first, clip| {
            let is_next = clip.first == first && clip.count > 0;
            first.checked_add(clip.count).filter(|_| is_next)
        });
        let wanted = slices.and_then(|slices| slices.checked_mul(patches));
        self.patches == patches && wanted == Some(self.moments.len())
    }

    /// The clip of a name.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        self.clips.iter().position(|clip| clip.name == name)
    }
}

/// A loop is played for so many ticks before its beginning: some times longer than shakes last.
const LEAD: usize = 60;

/// A clip is no loop if some skin is more than `JUMP` times as fast at the seam as anywhere within the clip, and faster
/// than `SLOW` heights of the creature a second.
const JUMP: f64 = 1.5;
const SLOW: f64 = 0.01;

/// How fast skin is within a clip is looked at in one of so many ticks.
const STRIDE: usize = 4;

/// A clip, and the skin as it is in it.
struct Played<'a> {
    source: &'a GraphSource<'a>,
    clip: &'a Clip,
    pose: Pose,
    palette: Palette,
    skin: Vec<Vec3>,
}

impl<'a> Played<'a> {
    fn new(source: &'a GraphSource<'a>, clip: &'a Clip) -> Result<Self, NavigationError> {
        let pose = source.skeleton.rest_pose();
        Ok(Self {
            palette: source.skeleton.palette(&pose)?,
            source,
            clip,
            pose,
            skin: Vec::new(),
        })
    }

    /// The skin at a time of the clip, in the space of the model.
    fn at(&mut self, time: f64) -> Result<&[Vec3], NavigationError> {
        let source = self.source;
        self.clip
            .sample_into(time, Playback::Clamp, &mut self.pose)?;
        source
            .skeleton
            .palette_into(&self.pose, &mut self.palette)?;
        clamber_surface::skin::skin_into(source.mesh, self.palette.matrices(), &mut self.skin)
            .map_err(SurfaceError::from)?;
        Ok(&self.skin)
    }

    fn places(&mut self, seats: &[Seat], time: f64) -> Result<Vec<DVec3>, NavigationError> {
        let skin = self.at(time)?;
        Ok(seats.iter().map(|seat| seat.at(skin).0).collect())
    }

    /// True if no seat is much faster from the clip's end to its beginning than within it.
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
        for tick in (1..=ticks).step_by(STRIDE) {
            if tick % TELLS < STRIDE {
                tell()?;
            }
            let time = |tick: usize| (tick as f64 * TICK * rate).min(duration);
            let before = self.places(seats, time(tick - 1))?;
            let now = self.places(seats, time(tick))?;
            for ((fastest, a), b) in within.iter_mut().zip(&before).zip(&now) {
                *fastest = fastest.max(a.distance(*b));
            }
        }
        // A tick with the seam in its middle.
        let half = (0.5 * TICK * rate).min(duration);
        let end = self.places(seats, duration - half)?;
        let start = self.places(seats, half)?;
        let tall = end.iter().map(|place| place.y);
        let [low, high] = tall.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], y| {
            [low.min(y), high.max(y)]
        });
        let slow = SLOW * (high - low).max(0.0) * TICK;
        let mut seams = end.iter().zip(&start).zip(&within);
        Ok(seams.all(|((a, b), within)| a.distance(*b) <= (JUMP * within).max(slow)))
    }
}

/// What a rider is subject to, in the space of the model, in which a climber may be small or large.
struct Rules {
    up: DVec3,
    scale: f64,
    /// Share of the shake that is kept from tick to tick.
    kept: f64,
    /// Shake up to which holding on costs no more, in the space of the model.
    threshold: f64,
}

impl Rules {
    fn new(source: &GraphSource<'_>, config: &GraphConfig) -> Self {
        let place = source.world_from_model;
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

/// The middle of a patch, as a point of the skin.
struct Seat {
    vertices: [usize; 3],
    barycentric: [f64; 3],
}

impl Seat {
    fn new(source: &GraphSource<'_>, patch: &Patch) -> Self {
        let vertices = source.mesh.triangles().get(patch.triangle.index());
        Self {
            vertices: vertices.map_or([0; 3], |vertices| vertices.map(|vertex| vertex.index())),
            barycentric: patch.barycentric,
        }
    }

    /// Its place in a pose of the skin, and a vector along the normal there, in the space of the model.
    fn at(&self, skin: &[Vec3]) -> (DVec3, DVec3) {
        let [a, b, c] = self.vertices.map(|vertex| skin[vertex].as_dvec3());
        let [u, v, w] = self.barycentric;
        (a * u + b * v + c * w, (b - a).cross(c - a))
    }
}

/// Somebody who rides on a patch, in the space of the model.
#[derive(Clone, Copy, Debug, Default)]
struct Rider {
    place: DVec3,
    velocity: DVec3,
    shake: DVec3,
    /// The square of the hardest shake.
    hardest: f64,
    excess: f64,
    ticks: f64,
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

    /// What was since the last time.
    fn moment(&mut self, rules: &Rules) -> [u8; 3] {
        let steps = |value: f64| value * rules.scale / STEP;
        let hardest = steps(self.hardest.sqrt()).ceil().clamp(0.0, 255.0);
        let mean = steps(self.excess / self.ticks.max(1.0))
            .round()
            .clamp(0.0, 255.0);
        let upright = ((self.lowest + 1.0) / COSINE).floor().clamp(0.0, 254.0);
        (self.hardest, self.excess, self.ticks) = (0.0, 0.0, 0.0);
        [hardest as u8, mean as u8, upright as u8]
    }
}
