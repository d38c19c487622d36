//! How hard each clip shakes each patch, and how it tilts it.

use clamber_surface::mesh::ColliderMesh;
use clamber_surface::rig::{Clip, Playback};
use clamber_surface::surface::SurfaceError;
use glam::{DVec3, Vec3};

use crate::graph::Patch;
use crate::progress::{Stage, Tell};
use crate::{GraphConfig, GraphSource, NavigationError};

/// Length of a slice of a clip, seconds.
pub(crate) const SLICE: f64 = 0.5;

/// The clips are played in ticks of this length, seconds.
const TICK: f64 = 1.0 / 60.0;

/// Shakes are stored in steps of this size, metres a second squared; the largest stands for all larger ones.
const STEP: f64 = 0.25;

/// Tilts are stored in steps of this size, in cosines.
const COSINE: f64 = 1.0 / 127.0;

/// A clip, by its slices.
#[derive(Clone, Debug)]
pub(crate) struct ClipSlices {
    pub(crate) name: String,
    /// Length, seconds.
    pub(crate) seconds: f64,
    first: usize,
    count: usize,
}

/// A patch in a slice of a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moment {
    /// The hardest shake, metres a second squared: never too low, unless it is beyond 63.75.
    pub(crate) shake: f64,
    /// By how much the shake exceeds what holding on costs no more for, on average, metres a second squared.
    pub(crate) excess: f64,
    /// The lowest cosine of the slope.
    pub(crate) upright: f64,
}

/// All clips of a creature.
#[derive(Clone, Debug)]
pub(crate) struct ClipFacts {
    pub(crate) clips: Vec<ClipSlices>,
    patches: usize,
    /// Shake, excess and slope of each patch in each slice: `slice * patches + patch`.
    moments: Vec<[u8; 3]>,
}

impl ClipFacts {
    /// Plays all clips of a creature, each from its beginning to its end.
    pub(crate) fn measure(
        source: &GraphSource<'_>,
        config: &GraphConfig,
        patches: &[Patch],
        tell: &mut Tell<'_>,
    ) -> Result<Self, NavigationError> {
        let mut facts = Self {
            clips: Vec::new(),
            patches: patches.len(),
            moments: Vec::new(),
        };
        for (done, clip) in source.clips.iter().enumerate() {
            tell.now(Stage::Clips, done, source.clips.len())?;
            facts.play(clip, source, config, patches)?;
        }
        Ok(facts)
    }

    fn play(
        &mut self,
        clip: &Clip,
        source: &GraphSource<'_>,
        config: &GraphConfig,
        patches: &[Patch],
    ) -> Result<(), NavigationError> {
        let count = ((clip.duration() / SLICE).ceil() as usize).max(1);
        let first = self.moments.len() / patches.len().max(1);
        self.clips.push(ClipSlices {
            name: clip.name.clone(),
            seconds: clip.duration(),
            first,
            count,
        });
        let per_slice = (SLICE / TICK).round() as usize;
        let ticks = ((clip.duration() / TICK).ceil() as usize).max(1);
        let mut riders = vec![Rider::default(); patches.len()];
        let mut pose = source.skeleton.rest_pose();
        let mut palette = source.skeleton.palette(&pose)?;
        let mut skin: Vec<Vec3> = Vec::new();
        for tick in 0..=ticks {
            let time = (tick as f64 * TICK).min(clip.duration());
            clip.sample_into(time, Playback::Clamp, &mut pose)?;
            source.skeleton.palette_into(&pose, &mut palette)?;
            clamber_surface::skin::skin_into(source.mesh, palette.matrices(), &mut skin)
                .map_err(SurfaceError::from)?;
            let frame = Frame {
                source,
                skin: &skin,
                mesh: source.mesh,
            };
            for (rider, patch) in riders.iter_mut().zip(patches) {
                rider.tick(frame.at(patch), config);
            }
            let is_last = tick == ticks;
            if is_last || (tick + 1) % per_slice == 0 {
                let wanted = (first + count) * patches.len();
                if self.moments.len() < wanted {
                    self.moments.extend(riders.iter_mut().map(Rider::moment));
                }
            }
        }
        Ok(())
    }

    /// A patch at a time of a clip, seconds; the clip goes on from its beginning.
    pub(crate) fn at(&self, clip: usize, seconds: f64, patch: usize) -> Moment {
        let Some(clip) = self.clips.get(clip) else {
            return Moment {
                upright: 1.0,
                ..Moment::default()
            };
        };
        let slice = ((seconds / SLICE) as usize) % clip.count;
        let at = (clip.first + slice) * self.patches + patch;
        let [shake, excess, upright] = self.moments.get(at).copied().unwrap_or([0, 0, 254]);
        Moment {
            shake: f64::from(shake) * STEP,
            excess: f64::from(excess) * STEP,
            upright: f64::from(upright) * COSINE - 1.0,
        }
    }

    /// The clip of a name.
    pub(crate) fn find(&self, name: &str) -> Option<usize> {
        self.clips.iter().position(|clip| clip.name == name)
    }
}

/// A pose of the skin.
struct Frame<'a> {
    source: &'a GraphSource<'a>,
    skin: &'a [Vec3],
    mesh: &'a ColliderMesh,
}

impl Frame<'_> {
    /// Where a patch is in the world, and its normal.
    fn at(&self, patch: &Patch) -> (DVec3, DVec3) {
        let vertices = self.mesh.triangles().get(patch.triangle.index());
        let corner = |k: usize| {
            let vertex = vertices.map(|vertices| vertices[k].index());
            let corner = vertex.and_then(|vertex| self.skin.get(vertex));
            corner.copied().unwrap_or_default().as_dvec3()
        };
        let [a, b, c] = [corner(0), corner(1), corner(2)];
        let [u, v, w] = patch.barycentric;
        let place = self.source.world_from_model;
        let normal = place.rotation * (b - a).cross(c - a);
        (place.transform_point(a * u + b * v + c * w), normal.normalize_or_zero())
    }
}

/// Somebody who rides on a patch.
#[derive(Clone, Copy, Debug, Default)]
struct Rider {
    place: Option<DVec3>,
    velocity: Option<DVec3>,
    shake: DVec3,
    hardest: f64,
    excess: f64,
    ticks: f64,
    lowest: f64,
}

impl Rider {
    fn tick(&mut self, (place, normal): (DVec3, DVec3), config: &GraphConfig) {
        let climber = &config.climber;
        let velocity = self.place.map(|before| (place - before) / TICK);
        if let (Some(velocity), Some(before)) = (velocity, self.velocity) {
            let kept = libm::exp(-TICK / climber.shake_time);
            self.shake = self.shake * kept + (velocity - before) / TICK * (1.0 - kept);
        }
        (self.place, self.velocity) = (Some(place), velocity);
        let shake = self.shake.length();
        let threshold = climber.stamina.map_or(f64::INFINITY, |stamina| stamina.shake_threshold);
        self.hardest = self.hardest.max(shake);
        self.excess += (shake - threshold).max(0.0);
        self.lowest = if self.ticks == 0.0 {
            normal.dot(climber.up())
        } else {
            self.lowest.min(normal.dot(climber.up()))
        };
        self.ticks += 1.0;
    }

    /// What was since the last time.
    fn moment(&mut self) -> [u8; 3] {
        let steps = |value: f64| (value / STEP).ceil().clamp(0.0, 255.0) as u8;
        let mean = self.excess / self.ticks.max(1.0);
        let upright = ((self.lowest + 1.0) / COSINE).floor().clamp(0.0, 254.0) as u8;
        let moment = [steps(self.hardest), (mean / STEP).round().clamp(0.0, 255.0) as u8, upright];
        (self.hardest, self.excess, self.ticks) = (0.0, 0.0, 0.0);
        moment
    }
}
