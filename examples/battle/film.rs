//! Films a battle.

use std::error::Error;
use std::io::Write;
use std::path::PathBuf;

use clamber::gltf::{Rig, load};
use clamber::mesh::PartId;
use clamber::prelude::*;
use clamber::render::{
    Camera, Color, Drawn, Frame, Gif, Gpu, Light, Look, MeshId, MeshSource, Overlay, Renderer,
    SkinSource,
};
use clamber::rig::JointId;
use clamber::surface::{JointMaps, PartBounds};
use clamber::world::rapier3d::prelude::*;
use clamber_scenes::battle::{Battle, BattleOptions, CREATURE, TICK};
use clamber_scenes::{giant, valley};
use glam::{DQuat, DVec3, Vec3};

use crate::{CameraKind, FilmOptions, OverlayKind};

type Failure = Box<dyn Error + Send + Sync>;

/// Metres between two vertices of the ground that is drawn.
const GROUND_CELL: f64 = 2.0;

/// Radians a second that the orbiting camera goes round.
const ORBIT: f64 = 0.08;

/// Points of the climber's way that are drawn.
const WAY: usize = 90;

/// A camera, what it films, and where the pictures go.
pub(crate) struct Film {
    renderer: Renderer,
    creature: Vec<MeshId>,
    ground: MeshId,
    climber: [MeshId; 2],
    rocks: Vec<(RigidBodyHandle, MeshId)>,
    camera: CameraKind,
    overlays: Vec<OverlayKind>,
    height: f64,
    frames: Option<PathBuf>,
    gif: Option<Gif>,
    raw: bool,
    /// Ticks from one picture to the next.
    every: u32,
    /// Ticks before the first.
    from: u32,
    tick: u32,
    taken: u32,
    way: Vec<DVec3>,
    /// Where a chasing camera looks from and at, behind what it follows.
    eye: Option<[DVec3; 2]>,
}

impl Film {
    pub(crate) fn new(battle: &BattleOptions, film: &FilmOptions) -> Result<Self, Failure> {
        let gpu = Gpu::new()?;
        eprintln!("pictures by {}", gpu.name());
        let mut renderer = Renderer::new(gpu, film.width, film.rows)?;
        let path = battle.creature.clone().unwrap_or_else(giant::path);
        let creature = add_creature(&mut renderer, &load(path)?)?;
        let ground = add_ground(&mut renderer)?;
        let climber = [
            add_solid(
                &mut renderer,
                &SharedShape::capsule_y(0.42, 0.24),
                [0.36, 0.08, 0.06],
                Look::Plain,
            )?,
            add_solid(
                &mut renderer,
                &SharedShape::ball(0.17),
                [0.55, 0.36, 0.26],
                Look::Plain,
            )?,
        ];
        if let Some(folder) = &film.frames {
            std::fs::create_dir_all(folder)?;
        }
        let gif = film.gif.as_ref().map(|path| {
            let delay = (100.0 / f64::from(film.rate)).round() as u16;
            Gif::create(path, film.width / 2, film.rows / 2, delay)
        });
        Ok(Self {
            renderer,
            creature,
            ground,
            climber,
            rocks: Vec::new(),
            camera: film.camera,
            overlays: film.overlay.clone(),
            height: battle.height(),
            frames: film.frames.clone(),
            gif: gif.transpose()?,
            raw: film.raw,
            every: ((1.0 / TICK).round() as u32 / film.rate).max(1),
            from: (film.from / TICK) as u32,
            tick: 0,
            taken: 0,
            way: Vec::new(),
            eye: None,
        })
    }

    /// Takes a picture if it is time for one.
    pub(crate) fn watch(&mut self, battle: &Battle<'_>) -> Result<(), Failure> {
        let tick = self.tick;
        self.tick += 1;
        let up = battle.climber().config().up();
        let feet = battle.climber().state().position - up * battle.climber().config().radius;
        self.way.push(feet);
        if self.way.len() > WAY {
            self.way.remove(0);
        }
        let camera = self.follow(battle);
        if tick < self.from || !(tick - self.from).is_multiple_of(self.every) {
            return Ok(());
        }
        if self.rocks.is_empty() {
            self.add_rocks(battle)?;
        }
        let root = *battle.surface().world_from_model();
        let center = root.translation + DVec3::Y * (0.45 * self.height);
        let mut drawn = vec![Drawn {
            mesh: self.ground,
            world_from_model: Similarity::IDENTITY,
            palette: None,
        }];
        drawn.extend(self.creature.iter().map(|mesh| Drawn {
            mesh: *mesh,
            world_from_model: root,
            palette: Some(battle.palette()),
        }));
        let at = |mesh, translation, rotation: DQuat| Drawn {
            mesh,
            world_from_model: Similarity {
                rotation,
                scale: 1.0,
                translation,
            },
            palette: None,
        };
        let [body, head] = self.climber;
        drawn.push(at(body, feet + up * 0.72, DQuat::IDENTITY));
        drawn.push(at(head, feet + up * 1.56, DQuat::IDENTITY));
        for (rock, mesh) in &self.rocks {
            let body = &battle.world().bodies[*rock];
            let turn = body.rotation().as_dquat().normalize();
            drawn.push(at(*mesh, body.translation().as_dvec3(), turn));
        }
        let frame = Frame {
            camera,
            light: Light::over(center, self.height * 0.85),
            drawn,
            overlay: self.overlay(battle),
        };
        let image = self.renderer.draw(&frame)?;
        if let Some(folder) = &self.frames {
            image.write_png(&folder.join(format!("{:05}.png", self.taken)))?;
        }
        if let Some(gif) = &mut self.gif {
            gif.push(&image.halved())?;
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
        let above_ground = |eye: DVec3, least: f64| {
            DVec3::new(
                eye.x,
                eye.y.max(valley::height(eye.x, eye.z) + least),
                eye.z,
            )
        };
        match self.camera {
            CameraKind::Orbit => {
                let heading = 0.6 + ORBIT * f64::from(self.tick) * TICK;
                let mut camera = Camera::orbit(middle, 1.45 * self.height, heading, -0.12);
                camera.eye = above_ground(camera.eye, 0.04 * self.height);
                camera
            }
            CameraKind::Fixed => {
                let eye = DVec3::new(0.0, valley::height(0.0, 0.0) + 0.08 * self.height, 0.0);
                let mut camera = Camera::new(eye, middle);
                camera.field_of_view = 65f64.to_radians();
                camera
            }
            CameraKind::Chase => {
                let state = battle.climber().state();
                let outward = (state.position - middle) * DVec3::new(1.0, 0.0, 1.0);
                let behind = -(root.rotation * DVec3::Z) + outward.normalize_or_zero() * 0.6;
                let wanted =
                    state.position + (behind.normalize_or(DVec3::X) * 8.0 + DVec3::Y * 4.0);
                let wanted = [wanted, state.position];
                let [eye, target] = self.eye.unwrap_or(wanted);
                let eye = above_ground(eye.lerp(wanted[0], 0.06), 1.0);
                let target = target.lerp(wanted[1], 0.3);
                self.eye = Some([eye, target]);
                Camera::new(eye, target)
            }
        }
    }

    fn overlay(&self, battle: &Battle<'_>) -> Overlay {
        let mut over = Overlay::default();
        for kind in &self.overlays {
            match kind {
                OverlayKind::Joints => joints(&mut over, battle),
                OverlayKind::Capsules => bounds(&mut over, battle, false),
                OverlayKind::Spheres => bounds(&mut over, battle, true),
                OverlayKind::Touched => touched(&mut over, battle),
                OverlayKind::Contact => contact(&mut over, battle, &self.way),
                OverlayKind::Velocity => velocity(&mut over, battle),
                OverlayKind::Rocks => rocks(&mut over, battle),
            }
        }
        over
    }

    fn add_rocks(&mut self, battle: &Battle<'_>) -> Result<(), Failure> {
        for (number, rock) in battle.rocks().bodies().iter().enumerate() {
            let body = &battle.world().bodies[*rock];
            let shade = 0.24 + 0.03 * (number % 5) as f32;
            for collider in body.colliders() {
                let shape = battle.world().colliders[*collider].shared_shape();
                let mesh = add_solid(
                    &mut self.renderer,
                    shape,
                    [shade, shade * 0.95, shade * 0.86],
                    Look::Stone,
                )?;
                self.rocks.push((*rock, mesh));
            }
        }
        Ok(())
    }
}

fn add_creature(renderer: &mut Renderer, rig: &Rig) -> Result<Vec<MeshId>, Failure> {
    let mut meshes = Vec::new();
    for visual in &rig.visual {
        let mut colors = vec![[1.0; 3]; visual.positions.len()];
        let mut looks = vec![Look::Plain; visual.positions.len()];
        let mut triangles = Vec::new();
        for primitive in &visual.primitives {
            let material = primitive.material.map(|index| &rig.materials[index]);
            let base = material.map_or([1.0; 4], |material| material.base_color);
            let look = material.map_or(Look::Plain, |material| look_of(material.tag));
            for corner in primitive.triangles.iter().flatten() {
                let vertex = *corner as usize;
                let own = visual.colors.get(vertex).copied().unwrap_or([1.0; 4]);
                colors[vertex] = [0, 1, 2].map(|channel| base[channel] * own[channel]);
                looks[vertex] = look;
            }
            triangles.extend_from_slice(&primitive.triangles);
        }
        meshes.push(renderer.add_mesh(&MeshSource {
            positions: &visual.positions,
            normals: &visual.normals,
            colors: &colors,
            looks: &looks,
            triangles: &triangles,
            skin: Some(SkinSource {
                influences: &visual.influences,
                ends: &visual.influence_ends,
                joint_count: rig.skeleton.joints().len(),
            }),
        })?);
    }
    Ok(meshes)
}

fn look_of(tag: SurfaceTag) -> Look {
    match tag.kind {
        SurfaceKind::Fur => Look::Fur,
        SurfaceKind::Stone => Look::Stone,
        _ => Look::Plain,
    }
}

fn add_ground(renderer: &mut Renderer) -> Result<MeshId, Failure> {
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
    let looks = vec![Look::Ground; positions.len()];
    Ok(renderer.add_mesh(&MeshSource {
        positions: &positions,
        looks: &looks,
        triangles: &triangles,
        ..MeshSource::default()
    })?)
}

fn add_solid(
    renderer: &mut Renderer,
    shape: &SharedShape,
    color: [f32; 3],
    look: Look,
) -> Result<MeshId, Failure> {
    let (positions, triangles) = match shape.as_typed_shape() {
        TypedShape::Ball(ball) => ball.to_trimesh(24, 16),
        TypedShape::Cuboid(cuboid) => cuboid.to_trimesh(),
        TypedShape::Capsule(capsule) => capsule.to_trimesh(24, 12),
        other => return Err(format!("a rock of a shape that is not drawn: {other:?}").into()),
    };
    // Corners of their own, so that edges stay sharp; round shapes have so many that it does not show.
    let sharp = matches!(shape.as_typed_shape(), TypedShape::Cuboid(_));
    let (positions, triangles): (Vec<Vec3>, Vec<[u32; 3]>) = if sharp {
        let corners = triangles.iter().flatten();
        let positions = corners.map(|corner| positions[*corner as usize]).collect();
        let triangles = (0..triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
        (positions, triangles.collect())
    } else {
        (positions, triangles)
    };
    let colors = vec![color; positions.len()];
    let looks = vec![look; positions.len()];
    Ok(renderer.add_mesh(&MeshSource {
        positions: &positions,
        colors: &colors,
        looks: &looks,
        triangles: &triangles,
        ..MeshSource::default()
    })?)
}

fn joints(over: &mut Overlay, battle: &Battle<'_>) {
    let root = battle.surface().world_from_model();
    let skeleton = &battle.creature().skeleton;
    let at = |joint: JointId| {
        let frame = battle.palette().model_from_joint(joint)?;
        Some(root.transform_point(frame.translation))
    };
    for (index, joint) in (0..).zip(skeleton.joints()) {
        let Some(place) = at(JointId(index)) else {
            continue;
        };
        if let Some(parent) = joint.parent.and_then(at) {
            over.line(parent, place, 3.0, [1.0, 0.75, 0.1, 0.9]);
        }
        over.sphere(place, 0.25, 1.5, [1.0, 0.35, 0.05, 0.9]);
    }
}

fn bounds(over: &mut Overlay, battle: &Battle<'_>, spheres: bool) {
    const COLOR: Color = [0.2, 0.8, 1.0, 0.5];
    let mesh = battle.surface().mesh();
    let root = battle.surface().world_from_model();
    let bounds = PartBounds::new(mesh);
    let Ok(maps) = JointMaps::new(mesh, battle.palette()) else {
        return;
    };
    for part in (0..bounds.part_count() as u32).map(PartId) {
        if spheres && let Some(sphere) = bounds.sphere(part, &maps) {
            let center = root.transform_point_f32(sphere.center);
            over.sphere(center, f64::from(sphere.radius) * root.scale, 1.0, COLOR);
        }
        if !spheres && let Some(capsule) = bounds.capsule(part, &maps) {
            let [a, b] = [capsule.a, capsule.b].map(|end| root.transform_point_f32(end));
            over.capsule(a, b, f64::from(capsule.radius) * root.scale, 1.0, COLOR);
        }
    }
}

fn touched(over: &mut Overlay, battle: &Battle<'_>) {
    let surface = battle.surface();
    for triangle in surface.touched_triangles() {
        if let Some(corners) = posed(surface, triangle) {
            over.triangle(corners, [1.0, 0.55, 0.05, 0.35]);
            let [a, b, c] = corners;
            over.path(&[a, b, c, a], 1.0, [1.0, 0.7, 0.2, 0.8]);
        }
    }
}

/// The corners of a triangle, in the world.
fn posed(surface: &SkinnedSurface, triangle: TriangleId) -> Option<[DVec3; 3]> {
    let corners = surface.mesh().triangles().get(triangle.index())?;
    let [a, b, c] = corners.map(|vertex| surface.position(vertex));
    let root = surface.world_from_model();
    Some([a?, b?, c?].map(|corner| root.transform_point_f32(corner)))
}

fn contact(over: &mut Overlay, battle: &Battle<'_>, way: &[DVec3]) {
    over.path(way, 2.5, [1.0, 1.0, 1.0, 0.8]);
    let footing = battle.climber().state().footing;
    let Some(footing) = footing.filter(|footing| footing.obstacle == CREATURE) else {
        return;
    };
    let triangle = TriangleId(footing.point.key as u32);
    if let Some(corners) = posed(battle.surface(), triangle) {
        over.triangle(corners, [0.1, 1.0, 0.3, 0.55]);
        let [a, b, c] = corners;
        over.path(&[a, b, c, a], 3.0, [0.1, 1.0, 0.3, 1.0]);
    }
    over.sphere(footing.contact, 0.08, 2.0, [1.0, 0.1, 0.1, 1.0]);
}

fn velocity(over: &mut Overlay, battle: &Battle<'_>) {
    let footing = battle.climber().state().footing;
    let Some(footing) = footing.filter(|footing| footing.obstacle == CREATURE) else {
        return;
    };
    if let Some(motion) = Obstacle::motion(battle.surface(), &footing.point, TICK) {
        over.arrow(
            motion.position,
            motion.velocity * 0.5,
            3.0,
            [1.0, 0.2, 0.8, 1.0],
        );
    }
}

fn rocks(over: &mut Overlay, battle: &Battle<'_>) {
    for (_, collider) in battle.world().colliders.iter() {
        let Some(mesh) = collider
            .shape()
            .as_trimesh()
            .filter(|_| collider.is_enabled())
        else {
            continue;
        };
        for triangle in mesh.triangles() {
            let at = |corner: Vec3| collider.position().transform_point(corner).as_dvec3();
            let corners = [at(triangle.a), at(triangle.b), at(triangle.c)];
            over.triangle(corners, [0.1, 0.5, 1.0, 0.35]);
            over.path(
                &[corners[0], corners[1], corners[2], corners[0]],
                1.5,
                [0.3, 0.7, 1.0, 0.9],
            );
        }
    }
}
