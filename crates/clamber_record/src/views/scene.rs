use clamber_climber::{ClimberConfig, ClimberMode, ClimberState};
use clamber_surface::mesh::{ColliderMesh, TriangleId, VertexId};
use foxglove::messages::{
    Color, CylinderPrimitive, SceneEntity, SceneUpdate, SpherePrimitive, TriangleListPrimitive,
};
use glam::{DQuat, DVec3, Vec3};

use super::{CLIMBER, CREATURE, color, entity, point, pose, triangle_list, vector};
use crate::climber::{ClimberTick, TakenSkin};

/// Marks a vertex that is not among the points. No point has this index.
const NOWHERE: u32 = u32::MAX;

/// Size of a climber's body, as it is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BodyShape {
    radius: f64,
    /// Vector from the centre of the climber's lower ball to the centre of its upper ball while it is upright, metres.
    upright: DVec3,
}

impl BodyShape {
    pub(crate) fn of(climber: &ClimberConfig) -> Self {
        Self {
            radius: climber.body.radius,
            upright: climber.up() * climber.body.height,
        }
    }

    /// Adds the climber's body: a ball, or a capsule if the climber is upright and has a height.
    pub(crate) fn draw(&self, state: &ClimberState, climber: &mut SceneEntity) {
        let tint = Some(color_of(state.mode));
        let diameter = 2.0 * self.radius;
        let ball = |center| SpherePrimitive {
            pose: Some(pose(center, DQuat::IDENTITY)),
            size: Some(vector(DVec3::splat(diameter))),
            color: tint,
        };
        climber.spheres = vec![ball(state.position)];
        let height = self.upright.length();
        if height > 0.0 && !state.mode.is_holding() && !state.crouched {
            climber.spheres.push(ball(state.position + self.upright));
            climber.cylinders = vec![CylinderPrimitive {
                pose: Some(pose(
                    state.position + self.upright * 0.5,
                    from_z_to(self.upright / height),
                )),
                size: Some(vector(DVec3::new(diameter, diameter, height))),
                bottom_scale: 1.0,
                top_scale: 1.0,
                color: tint,
            }];
        }
    }
}

/// The view of the scene: triangles that this tick's queries reached, the triangle that supports the climber, and
/// the climber's body.
pub(crate) struct Scene {
    tick_seconds: f64,
    shape: BodyShape,
    /// For each vertex, its index among the points; all are [`NOWHERE`] between calls. Kept so that its memory is
    /// reused.
    places: Vec<u32>,
}

impl Scene {
    pub(crate) fn new(climber: &ClimberConfig, tick_seconds: f64) -> Self {
        Self {
            tick_seconds,
            shape: BodyShape::of(climber),
            places: Vec::new(),
        }
    }

    /// The message of a tick. `positions` are the posed positions of all vertices of the surface, in model space.
    pub(crate) fn message(
        &mut self,
        nanoseconds: u64,
        taken: &ClimberTick,
        skin: &TakenSkin,
        positions: &[Vec3],
    ) -> SceneUpdate {
        let (state, scale) = (&taken.state, taken.world_from_model.scale);
        let mesh = &*skin.mesh;
        let on_creature = |id: &str| {
            let mut entity = entity(nanoseconds, id);
            entity.frame_id = CREATURE.to_owned();
            entity
        };
        let mut touched = on_creature("touched");
        if let Some(triangles) = &skin.triangles {
            // The triangles are shown until the next view of the skin, which moves on.
            let shown = self.tick_seconds * f64::from(skin.every);
            touched.lifetime = foxglove::messages::Duration::try_from_secs_f64(shown).ok();
            let triangles = triangles.iter().copied();
            let tint = color(0.95, 0.7, 0.2, 0.5);
            touched.triangles = vec![self.list(mesh, scale, positions, triangles, tint)];
        }

        let mut support = on_creature("support");
        // The key of a support on another obstacle has another meaning, and may equal a triangle's index by chance. So
        // the triangle is drawn only if the contact lies on it.
        let key = state.support.map(|support| support.attachment.material.key);
        let on = key.filter(|_| contact_is_on(taken, mesh, positions));
        let triangle = on.map(|key| TriangleId(key as u32)).into_iter();
        let tint = color(0.9, 0.1, 0.1, 1.0);
        support.triangles = vec![self.list(mesh, scale, positions, triangle, tint)];

        let mut climber = entity(nanoseconds, CLIMBER);
        self.shape.draw(state, &mut climber);
        SceneUpdate {
            deletions: Vec::new(),
            entities: [touched, support, climber]
                .into_iter()
                .skip(usize::from(skin.triangles.is_none()))
                .collect(),
        }
    }

    /// Triangles as a list of points and indices, in the creature's frame.
    fn list(
        &mut self,
        mesh: &ColliderMesh,
        scale: f64,
        positions: &[Vec3],
        triangles: impl Iterator<Item = TriangleId>,
        tint: Color,
    ) -> TriangleListPrimitive {
        self.places.resize(positions.len(), NOWHERE);
        let (mut points, mut indices) = (Vec::new(), Vec::new());
        let mut used: Vec<VertexId> = Vec::new();
        let all = mesh.triangles();
        for corners in triangles.filter_map(|triangle| all.get(triangle.index())) {
            for corner in corners {
                let vertex = corner.index();
                let (Some(place), Some(p)) = (self.places.get_mut(vertex), positions.get(vertex))
                else {
                    continue;
                };
                if *place == NOWHERE {
                    *place = points.len() as u32;
                    used.push(*corner);
                    points.push(point(p.as_dvec3() * scale));
                }
                indices.push(*place);
            }
        }
        for vertex in used {
            self.places[vertex.index()] = NOWHERE;
        }
        triangle_list(points, indices, tint)
    }
}

/// The colour of a mode: green on the feet, amber to red on the hands, blue in the air, grey when knocked down, violet
/// in the game's custom modes.
fn color_of(mode: ClimberMode) -> Color {
    match mode {
        ClimberMode::Standing => color(0.2, 0.7, 0.3, 0.9),
        ClimberMode::Sliding => color(0.6, 0.8, 0.2, 0.9),
        ClimberMode::Holding => color(0.95, 0.65, 0.1, 0.9),
        ClimberMode::LedgeHanging => color(0.9, 0.45, 0.1, 0.9),
        ClimberMode::Hanging => color(0.85, 0.2, 0.1, 0.9),
        ClimberMode::Falling => color(0.2, 0.4, 0.9, 0.9),
        ClimberMode::Tumbling => color(0.5, 0.5, 0.5, 0.9),
        ClimberMode::Custom(_) => color(0.6, 0.3, 0.8, 0.9),
    }
}

/// The shortest rotation from +Z to a unit vector; a half turn about X if the vector is -Z.
pub(crate) fn from_z_to(to: DVec3) -> DQuat {
    let axis = DVec3::Z.cross(to);
    let real = 1.0 + to.z;
    if real < 1e-9 {
        return DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0);
    }
    DQuat::from_xyzw(axis.x, axis.y, axis.z, real).normalize()
}

/// True if the climber's support names a triangle of the surface, and the contact lies near that triangle.
fn contact_is_on(taken: &ClimberTick, mesh: &ColliderMesh, positions: &[Vec3]) -> bool {
    let named = || {
        let support = taken.state.support?;
        let triangle = usize::try_from(support.attachment.material.key).ok()?;
        let corners = mesh.triangles().get(triangle)?;
        let mut position = DVec3::ZERO;
        for (corner, weight) in corners.iter().zip(support.attachment.material.coordinates) {
            position += positions.get(corner.index())?.as_dvec3() * weight;
        }
        let in_world = taken.world_from_model.transform_point(position);
        let distance = in_world.distance(support.attachment.point);
        Some(distance < 0.01 * taken.world_from_model.scale.max(1.0))
    };
    named().unwrap_or(false)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clamber_climber::Climber;
    use foxglove::messages::{Pose, Vector3};

    fn drawn(config: ClimberConfig, change: fn(&mut ClimberState)) -> SceneEntity {
        let climber = Climber::new(config, DVec3::new(1.0, 2.0, 3.0)).unwrap();
        let mut state = *climber.state();
        change(&mut state);
        let mut entity = SceneEntity::default();
        BodyShape::of(&config).draw(&state, &mut entity);
        entity
    }

    fn place(pose: Option<&Pose>) -> (DVec3, DQuat) {
        let pose = pose.unwrap();
        let Vector3 { x, y, z } = pose.position.unwrap();
        let q = pose.orientation.unwrap();
        (DVec3::new(x, y, z), DQuat::from_xyzw(q.x, q.y, q.z, q.w))
    }

    #[test]
    fn an_upright_capsule_stands_against_gravity_and_a_crouched_one_is_a_ball() {
        for up in [DVec3::Y, DVec3::X, -DVec3::Z, DVec3::new(0.0, 0.6, -0.8)] {
            let mut config = ClimberConfig::walker();
            config.body.height = 1.0;
            config.gravity = up * -9.81;
            let body = drawn(config, |_| ());
            let foot = DVec3::new(1.0, 2.0, 3.0);
            let balls = body.spheres.iter().map(|ball| place(ball.pose.as_ref()).0);
            let balls: Vec<DVec3> = balls.collect();
            assert!(
                balls[0].distance(foot) < 1e-12 && balls.len() == 2,
                "{balls:?}"
            );
            assert!(balls[1].distance(foot + up) < 1e-12, "{up} {balls:?}");
            let (middle, turn) = place(body.cylinders[0].pose.as_ref());
            assert!(middle.distance(foot + up * 0.5) < 1e-12, "{up} {middle}");
            assert!((turn * DVec3::Z).distance(up) < 1e-12, "{up} {turn}");
            for crouched in [
                drawn(config, |state| state.crouched = true),
                drawn(config, |state| state.mode = ClimberMode::Holding),
            ] {
                assert_eq!((crouched.spheres.len(), crouched.cylinders.len()), (1, 0));
            }
        }
    }

    #[test]
    fn every_mode_has_a_colour_of_its_own() {
        for mode in ClimberMode::ALL {
            for other in ClimberMode::ALL {
                let same = color_of(mode) == color_of(other);
                assert_eq!(same, mode == other, "{mode:?} {other:?}");
            }
        }
    }
}
