//! A battle for the renderer: meshes of its creature, its climber and the ground, light and cameras.

use clamber_gltf::Model;
use clamber_render::{
    Camera, Drawn, Light, Look, RenderError, RenderMesh, RenderMeshId, Renderer, SkinSource,
    visual_meshes,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{ColliderMesh, Influence, VertexId};
use clamber_surface::rig::Palette;
use glam::DVec3;

use crate::battle::{Battle, SceneError, Triangles, outcrop};
use crate::hero::{Hero, hero_path};
use crate::valley;

/// Distance between neighbouring vertices of the drawn ground, metres.
const GROUND_CELL: f64 = 2.0;

/// Colour of the outcrop, linear red, green and blue.
const OUTCROP: [f32; 3] = [0.3, 0.28, 0.25];

/// The meshes of a battle, as added to a renderer, and the body of its climber.
#[derive(Clone, Debug)]
pub struct Stage {
    creature: Vec<RenderMeshId>,
    ground: RenderMeshId,
    outcrop: RenderMeshId,
    hero: Hero,
    hero_meshes: Vec<RenderMeshId>,
    watched: bool,
}

impl Stage {
    /// Adds the meshes of the ground, the outcrop and the hero to a renderer. `creature` has the ids of the creature's
    /// meshes in the same renderer, from [`add_visual`] or [`add_collider`].
    pub fn new(renderer: &mut Renderer, creature: Vec<RenderMeshId>) -> Result<Self, SceneError> {
        let model = clamber_gltf::load(hero_path())?;
        Ok(Self {
            creature,
            ground: add_plain(renderer, &valley::mesh(GROUND_CELL), [1.0; 3], Look::Ground)?,
            outcrop: add_plain(renderer, &sharp(&outcrop()), OUTCROP, Look::Stone)?,
            hero_meshes: add_visual(renderer, &model)?,
            hero: Hero::new(model.rig)?,
            watched: false,
        })
    }

    /// Poses the hero for the battle's current tick, `dt` seconds after the last one that was watched.
    pub fn watch(&mut self, battle: &Battle<'_>, dt: f64) -> Result<(), SceneError> {
        self.hero.watch(battle, dt)?;
        self.watched = true;
        Ok(())
    }

    /// Everything to draw for the battle's current tick, with the creature in the pose `palette`: [`Battle::palette`]
    /// or another one. The hero is drawn as it was last [watched](Stage::watch).
    pub fn drawn<'a>(&'a self, battle: &Battle<'_>, palette: &'a Palette) -> Vec<Drawn<'a>> {
        let at = |mesh, world_from_model, palette| Drawn {
            mesh,
            world_from_model,
            palette,
        };
        let mut drawn = vec![at(self.ground, Similarity::IDENTITY, None)];
        if self.watched {
            let (place, palette) = (self.hero.world_from_model(), self.hero.palette());
            let meshes = self.hero_meshes.iter();
            drawn.extend(meshes.map(|mesh| at(*mesh, place, Some(palette))));
        }
        if battle.arena().is_some() {
            drawn.push(at(self.outcrop, Similarity::IDENTITY, None));
        }
        let place = *battle.surface().world_from_model();
        let creature = self.creature.iter();
        drawn.extend(creature.map(|mesh| at(*mesh, place, Some(palette))));
        drawn
    }
}

/// Sunlight for a battle with a creature `height` metres tall.
pub fn light(battle: &Battle<'_>, height: f64) -> Light {
    let root = battle.surface().world_from_model();
    let center = root.translation + DVec3::Y * (0.45 * height);
    Light::over(center, height * 0.85)
}

/// A camera that shows all of a creature `height` metres tall, from `heading` radians around Y from +Z. It stays above
/// the ground.
pub fn orbit(battle: &Battle<'_>, height: f64, heading: f64) -> Camera {
    let middle = battle.surface().world_from_model().translation + DVec3::Y * (0.42 * height);
    let mut camera = Camera::orbit(middle, 1.45 * height, heading, -0.12);
    let least = valley::height(camera.eye.x, camera.eye.z) + 0.04 * height;
    camera.eye.y = camera.eye.y.max(least);
    camera
}

/// A camera that looks at the climber from its position plus `away`, metres.
pub fn beside(battle: &Battle<'_>, away: DVec3) -> Camera {
    let place = battle.climber().state().position;
    Camera::new(place + away, place)
}

/// Adds the visual meshes of a creature's file to a renderer, with fur and stone where the file has them.
pub fn add_visual(
    renderer: &mut Renderer,
    model: &Model,
) -> Result<Vec<RenderMeshId>, RenderError> {
    visual_meshes(model)
        .map(|mesh| renderer.add_mesh(&mesh.source()))
        .collect()
}

/// Adds a collider to a renderer, in one colour.
pub fn add_collider(
    renderer: &mut Renderer,
    mesh: &ColliderMesh,
    color: [f32; 3],
) -> Result<RenderMeshId, RenderError> {
    let count = mesh.positions().len() as u32;
    let (mut influences, mut ends) = (Vec::new(), Vec::new());
    for vertex in 0..count {
        let own = mesh.influences(VertexId(vertex));
        influences.extend(own.map(|(joint, weight)| Influence { joint, weight }));
        ends.push(influences.len() as u32);
    }
    let triangles: Vec<[u32; 3]> = mesh.triangles().iter().map(|t| t.map(|v| v.0)).collect();
    renderer.add_mesh(&RenderMesh {
        positions: mesh.positions(),
        colors: &vec![color; count as usize],
        triangles: &triangles,
        skin: Some(SkinSource {
            influences: &influences,
            ends: &ends,
            joint_count: mesh.joint_count(),
        }),
        ..RenderMesh::default()
    })
}

/// The triangles with three corners of their own each, so that edges are shaded sharp.
pub fn sharp((corners, triangles): &Triangles) -> Triangles {
    let own = triangles.iter().flatten();
    let own = own.map(|corner| corners[*corner as usize]).collect();
    let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    (own, triangles.collect())
}

/// Adds a mesh in one colour to a renderer.
pub fn add_plain(
    renderer: &mut Renderer,
    (positions, triangles): &Triangles,
    color: [f32; 3],
    look: Look,
) -> Result<RenderMeshId, RenderError> {
    renderer.add_mesh(&RenderMesh {
        positions,
        colors: &vec![color; positions.len()],
        looks: &vec![look; positions.len()],
        triangles,
        ..RenderMesh::default()
    })
}
