//! Every query over several surfaces agrees with brute force in f64.

use bevy_app::{App, FixedPostUpdate};
use bevy_clamber::EntitySweepHit;
use bevy_clamber::clamber_surface::geometry::Capsule;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Quat, Vec3};
use bevy_shape::Ray3d;
use bevy_transform::components::Transform;
use clamber_verify::brute_force::{self, Corners, Crossing, Triangles, segment_distance};
use glam::DVec3;

use super::common::posed;
use super::common::{Limb, add_bindposes, add_mesh, app, bend, limb_mesh, spawn_limb, wait};

/// Largest error of a distance, metres: a few roundings of positions to f32, at up to 30 m.
const CLOSE: f64 = 3e-5;

/// Bent limbs around the origin, with various rotations and scales.
fn crowd(app: &mut App) -> Vec<Limb> {
    let turned = Quat::from_xyzw(0.1, 0.7, -0.1, 0.7);
    let places = [
        Transform::IDENTITY,
        Transform::from_xyz(2.0, -1.0, 0.5)
            .with_rotation(turned)
            .with_scale(Vec3::splat(2.5)),
        Transform::from_xyz(-2.0, 0.0, 1.0).with_scale(Vec3::new(-1.0, 1.0, 1.0)),
        Transform::from_xyz(0.0, 1.0, -2.0)
            .with_rotation(turned)
            .with_scale(Vec3::new(1.0, 2.0, 0.5)),
        Transform::from_xyz(0.0, -2.0, 2.0)
            .with_rotation(turned)
            .with_scale(Vec3::new(0.1, -0.3, 1.0)),
    ];
    let mesh = add_mesh(app, limb_mesh());
    let bindposes = add_bindposes(app);
    let mut limbs = Vec::new();
    for (index, place) in places.into_iter().enumerate() {
        let limb = spawn_limb(app, mesh.clone(), bindposes.clone(), place);
        if index == 3 {
            // Sheared: a rotation below a non-uniform scale.
            let squeezed = Transform::from_scale(Vec3::new(1.5, 0.5, 1.0));
            let above = app.world_mut().spawn(squeezed).id();
            app.world_mut().entity_mut(limb.root).insert(ChildOf(above));
        }
        turn(app, &limb, 0.4 * index as f64);
        app.world_mut()
            .entity_mut(limb.mesh)
            .insert(SkinnedCollider::default());
        limbs.push(limb);
    }
    for limb in &limbs {
        wait(app, limb.mesh);
    }
    for _ in 0..4 {
        app.update();
    }
    limbs
}

fn turn(app: &mut App, limb: &Limb, seconds: f64) {
    let mut joint = app.world_mut().entity_mut(limb.joints[1]);
    joint.get_mut::<Transform>().unwrap().rotation = bend(seconds);
}

/// Makes a query in a system.
fn ask<R: Send + Sync + 'static>(
    app: &mut App,
    question: impl Fn(&SurfaceQuery<'_, '_>) -> R + Send + Sync + 'static,
) -> R {
    let system = move |surfaces: SurfaceQuery| question(&surfaces);
    app.world_mut().run_system_once(system).unwrap()
}

fn ball(center: Vec3, radius: f32) -> Capsule {
    Capsule::ball(center, radius).unwrap()
}

fn rod(a: Vec3, b: Vec3, radius: f32) -> Capsule {
    Capsule::new(a, b, radius).unwrap()
}

fn all() -> SurfaceFilter<'static> {
    SurfaceFilter::default()
}

/// The hits of a query, made twice with the same vector, which it must clear.
fn every(query: impl Fn(&mut Vec<EntityHit>)) -> Vec<EntityHit> {
    let mut hits = Vec::new();
    query(&mut hits);
    query(&mut hits);
    hits
}

/// Each limb with its triangles.
fn posed(app: &App, limbs: &[Limb]) -> Vec<(Entity, Vec<Corners>)> {
    let of = |limb: &Limb| (limb.mesh, posed::triangles(app, limb.mesh));
    limbs.iter().map(of).collect()
}

/// Checks that the fields of a hit agree with each other and with the posed triangles.
fn check_hit(app: &App, hit: &EntityHit, posed: &[(Entity, Vec<Corners>)]) {
    let surface = app.world().get::<PosedSurface>(hit.entity).unwrap();
    let (_, triangles) = posed.iter().find(|(e, _)| *e == hit.entity).unwrap();
    let source = surface.source_triangle(hit.triangle).unwrap();
    let [a, b, c] = triangles[source as usize];
    let apart = brute_force::distance(hit.point.as_dvec3(), &[a, b, c]);
    assert!(apart < CLOSE, "{apart} {hit:?}");
    assert!((hit.normal.length() - 1.0).abs() < 1e-5, "{hit:?}");
    let outward = (b - a).cross(c - a).normalize();
    let along = outward.dot(hit.normal.as_dvec3()).abs();
    assert!(along > 1.0 - 1e-6, "{hit:?} {outward}");
    let sum: f32 = hit.barycentric.iter().sum();
    assert!((sum - 1.0).abs() < 1e-5, "{hit:?}");
}

#[test]
fn rays_agree_with_brute_force() {
    let mut app = app(64.0);
    let limbs = crowd(&mut app);
    let posed = posed(&app, &limbs);
    let mut rng = fastrand::Rng::with_seed(1);
    let (mut hits, mut clear) = (0, 0);
    for case in 0..2_000 {
        let origin = vector(&mut rng, 6.0).as_vec3();
        let target = vector(&mut rng, 2.5).as_vec3();
        let direction = Dir3::new(target - origin).unwrap();
        let along = direction.as_dvec3().normalize();
        let max = 12.0;
        let mut expected: Vec<(f64, Entity)> = Vec::new();
        let mut certain = true;
        for (entity, triangles) in &posed {
            for corners in triangles {
                let crossing = brute_force::ray(origin.as_dvec3(), along, corners);
                if let Some(Crossing { distance, border }) = crossing
                    && border > -1e-3
                    && distance > -1e-3
                {
                    certain &= border.abs() > 1e-4 && distance.abs() > 1e-4;
                    certain &= (distance - f64::from(max)).abs() > 1e-4;
                    if border >= 0.0 && (0.0..=f64::from(max)).contains(&distance) {
                        expected.push((distance, *entity));
                    }
                }
            }
        }
        if !certain {
            continue;
        }
        clear += 1;
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ray = Ray3d::new(origin, direction);
        let (nearest, any, every) = ask(&mut app, move |s| {
            (
                s.cast_ray(ray, max, &all()),
                s.intersects_ray(ray, max, &all()),
                every(|hits| s.cast_ray_all(ray, max, &all(), hits)),
            )
        });
        assert_eq!(any, !expected.is_empty(), "case {case}");
        assert_eq!(
            every.len(),
            expected.len(),
            "case {case}: {every:?} {expected:?}"
        );
        assert_eq!(nearest, every.first().copied(), "case {case}");
        for (hit, (distance, _)) in every.iter().zip(&expected) {
            let found = f64::from(hit.distance);
            assert!(
                (found - distance).abs() < CLOSE,
                "case {case}: {hit:?} {distance}"
            );
            let there = origin.as_dvec3() + along * found;
            assert!(
                (there - hit.point.as_dvec3()).length() < CLOSE,
                "case {case}: {hit:?}"
            );
            check_hit(&app, hit, &posed);
        }
        hits += every.len();
    }
    println!("{clear} rays, {hits} hits");
    assert!(hits > 500, "{hits}");
}

#[test]
fn normals_point_out_of_the_skin_however_it_is_placed() {
    let mut app = app(64.0);
    let limbs = crowd(&mut app);
    for limb in limbs {
        // A ray from inside the tube hits the wall, whose normal points outward.
        let inside = posed::world_from(&app, limb.joints[0]);
        let origin = inside.transform_point3(DVec3::Y * 0.3).as_vec3();
        let to = inside.transform_vector3(DVec3::new(1.0, 0.1, 0.05));
        let ray = Ray3d::new(origin, Dir3::new(to.as_vec3()).unwrap());
        let only = limb.mesh;
        let hit = ask(&mut app, move |s| {
            s.cast_ray(ray, 9.0, &SurfaceFilter::only(&|entity| entity == only))
        });
        let hit = hit.unwrap();
        let outward = hit.normal.dot(*ray.direction);
        // The winding of the mesh decides; mirroring must not flip the normal.
        assert!(outward > 0.0, "{hit:?} {outward}");
    }
}

#[test]
fn nearest_points_and_overlaps_agree_with_brute_force() {
    let mut app = app(64.0);
    let limbs = crowd(&mut app);
    let posed = posed(&app, &limbs);
    let mut rng = fastrand::Rng::with_seed(2);
    for case in 0..400 {
        let center = vector(&mut rng, 4.0);
        let (a, b) = (center.as_vec3(), (center + vector(&mut rng, 1.0)).as_vec3());
        let radius = (0.02 + 1.5 * rng.f64()) as f32;
        let (closest, sphere, capsule) = ask(&mut app, move |s| {
            (
                s.closest_point(a, radius, &all()),
                every(|hits| s.overlap_capsule(&ball(a, radius), &all(), hits)),
                every(|hits| s.overlap_capsule(&rod(a, b, radius), &all(), hits)),
            )
        });
        let skin = Triangles(posed.iter().flat_map(|(_, t)| t.clone()).collect());
        let reach = f64::from(radius);
        let (a, b) = (a.as_dvec3(), b.as_dvec3());
        let within = |reach: f64, distance: &dyn Fn(&Corners) -> f64| {
            skin.0.iter().filter(|t| distance(t) <= reach).count()
        };
        for (what, found, distance) in [
            (
                "sphere",
                sphere,
                &(|t: &Corners| brute_force::distance(a, t)) as &dyn Fn(&Corners) -> f64,
            ),
            ("capsule", capsule, &|t: &Corners| {
                segment_distance([a, b], t)
            }),
        ] {
            let range = within(reach - CLOSE, distance)..=within(reach + CLOSE, distance);
            let case = format!("{what} {case}: {a} {b} {radius}");
            assert!(
                range.contains(&found.len()),
                "{case}: {} {range:?}",
                found.len()
            );
            assert!(
                found.is_sorted_by(|a, b| a.distance <= b.distance),
                "{case}"
            );
            for hit in &found {
                check_hit(&app, hit, &posed);
                let to = match what {
                    "sphere" => (hit.point.as_dvec3() - a).length(),
                    _ => segment_distance([a, b], &[hit.point.as_dvec3(); 3]),
                };
                assert!(
                    (to - f64::from(hit.distance)).abs() < CLOSE,
                    "{case}: {hit:?} {to}"
                );
            }
        }
        let least = skin.distance(a);
        match closest {
            Some(hit) => {
                assert!(
                    (f64::from(hit.distance) - least).abs() < CLOSE,
                    "{case}: {hit:?} {least}"
                );
                check_hit(&app, &hit, &posed);
            }
            None => assert!(least > reach - CLOSE, "{case}: {least} {radius}"),
        }
    }
}

/// The triangles in world space at the tick before the last and at the last. Points move straight between them.
fn moving(app: &App, limbs: &[Limb]) -> Vec<[Corners; 2]> {
    let mut all = Vec::new();
    for limb in limbs {
        let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
        let world = |p: Vec3| surface.world_from_model().transform_point_f32(p);
        for corners in surface.mesh().triangles() {
            all.push([
                corners.map(|v| world(surface.in_model().previous_position(v).unwrap())),
                corners.map(|v| world(surface.in_model().position(v).unwrap())),
            ]);
        }
    }
    all
}

/// A random vector in a cube with sides of `2 * half`.
fn vector(rng: &mut fastrand::Rng, half: f64) -> DVec3 {
    let mut coordinate = || (rng.f64() * 2.0 - 1.0) * half;
    DVec3::new(coordinate(), coordinate(), coordinate())
}

fn between([from, to]: [Corners; 2], time: f64) -> Corners {
    [0, 1, 2].map(|corner| from[corner].lerp(to[corner], time))
}

/// Checks a sweep's hit against the distances at sampled times.
fn check_sweep(
    what: &str,
    hit: Option<&EntitySweepHit>,
    radius: f64,
    distance_at: impl Fn(f64) -> f64,
) {
    let end = hit.map_or(1.0, |hit| f64::from(hit.fraction));
    for sample in 0..20 {
        // There is no contact before the reported time.
        let time = end * f64::from(sample) / 20.0;
        if time < end {
            let apart = distance_at(time);
            assert!(apart > radius - CLOSE, "{what}: {apart} at {time}, {hit:?}");
        }
    }
    if let Some(hit) = hit {
        let apart = distance_at(end);
        assert!(!hit.undecided, "{what}: {hit:?}");
        if hit.started_inside {
            assert!(apart < radius + CLOSE, "{what}: {apart} {hit:?}");
        } else {
            let touch = radius - CLOSE..radius + 1e-4 + CLOSE;
            assert!(touch.contains(&apart), "{what}: {apart} {hit:?}");
            assert!(
                (f64::from(hit.hit.distance) - apart).abs() < CLOSE,
                "{what}: {apart} {hit:?}"
            );
        }
    }
}

#[test]
fn casts_and_sweeps_agree_with_brute_force() {
    let mut app = app(64.0);
    let limbs = crowd(&mut app);
    // A large motion in the last tick.
    for limb in &limbs {
        turn(&mut app, limb, 0.9);
    }
    app.update();
    app.update();
    let moving = moving(&app, &limbs);
    let travelled = moving.iter().map(|[a, b]| (a[0] - b[0]).length());
    assert!(travelled.fold(0.0, f64::max) > 0.1);
    let mut rng = fastrand::Rng::with_seed(3);
    let (mut found, mut apart) = ([0; 4], 0);
    for case in 0..400 {
        let [a, b] = [vector(&mut rng, 3.0), vector(&mut rng, 3.0)].map(|p| p.as_vec3());
        let b = a + (b - a) * 0.2;
        let motions = [vector(&mut rng, 3.0), vector(&mut rng, 3.0)].map(|p| p.as_vec3());
        let motions = [motions[0], motions[0] + motions[1] * 0.1];
        let radius = (0.02 + 0.3 * rng.f64()) as f32;
        let hits = ask(&mut app, move |s| {
            [
                s.cast_capsule(
                    &ball(a, radius),
                    [motions[0]; 2],
                    TargetMotion::Still,
                    &all(),
                ),
                s.cast_capsule(
                    &ball(a, radius),
                    [motions[0]; 2],
                    TargetMotion::Moving,
                    &all(),
                ),
                s.cast_capsule(&rod(a, b, radius), motions, TargetMotion::Still, &all()),
                s.cast_capsule(&rod(a, b, radius), motions, TargetMotion::Moving, &all()),
            ]
        });
        let sphere = |time: f64| a.as_dvec3() + motions[0].as_dvec3() * time;
        let capsule = |time: f64| [sphere(time), b.as_dvec3() + motions[1].as_dvec3() * time];
        let skin = |pose: f64| Triangles(moving.iter().map(|t| between(*t, pose)).collect());
        let now = skin(1.0);
        let radius = f64::from(radius);
        check_sweep(
            &format!("cast sphere {case}"),
            hits[0].as_ref(),
            radius,
            |time| now.distance(sphere(time)),
        );
        check_sweep(
            &format!("sweep sphere {case}"),
            hits[1].as_ref(),
            radius,
            |time| skin(time).distance(sphere(time)),
        );
        check_sweep(
            &format!("cast capsule {case}"),
            hits[2].as_ref(),
            radius,
            |time| now.segment_distance(capsule(time)),
        );
        check_sweep(
            &format!("sweep capsule {case}"),
            hits[3].as_ref(),
            radius,
            |time| skin(time).segment_distance(capsule(time)),
        );
        for (count, hit) in found.iter_mut().zip(&hits) {
            *count += usize::from(hit.is_some());
        }
        for hit in hits[..2]
            .iter()
            .flatten()
            .filter(|hit| hit.hit.distance > 0.01)
        {
            let center = sphere(hit.fraction.into()).as_vec3();
            let aside = (center - hit.hit.point).normalize();
            let off = (aside - hit.separation_normal).length();
            assert!(off < 2e-3, "{case}: {aside} {hit:?}");
            // The separation normal differs from the triangle's at edges and on the inside.
            apart += usize::from(aside.dot(hit.hit.normal) < 0.99);
        }
    }
    println!("hits: {found:?} of 400, {apart} aside");
    assert!(apart > 20, "{apart}");
    assert!(found.iter().all(|count| *count > 40), "{found:?}");
}

#[test]
fn equal_distances_go_to_the_smaller_entity_and_filters_hide() {
    let mut app = app(64.0);
    let mesh = add_mesh(&mut app, limb_mesh());
    let bindposes = add_bindposes(&mut app);
    let spawn = |app: &mut App| {
        let limb = spawn_limb(app, mesh.clone(), bindposes.clone(), Transform::IDENTITY);
        app.world_mut()
            .entity_mut(limb.mesh)
            .insert(SkinnedCollider::default());
        limb.mesh
    };
    let mut entities = [0; 4].map(|_| spawn(&mut app));
    for entity in entities {
        wait(&mut app, entity);
    }
    // Moves the smallest entity to another archetype, so that it comes last in storage order.
    app.world_mut()
        .entity_mut(entities[0])
        .insert(Name::new("moved"));
    entities.sort();
    let ray = Ray3d::new(Vec3::new(9.0, 0.53, 0.07), Dir3::NEG_X);
    let at = Vec3::new(1.0, 0.52, 0.03);
    let first = ask(&mut app, move |s| {
        [
            s.cast_ray(ray, 20.0, &all()).unwrap().entity,
            every(|hits| s.cast_ray_all(ray, 20.0, &all(), hits))[0].entity,
            s.closest_point(at, 9.0, &all()).unwrap().entity,
            every(|hits| s.overlap_capsule(&ball(at, 0.9), &all(), hits))[0].entity,
            s.cast_capsule(
                &ball(at, 0.1),
                [Vec3::NEG_X; 2],
                TargetMotion::Still,
                &all(),
            )
            .unwrap()
            .hit
            .entity,
            s.cast_capsule(
                &ball(at, 0.1),
                [Vec3::NEG_X; 2],
                TargetMotion::Moving,
                &all(),
            )
            .unwrap()
            .hit
            .entity,
        ]
    });
    assert_eq!(first, [entities[0]; 6]);
    let next = ask(&mut app, move |s| {
        let two = &entities[..2];
        let except = SurfaceFilter::except(two);
        let last = |entity: Entity| entity == entities[3];
        let only = SurfaceFilter::only(&last);
        let none = |_: Entity| false;
        assert_eq!(s.cast_ray(ray, 20.0, &SurfaceFilter::only(&none)), None);
        assert!(!s.intersects_ray(ray, 20.0, &SurfaceFilter::only(&none)));
        assert_eq!(
            every(|hits| s.cast_ray_all(ray, 20.0, &only, hits)).len(),
            2
        );
        [
            s.cast_ray(ray, 20.0, &except).unwrap().entity,
            s.closest_point(at, 9.0, &except).unwrap().entity,
            s.closest_point(at, 9.0, &only).unwrap().entity,
        ]
    });
    assert_eq!(next, [entities[2], entities[2], entities[3]]);
}

#[test]
fn input_that_is_not_finite_finds_nothing() {
    let mut app = app(64.0);
    crowd(&mut app);
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    let o = Vec3::ZERO;
    ask(&mut app, move |s| {
        let ray = |origin, max| s.cast_ray(Ray3d::new(origin, Dir3::X), max, &all());
        assert!(ray(o, inf).is_some());
        assert!(s.closest_point(o, inf, &all()).is_some());
        for bad in [nan, inf, -inf] {
            let p = Vec3::new(0.0, bad, 0.0);
            assert_eq!(ray(p, 9.0), None);
            assert!(!s.intersects_ray(Ray3d::new(p, Dir3::Y), 9.0, &all()));
            assert!(
                every(|hits| s.cast_ray_all(Ray3d::new(p, Dir3::Y), 9.0, &all(), hits)).is_empty()
            );
            assert_eq!(s.closest_point(p, 9.0, &all()), None);
            for target in [TargetMotion::Still, TargetMotion::Moving] {
                for way in [[p, o], [o, p]] {
                    assert_eq!(s.cast_capsule(&ball(o, 9.0), way, target, &all()), None);
                }
            }
        }
        for bad in [nan, -1.0, -inf] {
            assert_eq!(ray(o, bad), None);
            assert_eq!(s.closest_point(o, bad, &all()), None);
        }
    });
}

#[test]
fn two_systems_may_query_in_parallel() {
    #[derive(Resource, Default)]
    struct Found([std::sync::Mutex<Vec<Option<EntityHit>>>; 2]);
    fn look<const N: usize>(surfaces: SurfaceQuery, found: Res<Found>) {
        let ray = Ray3d::new(Vec3::new(9.0, 0.53, 0.07), Dir3::NEG_X);
        let hit = surfaces.cast_ray(ray, 30.0, &SurfaceFilter::default());
        found.0[N].lock().unwrap().push(hit);
    }
    let mut app = app(64.0);
    crowd(&mut app);
    app.init_resource::<Found>().add_systems(
        FixedPostUpdate,
        (look::<0>, look::<1>).after(ClamberSystems::Pose),
    );
    for _ in 0..50 {
        app.update();
    }
    let found = app.world().resource::<Found>();
    let [a, b] = [0, 1].map(|n| found.0[n].lock().unwrap().clone());
    assert!(a.len() >= 49 && a[0].is_some(), "{a:?}");
    assert_eq!(a, b);
}
