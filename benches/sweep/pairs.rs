//! Single triangles: clamber's sweeps, eight triangles at a time, compared with additive CCD.

use std::error::Error;
use std::sync::Arc;
use std::time::Duration;

use clamber::geometry::Capsule;
use clamber::prelude::*;
use clamber::surface::CastOptions;
use clamber_scenes::measure::{Bound, Cells, median_us};
use glam::{DVec3, Vec3};

use crate::TOLERANCE;
use crate::additive::{End, MOST_STEPS, additive};

/// Radius of the sphere, metres. The sphere stays at the origin. It is larger than the sheets that move into it or past
/// it.
const RADIUS: f32 = 1.0;

/// Number of rows of a sheet, and of vertices in a row. The 49 vertices make one cluster.
const ROWS: usize = 7;

/// Half the width of a sheet, metres.
const HALF: f32 = 0.4;

/// The vertices of a sheet, row by row, at both ends of its motion.
type Sheet = [Vec<Vec3>; 2];

pub(crate) fn measure(count: usize, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    let mut rng = fastrand::Rng::with_seed(6);
    let sets: [(&str, Vec<Sheet>); 2] = [
        (
            "sheets that turn and fly into the sphere",
            (0..count).map(|_| nearing(&mut rng)).collect(),
        ),
        // The case in which additive CCD is slowest.
        (
            "sheets that slide by",
            (0..count / 10).map(|_| sliding(&mut rng)).collect(),
        ),
    ];
    for (name, sheets) in sets {
        let triangles: Vec<_> = sheets.iter().flat_map(triangles_of).collect();
        let ours = ours(name, &sheets)? * 1e3 / triangles.len() as f64;
        cells.value(&format!("{name}: ours, ns a triangle"), ours);
        let ends = [
            ("to a tenth of the gap", End::Share),
            ("to our tolerance", End::Tolerance(TOLERANCE)),
        ];
        for (until, end) in ends {
            let name = format!("{name}: additive CCD {until}");
            let (theirs, given_up) = additive_of(&name, &triangles, end);
            let theirs = theirs * 1e3 / triangles.len() as f64;
            cells.value(&format!("{name}, ns a triangle"), theirs);
            cells.push(&format!("{name} / ours"), theirs / ours, Bound::None);
            cells.value(&format!("{name}: share given up"), given_up);
        }
    }
    Ok(())
}

/// The time of clamber's sweeps for all sheets, each on its own surface, microseconds.
fn ours(name: &str, sheets: &[Sheet]) -> Result<f64, Box<dyn Error>> {
    let surfaces = sheets.iter().map(posed).collect::<Result<Vec<_>, _>>()?;
    let ball = Capsule::ball(Vec3::ZERO, RADIUS).ok_or("no ball")?;
    let options = CastOptions::MOVING.with_tolerance(TOLERANCE);
    let mut hits = Vec::new();
    let mut found = 0;
    let time = median_us(Duration::from_millis(300), || {
        found = 0;
        for surface in &surfaces {
            let space = surface.in_model();
            space.cast_capsule_all(&ball, [Vec3::ZERO; 2], &options, &mut hits);
            found += hits.len();
        }
    });
    let steps = surfaces
        .iter()
        .map(|s| s.diagnostics().most_cast_steps)
        .max();
    println!("{name}: ours: {found} contacts, at most {steps:?} steps");
    Ok(time)
}

/// The time of additive CCD for all triangles, microseconds, and the share of triangles that reach the limit of steps.
fn additive_of(name: &str, triangles: &[[[Vec3; 3]; 2]], end: End) -> (f64, f64) {
    let (mut found, mut capped, mut most) = (0, 0, 0);
    let time = median_us(Duration::from_millis(300), || {
        (found, capped, most) = (0, 0, 0);
        for [start, later] in triangles {
            let [a, b, c] = start.map(|p| p.as_dvec3());
            let [d, e, f] = later.map(|p| p.as_dvec3());
            let positions = [DVec3::ZERO, a, b, c];
            let motions = [DVec3::ZERO, d - a, e - b, f - c];
            let (time, steps) = additive(positions, motions, f64::from(RADIUS), end);
            found += usize::from(time.is_some());
            capped += usize::from(steps == MOST_STEPS);
            most = most.max(steps);
        }
    });
    println!(
        "{name}: {found} contacts of {}, at most {most} steps",
        triangles.len()
    );
    (time, capped as f64 / triangles.len() as f64)
}

/// A sheet that starts two metres off the sphere and moves to the sphere's centre while it turns.
fn nearing(rng: &mut fastrand::Rng) -> Sheet {
    let from = vector(rng).normalize_or(Vec3::X) * (RADIUS + 2.0);
    let (across, up) = from.normalize().any_orthonormal_pair();
    let turn = vector(rng) * 0.5;
    let flat = grid().map(|[x, y]| across * x + up * y + vector(rng) * 0.02);
    let start: Vec<Vec3> = flat.map(|p| p + from).collect();
    let end = start.iter().map(|p| *p - from + (*p - from).cross(turn));
    let end = end.collect();
    [start, end]
}

/// A sheet that slides in its own plane, at twice the tolerance from the sphere.
fn sliding(rng: &mut fastrand::Rng) -> Sheet {
    let height = RADIUS + 2.0 * TOLERANCE as f32;
    let way = vector(rng) * 0.5;
    let start: Vec<Vec3> = grid().map(|[x, z]| Vec3::new(x, height, z)).collect();
    let end = start.iter().map(|p| *p + Vec3::new(way.x, 0.0, way.z));
    let end = end.collect();
    [start, end]
}

fn grid() -> impl Iterator<Item = [f32; 2]> {
    let place = |k: usize| (k as f32 / (ROWS - 1) as f32 * 2.0 - 1.0) * HALF;
    (0..ROWS * ROWS).map(move |k| [place(k / ROWS), place(k % ROWS)])
}

/// Vertex indices of a sheet's triangles.
fn corners() -> impl Iterator<Item = [usize; 3]> {
    let squares = (0..ROWS * ROWS).filter(|k| k % ROWS < ROWS - 1 && k / ROWS < ROWS - 1);
    squares.flat_map(|k| [[k, k + 1, k + ROWS], [k + 1, k + ROWS + 1, k + ROWS]])
}

fn triangles_of(sheet: &Sheet) -> impl Iterator<Item = [[Vec3; 3]; 2]> {
    corners().map(|corners| [0, 1].map(|end| corners.map(|v| sheet[end][v])))
}

fn vector(rng: &mut fastrand::Rng) -> Vec3 {
    let mut coordinate = || rng.f32() * 2.0 - 1.0;
    Vec3::new(coordinate(), coordinate(), coordinate())
}

/// The surface of a sheet. Every vertex has a joint of its own, whose matrix has no linear part: its translation is the
/// vertex's exact position.
fn posed(sheet: &Sheet) -> Result<SkinnedSurface, Box<dyn Error>> {
    let vertices = (ROWS * ROWS) as u32;
    let influence = |v: u32| Influence {
        joint: JointId(v),
        weight: 1.0,
    };
    let source = MeshSource {
        positions: &grid()
            .map(|[x, y]| Vec3::new(x, y, 0.0))
            .collect::<Vec<_>>(),
        triangles: &corners()
            .map(|corners| corners.map(|v| v as u32))
            .collect::<Vec<_>>(),
        influences: &(0..vertices).map(influence).collect::<Vec<_>>(),
        joint_count: vertices as usize,
        ..MeshSource::default()
    };
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default())?;
    let palette = |end: usize| {
        Palette::from_matrices(sheet[end].iter().map(|p| Affine {
            rows: [
                [0.0, 0.0, 0.0, p.x],
                [0.0, 0.0, 0.0, p.y],
                [0.0, 0.0, 0.0, p.z],
            ],
        }))
    };
    let mut surface = SkinnedSurface::new(Arc::new(mesh));
    surface.teleport(&palette(0), Similarity::IDENTITY)?;
    surface.advance(&palette(1), Similarity::IDENTITY)?;
    Ok(surface)
}
