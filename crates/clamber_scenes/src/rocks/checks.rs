//! What the scene holds against the library, by means that owe nothing to its queries; but that a rock lies on
//! the giant is asked of one.

use std::fmt;

use clamber_surface::surface::SkinnedSurface;
use clamber_world::Obstacle;
use clamber_world::rapier3d::prelude::*;
use glam::DVec3;

use super::Rocks;
use crate::{solid_angle, valley};

/// What became of the rocks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// How many there are.
    pub rocks: usize,
    /// How many lie on the giant, or on others there.
    pub on_giant: usize,
    /// How many lie in the valley.
    pub on_ground: usize,
    /// How often the middle of one was seen inside the giant or under the ground.
    pub tunnelled: usize,
    /// Deepest that any that had settled reached into the giant, metres.
    pub deepest: f64,
    /// Bodies put back in front of skin, over all ticks.
    pub put_back: u32,
    /// Bodies caught between skin, over all ticks.
    pub caught: u32,
}

impl Outcome {
    /// True if the last look found each of them on the giant or in the valley, none in the air.
    pub fn all_lie(&self) -> bool {
        self.on_giant + self.on_ground == self.rocks
    }

    /// Looks at whether rocks are inside the giant or under the ground.
    pub fn look(&mut self, scene: &Rocks<'_>) {
        let mut positions = Vec::new();
        scene.surface.skin_all(&mut positions);
        let root = scene.surface.world_from_model();
        for rock in scene.rocks() {
            let place = scene.world.bodies[*rock].translation().as_dvec3();
            let inside = solid_angle::is_inside(
                &positions,
                scene.surface.mesh(),
                root.inverse_transform_point(place),
            );
            let under = place.y < valley::height(place.x, place.z);
            self.tunnelled += usize::from(inside || under);
        }
    }

    /// Looks at where they lie, now that they have settled, and how deep in the skin.
    pub fn settle(&mut self, scene: &Rocks<'_>) {
        self.rocks = scene.rocks().len();
        (self.on_giant, self.on_ground) = (0, 0);
        for rock in scene.rocks() {
            let place = scene.world.bodies[*rock].translation().as_dvec3();
            let high = place.y - valley::height(place.x, place.z);
            let skin = scene.surface.closest_point(place, PILE);
            self.on_ground += usize::from(high < PILE);
            self.on_giant += usize::from(high >= PILE && skin.is_some());
            self.deepest = self.deepest.max(depth(&scene.surface, &scene.world, *rock));
        }
    }
}

/// How far a rock's middle may be from what it lies on, others between included, metres.
const PILE: f64 = 2.5;

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "  rocks                          {:>8}", self.rocks)?;
        writeln!(f, "  still on the giant             {:>8}", self.on_giant)?;
        writeln!(f, "  in the valley                  {:>8}", self.on_ground)?;
        writeln!(f, "  seen inside the giant          {:>8}", self.tunnelled)?;
        writeln!(
            f,
            "  deepest in its skin, settled    {:>5.1} mm",
            self.deepest * 1e3
        )?;
        writeln!(f, "  put back in front of the skin  {:>8}", self.put_back)?;
        writeln!(f, "  caught in a fold               {:>8}", self.caught)
    }
}

/// Directions in which a rock is felt for its farthest points, along each of two angles.
const SPREAD: u32 = 10;

/// How deep a body reaches into the skin, metres; 0 if it does not. Over points all over the body that
/// the mesh winds around, the distance to the nearest triangle; over the mesh's vertices that are in the
/// body, their way out of it.
pub fn depth(surface: &SkinnedSurface, world: &PhysicsWorld, body: RigidBodyHandle) -> f64 {
    let (root, mesh) = (surface.world_from_model(), surface.mesh());
    let body = &world.bodies[body];
    let collider = &world.colliders[body.colliders()[0]];
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    let mut deepest = 0.0f64;
    for vertex in &positions {
        let place = root.transform_point_f32(*vertex).as_vec3();
        let local = body.position().inverse_transform_point(place);
        let nearest = collider.shape().project_local_point(local, false);
        if nearest.is_inside {
            let out = f64::from((nearest.point - local).length());
            deepest = deepest.max(out);
        }
    }
    let Some(support) = collider.shape().as_support_map() else {
        return deepest;
    };
    for polar in 0..=SPREAD {
        for round in 0..2 * SPREAD {
            let angle = |steps: u32| core::f64::consts::PI * f64::from(steps) / f64::from(SPREAD);
            let (polar, round) = (angle(polar), angle(round));
            let direction = DVec3::new(
                libm::sin(polar) * libm::cos(round),
                libm::cos(polar),
                libm::sin(polar) * libm::sin(round),
            );
            let local = support.local_support_point(direction.as_vec3());
            let place = body.position().transform_point(local).as_dvec3();
            let in_model = root.inverse_transform_point(place);
            // Far from the skin no sum over all triangles is needed.
            let near = surface.in_model().closest_point(in_model.as_vec3(), 0.5);
            if let Some(near) = near
                && solid_angle::is_inside(&positions, mesh, in_model)
            {
                deepest = deepest.max(near.distance * root.scale);
            }
        }
    }
    deepest
}
