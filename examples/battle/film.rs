//! Films a battle.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

use clamber::glam::DVec3;
use clamber::gltf::load;
use clamber::prelude::*;
use clamber::render::{Camera, Drawn, Frame, Gif, Gpu, Look, RenderMesh, RenderMeshId, Renderer};
use clamber::world::rapier3d::prelude::*;
use clamber_scenes::battle::{Battle, BattleOptions, TICK};
use clamber_scenes::picture::{Stage, add_visual, light, orbit, sharp};
use clamber_scenes::{giant, valley};

use crate::chase::Chase;
use crate::effects::{Effects, View};
use crate::overlays::Overlays;
use crate::{CameraKind, FilmOptions};

type Failure = Box<dyn Error + Send + Sync>;

/// Rate of the battle's ticks, 1 / s.
const TICKS_A_SECOND: f64 = 60.0;

/// Rate of the orbiting camera's turn, radians a second.
const ORBIT: f64 = 0.08;

/// Distance of a close camera from the climber, metres.
const CLOSE: f64 = 2.4;

/// A camera, the scene that it films, and the outputs of its pictures.
pub(crate) struct Film {
    renderer: Renderer,
    stage: Stage,
    rocks: Vec<(RigidBodyHandle, RenderMeshId)>,
    camera: CameraKind,
    overlays: Overlays,
    effects: Effects,
    /// Rows of pixels of a picture.
    rows: u32,
    height: f64,
    frames: Option<PathBuf>,
    gif: Option<Gif>,
    raw: bool,
    /// Pictures a second.
    rate: f64,
    /// Ticks before the first picture.
    from: u32,
    tick: u32,
    taken: u32,
    chase: Chase,
}

impl Film {
    pub(crate) fn new(battle: &BattleOptions, film: &FilmOptions) -> Result<Self, Failure> {
        let gpu = Gpu::new()?;
        eprintln!("pictures by {}", gpu.name());
        let mut renderer = Renderer::new(gpu, film.width, film.rows)?;
        let path = battle.creature.clone().unwrap_or_else(giant::path);
        let model = load(path)?;
        let creature = add_visual(&mut renderer, &model)?;
        let stage = Stage::new(&mut renderer, creature)?.with_plates(&model);
        let stage = stage.with_arms(&mut renderer)?;
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
            camera: film.camera,
            overlays: Overlays::new(&film.overlay, battle.height()),
            effects: Effects::new(battle.height()),
            rows: film.rows,
            height: battle.height(),
            frames: film.frames.clone(),
            gif: gif.transpose()?,
            raw: film.raw,
            rate: film.rate,
            from: (film.from / TICK) as u32,
            tick: 0,
            taken: 0,
            chase: Chase::new(battle.height()),
        })
    }

    /// Takes a picture if it is time for one.
    pub(crate) fn watch(&mut self, battle: &Battle<'_>) -> Result<(), Failure> {
        let tick = self.tick;
        self.tick += 1;
        self.overlays.watch(battle);
        self.effects.watch(battle);
        self.stage.watch(battle, TICK)?;
        let camera = self.follow(battle);
        // The rate holds on average, even if it does not divide the ticks of a second.
        if tick < self.from {
            return Ok(());
        }
        let due = f64::from(tick - self.from) * self.rate / TICKS_A_SECOND;
        if due < f64::from(self.taken) {
            return Ok(());
        }
        if self.rocks.is_empty() {
            self.add_rocks(battle)?;
        }
        let mut drawn = self.stage.drawn(battle, battle.palette());
        drawn.extend(self.rocks.iter().map(|(rock, mesh)| {
            let body = &battle.world().bodies[*rock];
            Drawn {
                mesh: *mesh,
                world_from_model: Similarity {
                    rotation: body.rotation().as_dquat().normalize(),
                    scale: 1.0,
                    translation: body.translation().as_dvec3(),
                },
                palette: None,
            }
        }));
        let mut overlay = self.overlays.draw(battle, &camera);
        let view = View {
            camera,
            rows: self.rows,
        };
        let sword = self.stage.hero().sword();
        self.effects.draw(&mut overlay, battle, &view, sword);
        let frame = Frame {
            camera,
            light: light(battle, self.height),
            drawn,
            overlay,
        };
        let mut image = self.renderer.draw(&frame)?;
        if let Some(gif) = &mut self.gif {
            let mut half = image.halved();
            self.overlays.write(battle, &mut half);
            gif.push(&half)?;
        }
        self.overlays.write(battle, &mut image);
        if let Some(folder) = &self.frames {
            image.write_png(&folder.join(format!("{:05}.png", self.taken)))?;
        }
        if self.raw {
            std::io::stdout().write_all(&image.pixels)?;
        }
        self.taken += 1;
        Ok(())
    }

    fn follow(&mut self, battle: &Battle<'_>) -> Camera {
        let root = battle.surface().world_from_model();
        let middle = root.translation + DVec3::Y * (0.42 * self.height);
        match self.camera {
            CameraKind::Orbit => {
                let heading = 0.6 + ORBIT * f64::from(self.tick) * TICK;
                orbit(battle, self.height, heading)
            }
            CameraKind::Fixed => {
                let eye = DVec3::new(0.0, valley::height(0.0, 0.0) + 0.08 * self.height, 0.0);
                let mut camera = Camera::new(eye, middle);
                camera.field_of_view = 65f64.to_radians();
                camera
            }
            CameraKind::Chase => self.chase.follow(battle),
            CameraKind::Close => close(battle),
        }
    }

    fn add_rocks(&mut self, battle: &Battle<'_>) -> Result<(), Failure> {
        for (number, rock) in battle.rocks().bodies().iter().enumerate() {
            let body = &battle.world().bodies[*rock];
            let shade = 0.24 + 0.03 * (number % 5) as f32;
            for collider in body.colliders() {
                let shape = battle.world().colliders[*collider].shared_shape();
                let color = [shade, shade * 0.95, shade * 0.86];
                let mesh = add_rock(&mut self.renderer, shape, color)?;
                self.rocks.push((*rock, mesh));
            }
        }
        Ok(())
    }
}

/// A camera a few steps from the climber: outward from the skin that it holds, and to a side, so that hands and face
/// are seen. It stays in front of skin that would hide the climber.
fn close(battle: &Battle<'_>) -> Camera {
    let (config, state) = (battle.climber().config(), battle.climber().state());
    let up = config.up();
    let side = state.heading.cross(up);
    let out = match state.support {
        Some(support) if state.mode.is_holding() => support.normal_in_world(),
        _ => -state.heading,
    };
    let target = state.position + up * 0.45;
    let away = (out * 0.75 + side * 0.75 + up * 0.35).normalize_or(up);
    let hit = battle.surface().cast_ray(target, away, CLOSE + 0.2);
    let free = hit.map_or(CLOSE, |hit| (hit.distance - 0.2).max(0.5 * hit.distance));
    let mut eye = target + away * free;
    eye.y = eye.y.max(valley::height(eye.x, eye.z) + 0.3);
    Camera::new(eye, target)
}

fn add_rock(
    renderer: &mut Renderer,
    shape: &SharedShape,
    color: [f32; 3],
) -> Result<RenderMeshId, Failure> {
    let (positions, triangles) = match shape.as_typed_shape() {
        TypedShape::Ball(ball) => ball.to_trimesh(24, 16),
        TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
        TypedShape::Capsule(capsule) => capsule.to_trimesh(24, 12),
        other => return Err(format!("cannot draw a rock of the shape {other:?}").into()),
    };
    // Round shapes have enough triangles that no edges are visible.
    let (positions, triangles) = match shape.as_typed_shape() {
        TypedShape::Cuboid(_) => sharp(&positions, &triangles),
        _ => (positions, triangles),
    };
    let colors = vec![color; positions.len()];
    let looks = vec![Look::Stone; positions.len()];
    Ok(renderer.add_mesh(&RenderMesh {
        positions: &positions,
        colors: &colors,
        looks: &looks,
        triangles: &triangles,
        ..RenderMesh::default()
    })?)
}
