//! Tests of a step: a walker on skin.

mod bad_input;
mod falling;
mod restoring;
mod standing;
mod walking;

use std::sync::Arc;

use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Obstacle, ObstacleId};
use glam::{DAffine3, DVec3, Vec3};

use crate::{Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, StepReport};

/// Length of a tick, seconds.
const DT: f64 = 1.0 / 60.0;

/// No input.
const IDLE: ClimberInput = ClimberInput::IDLE;

const fn walking(walk: DVec3) -> ClimberInput {
    ClimberInput { walk, ..IDLE }
}

const fn changed(from: ClimberMode, to: ClimberMode) -> ClimberEvent {
    ClimberEvent::Changed { from, to }
}

/// A surface of triangles over the XZ plane, on one joint.
fn patch(corners: &[(f32, f32, f32)], triangles: &[[u32; 3]]) -> SkinnedSurface {
    let positions: Vec<Vec3> = corners
        .iter()
        .map(|&(x, y, z)| Vec3::new(x, y, z))
        .collect();
    let source = MeshSource::rigid(&positions, triangles);
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    SkinnedSurface::new(Arc::new(mesh))
}

/// A square of 40 m at height 0.
fn level() -> SkinnedSurface {
    patch(
        &[
            (-20., 0., -20.),
            (-20., 0., 20.),
            (20., 0., 20.),
            (20., 0., -20.),
        ],
        &[[0, 1, 2], [0, 2, 3]],
    )
}

/// A valley along Z: two planes that rise to both sides at an angle in degrees.
fn trough(degrees: f64) -> SkinnedSurface {
    let rise = (20.0 * libm::tan(degrees.to_radians())) as f32;
    patch(
        &[
            (-20., rise, -20.),
            (-20., rise, 20.),
            (0., 0., 20.),
            (0., 0., -20.),
            (20., rise, 20.),
            (20., rise, -20.),
        ],
        &[[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]],
    )
}

/// Poses the one joint of a patch.
fn pose(surface: &mut SkinnedSurface, map: &DAffine3) {
    let palette = Palette::from_matrices([Affine::from_f64(map)]);
    surface.advance(&palette, Similarity::IDENTITY).unwrap();
}

fn climber_at(x: f64, y: f64, z: f64) -> Climber {
    Climber::new(ClimberConfig::default(), DVec3::new(x, y, z)).unwrap()
}

fn step_on(climber: &mut Climber, surface: &SkinnedSurface, input: &ClimberInput) -> StepReport {
    let obstacles: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), surface)];
    climber.step(input, &obstacles, DT).unwrap()
}

/// A climber that has come to stand on the surface.
fn landed(x: f64, y: f64, z: f64, surface: &SkinnedSurface) -> Climber {
    let mut climber = climber_at(x, y, z);
    for _ in 0..300 {
        step_on(&mut climber, surface, &IDLE);
        if climber.state().mode == ClimberMode::Standing {
            return climber;
        }
    }
    panic!("never landed: {:?}", climber.state());
}
