//! Films a battle.

mod camera;
mod overlays;

use std::path::PathBuf;

use clamber::glam::DVec3;
use clamber::gltf::VisualMesh;
use clamber::render::{Drawn, Frame, Gif, Gpu, Look, Overlay, RenderError, RenderMeshId, Renderer};
use clamber::world::rapier3d::dynamics::RigidBodyHandle;
use clamber_scenes::battle::{Battle, BattleOptions, TICK};
use clamber_scenes::giant;
use clamber_scenes::picture::{Stage, add_plain, add_visual, light, sharp};

use crate::Failure;
use crate::options::{FilmOptions, OverlayKind};
use camera::Views;

/// Number of ticks of the climber's path that are drawn.
const WAY: usize = 90;

/// Length of a drawn arrow, metres.
const ARROW: f64 = 0.8;

/// A camera, the scene that it films, and the outputs of its pictures.
pub(crate) struct Film {
    renderer: Renderer,
    stage: Stage,
    rocks: Vec<(RigidBodyHandle, RenderMeshId)>,
    /// Those of the creature's meshes that are plates, with the numbers by which its brain names them.
    plates: Vec<(RenderMeshId, u32)>,
    views: Views,
    overlays: Vec<OverlayKind>,
    /// Path of the climber's centre in the last ticks.
    way: Vec<DVec3>,
    frames: Option<PathBuf>,
    gif: Option<Gif>,
    /// Pictures a second.
    rate: f64,
    /// Ticks before the first picture.
    from: u64,
    taken: u32,
}

impl Film {
    pub(crate) fn new(battle: &BattleOptions, film: &FilmOptions) -> Result<Self, Failure> {
        let gpu = Gpu::new()?;
        eprintln!("pictures by {}", gpu.name());
        let mut renderer = Renderer::new(gpu, film.width, film.rows)?;
        let path = battle.creature.clone().unwrap_or_else(giant::path);
        let rig = clamber::gltf::load(path)?;
        let creature = add_visual(&mut renderer, &rig)?;
        let user = |mesh: &VisualMesh| mesh.primitives.first().map_or(0, |first| first.tag.user);
        let plates = creature.iter().copied().zip(rig.visual.iter().map(user));
        let plates = plates.filter(|(_, user)| *user > 0).collect();
        let stage = Stage::new(&mut renderer, creature)?;
        if let Some(folder) = &film.frames {
            let failed = |error| format!("{}: {error}", folder.display());
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        let gif = film.gif.as_ref().map(|path| {
            let delay = (100.0 / film.rate).round() as u16;
            Gif::create(path, film.width / 2, film.rows / 2, delay)
        });
        Ok(Self {
            renderer,
            stage,
            rocks: Vec::new(),
            plates,
            views: Views::new(film.camera),
            overlays: film.overlay.clone(),
            way: Vec::new(),
            frames: film.frames.clone(),
            gif: gif.transpose()?,
            rate: film.rate,
            from: (film.from / TICK) as u64,
            taken: 0,
        })
    }
}

impl Film {
    /// Draws the battle's rocks from now on.
    fn add_rocks(&mut self, battle: &Battle<'_>) -> Result<(), RenderError> {
        let meshes = battle.rocks.meshes(&battle.world);
        for (number, (rock, mesh)) in meshes.into_iter().enumerate() {
            let shade = 0.24 + 0.03 * (number % 5) as f32;
            let color = [shade, shade * 0.95, shade * 0.86];
            // Round shapes have so many triangles that their edges may be shaded smoothly.
            let mesh = if mesh.1.len() <= 12 {
                sharp(&mesh)
            } else {
                mesh
            };
            let mesh = add_plain(&mut self.renderer, &mesh, color, Look::Stone)?;
            self.rocks.push((rock, mesh));
        }
        Ok(())
    }

    /// True unless a mesh is a plate that is broken.
    fn is_whole(&self, mesh: RenderMeshId, battle: &Battle<'_>) -> bool {
        let plate = self.plates.iter().find(|(id, _)| *id == mesh);
        let (Some((_, user)), Some(life)) = (plate, battle.life()) else {
            return true;
        };
        let files = &life.kind().brain().file().body.plates;
        let index = files.iter().position(|file| file.user == *user);
        index.is_none_or(|index| life.state().plate(index) > 0)
    }
}

impl crate::Camera for Film {
    /// Takes a picture if it is time for one.
    fn watch(&mut self, battle: &Battle<'_>) -> Result<(), Failure> {
        self.way.push(battle.climber().state().position);
        self.way.drain(..self.way.len().saturating_sub(WAY));
        self.stage.watch(battle, TICK)?;
        let camera = self.views.follow(battle);
        let Some(ticks) = battle.tick().checked_sub(self.from) else {
            return Ok(());
        };
        // The rate holds on average, even if it does not divide the ticks of a second.
        if ticks as f64 * self.rate * TICK + 1e-9 < f64::from(self.taken) {
            return Ok(());
        }
        if self.taken == 0 {
            self.add_rocks(battle)?;
        }
        let rocks = self.rocks.iter().map(|(rock, mesh)| Drawn {
            mesh: *mesh,
            world_from_model: battle.placed(*rock),
            palette: None,
        });
        let others = self.stage.drawn(battle, battle.palette()).into_iter();
        let others = others.filter(|drawn| self.is_whole(drawn.mesh, battle));
        let drawn = rocks.chain(others).collect();
        let mut overlay = overlays::draw(&self.overlays, battle, camera.eye, &self.way);
        arrows(&mut overlay, battle);
        let light = light(battle, battle.height);
        let mut image = self.renderer.draw(&Frame {
            camera,
            light,
            drawn,
            overlay,
        })?;
        if let Some(gif) = &mut self.gif {
            let mut half = image.halved();
            overlays::write(&self.overlays, battle, &mut half);
            gif.push(&half)?;
        }
        overlays::write(&self.overlays, battle, &mut image);
        if let Some(folder) = &self.frames {
            image.write_png(&folder.join(format!("{:05}.png", self.taken)))?;
        }
        self.taken += 1;
        Ok(())
    }
}

/// Draws the arrows and stones of a fight as lines.
fn arrows(over: &mut Overlay, battle: &Battle<'_>) {
    let Some(arena) = battle.arena() else {
        return;
    };
    battle.touched(|obstacles| {
        let all = arena.projectiles().iter();
        for place in all.filter_map(|one| arena.place(one, obstacles)) {
            let nock = place.tip - place.direction * ARROW;
            over.line(nock, place.tip, 3.0, [0.85, 0.8, 0.72, 1.0]);
        }
    });
}
