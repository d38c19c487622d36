//! Compares the libraries in C++ with all triangles in f64, in several poses.

#![cfg(any(
    feature = "bullet",
    feature = "embree",
    feature = "fcl",
    feature = "physx"
))]
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

use std::sync::Arc;

use clamber_peers::{Peer, all, ball};
use clamber_surface::geometry::{Affine, Ray, Sphere, rotation_from_axis_angle};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, Influence, MeshSource};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::skin::skin_into;
use clamber_verify::brute_force::{self, Triangles};
use glam::{DAffine3, DVec3, Vec3};

/// Number of rings of the ball.
const RINGS: u32 = 24;
/// Number of segments of a ring.
const SEGMENTS: u32 = 32;
/// Number of queries of each kind and pose.
const QUERIES: usize = 300;

/// A closed, bumpy ball of about 10 m across on two joints, one for each half, blended between.
fn bumpy_ball() -> ColliderMesh {
    let bumps = |a: f64, b: f64| libm::sin(3.0 * b) * libm::sin(4.0 * a) * libm::sin(a);
    let (positions, triangles) = ball(RINGS, SEGMENTS, |a, b| 5.0 + 0.8 * bumps(a, b));
    let influences: Vec<Influence> = positions
        .iter()
        .flat_map(|p| {
            let upper = (p.y / 4.0 + 0.5).clamp(0.0, 1.0);
            [(0, 1.0 - upper), (1, upper)].map(|(joint, weight)| Influence {
                joint: JointId(joint),
                weight,
            })
        })
        .collect();
    let source = MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        joint_count: 2,
        ..MeshSource::default()
    };
    ColliderMesh::build(&source, &ColliderBuildOptions::default())
        .unwrap()
        .0
}

/// A palette that leaves the lower half in place, and turns and moves the upper half.
fn palette(angle: f64, by: DVec3) -> Palette {
    let upper = DAffine3::from_rotation_translation(
        rotation_from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle),
        by,
    );
    Palette::from_matrices([Affine::IDENTITY, Affine::from_f64(&upper)])
}

/// All triangles of a pose.
struct Truth {
    triangles: Triangles,
    /// Largest allowed error of f32, metres: about ten units in the last place of the largest coordinate.
    slack: f64,
}

impl Truth {
    fn new(mesh: &ColliderMesh, palette: &Palette, place: DVec3) -> Self {
        let moved: Vec<Affine> = palette
            .matrices()
            .iter()
            .map(|m| Affine::from_f64(&(DAffine3::from_translation(place) * m.to_f64())))
            .collect();
        let mut positions = vec![Vec3::ZERO; mesh.positions().len()];
        skin_into(mesh, &moved, &mut positions).unwrap();
        let corners = mesh.triangles().iter();
        Self {
            triangles: Triangles(
                corners
                    .map(|t| t.map(|v| positions[v.index()].as_dvec3()))
                    .collect(),
            ),
            slack: (place.length() + 10.0) * 2e-6,
        }
    }

    /// Distance along a ray at which it hits a triangle, grown by a share of the triangle's size, or shrunk if `grown`
    /// is negative.
    fn cast(&self, ray: &Ray, triangle: usize, grown: f64) -> Option<f64> {
        let (origin, direction) = (ray.origin().as_dvec3(), ray.direction().as_dvec3());
        let crossing = brute_force::ray(origin, direction, &self.triangles.0[triangle])?;
        let met = crossing.border >= -grown && crossing.distance >= -self.slack;
        met.then_some(crossing.distance)
    }
}

struct Queries {
    rng: fastrand::Rng,
    around: Vec3,
}

impl Queries {
    fn vector(&mut self, size: f32) -> Vec3 {
        let mut coordinate = || (self.rng.f32() * 2.0 - 1.0) * size;
        Vec3::new(coordinate(), coordinate(), coordinate())
    }

    fn point(&mut self) -> Vec3 {
        self.around + self.vector(8.0)
    }
}

fn rays_agree(name: &str, peer: &mut dyn Peer, truth: &Truth, queries: &mut Queries) {
    /// Share of a triangle's size by which a hit may be outside: three times the ten-thousandth by which Bullet
    /// enlarges a triangle.
    const GROWN: f64 = 3e-4;
    let mut hits = 0;
    for _ in 0..QUERIES {
        let origin = queries.point();
        let target = queries.around + queries.vector(4.0);
        let ray = Ray::new(origin, target - origin).unwrap();
        let max_distance = queries.rng.f32() * 20.0;
        let most = f64::from(max_distance);
        let context = format!("{name}: {ray:?}, {max_distance}");
        let all = 0..truth.triangles.0.len();
        let surely = all.filter_map(|k| truth.cast(&ray, k, -GROWN));
        let first = surely
            .filter(|t| (truth.slack..most - truth.slack).contains(t))
            .fold(f64::INFINITY, f64::min);
        let Ok(hit) = peer.cast_ray(&ray, max_distance) else {
            return;
        };
        let Some(hit) = hit else {
            assert!(first.is_infinite(), "{context}: missed {first}");
            continue;
        };
        let found = f64::from(hit.distance);
        let there = truth.cast(&ray, hit.triangle.index(), GROWN);
        let there = there.unwrap_or_else(|| panic!("{context}: {hit:?} is not there"));
        let slack = truth.slack * 20.0;
        assert!((there - found).abs() < slack, "{context}: {hit:?}, {there}");
        assert!(found < first + slack, "{context}: {hit:?} after {first}");
        assert!(found < most + slack, "{context}: {hit:?} beyond the end");
        hits += 1;
    }
    assert!(hits > QUERIES / 4, "{name}: too few rays hit: {hits}");
}

fn overlaps_agree(name: &str, peer: &mut dyn Peer, truth: &Truth, queries: &mut Queries) {
    let mut touched = 0;
    for _ in 0..QUERIES {
        let sphere = Sphere {
            center: queries.point(),
            radius: 0.1 + queries.rng.f32() * 2.0,
        };
        let center = sphere.center.as_dvec3();
        let radius = f64::from(sphere.radius);
        let [least, unsure] = truth.triangles.within(center, radius, truth.slack);
        let most = least + unsure;
        let Ok(found) = peer.overlap_sphere(&sphere) else {
            return;
        };
        assert!(
            (least..=most).contains(&found),
            "{name}: {sphere:?}: {found}, not {least} to {most}"
        );
        touched += found;
    }
    assert!(
        touched > QUERIES,
        "{name}: the spheres touch too few triangles: {touched}"
    );
    let around_all = Sphere {
        center: queries.around,
        radius: 30.0,
    };
    let found = peer.overlap_sphere(&around_all);
    assert_eq!(found, Ok(truth.triangles.0.len()), "{name}: {around_all:?}");
}

fn closest_points_agree(name: &str, peer: &mut dyn Peer, truth: &Truth, queries: &mut Queries) {
    for k in 0..QUERIES {
        let point = queries.point();
        let max_distance = match k % 3 {
            0 => f32::INFINITY,
            1 => 100.0,
            _ => queries.rng.f32() * 4.0,
        };
        let context = format!("{name}: {point}, {max_distance}");
        let distance = truth.triangles.distance(point.as_dvec3());
        let Ok(found) = peer.closest_point(point, max_distance) else {
            return;
        };
        let Some(found) = found else {
            assert!(
                distance > f64::from(max_distance) - truth.slack,
                "{context}: missed one at {distance}"
            );
            continue;
        };
        let off = f64::from(found.distance) - distance;
        assert!(off.abs() < truth.slack, "{context}: {found:?}, {distance}");
        assert!(
            found.distance <= max_distance,
            "{context}: {found:?} is beyond"
        );
        let off = truth.triangles.distance(found.point.as_dvec3());
        assert!(
            off < truth.slack,
            "{context}: {found:?} is {off} off the skin"
        );
    }
}

fn sphere_casts_agree(name: &str, peer: &mut dyn Peer, truth: &Truth, queries: &mut Queries) {
    /// Largest allowed gap at the end of a cast, metres: twice the millimetre at which Bullet's casts end.
    const GAP: f64 = 2e-3;
    let (mut hits, mut in_touch) = (0, 0);
    for _ in 0..QUERIES {
        let sphere = Sphere {
            center: queries.point(),
            radius: 0.1 + queries.rng.f32(),
        };
        let motion = queries.vector(10.0);
        let cast = |radius| {
            truth
                .triangles
                .cast_sphere(sphere.center.as_dvec3(), radius, motion.as_dvec3())
        };
        let radius = f64::from(sphere.radius);
        let (earliest, latest) = (cast(radius + GAP), cast(radius - GAP));
        // In Bullet, a sphere that starts in contact and moves away has no hit.
        if earliest == Some(0.0) && (latest != earliest || name.starts_with("Bullet")) {
            continue;
        }
        in_touch += usize::from(latest == Some(0.0));
        let Ok(found) = peer.cast_sphere(&sphere, motion) else {
            return;
        };
        let found = found.map(f64::from);
        let context = format!("{name}: {sphere:?}, {motion}: {found:?}");
        let Some(found) = found else {
            assert!(latest.is_none(), "{context}, not {latest:?}");
            continue;
        };
        let earliest = earliest.unwrap_or_else(|| panic!("{context}: nothing is there"));
        let latest = latest.unwrap_or(1.0);
        assert!(
            (earliest - 1e-4..=latest + 1e-4).contains(&found),
            "{context}, not {earliest} to {latest}"
        );
        hits += 1;
    }
    assert!(hits > QUERIES / 10, "{name}: too few spheres hit: {hits}");
    assert!(
        in_touch > 10 || name.starts_with("Bullet"),
        "{name}: too few spheres start in contact: {in_touch}"
    );
}

#[test]
fn libraries_agree_with_all_triangles_after_each_update() {
    let mesh = Arc::new(bumpy_ball());
    let poses = [
        (palette(0.0, DVec3::ZERO), DVec3::ZERO),
        (palette(1.2, DVec3::new(0.5, 1.0, 0.0)), DVec3::ZERO),
        (
            palette(-0.7, DVec3::new(-1.0, 2.0, 1.0)),
            DVec3::new(40.0, -3.0, 7.0),
        ),
        (palette(0.3, DVec3::new(0.0, -1.0, 0.0)), DVec3::ZERO),
    ];
    let native = |name: &str| {
        ["Embree", "Bullet", "FCL", "PhysX"]
            .iter()
            .any(|n| name.starts_with(n))
    };
    let entries = all().into_iter().filter(|entry| native(entry.name));
    let mut tested = 0;
    for entry in entries {
        let mut peer = (entry.make)(&mesh).unwrap();
        for (k, (palette, place)) in poses.iter().enumerate() {
            peer.update(palette, *place).unwrap();
            let truth = Truth::new(&mesh, palette, *place);
            let mut queries = Queries {
                rng: fastrand::Rng::with_seed(k as u64),
                around: place.as_vec3(),
            };
            let name = format!("{} in pose {k}", entry.name);
            rays_agree(&name, &mut *peer, &truth, &mut queries);
            overlaps_agree(&name, &mut *peer, &truth, &mut queries);
            closest_points_agree(&name, &mut *peer, &truth, &mut queries);
            sphere_casts_agree(&name, &mut *peer, &truth, &mut queries);
        }
        tested += 1;
    }
    assert!(tested > 0, "no library is compiled in");
}

#[test]
fn missing_queries_are_reported_as_unsupported() {
    let mesh = Arc::new(bumpy_ball());
    let ray = Ray::new(Vec3::ZERO, Vec3::X).unwrap();
    let sphere = Sphere {
        center: Vec3::X * 9.0,
        radius: 0.5,
    };
    for entry in all() {
        let mut peer = (entry.make)(&mesh).unwrap();
        let lacks = [
            peer.cast_ray(&ray, 20.0).is_err(),
            peer.cast_sphere(&sphere, Vec3::X * -9.0).is_err(),
        ];
        match entry.name {
            "Embree 3" | "Embree 3 robust" => assert_eq!(lacks, [false, true]),
            "Bullet 3" | "PhysX 5.1" => assert_eq!(lacks, [false, false]),
            "FCL 0.7" => assert_eq!(lacks, [true, true]),
            _ => {}
        }
    }
}
