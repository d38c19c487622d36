//! Pointers hit skin in the pose that is drawn.

use bevy_app::{AnimationSystems, App, PostUpdate, Update};
use bevy_asset::{Assets, Handle};
use bevy_camera::visibility::{RenderLayers, Visibility, VisibilityPlugin};
use bevy_camera::{
    Camera, CameraProjection, CameraProjectionPlugin, ComputedCameraValues, PerspectiveProjection,
    Projection, RenderTarget, RenderTargetInfo,
};
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{UVec2, Vec3};
use bevy_mesh::{Mesh, Mesh3d};
use bevy_picking::backend::{HitData, PointerHits};
use bevy_picking::events::PointerClick;
use bevy_picking::mesh_picking::ray_cast::{
    MeshRayCast, MeshRayCastSettings, RayCastVisibility, SimplifiedMesh,
};
use bevy_picking::pointer::{
    Location, PointerAction, PointerButton, PointerId, PointerInput, PointerLocation,
};
use bevy_picking::{InteractionPlugin, Pickable, PickingPlugin, PickingSettings};
use bevy_transform::components::{GlobalTransform, Transform};
use bevy_window::{PrimaryWindow, Window};

use super::common::{Limb, animate, app_with, bend, drawn, limb};

/// The `PointerHits` of the last update.
#[derive(Resource, Default)]
struct Told(Vec<PointerHits>);

/// A camera in front of the limb's middle that looks along -Z, with its window and pointer.
#[derive(Clone, Copy)]
struct Viewer {
    camera: Entity,
    window: Entity,
    pointer: Entity,
}

fn picking_app(rate: f64) -> (App, Viewer) {
    let plugins = (
        ClamberPlugins::default(),
        PickingPlugin,
        InteractionPlugin,
        SurfacePickingPlugin,
        CameraProjectionPlugin,
        VisibilityPlugin,
    );
    let mut app = app_with(rate, plugins);
    app.world_mut()
        .resource_mut::<PickingSettings>()
        .is_window_picking_enabled = false;
    app.init_resource::<Told>().add_systems(
        Update,
        |mut hits: MessageReader<PointerHits>, mut told: ResMut<Told>| {
            told.0 = hits.read().cloned().collect();
        },
    );
    let projection = PerspectiveProjection::default();
    let camera = Camera {
        order: 3,
        // `CameraPlugin` would compute these values, but it needs images.
        computed: ComputedCameraValues {
            clip_from_view: projection.get_clip_from_view(),
            target_info: Some(RenderTargetInfo {
                physical_size: UVec2::splat(1000),
                scale_factor: 1.0,
            }),
            ..ComputedCameraValues::default()
        },
        ..Camera::default()
    };
    let world = app.world_mut();
    let window = world.spawn((Window::default(), PrimaryWindow)).id();
    let place = Transform::from_xyz(0.0, 1.0, 8.0);
    let projection = Projection::Perspective(projection);
    let camera = world.spawn((camera, projection, place)).id();
    let pointer = world.spawn(PointerId::Mouse).id();
    let viewer = Viewer {
        camera,
        window,
        pointer,
    };
    (app, viewer)
}

/// The location on the window at which a point in the world is seen.
fn location(app: &App, viewer: Viewer, place: Vec3) -> Location {
    let camera = app.world().get::<Camera>(viewer.camera).unwrap();
    let from = app.world().get::<GlobalTransform>(viewer.camera).unwrap();
    let target = RenderTarget::default().normalize(Some(viewer.window));
    Location {
        target: target.unwrap(),
        position: camera.world_to_viewport(from, place).unwrap(),
    }
}

/// Moves the pointer to a point in the world, and returns the hits there.
fn point_at(app: &mut App, viewer: Viewer, place: Vec3) -> Vec<(Entity, HitData)> {
    let location = location(app, viewer, place);
    let mut pointer = app.world_mut().entity_mut(viewer.pointer);
    *pointer.get_mut().unwrap() = PointerLocation::new(location);
    app.update();
    let told = &app.world().resource::<Told>().0;
    assert!(told.iter().all(|hits| hits.order == 3.0), "{told:?}");
    told.iter().flat_map(|hits| hits.picks.clone()).collect()
}

/// The first hit of Bevy's own ray cast, from the camera through a point in the world.
fn bevy_hit(app: &mut App, viewer: Viewer, place: Vec3) -> Option<Vec3> {
    let position = location(app, viewer, place).position;
    let camera = app.world().get::<Camera>(viewer.camera).unwrap();
    let from = app.world().get::<GlobalTransform>(viewer.camera).unwrap();
    let ray = camera.viewport_to_world(from, position).unwrap();
    let cast = move |mut meshes: MeshRayCast| {
        let settings = MeshRayCastSettings::default().with_visibility(RayCastVisibility::Any);
        meshes
            .cast_ray(ray, &settings)
            .first()
            .map(|(_, hit)| hit.point)
    };
    app.world_mut().run_system_once(cast).unwrap()
}

/// Bends the limb's upper half to lie along -X.
fn bend_down(app: &mut App, limb: &Limb) {
    let mut joint = app.world_mut().entity_mut(limb.joints[1]);
    joint.get_mut::<Transform>().unwrap().rotation = bend(core::f64::consts::FRAC_PI_4);
    app.update();
}

/// A point on the front skin of the upper half in the bind pose, and one in the bent pose.
const MODELLED: Vec3 = Vec3::new(0.05, 1.7, 0.2);
const BENT: Vec3 = Vec3::new(-0.7, 1.05, 0.2);

#[test]
fn a_pointer_hits_the_pose_where_bevys_ray_cast_hits_the_bind_pose() {
    // bevy#23378
    let (mut app, viewer) = picking_app(60.0);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    bend_down(&mut app, &limb);

    let bevy = bevy_hit(&mut app, viewer, MODELLED).unwrap();
    assert!((bevy - MODELLED).length() < 1e-4, "{bevy}");
    assert_eq!(bevy_hit(&mut app, viewer, BENT), None);

    assert_eq!(point_at(&mut app, viewer, MODELLED), []);
    let hits = point_at(&mut app, viewer, BENT);
    let [(entity, hit)] = &hits[..] else {
        panic!("{hits:?}");
    };
    assert_eq!((*entity, hit.camera), (limb.mesh, viewer.camera));
    let (point, normal) = (hit.position.unwrap(), hit.normal.unwrap());
    assert!((point - BENT).length() < 1e-4, "{hit:?}");
    assert!((normal - Vec3::Z).length() < 1e-4, "{hit:?}");
    // The depth is from the near plane, 0.1 m in front of the eye; the eye is 7.8 m in front of the skin.
    let along = (BENT - Vec3::new(0.0, 1.0, 8.0)).length() * (1.0 - 0.1 / 7.8);
    assert!((hit.depth - along).abs() < 1e-4, "{hit:?}");

    // With this component Bevy's backend no longer hits the limb, as the documentation says.
    let nothing = SimplifiedMesh(Handle::default());
    app.world_mut().entity_mut(limb.mesh).insert(nothing);
    assert_eq!(bevy_hit(&mut app, viewer, MODELLED), None);
    assert_eq!(point_at(&mut app, viewer, BENT).len(), 1);
}

#[test]
fn a_pointer_hits_skin_where_bevys_ray_cast_hits_the_air_in_front_of_it() {
    // bevy#25605: skinning ignores the transform of the mesh's own entity.
    let (mut app, viewer) = picking_app(60.0);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    let mut mesh = app.world_mut().entity_mut(limb.mesh);
    *mesh.get_mut::<Transform>().unwrap() = Transform::from_xyz(0.0, 0.0, 2.0);
    app.update();
    let skin = Vec3::new(0.1, 0.55, 0.2);
    let bevy = bevy_hit(&mut app, viewer, skin).unwrap();
    assert!((bevy.z - 2.2).abs() < 1e-4, "{bevy}");
    let hits = point_at(&mut app, viewer, skin);
    let point = hits[0].1.position.unwrap();
    assert!((point - skin).length() < 1e-4, "{hits:?}");
}

#[test]
fn a_hit_is_a_point_of_the_pose_that_the_last_frame_drew() {
    let (mut app, viewer) = picking_app(30.0);
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems));
    let place = Transform::from_xyz(0.1, 0.2, -0.3).with_scale(Vec3::splat(0.8));
    let limb = limb(&mut app, place, SkinnedCollider::default());
    let mesh = app.world().get::<Mesh3d>(limb.mesh).unwrap();
    let mesh = app.world().resource::<Assets<Mesh>>().get(mesh).unwrap();
    let indices: Vec<usize> = mesh.indices().unwrap().iter().collect();
    let (mut worst, mut count) = (0.0f64, 0);
    for frame in 0..60 {
        // A point on the front of the upper half.
        let at = drawn(&app, &limb, 60).lerp(drawn(&app, &limb, 83), 0.5);
        let at = at.as_vec3();
        let vertices: Vec<_> = (0..84).map(|vertex| drawn(&app, &limb, vertex)).collect();
        for (entity, hit) in point_at(&mut app, viewer, at) {
            assert_eq!(entity, limb.mesh);
            let pick = hit.extra_as::<SurfacePick>().unwrap();
            let triangle = pick.source_triangle.unwrap() as usize;
            let corners = &indices[3 * triangle..][..3];
            let mut point = glam::DVec3::ZERO;
            for (corner, weight) in corners.iter().zip(pick.barycentric) {
                point += vertices[*corner] * f64::from(weight);
            }
            let apart = (hit.position.unwrap().as_dvec3() - point).length();
            assert!(apart < 1e-4, "frame {frame}: {apart} {pick:?}");
            worst = worst.max(apart);
            count += 1;
        }
    }
    println!("{count} hits, at most {worst:.1e} m from the skin as drawn");
    assert_eq!(count, 60);
}

#[test]
fn skin_that_is_hidden_ignored_on_other_layers_or_disabled_is_not_hit() {
    let (mut app, viewer) = picking_app(60.0);
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    app.update();
    let count = |app: &mut App| {
        // Visibility is computed at the end of a frame, and hits at the start of the next.
        app.update();
        point_at(app, viewer, MODELLED).len()
    };
    assert_eq!(count(&mut app), 1);
    let mesh = limb.mesh;

    app.world_mut().entity_mut(mesh).insert(Visibility::Hidden);
    assert_eq!(count(&mut app), 0);
    app.world_mut().entity_mut(mesh).insert(Visibility::Visible);
    assert_eq!(count(&mut app), 1);

    app.world_mut().entity_mut(mesh).insert(Pickable::IGNORE);
    assert_eq!(count(&mut app), 0);
    app.world_mut().entity_mut(mesh).remove::<Pickable>();

    let other = RenderLayers::layer(1);
    app.world_mut().entity_mut(mesh).insert(other.clone());
    assert_eq!(count(&mut app), 0);
    app.world_mut().entity_mut(viewer.camera).insert(other);
    assert_eq!(count(&mut app), 1);

    // With the front disabled, the inside of the back is hit.
    let hits = point_at(&mut app, viewer, MODELLED);
    let front = *hits[0].1.extra_as::<SurfacePick>().unwrap();
    let mut surface = app.world_mut().get_mut::<PosedSurface>(mesh).unwrap();
    surface
        .surface_mut()
        .disable_triangle(front.triangle)
        .unwrap();
    // The drawn skin is edited at the end of the frame.
    app.update();
    let hits = point_at(&mut app, viewer, MODELLED);
    let back = hits[0].1.extra_as::<SurfacePick>().unwrap();
    assert_ne!(back.triangle, front.triangle);
    let point = hits[0].1.position.unwrap();
    assert!((point.z + 0.2).abs() < 1e-4, "{point}");
}

#[test]
fn skin_blocks_the_skin_behind_it_unless_it_lets_pointers_through() {
    let (mut app, viewer) = picking_app(60.0);
    let [near, far] = [0.0, -2.0].map(|z| {
        let place = Transform::from_xyz(0.0, 0.0, z);
        limb(&mut app, place, SkinnedCollider::default()).mesh
    });
    app.update();
    let seen = |app: &mut App| {
        let mut hits = point_at(app, viewer, Vec3::new(0.05, 1.1, 0.2));
        hits.sort_by(|a, b| a.1.depth.total_cmp(&b.1.depth));
        let entities: Vec<_> = hits.iter().map(|(entity, _)| *entity).collect();
        entities
    };
    assert_eq!(seen(&mut app), [near]);
    let through = Pickable {
        should_block_lower: false,
        is_hoverable: true,
    };
    app.world_mut().entity_mut(near).insert(through);
    assert_eq!(seen(&mut app), [near, far]);
    app.world_mut().entity_mut(near).insert(Pickable::default());
    assert_eq!(seen(&mut app), [near]);
}

#[test]
fn a_click_attaches_an_entity_to_moving_skin() {
    #[derive(Resource)]
    struct Stuck(Entity);
    let (mut app, viewer) = picking_app(60.0);
    app.add_systems(PostUpdate, animate.in_set(AnimationSystems))
        .add_observer(|click: On<PointerClick>, mut commands: Commands| {
            let Some(pick) = click.hit.extra_as::<SurfacePick>() else {
                return;
            };
            if pick.anchor.surface == click.entity {
                let arrow = commands.spawn(pick.anchor).id();
                commands.insert_resource(Stuck(arrow));
            }
        });
    let limb = limb(&mut app, Transform::IDENTITY, SkinnedCollider::default());
    for action in [
        PointerAction::Move {
            delta: bevy_math::Vec2::ONE,
        },
        PointerAction::Press(PointerButton::Primary),
        PointerAction::Release(PointerButton::Primary),
    ] {
        let middle = drawn(&app, &limb, 60).lerp(drawn(&app, &limb, 63), 0.4);
        let location = location(&app, viewer, middle.as_vec3());
        app.world_mut()
            .write_message(PointerInput::new(PointerId::Mouse, location, action));
        app.update();
    }
    let Stuck(arrow) = *app.world().resource::<Stuck>();
    let anchor = app.world().get::<SurfaceAnchor>(arrow).unwrap();
    let anchor = anchor.anchor().unwrap();
    let surface = app.world().get::<PosedSurface>(limb.mesh).unwrap();
    let corners = surface.mesh().triangles()[anchor.triangle.index()];
    let corners = corners.map(|corner| surface.mesh().positions()[corner.index()]);
    let sides = [(0.2, 0.2), (0.2, -0.2), (-0.2, -0.2), (-0.2, 0.2)];
    let vertices = corners.map(|corner| {
        let side = sides.iter().position(|s| *s == (corner.x, corner.z));
        (corner.y / 0.1).round() as usize * 4 + side.unwrap()
    });
    for frame in 0..60 {
        app.update();
        let mut expected = glam::DVec3::ZERO;
        for (vertex, weight) in vertices.iter().zip(anchor.barycentric) {
            expected += drawn(&app, &limb, *vertex) * f64::from(weight);
        }
        let found = app.world().get::<GlobalTransform>(arrow).unwrap();
        let apart = (found.translation().as_dvec3() - expected).length();
        assert!(apart < 1e-4, "frame {frame}: {apart}");
        // Its +Y points along the normal, which is +Z on this side of the limb.
        let up = found.rotation() * Vec3::Y;
        assert!((up - Vec3::Z).length() < 1e-3, "frame {frame}: {up}");
    }
}
