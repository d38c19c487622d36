//! A steady tick allocates nothing: pose, queries and motion reuse the memory of the first ticks.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use allocation_counter::measure;
use clamber::geometry::{Capsule, Ray};
use clamber::prelude::*;
use clamber::surface::CastOptions;
use clamber_scenes::giant;
use glam::{DQuat, DVec3, Vec3};

/// The surface, and the buffers that are kept between ticks.
struct Scene {
    surface: SkinnedSurface,
    palettes: Vec<Palette>,
    anchors: Vec<Anchor>,
    hits: Vec<SurfaceHit>,
    swept: Vec<SweepHit>,
    positions: Vec<Vec3>,
    found: usize,
}

/// Whether the creature's root moves; if it does, the previous palette is computed again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Root {
    Still,
    Moving,
}

/// Whether a tick's queries touch so many clusters that the next tick is skinned ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MoverContact {
    Little,
    Everything,
}

/// Number of ticks before the counted ones, in which buffers may grow.
const WARM: usize = 4;
/// Number of counted ticks.
const COUNTED: usize = 12;

impl Scene {
    fn new() -> Self {
        let creature = giant::giant().unwrap();
        let palette = |tick: usize| creature.palette("walk", tick as f64 / 60.0).unwrap();
        let palettes = (0..WARM + COUNTED).map(palette).collect();
        let surface = SkinnedSurface::new(creature.rig.collider.clone());
        let triangles = creature.rig.collider.triangles().len() as u32;
        let anchors = (0..triangles).step_by(4_000);
        let anchors = anchors.map(|id| surface.anchor(TriangleId(id), [0.5, 0.25, 0.25]).unwrap());
        Self {
            palettes,
            anchors: anchors.collect(),
            surface,
            hits: Vec::new(),
            swept: Vec::new(),
            positions: Vec::new(),
            found: 0,
        }
    }

    fn tick(&mut self, tick: usize, root: Root, touch: MoverContact) {
        let shift = match root {
            Root::Still => 0.0,
            Root::Moving => tick as f64 * 0.1,
        };
        let world = Similarity {
            rotation: DQuat::IDENTITY,
            scale: 1.0,
            translation: DVec3::new(0.0, 0.0, shift),
        };
        self.surface.advance(&self.palettes[tick], world).unwrap();
        for anchor in &self.anchors {
            let motion = self.surface.in_model().motion(anchor, 1.0 / 60.0).unwrap();
            let origin = motion.position + motion.normal * 0.5;
            let ray = Ray::new(origin, -motion.normal).unwrap();
            let space = self.surface.in_model();
            let hit = space.cast_ray(&ray, 2.0);
            self.found += usize::from(hit.is_some());
            self.found += usize::from(space.intersects_ray(&ray, 2.0));
            let hits = &mut self.hits;
            space.cast_ray_all(&ray, 50.0, hits);
            self.found += hits.len();
            let near = space.closest_point(origin, 2.0);
            self.found += usize::from(near.is_some());
            let body = Capsule::ball(origin, 1.0).unwrap();
            let limb = Capsule::new(origin, motion.position, 0.5).unwrap();
            let (way, swept) = (-motion.normal * 3.0, &mut self.swept);
            for capsule in [&body, &limb] {
                space.overlap_capsule(capsule, hits);
                self.found += hits.len();
                let near = space.closest_to_capsule(capsule, 1.0);
                self.found += usize::from(near.is_some());
                for options in [CastOptions::STILL, CastOptions::MOVING] {
                    let hit = space.cast_capsule(capsule, [way; 2], &options);
                    self.found += usize::from(hit.is_some());
                    space.cast_capsule_all(capsule, [way, Vec3::ZERO], &options, swept);
                    self.found += swept.len();
                }
            }
        }
        if touch == MoverContact::Everything {
            let everything = Capsule::ball(Vec3::ZERO, f32::MAX).unwrap();
            let hits = &mut self.hits;
            self.surface.in_model().overlap_capsule(&everything, hits);
        }
        self.surface.skin_all(&mut self.positions);
    }
}

#[test]
fn a_steady_tick_allocates_nothing() {
    for root in [Root::Still, Root::Moving] {
        for touch in [MoverContact::Little, MoverContact::Everything] {
            let mut scene = Scene::new();
            // Reserves memory for all hits that a tick may have.
            scene.hits.reserve(scene.surface.mesh().triangles().len());
            scene.swept.reserve(scene.surface.mesh().triangles().len());
            for tick in 0..WARM {
                scene.tick(tick, root, touch);
            }
            let case = format!("root {root:?}, touching {touch:?}");
            for tick in WARM..WARM + COUNTED {
                let found = measure(|| scene.tick(tick, root, touch));
                assert_eq!(found.count_total, 0, "{case}, tick {tick}: {found:?}");
            }
            let diagnostics = scene.surface.diagnostics();
            let ahead = diagnostics.clusters_skinned == diagnostics.clusters;
            assert_eq!(
                ahead,
                touch == MoverContact::Everything,
                "{case}: {diagnostics:?}"
            );
            assert!(scene.found > 500, "{case}: {}", scene.found);
        }
    }
}

#[test]
fn the_counter_sees_an_allocation() {
    let mut scene = Scene::new();
    let found = measure(|| scene.tick(0, Root::Still, MoverContact::Little));
    assert!(found.count_total > 0, "{found:?}");
}
