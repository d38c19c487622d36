//! Surfaces as they were in the last tick, to notice skin that is at a place without having moved there.

use clamber_surface::mesh::{MeshId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use crate::ObstacleId;

/// Number of vertices that stand for all skin. More would notice the jump of a smaller limb, but each costs the
/// skinning of a vertex, twice a tick.
const MARKS: usize = 16;

/// Skin has jumped if a vertex starts its tick farther from its last place than this fraction of the surface's radius:
/// less than a rock could hide in, and far more than rounding.
const JUMP: f64 = 1e-4;

/// Rounding of a position a tick ago that is expressed in the frame of now, as a fraction of its size in model space:
/// 16 units of f32's last place.
const ROUNDING: f64 = 16.0 * f32::EPSILON as f64;

/// A surface as it was in the last tick.
///
/// A jump is noticed by where the skin was, not by calls of [`SkinnedSurface::teleport`] or a count of poses. These may
/// differ after debris was restored from a snapshot, and the run would then go on differently.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    mesh: MeshId,
    /// The surface's mask of hidden skin: hidden skin that shows again counts as having appeared.
    mask: u64,
    /// Positions in world space of vertices that are spread evenly over the mesh; `None` for removed ones.
    marks: [Option<DVec3>; MARKS],
    /// True if the surface is new, or has jumped or got other skin since the tick before.
    pub(super) jumped: bool,
}

impl Seen {
    fn of(surface: &SkinnedSurface) -> Self {
        let space = surface.in_model();
        let marks = std::array::from_fn(|mark| {
            let position = space.position(vertex(surface, mark))?;
            Some(surface.world_from_model().transform_point_f32(position))
        });
        Self {
            mesh: surface.mesh().id(),
            mask: surface.mask(),
            marks,
            jumped: true,
        }
    }

    /// True if the surface's tick starts where this one ended, with the same skin.
    fn goes_on(&self, surface: &SkinnedSurface) -> bool {
        if surface.mesh().id() != self.mesh || surface.mask() != self.mask {
            return false;
        }
        let (space, world_from_model) = (surface.in_model(), surface.world_from_model());
        let radius = surface.bounding_ball().map_or(0.0, |(_, radius)| radius);
        self.marks.iter().enumerate().all(|(mark, seen)| {
            let previous = space.previous_position(vertex(surface, mark));
            let (Some(seen), Some(previous)) = (seen, previous) else {
                return seen.is_none() == previous.is_none();
            };
            let size = previous.as_dvec3().abs().max_element() * world_from_model.scale;
            let off = world_from_model.transform_point_f32(previous) - *seen;
            off.length() <= radius * JUMP + size * ROUNDING
        })
    }
}

/// The vertex of a mark.
fn vertex(surface: &SkinnedSurface, mark: usize) -> VertexId {
    let count = surface.mesh().positions().len();
    VertexId((count * (2 * mark + 1) / (2 * MARKS)) as u32)
}

/// Stores the surfaces of this tick in `seen`, and which of them have jumped. `order` holds their ids, ascending, with
/// their indices; `seen` gets the same order.
pub(super) fn look(
    seen: &mut Vec<(ObstacleId, Seen)>,
    order: &[(ObstacleId, usize)],
    surfaces: &[(ObstacleId, &SkinnedSurface)],
) {
    seen.retain(|(known, _)| order.binary_search_by_key(known, |(id, _)| *id).is_ok());
    for (at, (obstacle, index)) in order.iter().enumerate() {
        let surface = surfaces[*index].1;
        let now = Seen::of(surface);
        match seen.get_mut(at).filter(|(known, _)| known == obstacle) {
            Some((_, known)) => {
                let jumped = !known.goes_on(surface);
                *known = Seen { jumped, ..now };
            }
            None => seen.insert(at, (*obstacle, now)),
        }
    }
}
