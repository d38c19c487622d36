//! A battle for the renderer: meshes of its creature, its climber and the ground, light and cameras.

use clamber_climber::{Climber, ClimberMode};
use clamber_gltf::Rig;
use clamber_render::{
    Camera, Drawn, Light, Look, RenderError, RenderMesh, RenderMeshId, Renderer, SkinSource,
    visual_meshes,
};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{ColliderMesh, Influence, VertexId};
use clamber_surface::rig::Palette;
use clamber_world::rapier3d::prelude::*;
use glam::{DQuat, DVec3, Vec3};

use crate::battle::Battle;
use crate::valley;

/// Distance between neighbouring vertices of the drawn ground, metres.
const GROUND_CELL: f64 = 2.0;

/// The meshes of a battle, as added to a renderer.
#[derive(Clone, Debug)]
pub struct Stage {
    creature: Vec<RenderMeshId>,
    ground: RenderMeshId,
    outcrop: RenderMeshId,
    /// Body, head, and an arm.
    climber: [RenderMeshId; 3],
}

/// The drawn climber, metres. Body and arms are capsules: half the length of the segment, and the radius. The head
/// is a ball: its radius.
const BODY: [f32; 2] = [0.42, 0.24];
const HEAD: f32 = 0.17;
const ARM: [f32; 2] = [0.24, 0.075];

/// Metres from the body's centre along its axis to the shoulders and to the head's centre, and from the axis to a
/// shoulder.
const SHOULDER: f64 = 0.45;
const CROWN: f64 = 0.84;
const ACROSS: f64 = 0.3;

impl Stage {
    /// Adds the meshes of the ground, the outcrop and the climber to a renderer. `creature` has the ids of the
    /// creature's meshes in the same renderer, from [`add_visual`] or [`add_collider`].
    ///
    /// # Errors
    /// [`RenderError`].
    pub fn new(renderer: &mut Renderer, creature: Vec<RenderMeshId>) -> Result<Self, RenderError> {
        let capsule = |[half, radius]: [f32; 2]| {
            let shape = SharedShape::capsule_y(half, radius);
            let capsule = shape.as_capsule().map(|capsule| capsule.to_trimesh(24, 12));
            capsule.unwrap_or_default()
        };
        let head = Ball::new(HEAD).to_trimesh(24, 16);
        Ok(Self {
            creature,
            ground: add_ground(renderer)?,
            outcrop: add_outcrop(renderer)?,
            climber: [
                add_plain(renderer, &capsule(BODY), [0.36, 0.08, 0.06])?,
                add_plain(renderer, &head, [0.55, 0.36, 0.26])?,
                add_plain(renderer, &capsule(ARM), [0.55, 0.36, 0.26])?,
            ],
        })
    }

    /// Everything to draw for the battle's current tick, with the creature in the pose `palette`:
    /// [`Battle::palette`] or another one.
    pub fn drawn<'a>(&self, battle: &Battle<'_>, palette: &'a Palette) -> Vec<Drawn<'a>> {
        let posture = Posture::of(battle.climber());
        let along = DQuat::from_rotation_arc(DVec3::Y, posture.along);
        let at = |mesh, rotation, translation| Drawn {
            mesh,
            world_from_model: Similarity {
                rotation,
                scale: 1.0,
                translation,
            },
            palette: None,
        };
        let [body, head, arm] = self.climber;
        let mut drawn = vec![
            at(self.ground, DQuat::IDENTITY, DVec3::ZERO),
            at(body, along, posture.middle),
            at(head, along, posture.middle + posture.along * CROWN),
        ];
        for side in [-1.0, 1.0] {
            let shoulder =
                posture.middle + posture.along * SHOULDER + posture.across * (side * ACROSS);
            let reach = posture.hands + posture.across * (side * ACROSS) - shoulder;
            let direction = reach.normalize_or(-posture.along);
            let half = f64::from(ARM[0]);
            drawn.push(at(
                arm,
                DQuat::from_rotation_arc(DVec3::Y, direction),
                shoulder + direction * half,
            ));
        }
        if battle.has_outcrop() {
            drawn.push(at(self.outcrop, DQuat::IDENTITY, DVec3::ZERO));
        }
        drawn.extend(self.creature.iter().map(|mesh| Drawn {
            mesh: *mesh,
            world_from_model: *battle.surface().world_from_model(),
            palette: Some(palette),
        }));
        drawn
    }
}

/// The posture of the drawn figure, by the climber's mode. It stands at the climber's ball.
struct Posture {
    /// Centre of the body.
    middle: DVec3,
    /// Unit vectors towards the head, and to the figure's right.
    along: DVec3,
    across: DVec3,
    hands: DVec3,
}

impl Posture {
    fn of(climber: &Climber) -> Self {
        let (config, state) = (climber.config(), climber.state());
        let (up, position) = (config.up(), state.position);
        let contact = state
            .support
            .map_or(position, |support| support.attachment.point);
        let across = state.heading.cross(up).normalize_or(DVec3::X);
        let standing = |along: DVec3, hands: DVec3| {
            let middle = position + along * (0.72 - config.body.radius);
            Self {
                middle,
                along,
                across,
                hands: middle + hands,
            }
        };
        match state.mode {
            ClimberMode::Standing => standing(up, -up * 0.3),
            ClimberMode::Sliding => {
                let along = (up - state.heading * 0.5).normalize_or(up);
                standing(along, state.heading - along * 0.2)
            }
            ClimberMode::Falling | ClimberMode::Custom(_) => standing(up, up),
            ClimberMode::Tumbling => {
                let middle = position - up * (config.body.radius - f64::from(BODY[1]));
                Self {
                    middle,
                    along: state.heading,
                    across,
                    hands: middle + state.heading * 0.2,
                }
            }
            ClimberMode::Holding => {
                let normal = (position - contact).normalize_or(up);
                let along = (up - normal * up.dot(normal)).normalize_or(state.heading);
                Self {
                    middle: position,
                    along,
                    across: along.cross(normal).normalize_or(across),
                    hands: contact + along * 0.9,
                }
            }
            ClimberMode::Hanging | ClimberMode::LedgeHanging => {
                let arm = contact - position;
                let along = if state.mode == ClimberMode::Hanging {
                    arm.normalize_or(up)
                } else {
                    up
                };
                Self {
                    middle: contact - along * (arm.dot(along) + 0.2),
                    along,
                    across,
                    hands: contact,
                }
            }
        }
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
pub fn add_visual(renderer: &mut Renderer, rig: &Rig) -> Result<Vec<RenderMeshId>, RenderError> {
    visual_meshes(rig)
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

fn add_plain(
    renderer: &mut Renderer,
    (positions, triangles): &(Vec<Vec3>, Vec<[u32; 3]>),
    color: [f32; 3],
) -> Result<RenderMeshId, RenderError> {
    renderer.add_mesh(&RenderMesh {
        positions,
        colors: &vec![color; positions.len()],
        triangles,
        ..RenderMesh::default()
    })
}
