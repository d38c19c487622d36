//! Measures single operations on the lazy surface: as the first one in a tick, when no vertex is skinned yet, and
//! again, when the surface's caches hold all that they need.
//!
//! Run it with `cargo bench -p clamber_benches --bench surface`; briefly with `-- --test`.

use std::error::Error;
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Duration;

use clamber::geometry::{Capsule, Ray};
use clamber::mesh::VertexId;
use clamber::prelude::*;
use clamber_scenes::Creature;
use clamber_scenes::giant::{giant, giant_of};
use clamber_scenes::measure::{exit_code, is_brief};
use criterion::Criterion;
use glam::Vec3;

/// Approximate number of vertices of the larger giant.
const LARGE: usize = 100_000;

fn main() -> ExitCode {
    exit_code(run(is_brief()))
}

fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mut criterion = Criterion::default()
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(800))
        .sample_size(20)
        .configure_from_args();
    measure(&mut criterion, &giant()?)?;
    if !brief {
        measure(&mut criterion, &giant_of(LARGE)?)?;
    }
    criterion.final_summary();
    Ok(())
}

/// An operation with its name.
type Operation<'a> = (&'a str, Box<dyn FnMut(&SkinnedSurface) + 'a>);

fn measure(criterion: &mut Criterion, creature: &Creature) -> Result<(), Box<dyn Error>> {
    let mesh = &creature.rig.collider;
    let mut surface = SkinnedSurface::new(mesh.clone());
    // One second of the walk, tick by tick.
    let poses = (0..60).map(|tick| creature.palette("walk", f64::from(tick) / 60.0));
    let poses = poses.collect::<Result<Vec<_>, _>>()?;
    surface.teleport(&poses[0], Similarity::IDENTITY)?;
    let mut group = criterion.benchmark_group(format!("giant, {}", mesh.positions().len()));

    let mut turn = poses.iter().cycle();
    let mut advance = |surface: &mut SkinnedSurface| {
        if let Some(pose) = turn.next() {
            let advanced = surface.advance(pose, Similarity::IDENTITY);
            assert_eq!(advanced, Ok(()));
        }
    };
    group.bench_function("advance", |bencher| bencher.iter(|| advance(&mut surface)));
    for (name, mut operation) in operations(&surface)? {
        group.bench_function(
            format!("{name}, first in a tick, with advance"),
            |bencher| {
                bencher.iter(|| {
                    advance(&mut surface);
                    operation(&surface);
                });
            },
        );
        operation(&surface);
        group.bench_function(format!("{name}, again"), |bencher| {
            bencher.iter(|| operation(black_box(&surface)));
        });
    }
    group.bench_function("skin ahead, with advance", |bencher| {
        bencher.iter(|| {
            advance(&mut surface);
            surface.skin_ahead();
        });
    });
    group.finish();
    Ok(())
}

/// All operations, with queries around the head.
fn operations(surface: &SkinnedSurface) -> Result<Vec<Operation<'static>>, Box<dyn Error>> {
    let mesh = surface.mesh();
    let place = |v: VertexId| mesh.positions()[v.index()];
    let [a, b, _] = mesh.triangles()[0];
    let edge = place(a).distance(place(b));
    let top = mesh
        .positions()
        .iter()
        .copied()
        .reduce(|top, p| if p.y > top.y { p } else { top });
    let top = top.ok_or("no vertices")?;
    let ray = Ray::new(top + Vec3::Y * 5.0, -Vec3::Y).ok_or("no direction")?;
    let near = surface.in_model().closest_point(top, f32::INFINITY);
    let anchor = surface.anchor_at(&near.ok_or("no skin")?)?;
    let (mut few, mut many, mut along, mut in_capsule) = (vec![], vec![], vec![], vec![]);
    let mut positions = Vec::new();
    let small = Capsule::ball(top, edge).ok_or("no ball")?;
    let large = Capsule::ball(top, 10.0 * edge).ok_or("no ball")?;
    let capsule = Capsule::new(top, top + Vec3::X * edge * 4.0, edge).ok_or("no capsule")?;
    Ok(vec![
        (
            "ray",
            Box::new(move |s| {
                black_box(s.in_model().cast_ray(&ray, 10.0));
            }),
        ),
        (
            "any ray",
            Box::new(move |s| {
                black_box(s.in_model().intersects_ray(&ray, 10.0));
            }),
        ),
        (
            "all along a ray",
            Box::new(move |s| s.in_model().cast_ray_all(&ray, 10.0, &mut along)),
        ),
        (
            "closest point",
            Box::new(move |s| {
                black_box(s.in_model().closest_point(top, 10.0));
            }),
        ),
        (
            "sphere of an edge",
            Box::new(move |s| s.in_model().overlap_capsule(&small, &mut few)),
        ),
        (
            "sphere of ten edges",
            Box::new(move |s| s.in_model().overlap_capsule(&large, &mut many)),
        ),
        (
            "capsule",
            Box::new(move |s| s.in_model().overlap_capsule(&capsule, &mut in_capsule)),
        ),
        (
            "motion",
            Box::new(move |s| drop(black_box(s.in_model().motion(&anchor, 1.0 / 60.0)))),
        ),
        ("skin all", Box::new(move |s| s.skin_all(&mut positions))),
    ])
}
