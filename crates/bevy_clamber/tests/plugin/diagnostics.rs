//! Bevy's diagnostics agree with the surfaces' own counts.

use bevy_app::{App, FixedPostUpdate, FixedUpdate, PostUpdate};
use bevy_clamber::prelude::*;
use bevy_diagnostic::{DiagnosticPath, DiagnosticsStore};
use bevy_ecs::prelude::*;
use bevy_math::{Dir3, Vec3};
use bevy_shape::Ray3d;
use bevy_transform::components::Transform;

use super::common::{animate, app_with, limb};

type Plugin = SurfaceDiagnosticsPlugin;

fn value(app: &App, path: &DiagnosticPath) -> f64 {
    let store = app.world().resource::<DiagnosticsStore>();
    store.get(path).unwrap().value().unwrap()
}

/// An app with two limbs and one tick per frame. In each tick a ray hits one of the limbs.
fn scene() -> App {
    let plugins = (ClamberPlugins::default(), Plugin::default());
    let mut app = app_with(64.0, plugins);
    for x in [0.0, 5.0] {
        let place = Transform::from_xyz(x, 0.0, 0.0);
        limb(&mut app, place, SkinnedCollider::default());
    }
    app.add_systems(FixedUpdate, |surfaces: SurfaceQuery| {
        let ray = Ray3d::new(Vec3::new(0.05, 0.35, 9.0), Dir3::NEG_Z);
        assert!(surfaces.intersects_ray(ray, 99.0, &SurfaceFilter::default()));
    });
    app
}

#[test]
fn diagnostics_are_sums_over_all_surfaces() {
    #[derive(Resource, Default, Debug, PartialEq)]
    struct Said {
        surfaces: usize,
        clusters_touched: usize,
        vertices_skinned: usize,
        triangles_tested: u64,
    }
    let mut app = scene();
    app.init_resource::<Said>()
        .add_systems(PostUpdate, animate.in_set(bevy_app::AnimationSystems))
        .add_systems(
            FixedPostUpdate,
            (|surfaces: Query<&PosedSurface>, mut said: ResMut<Said>| {
                *said = Said::default();
                for surface in &surfaces {
                    let counts = surface.diagnostics();
                    said.surfaces += 1;
                    said.clusters_touched += counts.clusters_touched;
                    said.vertices_skinned += counts.vertices_skinned;
                    said.triangles_tested += counts.triangles_tested;
                }
            })
            .before(ClamberSystems::Pose),
        );
    for tick in 0..20 {
        app.update();
        if tick < 3 {
            continue;
        }
        let said = app.world().resource::<Said>();
        let told = Said {
            surfaces: value(&app, &Plugin::SURFACES) as usize,
            clusters_touched: value(&app, &Plugin::CLUSTERS_TOUCHED) as usize,
            vertices_skinned: value(&app, &Plugin::VERTICES_SKINNED) as usize,
            triangles_tested: value(&app, &Plugin::TRIANGLES_TESTED) as u64,
        };
        assert_eq!(told, *said, "tick {tick}");
        assert_eq!(told.surfaces, 2);
        assert!(
            told.clusters_touched > 0 && told.vertices_skinned > 0,
            "{told:?}"
        );
        assert!(told.triangles_tested > 0, "{told:?}");
        let time = value(&app, &Plugin::POSE_TIME);
        assert!(time > 0.0 && time < 1e3, "{time} ms");
    }
}

#[test]
fn skinning_for_a_still_surface_is_counted_once() {
    let mut app = scene();
    for _ in 0..5 {
        app.update();
    }
    let tested = value(&app, &Plugin::TRIANGLES_TESTED);
    assert!(tested > 0.0);
    for tick in 0..5 {
        app.update();
        // The same ray tests the same triangles again, but they are skinned already.
        assert_eq!(
            value(&app, &Plugin::TRIANGLES_TESTED),
            tested,
            "tick {tick}"
        );
        assert_eq!(value(&app, &Plugin::VERTICES_SKINNED), 0.0, "tick {tick}");
        assert_eq!(value(&app, &Plugin::CLUSTERS_TOUCHED), 0.0, "tick {tick}");
    }
}
