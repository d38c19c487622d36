//! Surface tags of meshes: from a component, from an observer, and changed later.

use bevy_app::App;
use bevy_clamber::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Vec3};
use bevy_shape::Ray3d;
use bevy_transform::components::Transform;

use super::common::{Limb, add_bindposes, add_mesh, app, limb_mesh, spawn_limb, wait};

const FUR: SurfaceTag = SurfaceTag::new(SurfaceKind::Fur);
const STONE: SurfaceTag = SurfaceTag::new(SurfaceKind::Stone).with_user(1);

/// A limb with a name, without a collider.
fn named(app: &mut App, name: &str, x: f32) -> Limb {
    let (mesh, inverse_bindposes) = (add_mesh(app, limb_mesh()), add_bindposes(app));
    let limb = spawn_limb(
        app,
        mesh,
        inverse_bindposes,
        Transform::from_xyz(x, 0.0, 0.0),
    );
    let mut mesh = app.world_mut().entity_mut(limb.mesh);
    mesh.insert(Name::new(name.to_owned()));
    limb
}

/// The tag of the skin that a ray along -Z hits.
fn tag_at(app: &mut App, x: f32) -> SurfaceTag {
    let ray = Ray3d::new(Vec3::new(x + 0.03, 1.5, 9.0), Dir3::NEG_Z);
    let ask = move |surfaces: SurfaceQuery| surfaces.cast_ray(ray, 20.0, &SurfaceFilter::default());
    app.world_mut().run_system_once(ask).unwrap().unwrap().tag
}

/// Tags colliders by the names of their meshes, when they are inserted.
fn tag_by_name(
    added: On<Add<SkinnedCollider>>,
    names: Query<&Name, Without<ColliderTag>>,
    mut commands: Commands,
) {
    if names
        .get(added.entity)
        .is_ok_and(|name| name.contains("fur"))
    {
        commands.entity(added.entity).insert(ColliderTag(FUR));
    }
}

#[test]
fn an_observer_tags_meshes_that_have_no_tag() {
    let mut app = app(60.0);
    app.add_observer(tag_by_name);
    let collider = SkinnedCollider::default();
    let furry = named(&mut app, "furry", 0.0);
    let bald = named(&mut app, "bald", 5.0);
    let tagged = named(&mut app, "furry, but of stone", 10.0);
    // Tag and collider are inserted in one command, or in two.
    let world = app.world_mut();
    world
        .entity_mut(tagged.mesh)
        .insert((collider, ColliderTag(STONE)));
    world.entity_mut(furry.mesh).insert(collider);
    world.entity_mut(bald.mesh).insert(ColliderTag::default());
    world.entity_mut(bald.mesh).insert(collider);
    for limb in [furry, bald, tagged] {
        wait(&mut app, limb.mesh);
    }
    assert_eq!(tag_at(&mut app, 0.0), FUR);
    assert_eq!(tag_at(&mut app, 5.0), SurfaceTag::default());
    assert_eq!(tag_at(&mut app, 10.0), STONE);
}

#[test]
fn without_one_the_tag_is_the_default_until_it_is_changed() {
    let mut app = app(60.0);
    let limb = named(&mut app, "furry", 0.0);
    app.world_mut()
        .entity_mut(limb.mesh)
        .insert(SkinnedCollider::default());
    wait(&mut app, limb.mesh);
    assert_eq!(tag_at(&mut app, 0.0), SurfaceTag::default());
    app.world_mut()
        .entity_mut(limb.mesh)
        .insert(ColliderTag(FUR));
    app.update();
    wait(&mut app, limb.mesh);
    assert_eq!(tag_at(&mut app, 0.0), FUR);
}
