//! Boxes of fur and stone that move by their root transform, and a climber among them.

use std::sync::Arc;

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberState, StepReport,
};
use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, MeshSource, SurfaceKind, SurfaceTag,
};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DQuat, DVec3, Vec3};

/// Length of a tick, seconds.
pub(crate) const DT: f64 = 1.0 / 60.0;

/// The tag of fur, which can be gripped.
pub(crate) const FUR: SurfaceTag = SurfaceTag::new(SurfaceKind::Fur);

/// The tag of stone with a ledge, which cannot be gripped.
pub(crate) const STONE: SurfaceTag = SurfaceTag::new(SurfaceKind::Stone);

/// A closed box about the origin, its faces in squares of about a metre.
pub(crate) fn cuboid(half: Vec3, tag: SurfaceTag) -> SkinnedSurface {
    cuboid_with(half, |_| tag)
}

/// A [`cuboid`] at a place.
pub(crate) fn cuboid_at(half: Vec3, tag: SurfaceTag, place: DVec3) -> SkinnedSurface {
    let mut surface = cuboid(half, tag);
    placed(&mut surface, place);
    surface
}

/// A [`cuboid`] with a tag for each triangle, chosen by the triangle's centre.
pub(crate) fn cuboid_with(half: Vec3, tag: impl Fn(Vec3) -> SurfaceTag) -> SkinnedSurface {
    let (mut positions, mut triangles, mut tags) = (Vec::new(), Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let count = |k: usize| (half[k] * 2.0).ceil().max(1.0) as u32;
            let (nu, nv) = (count(u), count(v));
            let first = positions.len() as u32;
            for j in 0..=nv {
                for i in 0..=nu {
                    let mut p = Vec3::ZERO;
                    p[axis] = half[axis] * side;
                    p[u] = half[u] * (2.0 * i as f32 / nu as f32 - 1.0);
                    p[v] = half[v] * (2.0 * j as f32 / nv as f32 - 1.0);
                    positions.push(p);
                }
            }
            for j in 0..nv {
                for i in 0..nu {
                    let a = first + j * (nu + 1) + i;
                    let (b, c, d) = (a + 1, a + nu + 2, a + nu + 1);
                    let pair = if side > 0.0 {
                        [[a, b, c], [a, c, d]]
                    } else {
                        [[a, c, b], [a, d, c]]
                    };
                    for triangle in pair {
                        let middle: Vec3 = triangle.map(|k| positions[k as usize]).iter().sum();
                        triangles.push(triangle);
                        tags.push(tag(middle / 3.0));
                    }
                }
            }
        }
    }
    tagged(&positions, &triangles, &tags)
}

/// A surface on one joint, with a tag for each triangle.
pub(crate) fn tagged(
    positions: &[Vec3],
    triangles: &[[u32; 3]],
    tags: &[SurfaceTag],
) -> SkinnedSurface {
    let source = MeshSource {
        tags,
        ..MeshSource::rigid(positions, triangles)
    };
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    SkinnedSurface::new(Arc::new(mesh))
}

/// Places a surface.
pub(crate) fn placed(surface: &mut SkinnedSurface, translation: DVec3) {
    placed_turned(surface, translation, DQuat::IDENTITY);
}

pub(crate) fn placed_turned(surface: &mut SkinnedSurface, translation: DVec3, rotation: DQuat) {
    let place = similarity(translation, rotation);
    surface.teleport(&rest(), place).unwrap();
}

/// Moves a surface within a tick.
pub(crate) fn moved(surface: &mut SkinnedSurface, translation: DVec3) {
    moved_turned(surface, translation, DQuat::IDENTITY);
}

pub(crate) fn moved_turned(surface: &mut SkinnedSurface, translation: DVec3, rotation: DQuat) {
    let place = similarity(translation, rotation);
    surface.advance(&rest(), place).unwrap();
}

/// Places a surface in the first tick, and moves it in every other one.
pub(crate) fn placed_or_moved(surface: &mut SkinnedSurface, translation: DVec3, tick: u32) {
    let set = if tick == 0 { placed } else { moved };
    set(surface, translation);
}

/// Scales a surface to a tenth about its own origin.
pub(crate) fn scaled_down(surface: &mut SkinnedSurface) {
    let world_from_model = Similarity {
        scale: 0.1,
        ..*surface.world_from_model()
    };
    surface.teleport(&rest(), world_from_model).unwrap();
}

/// The pose of a surface's only joint.
pub(crate) fn rest() -> Palette {
    Palette::from_matrices([Affine::IDENTITY])
}

fn similarity(translation: DVec3, rotation: DQuat) -> Similarity {
    Similarity {
        translation,
        rotation,
        scale: 1.0,
    }
}

/// A climber with every ability.
pub(crate) fn climber(position: DVec3) -> Climber {
    Climber::new(ClimberConfig::colossus_climber(), position).unwrap()
}

/// A climber that only walks and jumps.
pub(crate) fn walker(position: DVec3) -> Climber {
    Climber::new(ClimberConfig::walker(), position).unwrap()
}

/// Sets a climber's velocity and the velocity of its frame.
pub(crate) fn throw(climber: &mut Climber, velocity: DVec3, base_velocity: DVec3) {
    let state = ClimberState {
        velocity,
        base_velocity,
        ..*climber.state()
    };
    climber.restore(state).unwrap();
}

/// Sets a climber's position and velocity, and keeps the rest of its state.
pub(crate) fn put(climber: &mut Climber, position: DVec3, velocity: DVec3) {
    let state = ClimberState {
        position,
        velocity,
        ..*climber.state()
    };
    climber.restore(state).unwrap();
}

/// Obstacles with the ids 0, 1, 2 and so on.
pub(crate) fn list<'a>(obstacles: &[&'a dyn Obstacle]) -> Vec<(ObstacleId, &'a dyn Obstacle)> {
    let ids = (0..).map(ObstacleId);
    ids.zip(obstacles.iter().copied()).collect()
}

/// [`list`] of obstacles of any types.
pub(crate) fn list_owned(owned: &[Box<dyn Obstacle>]) -> Vec<(ObstacleId, &dyn Obstacle)> {
    let each: Vec<_> = owned.iter().map(|obstacle| &**obstacle).collect();
    list(&each)
}

/// Steps a climber by one tick at 60 Hz.
pub(crate) fn tick_among(
    climber: &mut Climber,
    obstacles: &[&dyn Obstacle],
    input: &ClimberInput,
) -> StepReport {
    climber.step(input, &list(obstacles), DT).unwrap()
}

/// Steps the climber by one tick among some surfaces.
pub(crate) fn step(
    climber: &mut Climber,
    surfaces: &[&SkinnedSurface],
    input: &ClimberInput,
) -> StepReport {
    let obstacles: Vec<_> = surfaces.iter().map(|one| *one as &dyn Obstacle).collect();
    let report = tick_among(climber, &obstacles, input);
    let state = climber.state();
    assert!(report.is_clear, "{report:?} {state:?}");
    assert!(report.penetration < 1e-3, "{report:?} {state:?}");
    report
}

/// Steps the climber by some ticks with the same input. Returns all events.
pub(crate) fn run(
    climber: &mut Climber,
    surfaces: &[&SkinnedSurface],
    input: &ClimberInput,
    ticks: usize,
) -> Vec<ClimberEvent> {
    (0..ticks)
        .flat_map(|_| step(climber, surfaces, input).events)
        .collect()
}

pub(crate) fn assert_mode(climber: &Climber, mode: ClimberMode) {
    assert_eq!(climber.state().mode, mode, "{:?}", climber.state());
}
