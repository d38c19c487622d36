//! Measures a tick that crushes a climber, compared with a tick in which the climber has room.
//!
//! Boxes of skin close in on a climber from two, five and all 26 directions, until it has three quarters of the room
//! that it needs, and move back. Times are medians over the ticks that crush the climber, and over the other ticks.

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use clamber::prelude::*;
use clamber_scenes::climbs::RATE;
use clamber_scenes::measure::{Bound, Cells, quantile};
use glam::{DQuat, DVec3, Vec3};

/// Length of a tick, seconds.
const DT: f64 = 1.0 / RATE;

/// Half extents of a wall, metres. Y is its thickness.
const HALF: Vec3 = Vec3::new(1.0, 0.5, 1.0);

/// Largest and smallest distance of the walls' faces from the climber's start, metres. The climber's radius is 0.4.
const GAP: [f64; 2] = [0.45, 0.3];

/// Duration of closing in, and again of moving back, seconds.
const CLOSE: f64 = 2.0;

/// Bound: the largest ratio of a tick that crushes to a tick with room.
const MOST: f64 = 5.0;

/// Adds rows for two, five and 26 walls.
pub(crate) fn measure(times: u32, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z, DVec3::NEG_Y];
    let all = (0..27).filter(|index| *index != 13).map(|index| {
        let part = |power: i32| f64::from(index / power % 3 - 1);
        DVec3::new(part(1), part(3), part(9)).normalize()
    });
    let all: Vec<DVec3> = all.collect();
    row("floor and lid", &[DVec3::Y, DVec3::NEG_Y], times, cells)?;
    row("four walls and floor", &axes, times, cells)?;
    row("26 walls", &all, times, cells)
}

fn row(
    name: &str,
    directions: &[DVec3],
    times: u32,
    cells: &mut Cells,
) -> Result<(), Box<dyn Error>> {
    let wall = Arc::new(wall()?);
    let new = |_: &DVec3| SkinnedSurface::new(Arc::clone(&wall));
    let mut walls: Vec<SkinnedSurface> = directions.iter().map(new).collect();
    let (mut free, mut crushed) = (Vec::new(), Vec::new());
    let ticks = (2.0 * CLOSE * RATE) as u32;
    for _ in 0..times {
        let mut climber = Climber::new(ClimberConfig::walker(), DVec3::ZERO)?;
        for tick in 0..ticks {
            let phase = f64::from(tick) * DT / CLOSE;
            let gap = GAP[0] + (GAP[1] - GAP[0]) * phase.min(2.0 - phase);
            for (wall, direction) in walls.iter_mut().zip(directions) {
                let place = Similarity {
                    translation: *direction * (gap + f64::from(HALF.y)),
                    rotation: DQuat::from_rotation_arc(DVec3::Y, *direction),
                    scale: 1.0,
                };
                let rest = Palette::from_matrices([Affine::IDENTITY]);
                if tick == 0 {
                    wall.teleport(&rest, place)?;
                } else {
                    wall.advance(&rest, place)?;
                }
            }
            let numbered = walls.iter().enumerate();
            let obstacles: Vec<(ObstacleId, &dyn Obstacle)> = numbered
                .map(|(index, wall)| (ObstacleId(index as u64), wall as &dyn Obstacle))
                .collect();
            let start = Instant::now();
            let report = climber.step(&ClimberInput::default(), &obstacles, DT)?;
            let time = start.elapsed().as_secs_f64() * 1e6;
            let crushes = |event: &ClimberEvent| matches!(event, ClimberEvent::Crushed { .. });
            if report.events.iter().any(crushes) {
                crushed.push(time);
            } else {
                free.push(time);
            }
        }
    }
    if crushed.is_empty() || free.is_empty() {
        return Err(format!("{name}: the walls crush in every tick, or in none").into());
    }
    let [free, most] = [(&mut free, 0.5), (&mut crushed, 0.9)].map(|(t, part)| quantile(t, part));
    let median = quantile(&mut crushed, 0.5);
    cells.value(&format!("{name}: a tick with room, us"), free);
    cells.value(&format!("{name}: a tick that crushes, us"), median);
    cells.value(&format!("{name}: the slowest tenth of those, us"), most);
    let name = format!("{name}: a tick that crushes / one with room");
    cells.push(&name, median / free, Bound::Most(MOST));
    Ok(())
}

/// The mesh of a wall: a box whose faces are divided into squares of 1 m.
fn wall() -> Result<ColliderMesh, Box<dyn Error>> {
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let [nu, nv] = [u, v].map(|axis| (2.0 * HALF[axis]) as u32);
        for side in [-1.0, 1.0] {
            let first = positions.len() as u32;
            for index in 0..(nu + 1) * (nv + 1) {
                let (i, j) = (index % (nu + 1), index / (nu + 1));
                let mut position = Vec3::ZERO;
                position[axis] = side * HALF[axis];
                position[u] = i as f32 - HALF[u];
                position[v] = j as f32 - HALF[v];
                positions.push(position);
                if i < nu && j < nv {
                    let corner = first + index;
                    let [a, b] = [corner, corner + nu + 2];
                    let [c, d] = [corner + 1, corner + nu + 1];
                    let outward = side > 0.0;
                    let (c, d) = if outward { (c, d) } else { (d, c) };
                    triangles.extend([[a, c, b], [a, b, d]]);
                }
            }
        }
    }
    let source = MeshSource::rigid(&positions, &triangles);
    Ok(ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0)
}
