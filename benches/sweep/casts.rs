//! Casts and sweeps against a whole creature.

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use clamber::geometry::{Capsule, Sphere};
use clamber::prelude::*;

use clamber_scenes::giant::giant_of;
use clamber_scenes::measure::{Bound, Cells, quantile};
use clamber_scenes::riders::mean_edge;
use glam::Vec3;

use crate::TOLERANCE;
use crate::parry::Parry;

/// One moving sphere, in model space.
pub(crate) struct Cast {
    pub(crate) sphere: Sphere,
    pub(crate) motion: Vec3,
}

/// A walking giant at two ticks.
pub(crate) struct Field {
    /// The giant's skin, posed for the second tick.
    surface: SkinnedSurface,
    /// Palettes at the start and at the end of the swept tick.
    palettes: [Palette; 2],
    parry: Parry,
    edge: f32,
}

/// Length of a sphere's motion, in radii.
const WAY: f32 = 10.0;

/// Height of a sphere's start above the skin, in radii.
const ABOVE: f32 = 3.0;

impl Field {
    pub(crate) fn new(vertices: usize) -> Result<Self, Box<dyn Error>> {
        let creature = giant_of(vertices)?;
        let palette = |seconds: f64| creature.palette("walk", seconds);
        let palettes = [palette(0.5)?, palette(0.5 + 1.0 / 60.0)?];
        let mut surface = SkinnedSurface::new(creature.rig.collider.clone());
        surface.teleport(&palettes[0], Similarity::IDENTITY)?;
        surface.advance(&palettes[1], Similarity::IDENTITY)?;
        Ok(Self {
            parry: Parry::new(&surface)?,
            edge: mean_edge(&creature.rig.collider),
            surface,
            palettes,
        })
    }

    /// Measures casts of spheres with a radius of `edges` mean edge lengths.
    pub(crate) fn measure(
        &mut self,
        edges: f32,
        count: usize,
        bound: Bound,
        cells: &mut Cells,
    ) -> Result<(), Box<dyn Error>> {
        let name = format!("radius {edges} edges");
        let casts = self.casts(edges * self.edge, count)?;
        self.compare(&casts, &name, cells)?;
        let mut times: [Vec<f64>; 5] = Default::default();
        for cast in &casts {
            // `time` runs each query once before it is timed, so that its data is in the caches.
            times[0].push(time(|| self.cast(cast)));
            times[1].push(time(|| self.sweep(cast)));
            times[2].push(time(|| self.parry.cast(cast)));
        }
        for cast in &casts {
            self.renew()?;
            times[3].push(once(|| self.cast(cast)));
            self.renew()?;
            times[4].push(once(|| self.sweep(cast)));
        }
        let [cast, sweep, parry, first_cast, first_sweep] =
            times.map(|mut times| quantile(&mut times, 0.5));
        let mut rows = cells.of(name);
        rows.value("cast, us", cast);
        rows.value("sweep, us", sweep);
        rows.value("parry's cast, us", parry);
        rows.push("parry / cast", parry / cast, bound);
        rows.push("sweep / cast", sweep / cast, Bound::Least(1.3));
        rows.value("cast, first of its tick, us", first_cast);
        rows.value("sweep, first of its tick, us", first_sweep);
        rows.value("parry / cast, first of its tick", parry / first_cast);
        Ok(())
    }

    /// Starts a new tick, in which no vertex is skinned and no bound computed yet.
    fn renew(&mut self) -> Result<(), Box<dyn Error>> {
        self.surface
            .teleport(&self.palettes[0], Similarity::IDENTITY)?;
        self.surface
            .advance(&self.palettes[1], Similarity::IDENTITY)?;
        Ok(())
    }

    fn cast(&self, cast: &Cast) -> Option<SweepHit> {
        self.answer(cast, CastOptions::STILL)
    }

    fn sweep(&self, cast: &Cast) -> Option<SweepHit> {
        self.answer(cast, CastOptions::MOVING)
    }

    fn answer(&self, cast: &Cast, options: CastOptions) -> Option<SweepHit> {
        let ball = Capsule::ball(cast.sphere.center, cast.sphere.radius)?;
        let options = options.with_tolerance(TOLERANCE);
        let space = self.surface.in_model();
        space.cast_capsule(&ball, [cast.motion; 2], &options)
    }

    /// Seeded random casts. They start above random points of the skin, without contact, and move down towards the skin
    /// in a random direction.
    fn casts(&self, radius: f32, count: usize) -> Result<Vec<Cast>, Box<dyn Error>> {
        let mut rng = fastrand::Rng::with_seed(5);
        let mut casts = Vec::with_capacity(count);
        while casts.len() < count {
            let triangle = TriangleId(rng.u32(0..self.surface.mesh().triangles().len() as u32));
            let seat = self.surface.anchor(triangle, [0.5, 0.25, 0.25])?;
            let skin = self.surface.in_model().motion(&seat, 1.0 / 60.0)?;
            let sphere = Sphere {
                center: skin.position + skin.normal * (ABOVE * radius),
                radius,
            };
            let coordinate = |rng: &mut fastrand::Rng| rng.f32() * 2.0 - 1.0;
            let aside = Vec3::from([(); 3].map(|()| coordinate(&mut rng))).normalize_or(Vec3::X);
            let motion = (aside - skin.normal).normalize_or(-skin.normal) * (WAY * radius);
            let space = self.surface.in_model();
            let nearest = space.closest_point(sphere.center, radius * 1.01);
            if nearest.is_none() {
                casts.push(Cast { sphere, motion });
            }
        }
        Ok(casts)
    }

    /// Counts the hits of clamber and parry, and prints the largest difference where both hit. Fails if clamber misses
    /// a hit of parry's, unless parry reports it where there is no skin.
    fn compare(&self, casts: &[Cast], name: &str, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
        let (mut hits, mut only_ours, mut only_theirs, mut worst) = (0, 0, 0, 0.0f64);
        let mut nothing_there = 0;
        for cast in casts {
            match (self.cast(cast), self.parry.cast(cast)) {
                (Some(ours), Some(theirs)) => {
                    hits += 1;
                    // Measured along the motion: in grazing contacts a small difference in depth is a long distance
                    // along it.
                    let off = (ours.fraction - theirs).abs() * f64::from(cast.motion.length());
                    worst = worst.max(off / f64::from(cast.sphere.radius));
                }
                (Some(_), None) => only_ours += 1,
                (None, Some(theirs)) => {
                    let there = cast.sphere.center + cast.motion * theirs as f32;
                    let reach = cast.sphere.radius + TOLERANCE as f32;
                    let skin = self.surface.in_model().closest_point(there, reach);
                    *(if skin.is_some() {
                        &mut only_theirs
                    } else {
                        &mut nothing_there
                    }) += 1;
                }
                (None, None) => {}
            }
        }
        println!(
            "{name}: {hits} hits of {}, worst difference {worst:.1e} radii",
            casts.len()
        );
        let mut rows = cells.of(name);
        rows.value("hits that parry misses", f64::from(only_ours));
        let what = "hits of parry's where no skin is";
        rows.value(what, f64::from(nothing_there));
        if only_theirs > 0 {
            return Err(format!("{name}: clamber misses {only_theirs} hits of parry's").into());
        }
        Ok(())
    }
}

/// Runs `run` twice; returns the microseconds of the second run.
fn time<T>(mut run: impl FnMut() -> T) -> f64 {
    black_box(run());
    once(run)
}

fn once<T>(mut run: impl FnMut() -> T) -> f64 {
    let start = Instant::now();
    black_box(run());
    start.elapsed().as_secs_f64() * 1e6
}
