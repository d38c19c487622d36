//! Gizmos of surfaces, without a renderer.

use std::any::TypeId;

use bevy_app::{AnimationSystems, App, FixedUpdate, PostUpdate};
use bevy_asset::Assets;
use bevy_clamber::clamber_surface::geometry::Capsule;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_gizmos::config::GizmoConfigStore;
use bevy_gizmos::{GizmoAsset, GizmoHandles, GizmoPlugin};
use bevy_math::{Dir3, Vec3};
use bevy_shape::Ray3d;
use bevy_transform::components::{GlobalTransform, Transform};

use super::common::{Limb, animate, app_with, drawn, limb};

const NOTHING: SurfaceGizmos = SurfaceGizmos {
    parts: false,
    clusters: false,
    anchors: false,
    contacts: false,
    velocities: false,
};

/// A limb that bends, with an entity anchored to it.
fn scene() -> (App, Limb, Entity) {
    let plugins = (
        ClamberPlugins::default(),
        GizmoPlugin,
        SurfaceGizmosPlugin::default(),
    );
    // One tick per frame.
    let mut app = app_with(64.0, plugins);
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let ray = Ray3d::new(Vec3::new(9.0, 0.35, 0.05), Dir3::NEG_X);
    let stick = move |surfaces: SurfaceQuery| {
        let hit = surfaces.cast_ray(ray, 99.0, &SurfaceFilter::default())?;
        surfaces.anchor_at(&hit).ok()
    };
    let mut anchor = app.world_mut().run_system_once(stick).unwrap().unwrap();
    // A point at the tip, which moves most.
    anchor.attachment.material.key = u64::from(tip(&app, &limb).0);
    let arrow = app.world_mut().spawn(anchor).id();
    (app, limb, arrow)
}

/// The highest triangle in the rest pose.
fn tip(app: &App, limb: &Limb) -> bevy_clamber::clamber_surface::mesh::TriangleId {
    let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
    let mesh = surface.mesh();
    let height = |corners: &[bevy_clamber::clamber_surface::mesh::VertexId; 3]| {
        let heights = corners.map(|corner| mesh.positions()[corner.index()].y);
        heights.iter().sum::<f32>()
    };
    let triangles = mesh.triangles().iter().zip(0..);
    let highest = triangles.max_by(|a, b| height(a.0).total_cmp(&height(b.0)));
    bevy_clamber::clamber_surface::mesh::TriangleId(highest.unwrap().1)
}

fn show(app: &mut App, show: SurfaceGizmos) {
    let mut store = app.world_mut().resource_mut::<GizmoConfigStore>();
    *store.config_mut::<SurfaceGizmos>().1 = show;
}

/// Points of all lines that the last frame draws.
fn points(app: &App) -> Vec<Vec3> {
    let handles = app.world().resource::<GizmoHandles>().handles();
    let Some(Some(handle)) = handles.get(&TypeId::of::<SurfaceGizmos>()) else {
        return Vec::new();
    };
    let assets = app.world().resource::<Assets<GizmoAsset>>();
    let buffer = assets.get(handle).unwrap().buffer().buffer();
    let strips = buffer.strip_positions.iter();
    let all = buffer.list_positions.iter().chain(strips).copied();
    // Strips end with NaN.
    all.filter(|point| point.is_finite()).collect()
}

#[test]
fn each_kind_is_drawn_when_it_is_on_and_nothing_when_all_are_off() {
    let (mut app, _, _) = scene();
    // In the fixed loop before surfaces are posed, like queries of gameplay.
    app.add_systems(FixedUpdate, |surfaces: SurfaceQuery| {
        let ray = Ray3d::new(Vec3::new(9.0, 0.35, 0.05), Dir3::NEG_X);
        assert!(surfaces.intersects_ray(ray, 99.0, &SurfaceFilter::default()));
    });
    app.update();
    let off = NOTHING;
    let kinds = [
        ("parts", SurfaceGizmos { parts: true, ..off }),
        (
            "clusters",
            SurfaceGizmos {
                clusters: true,
                ..off
            },
        ),
        (
            "anchors",
            SurfaceGizmos {
                anchors: true,
                ..off
            },
        ),
        (
            "contacts",
            SurfaceGizmos {
                contacts: true,
                ..off
            },
        ),
        (
            "velocities",
            SurfaceGizmos {
                velocities: true,
                ..off
            },
        ),
    ];
    for (name, kind) in kinds {
        show(&mut app, kind);
        // Touched clusters are recorded in the tick before.
        app.update();
        app.update();
        let points = points(&app);
        println!("{name}: {} points", points.len());
        assert!(!points.is_empty(), "{name}");
    }
    show(&mut app, NOTHING);
    app.update();
    assert_eq!(points(&app), []);
    show(&mut app, SurfaceGizmos::default());
    let mut store = app.world_mut().resource_mut::<GizmoConfigStore>();
    store.config_mut::<SurfaceGizmos>().0.enabled = false;
    app.update();
    assert_eq!(points(&app), []);
}

#[test]
fn without_queries_no_clusters_or_contacts_are_drawn() {
    let (mut app, _, _) = scene();
    show(
        &mut app,
        SurfaceGizmos {
            clusters: true,
            contacts: true,
            ..NOTHING
        },
    );
    for _ in 0..3 {
        app.update();
    }
    assert_eq!(points(&app), []);
}

#[test]
fn contacts_lie_on_the_skin_as_it_is_drawn() {
    let (mut app, limb, _) = scene();
    app.add_systems(FixedUpdate, |surfaces: SurfaceQuery| {
        let mut all = Vec::new();
        let ball = Capsule::ball(Vec3::Y, 9.0).unwrap();
        surfaces.overlap_capsule(&ball, &SurfaceFilter::default(), &mut all);
        assert!(!all.is_empty());
    });
    show(
        &mut app,
        SurfaceGizmos {
            contacts: true,
            ..NOTHING
        },
    );
    for _ in 0..40 {
        app.update();
    }
    let vertices: Vec<_> = (0..84).map(|vertex| drawn(&app, &limb, vertex)).collect();
    let points = points(&app);
    // All triangles of 20 rings, four points each.
    assert_eq!(points.len(), 160 * 4);
    for point in points {
        let apart = vertices.iter().map(|v| (point.as_dvec3() - v).length());
        let apart = apart.fold(f64::INFINITY, f64::min);
        assert!(apart < 1e-4, "{point}: {apart}");
    }
}

#[test]
fn the_arrow_of_a_velocity_starts_at_its_anchor_and_points_along_its_motion() {
    let (mut app, _, arrow) = scene();
    show(
        &mut app,
        SurfaceGizmos {
            velocities: true,
            ..NOTHING
        },
    );
    for _ in 0..40 {
        app.update();
    }
    let at = |app: &App| {
        let place = app.world().get::<GlobalTransform>(arrow).unwrap();
        place.translation()
    };
    let before = at(&app);
    app.update();
    let now = at(&app);
    let shaft = points(&app);
    assert!((shaft[0] - now).length() < 1e-5, "{} {now}", shaft[0]);
    // The arrow's length is 0.1 s of motion. Surfaces lag one frame behind the pose that is drawn.
    let expected = (now - before) * 64.0 * 0.1;
    let found = shaft[1] - shaft[0];
    assert!(expected.length() > 0.15, "{expected}");
    assert!(
        (found - expected).length() < 0.1 * expected.length(),
        "{found} {expected}"
    );
}

#[test]
fn part_spheres_enclose_the_skin_that_is_drawn() {
    let (mut app, limb, _) = scene();
    show(
        &mut app,
        SurfaceGizmos {
            parts: true,
            ..NOTHING
        },
    );
    for _ in 0..40 {
        app.update();
    }
    // The box around all spheres contains the skin.
    let points = points(&app);
    let low = points.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = points.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    for vertex in (0..84).map(|vertex| drawn(&app, &limb, vertex).as_vec3()) {
        let inside = vertex.cmpge(low - 1e-2).all() && vertex.cmple(high + 1e-2).all();
        assert!(inside, "{vertex} {low} {high}");
    }
    assert!((high - low).max_element() < 4.0, "{low} {high}");
}
