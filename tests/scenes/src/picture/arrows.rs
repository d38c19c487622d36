//! Arrows and stones of a fight as they are drawn: in flight, in the skin, and falling.

use clamber_fight::{Arena, ProjectileKind, ProjectilePlace};
use clamber_render::{Drawn, Look, RenderError, RenderMesh, RenderMeshId, Renderer};
use clamber_surface::geometry::Similarity;
use glam::{DMat3, DQuat, DVec3, Vec3};

use crate::battle::Battle;

/// Length of an arrow, and how thick its shaft and how long and wide its head and its vanes are, metres. The head is
/// thicker than a real one, so that it is seen.
const LENGTH: f32 = 0.8;
const SHAFT: f32 = 0.011;
const HEAD: [f32; 2] = [0.09, 0.024];
const VANES: [f32; 2] = [0.16, 0.055];

/// Sides of the shaft.
const SIDES: u32 = 6;

/// Radius of a drawn stone, metres.
const STONE: f64 = 0.09;

const WOOD: [f32; 3] = [0.36, 0.22, 0.10];
const IRON: [f32; 3] = [0.30, 0.30, 0.32];
const FEATHER: [f32; 3] = [0.85, 0.80, 0.72];

/// The meshes of projectiles: an arrow whose tip is at the origin and that points along +Z, and a stone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrows {
    arrow: RenderMeshId,
    stone: RenderMeshId,
}

impl Arrows {
    pub(super) fn add(renderer: &mut Renderer) -> Result<Self, RenderError> {
        let (positions, triangles, colors) = arrow();
        let arrow = renderer.add_mesh(&RenderMesh {
            positions: &positions,
            colors: &colors,
            triangles: &triangles,
            ..RenderMesh::default()
        })?;
        let (corners, faces) = octahedron();
        let stone = renderer.add_mesh(&RenderMesh {
            positions: &corners,
            colors: &vec![[0.3; 3]; corners.len()],
            looks: &vec![Look::Stone; corners.len()],
            triangles: &faces,
            ..RenderMesh::default()
        })?;
        Ok(Self { arrow, stone })
    }

    /// All projectiles that there are now.
    pub(super) fn drawn<'a>(&self, battle: &Battle<'_>) -> Vec<Drawn<'a>> {
        let Some(arena) = battle.arena() else {
            return Vec::new();
        };
        let places = places(battle, arena);
        let drawn = places.into_iter().map(|(kind, place)| {
            let (mesh, scale) = match kind {
                ProjectileKind::Arrow => (self.arrow, 1.0),
                ProjectileKind::Stone => (self.stone, STONE),
            };
            Drawn {
                mesh,
                world_from_model: Similarity {
                    rotation: facing(place.direction),
                    scale,
                    translation: place.tip,
                },
                palette: None,
            }
        });
        drawn.collect()
    }
}

fn places(battle: &Battle<'_>, arena: &Arena) -> Vec<(ProjectileKind, ProjectilePlace)> {
    battle.touched(|obstacles| {
        let all = arena.projectiles().iter();
        let placed = all.filter_map(|one| Some((one.kind, arena.place(one, obstacles)?)));
        placed.collect()
    })
}

/// The rotation that takes +Z to a unit vector.
fn facing(direction: DVec3) -> DQuat {
    let (x, y) = direction.any_orthonormal_pair();
    let frame = DMat3::from_cols(x, y, direction);
    let frame = if frame.determinant() < 0.0 {
        DMat3::from_cols(y, x, direction)
    } else {
        frame
    };
    DQuat::from_mat3(&frame).normalize()
}

type Shape = (Vec<Vec3>, Vec<[u32; 3]>, Vec<[f32; 3]>);

fn arrow() -> Shape {
    let (mut positions, mut triangles, mut colors) = (Vec::new(), Vec::new(), Vec::new());
    let mut cone = |[tip, base]: [f32; 2], [thin, thick]: [f32; 2], color: [f32; 3]| {
        let first = positions.len() as u32;
        for side in 0..SIDES {
            let (sin, cos) = libm::sincosf(side as f32 / SIDES as f32 * core::f32::consts::TAU);
            positions.push(Vec3::new(cos * thin, sin * thin, tip));
            positions.push(Vec3::new(cos * thick, sin * thick, base));
            let [a, b] = [side, (side + 1) % SIDES].map(|side| first + 2 * side);
            triangles.extend([[a, a + 1, b], [b, a + 1, b + 1]]);
        }
        colors.resize(positions.len(), color);
    };
    let [head, wide] = HEAD;
    cone([0.0, -head], [0.0, wide], IRON);
    cone([-head, -head - 1e-3], [wide, SHAFT], IRON);
    cone([-head, -LENGTH], [SHAFT, SHAFT], WOOD);
    let [long, far] = VANES;
    for vane in 0..3u32 {
        let (sin, cos) = libm::sincosf(vane as f32 / 3.0 * core::f32::consts::TAU);
        let out = Vec3::new(cos, sin, 0.0);
        let first = positions.len() as u32;
        let end = -LENGTH + 0.02;
        positions.extend([
            Vec3::Z * (end + long),
            Vec3::Z * end,
            out * far + Vec3::Z * -LENGTH,
            out * far + Vec3::Z * (end + 0.6 * long),
        ]);
        // Both sides are seen.
        for [a, b, c] in [[0, 1, 2], [0, 2, 3], [0, 2, 1], [0, 3, 2]] {
            triangles.push([first + a, first + b, first + c]);
        }
        colors.resize(positions.len(), FEATHER);
    }
    (positions, triangles, colors)
}

fn octahedron() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let corners = [
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        Vec3::NEG_X,
        Vec3::NEG_Y,
        Vec3::NEG_Z,
    ];
    let faces = [
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    super::sharp(&corners, &faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_point_along_every_direction_without_being_mirrored() {
        for direction in [DVec3::Z, DVec3::NEG_Z, DVec3::Y, DVec3::new(0.6, 0.0, -0.8)] {
            let found = facing(direction) * DVec3::Z;
            assert!(
                found.distance(direction) < 1e-12,
                "{direction} became {found}"
            );
        }
    }

    #[test]
    fn an_arrow_ends_at_its_tip_and_has_its_length() {
        let (positions, _, colors) = arrow();
        assert_eq!(positions.len(), colors.len());
        let ends = positions.iter().map(|place| place.z);
        let (back, front) = (
            ends.clone().fold(f32::MAX, f32::min),
            ends.fold(f32::MIN, f32::max),
        );
        assert_eq!((back, front), (-LENGTH, 0.0));
    }
}
