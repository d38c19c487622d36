use clamber_surface::geometry::{Affine, Similarity, rotation_from_axis_angle};
use clamber_surface::mesh::{Influence, MeshSource};
use clamber_surface::rig::{JointId, Palette};
use clamber_surface::surface::SkinnedSurface;
use glam::{DVec3, Vec3};
use rapier3d::prelude::*;

use crate::ObstacleId;
use crate::debris::{Debris, DebrisConfig, DebrisReport};
use crate::testing::surface_of;

/// Length of a tick, seconds.
pub(super) const DT: f64 = 1.0 / 60.0;

/// The one creature of most scenes.
pub(super) const CREATURE: ObstacleId = ObstacleId(5);

/// A closed box around the origin, its faces divided into cells of about `cell` metres. It has `joints` joints evenly
/// along x, and each vertex is weighted to the two nearest.
pub(super) fn slab(half: Vec3, cell: f32, joints: usize) -> SkinnedSurface {
    let mut positions: Vec<Vec3> = Vec::new();
    let mut triangles = Vec::new();
    let sides = half.to_array();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let cells = [u, v].map(|side| (sides[side] * 2.0 / cell).ceil() as u32);
            let first = positions.len() as u32;
            for i in 0..=cells[0] {
                for j in 0..=cells[1] {
                    let mut p = [0.0; 3];
                    p[axis] = sign * sides[axis];
                    p[u] = sides[u] * (2.0 * i as f32 / cells[0] as f32 - 1.0);
                    p[v] = sides[v] * (2.0 * j as f32 / cells[1] as f32 - 1.0);
                    positions.push(Vec3::from_array(p));
                }
            }
            let at = |i: u32, j: u32| first + i * (cells[1] + 1) + j;
            for i in 0..cells[0] {
                for j in 0..cells[1] {
                    let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                    let both = if sign > 0.0 {
                        [[a, b, c], [a, c, d]]
                    } else {
                        [[a, c, b], [a, d, c]]
                    };
                    triangles.extend(both);
                }
            }
        }
    }
    let influences: Vec<Influence> = positions
        .iter()
        .flat_map(|p| {
            let last = joints.saturating_sub(1);
            let along = (p.x / half.x + 1.0) * 0.5 * last as f32;
            let joint = (along as usize).min(last.saturating_sub(1));
            let weight = along - joint as f32;
            [(joint, 1.0 - weight), ((joint + 1).min(last), weight)]
        })
        .map(|(joint, weight)| Influence {
            joint: JointId(joint as u32),
            weight,
        })
        .collect();
    surface_of(&MeshSource {
        positions: &positions,
        triangles: &triangles,
        influences: &influences,
        joint_count: joints,
        ..MeshSource::default()
    })
}

/// Every joint lifted by the height that `height` returns for its index.
pub(super) fn lifted(joints: usize, height: impl Fn(usize) -> f64) -> Palette {
    Palette::from_matrices((0..joints).map(|joint| {
        let mut matrix = Affine::IDENTITY;
        matrix.rows[1][3] = height(joint) as f32;
        matrix
    }))
}

pub(super) fn at(translation: DVec3, axis: DVec3, angle: f64) -> Similarity {
    Similarity {
        rotation: rotation_from_axis_angle(axis, angle),
        scale: 1.0,
        translation,
    }
}

/// A tick of rapier's world with debris on surfaces.
pub(super) fn step(
    world: &mut PhysicsWorld,
    debris: &mut Debris,
    surfaces: &[(ObstacleId, &SkinnedSurface)],
    dt: f64,
) -> DebrisReport {
    debris
        .before_step(surfaces, &mut world.bodies, &mut world.colliders, dt)
        .unwrap();
    world.step_with_events(debris, &());
    debris
        .after_step(
            surfaces,
            &mut world.bodies,
            &world.colliders,
            &world.broad_phase,
            &world.narrow_phase,
            dt,
        )
        .unwrap()
}

/// Adds a rock to rapier's world and to debris.
pub(super) fn add_rock(
    world: &mut PhysicsWorld,
    debris: &mut Debris,
    body: RigidBodyBuilder,
    collider: ColliderBuilder,
) -> (RigidBodyHandle, ColliderHandle) {
    let (body, collider) = world.insert(body, collider.friction(0.8).density(2500.0));
    debris
        .add(body, &mut world.bodies, &world.colliders)
        .unwrap();
    (body, collider)
}

/// Bits of the bodies' places and velocities.
pub(super) fn bits<'a>(bodies: impl Iterator<Item = &'a RigidBody>) -> Vec<u32> {
    let numbers = bodies.flat_map(|body| {
        let place = body.translation().to_array().into_iter();
        let turn = body.rotation().to_array();
        let speeds = [body.linvel().to_array(), body.angvel().to_array()];
        place.chain(turn).chain(speeds.into_iter().flatten())
    });
    numbers.map(f32::to_bits).collect()
}

/// A creature, debris, and rapier's world.
pub(super) struct Scene {
    pub(super) surface: SkinnedSurface,
    pub(super) world: PhysicsWorld,
    pub(super) debris: Debris,
    pub(super) put_back: u32,
    pub(super) caught: u32,
}

impl Scene {
    pub(super) fn new(surface: SkinnedSurface) -> Self {
        Self {
            surface,
            world: PhysicsWorld::default(),
            debris: Debris::new(DebrisConfig::default()),
            put_back: 0,
            caught: 0,
        }
    }

    pub(super) fn ground(&mut self, height: f32) {
        let ground = ColliderBuilder::cuboid(200.0, 1.0, 200.0).friction(0.6);
        let ground = ground.translation(Vector::new(0.0, height - 1.0, 0.0));
        self.world.insert_collider(ground, None);
    }

    pub(super) fn drop(
        &mut self,
        collider: ColliderBuilder,
        place: Vector,
    ) -> (RigidBodyHandle, ColliderHandle) {
        let body = RigidBodyBuilder::dynamic().translation(place);
        add_rock(&mut self.world, &mut self.debris, body, collider)
    }

    pub(super) fn tick(&mut self, palette: &Palette, world_from_model: Similarity) -> DebrisReport {
        self.surface.advance(palette, world_from_model).unwrap();
        self.step()
    }

    /// A tick of the creature as it is posed.
    pub(super) fn step(&mut self) -> DebrisReport {
        let surfaces = [(CREATURE, &self.surface)];
        let report = step(&mut self.world, &mut self.debris, &surfaces, DT);
        self.put_back += report.put_back;
        self.caught += report.caught;
        report
    }

    /// Where a body's middle is, in the creature's model space.
    pub(super) fn in_model(&self, body: RigidBodyHandle) -> DVec3 {
        let place = self.world.bodies[body].translation().as_dvec3();
        self.surface
            .world_from_model()
            .inverse_transform_point(place)
    }

    /// True if a body's middle passed through the box `half` of model space, less 5 cm on each side, since it was at
    /// `before` in model space.
    pub(super) fn went_through(&self, body: RigidBodyHandle, before: DVec3, half: Vec3) -> bool {
        let (now, half) = (self.in_model(body), half.as_dvec3() - 0.05);
        let (mut enter, mut leave) = (0.0f64, 1.0f64);
        for axis in 0..3 {
            let (from, way) = (before[axis], now[axis] - before[axis]);
            let [a, b] = [(-half[axis] - from) / way, (half[axis] - from) / way];
            if way == 0.0 {
                leave = if from.abs() <= half[axis] {
                    leave
                } else {
                    -1.0
                };
            } else {
                enter = enter.max(a.min(b));
                leave = leave.min(a.max(b));
            }
        }
        enter <= leave
    }

    /// How deep a body's collider reaches into the box `half` of model space: the deepest of many points all over the
    /// collider.
    pub(super) fn depth(&self, body: RigidBodyHandle, half: Vec3) -> f64 {
        let found = &self.world.bodies[body];
        let collider = &self.world.colliders[found.colliders()[0]];
        let shape = collider.shape();
        let mut deepest = f64::NEG_INFINITY;
        let spread = 12;
        for i in 0..=spread {
            for j in 0..spread * 2 {
                let polar = core::f64::consts::PI * f64::from(i) / f64::from(spread);
                let round = core::f64::consts::PI * f64::from(j) / f64::from(spread);
                let direction = DVec3::new(
                    libm::sin(polar) * libm::cos(round),
                    libm::cos(polar),
                    libm::sin(polar) * libm::sin(round),
                );
                let Some(support) = shape.as_support_map() else {
                    continue;
                };
                let local = support.local_support_point(direction.as_vec3());
                let place = found.position().transform_point(local).as_dvec3();
                let p = self
                    .surface
                    .world_from_model()
                    .inverse_transform_point(place);
                let inside = (half.as_dvec3() - p.abs()).min_element();
                deepest = deepest.max(inside);
            }
        }
        deepest
    }
}
