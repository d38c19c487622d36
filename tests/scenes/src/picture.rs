//! A battle for the renderer: meshes of its creature, its climber and the ground, light and cameras.

mod arrows;

use arrows::Arrows;
use clamber_gltf::Model;
use clamber_render::{
    Camera, Drawn, Light, Look, RenderError, RenderMesh, RenderMeshId, Renderer, SkinSource,
    visual_meshes,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{ColliderMesh, Influence, VertexId};
use clamber_surface::rig::Palette;
use glam::{DVec3, Vec3};
use thiserror::Error;

use crate::battle::Battle;
use crate::hero::{Hero, HeroError, hero_path};
use crate::valley;

/// Distance between neighbouring vertices of the drawn ground, metres.
const GROUND_CELL: f64 = 2.0;

/// The meshes of a battle, as added to a renderer, and the body of its climber.
#[derive(Clone, Debug)]
pub struct Stage {
    creature: Vec<RenderMeshId>,
    ground: RenderMeshId,
    outcrop: RenderMeshId,
    hero: Hero,
    hero_meshes: Vec<RenderMeshId>,
    watched: bool,
    /// Those of the creature's meshes that are plates, with the numbers by which its brain names them.
    plates: Vec<(RenderMeshId, u32)>,
    arrows: Option<Arrows>,
}

/// Why a stage cannot be set.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StageError {
    /// A mesh cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// There is no hero.
    #[error(transparent)]
    Hero(#[from] HeroError),
}

impl Stage {
    /// Adds the meshes of the ground, the outcrop and the hero to a renderer. `creature` has the ids of the creature's
    /// meshes in the same renderer, from [`add_visual`] or [`add_collider`].
    ///
    /// # Errors
    /// [`StageError`].
    pub fn new(renderer: &mut Renderer, creature: Vec<RenderMeshId>) -> Result<Self, StageError> {
        let model = clamber_gltf::load(hero_path()).map_err(HeroError::from)?;
        Ok(Self {
            creature,
            ground: add_ground(renderer)?,
            outcrop: add_outcrop(renderer)?,
            hero_meshes: add_visual(renderer, &model)?,
            hero: Hero::new(model)?,
            watched: false,
            plates: Vec::new(),
            arrows: None,
        })
    }

    /// Draws what a fight has: the hero's sword and bow in its hands while it uses them, and arrows and stones.
    ///
    /// # Errors
    /// [`StageError::Render`] if the meshes cannot be added to the renderer.
    pub fn with_arms(mut self, renderer: &mut Renderer) -> Result<Self, StageError> {
        self.arrows = Some(Arrows::add(renderer)?);
        self.hero = self.hero.with_arms();
        Ok(self)
    }

    /// The hero as it was last [watched](Stage::watch).
    pub fn hero(&self) -> &Hero {
        &self.hero
    }

    /// Tells which of the creature's meshes are plates, which are drawn until they break: the file's whose meshes
    /// [`add_visual`] added.
    #[must_use]
    pub fn with_plates(mut self, model: &Model) -> Self {
        let user = |mesh: &clamber_gltf::VisualMesh| {
            let first = mesh.primitives.first();
            first.map_or(0, |primitive| primitive.tag.user)
        };
        let all = self
            .creature
            .iter()
            .copied()
            .zip(model.visual.iter().map(user));
        self.plates = all.filter(|(_, user)| *user > 0).collect();
        self
    }

    /// True unless a mesh is a plate that is broken.
    fn shows(&self, mesh: RenderMeshId, battle: &Battle<'_>) -> bool {
        let plate = self.plates.iter().find(|(id, _)| *id == mesh);
        let (Some((_, user)), Some(life)) = (plate, battle.life()) else {
            return true;
        };
        let files = &life.kind().brain().file().body.plates;
        let index = files.iter().position(|file| file.user == *user);
        index.is_none_or(|index| life.state().plate(index) > 0)
    }

    /// Poses the hero for the battle's current tick, `dt` seconds after the last one that was watched.
    ///
    /// # Errors
    /// [`StageError::Hero`].
    pub fn watch(&mut self, battle: &Battle<'_>, dt: f64) -> Result<(), StageError> {
        self.hero.watch(battle, dt)?;
        self.watched = true;
        Ok(())
    }

    /// Everything to draw for the battle's current tick, with the creature in the pose `palette`:
    /// [`Battle::palette`] or another one. The hero is drawn as it was last [watched](Stage::watch).
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
        if battle.has_outcrop() {
            drawn.push(at(self.outcrop, Similarity::IDENTITY, None));
        }
        drawn.extend(self.arrows.iter().flat_map(|arrows| arrows.drawn(battle)));
        let shown = self.creature.iter();
        let shown = shown.filter(|mesh| self.shows(**mesh, battle));
        drawn.extend(shown.map(|mesh| Drawn {
            mesh: *mesh,
            world_from_model: *battle.surface().world_from_model(),
            palette: Some(palette),
        }));
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
///
/// # Errors
/// [`RenderError`].
pub fn add_visual(
    renderer: &mut Renderer,
    model: &Model,
) -> Result<Vec<RenderMeshId>, RenderError> {
    visual_meshes(model)
        .map(|mesh| renderer.add_mesh(&mesh.source()))
        .collect()
}

/// Adds a collider to a renderer, in one colour.
///
/// # Errors
/// [`RenderError`].
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

fn add_ground(renderer: &mut Renderer) -> Result<RenderMeshId, RenderError> {
    let cells = (valley::SIZE / GROUND_CELL) as u32;
    let place = |index: u32| f64::from(index) * GROUND_CELL - valley::SIZE / 2.0;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for row in 0..=cells {
        for column in 0..=cells {
            let (x, z) = (place(column), place(row));
            positions.push(DVec3::new(x, valley::height(x, z), z).as_vec3());
            if row < cells && column < cells {
                let [a, b] = [row, row + 1].map(|row| row * (cells + 1) + column);
                triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
            }
        }
    }
    renderer.add_mesh(&RenderMesh {
        positions: &positions,
        looks: &vec![Look::Ground; positions.len()],
        triangles: &triangles,
        ..RenderMesh::default()
    })
}

/// The triangles with three corners of their own each, so that edges are shaded sharp.
pub fn sharp(corners: &[Vec3], triangles: &[[u32; 3]]) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let own = triangles.iter().flatten();
    let own = own.map(|corner| corners[*corner as usize]).collect();
    let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
    (own, triangles.collect())
}

fn add_outcrop(renderer: &mut Renderer) -> Result<RenderMeshId, RenderError> {
    let (corners, triangles) = crate::battle::outcrop();
    let (positions, triangles) = sharp(&corners, &triangles);
    renderer.add_mesh(&RenderMesh {
        positions: &positions,
        colors: &vec![[0.3, 0.28, 0.25]; positions.len()],
        looks: &vec![Look::Stone; positions.len()],
        triangles: &triangles,
        ..RenderMesh::default()
    })
}
