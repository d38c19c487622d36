//! Checks of where the rocks are, which mostly do not use the library's queries: solid angles tell what is inside.
//!
//! Two places use the query for the closest point: to tell that a rock lies on the giant, and for the depth of a point
//! that is inside it.

use std::fmt;

use clamber::prelude::*;
use clamber::world::rapier3d::prelude::*;
use clamber_scenes::measure::larger;
use clamber_scenes::{solid_angle, valley};
use glam::DVec3;

use crate::scene::Rocks;

/// Where the rocks are, and what happened to them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Outcome {
    /// Number of rocks.
    pub(crate) rocks: usize,
    /// Rocks that lie on the giant, or on other rocks there.
    pub(crate) on_giant: usize,
    /// Rocks that lie in the valley.
    pub(crate) on_ground: usize,
    /// How often a rock's centre was found inside the giant or under the ground.
    pub(crate) tunnelled: usize,
    /// The largest depth of a settled rock in the skin, metres.
    pub(crate) deepest: f64,
    /// `DebrisReport::put_back`, summed over all ticks.
    pub(crate) put_back: u32,
    /// `DebrisReport::caught`, summed over all ticks.
    pub(crate) caught: u32,
}

impl Outcome {
    /// True if the last [`Outcome::settle`] found every rock on the giant or in the valley, none in the air.
    pub(crate) fn all_lie(&self) -> bool {
        self.on_giant + self.on_ground == self.rocks
    }

    /// Counts the rocks that are inside the giant or under the ground now.
    pub(crate) fn look(&mut self, scene: &Rocks<'_>) {
        let mut positions = Vec::new();
        scene.surface.skin_all(&mut positions);
        let root = scene.surface.world_from_model();
        for rock in &scene.rocks.bodies {
            let place = scene.world.bodies[*rock].translation().as_dvec3();
            let inside = solid_angle::is_inside(
                &positions,
                scene.surface.mesh(),
                root.inverse_transform_point(place),
            );
            let under = !place.is_finite() || place.y < valley::height(place.x, place.z);
            self.tunnelled += usize::from(inside || under);
        }
    }

    /// Notes where the settled rocks lie, and the largest depth of one in the skin.
    pub(crate) fn settle(&mut self, scene: &Rocks<'_>) {
        self.rocks = scene.rocks.bodies.len();
        (self.on_giant, self.on_ground) = (0, 0);
        for rock in &scene.rocks.bodies {
            let place = scene.world.bodies[*rock].translation().as_dvec3();
            let high = place.y - valley::height(place.x, place.z);
            let skin = scene.surface.closest_point(place, PILE);
            self.on_ground += usize::from(high < PILE);
            self.on_giant += usize::from(high >= PILE && skin.is_some());
            let depth = depth(&scene.surface, &scene.world, *rock);
            self.deepest = larger(self.deepest, depth);
        }
    }
}

/// How far a rock's centre may be from the giant or the ground that it lies on, metres; other rocks may be in between.
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

/// Support points of a body are taken in so many directions per half turn, along each of two angles.
const SPREAD: u32 = 10;

/// How deep a body reaches into the skin, metres; 0 if it does not.
///
/// The larger of two depths: of the body's support points that are inside the mesh, the distance to the nearest
/// triangle; of the mesh's vertices that are inside the body, the distance to the body's surface. Reads the body's
/// first collider.
fn depth(surface: &SkinnedSurface, world: &PhysicsWorld, body: RigidBodyHandle) -> f64 {
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
            deepest = larger(deepest, out);
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
            // Far from the skin the sum over all triangles is saved.
            let near = surface.in_model().closest_point(in_model.as_vec3(), 0.5);
            if let Some(near) = near
                && solid_angle::is_inside(&positions, mesh, in_model)
            {
                deepest = larger(deepest, near.distance * root.scale);
            }
        }
    }
    deepest
}
