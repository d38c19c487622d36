//! Films a battle.

mod camera;
mod overlays;

use std::path::PathBuf;

use clamber::glam::DVec3;
use clamber::render::{Frame, Gif, Gpu, Overlay, Renderer};
use clamber_scenes::battle::{Battle, BattleOptions, TICK};
use clamber_scenes::giant;
use clamber_scenes::picture::{Stage, add_visual, light};

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
        let stage = Stage::new(&mut renderer, creature)?.with_plates(&rig);
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
            self.stage.add_rocks(&mut self.renderer, battle)?;
        }
        let drawn = self.stage.drawn(battle, battle.palette());
        let mut overlay = overlays::draw(&self.overlays, battle, camera.eye, &self.way);
        arrows(&mut overlay, battle);
        let light = light(battle, battle.height());
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
