//! Anchored entities are found from their surface, and are told of when it is gone.

use bevy_app::App;
use bevy_clamber::prelude::*;
use bevy_clamber::{AnchoredTo, SurfaceAnchors};
use bevy_ecs::message::Messages;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::Vec3;
use bevy_mesh::{Mesh, Mesh3d, VertexAttributeValues};
use bevy_transform::components::Transform;

use super::common::{Limb, add_mesh, app, limb, limb_mesh, wait};

fn arrow(app: &mut App, near: Vec3) -> Entity {
    let ask = move |surfaces: SurfaceQuery| {
        let hit = surfaces.closest_point(near, 9.0, &SurfaceFilter::default());
        surfaces.anchor_at(&hit.unwrap()).unwrap()
    };
    let anchor = app.world_mut().run_system_once(ask).unwrap();
    app.world_mut().spawn(anchor).id()
}

/// The arrows in a limb.
fn anchored(app: &App, limb: &Limb) -> Vec<Entity> {
    let anchors = app.world().get::<SurfaceAnchors>(limb.mesh);
    let mut all: Vec<Entity> = anchors.map(|all| all.iter().collect()).unwrap_or_default();
    all.sort_unstable();
    all
}

/// Gives a limb another mesh: a wider one.
fn widen(app: &mut App, limb: &Limb) {
    let mut wider = limb_mesh();
    let positions = wider.attribute_mut(Mesh::ATTRIBUTE_POSITION).unwrap();
    let VertexAttributeValues::Float32x3(positions) = positions else {
        panic!("positions");
    };
    for position in positions {
        position[0] *= 1.2;
    }
    let wider = add_mesh(app, wider);
    app.world_mut().entity_mut(limb.mesh).insert(Mesh3d(wider));
    app.update();
    wait(app, limb.mesh);
    app.update();
}

#[test]
fn a_surface_knows_what_is_anchored_to_it() {
    let mut app = app(60.0);
    let first = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let second = limb(
        &mut app,
        Transform::from_xyz(50.0, 0.0, 0.0),
        SkinnedCollider::default(),
    );
    let arrows: Vec<Entity> = (0..3)
        .map(|i| arrow(&mut app, Vec3::new(1.0, 0.5 * i as f32, 0.0)))
        .collect();
    let other = arrow(&mut app, Vec3::new(49.0, 1.0, 0.0));
    app.update();
    let mut all = arrows.clone();
    all.sort_unstable();
    assert_eq!(anchored(&app, &first), all);
    assert_eq!(anchored(&app, &second), [other]);
    assert_eq!(
        app.world().get::<AnchoredTo>(other),
        Some(&AnchoredTo(second.mesh))
    );
    // Another anchor on the same entity, none, and none of the entity.
    let moved = *app.world().get::<SurfaceAnchor>(other).unwrap();
    app.world_mut().entity_mut(arrows[0]).insert(moved);
    app.world_mut()
        .entity_mut(arrows[1])
        .remove::<SurfaceAnchor>();
    app.world_mut().entity_mut(arrows[2]).despawn();
    app.update();
    assert_eq!(anchored(&app, &first), []);
    assert_eq!(anchored(&app, &second).len(), 2);
    assert_eq!(app.world().get::<AnchoredTo>(arrows[1]), None);
    // Arrows outlive the surface, and are told of once.
    let mut cursor = app.world().resource::<Messages<AnchorLost>>().get_cursor();
    app.world_mut().entity_mut(second.root).despawn();
    let mut lost = Vec::new();
    for _ in 0..3 {
        app.update();
        lost.extend(
            cursor
                .read(app.world().resource::<Messages<AnchorLost>>())
                .map(|lost| (lost.entity, lost.surface)),
        );
    }
    lost.sort_unstable();
    let mut expected = [(arrows[0], second.mesh), (other, second.mesh)];
    expected.sort_unstable();
    assert_eq!(lost, expected);
    assert!(app.world().get::<Transform>(other).is_some());
    assert!(app.world().get::<SurfaceAnchor>(other).is_none());
}

#[test]
fn on_another_mesh_an_anchor_is_lost_or_anchored_anew() {
    fn anchor_anew(
        lost: On<AnchorLost>,
        places: Query<&Transform>,
        surfaces: DrawnSurfaceQuery,
        mut commands: Commands,
    ) {
        let place = places.get(lost.entity).unwrap();
        let is_same = |entity| entity == lost.surface;
        let filter = SurfaceFilter::only(&is_same);
        let near = surfaces
            .closest_point(place.translation, 0.5, &filter)
            .unwrap();
        let anchor = surfaces
            .anchor_with_rotation(&near, place.rotation)
            .unwrap();
        commands.entity(lost.entity).insert(anchor);
    }
    for anew in [false, true] {
        let mut app = app(60.0);
        if anew {
            app.add_observer(anchor_anew);
        }
        let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
        let arrow = arrow(&mut app, Vec3::new(1.0, 1.5, 0.0));
        app.update();
        let before = *app.world().get::<SurfaceAnchor>(arrow).unwrap();
        widen(&mut app, &limb);
        let after = app.world().get::<SurfaceAnchor>(arrow);
        assert_eq!(after.is_some(), anew);
        if let Some(after) = after {
            assert_ne!(after.mesh, before.mesh);
            app.update();
            let place = app.world().get::<Transform>(arrow).unwrap().translation;
            assert!((place.x - 0.24).abs() < 1e-4, "{place}");
        }
    }
}
