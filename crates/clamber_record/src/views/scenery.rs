//! Meshes that are neither climber nor creature, such as ground, rocks and buildings.

use std::collections::HashSet;
use std::sync::Arc;

use clamber_surface::geometry::Similarity;
use foxglove::messages::{FrameTransform, Log, Point3, SceneEntity, SceneUpdate};
use glam::{DQuat, DVec3, Vec3};

use super::{WORLD, color, entity, frame, left_out, point, triangle_list};

/// A mesh in the world for a recorder, for people to look at: at rest or moving, such as the ground or a rock.
#[derive(Clone, Copy, Debug)]
pub struct SceneryView<'a> {
    /// Its name. No joint, figure or other mesh may have the same name.
    pub name: &'a str,
    /// Transform from the mesh's own space to world space. The scale counts only when the mesh is recorded first.
    pub world_from_own: Similarity,
    /// Corners of its triangles in its own space; metres at a scale of 1.
    pub points: &'a [Vec3],
    /// Triangles, as indices of points. Triangles with an index out of range are left out.
    pub triangles: &'a [[u32; 3]],
    /// Red, green, blue, from 0 to 1.
    pub color: [f32; 3],
}

/// The shape of a mesh, for the file.
#[derive(Debug)]
pub(crate) struct Shape {
    points: Vec<Point3>,
    indices: Vec<u32>,
    color: [f32; 3],
}

/// A mesh in a tick.
#[derive(Debug)]
pub(crate) struct TakenScenery {
    name: Arc<str>,
    position: DVec3,
    rotation: DQuat,
    /// `Some` in the tick in which the mesh is recorded first.
    pub(crate) shape: Option<Shape>,
}

/// Names of the meshes that were recorded.
#[derive(Debug, Default)]
pub(crate) struct SceneryNames(HashSet<Arc<str>>);

impl SceneryNames {
    /// Copies the shape and the place of a new mesh, or the place of a known one if it is due; otherwise `None`.
    pub(crate) fn take(&mut self, view: &SceneryView<'_>, is_due: bool) -> Option<TakenScenery> {
        let (name, is_new) = match self.0.get(view.name) {
            Some(_) if !is_due => return None,
            Some(known) => (Arc::clone(known), false),
            None => (Arc::from(view.name), true),
        };
        if is_new {
            self.0.insert(Arc::clone(&name));
        }
        Some(TakenScenery {
            name,
            position: view.world_from_own.translation,
            rotation: view.world_from_own.rotation,
            shape: is_new.then(|| Shape::new(view)),
        })
    }
}

impl Shape {
    fn new(view: &SceneryView<'_>) -> Self {
        let point = |p: &Vec3| point(p.as_dvec3() * view.world_from_own.scale);
        let count = view.points.len() as u32;
        let sound = |corners: &&[u32; 3]| corners.iter().all(|corner| *corner < count);
        let triangles = view.triangles.iter();
        Self {
            points: view.points.iter().map(point).collect(),
            indices: triangles.filter(sound).flatten().copied().collect(),
            color: view.color,
        }
    }
}

/// Upper bounds of the bytes that a point and an index take in a message.
const BYTES: [usize; 2] = [29, 5];

/// Bytes that a mesh is assumed to take besides its points, indices and name.
const FIXED: usize = 256;

/// All meshes recorded so far. A viewer that seeks back shows only the last message, so each message has all of them.
#[derive(Debug, Default)]
pub(crate) struct Sceneries {
    entities: Vec<SceneEntity>,
    /// Approximate size of the meshes in a message, bytes.
    bytes: usize,
    /// True once a mesh was left out because of [`MOST`].
    is_full: bool,
    /// The log line that says so, until it is written.
    pub(crate) line: Option<Log>,
}

/// Largest size of all meshes together, bytes (64 MiB). All of them are written again for each new mesh, so a higher
/// limit makes files and chunks much larger.
const MOST: usize = 64 << 20;

impl Sceneries {
    /// The transforms of these meshes.
    pub(crate) fn frames(&self, nanoseconds: u64, taken: &[TakenScenery]) -> Vec<FrameTransform> {
        let placed = |one: &TakenScenery| {
            let names = (WORLD, &*one.name);
            frame(nanoseconds, names, (one.position, one.rotation))
        };
        taken.iter().map(placed).collect()
    }

    /// A message with all meshes; `None` if no new one was added.
    pub(crate) fn shapes(
        &mut self,
        nanoseconds: u64,
        taken: Vec<TakenScenery>,
    ) -> Option<SceneUpdate> {
        let before = self.entities.len();
        for one in taken {
            let Some(shape) = one.shape else { continue };
            let bytes = shape.points.len() * BYTES[0]
                + shape.indices.len() * BYTES[1]
                + one.name.len()
                + FIXED;
            if self.bytes + bytes > MOST {
                if !std::mem::replace(&mut self.is_full, true) {
                    self.line = Some(left_out("further meshes"));
                }
                continue;
            }
            self.bytes += bytes;
            let [r, g, b] = shape.color.map(f64::from);
            let mut entity = entity(nanoseconds, &one.name);
            entity.frame_id = one.name.to_string();
            let tint = color(r, g, b, 1.0);
            entity.triangles = vec![triangle_list(shape.points, shape.indices, tint)];
            self.entities.push(entity);
        }
        (self.entities.len() > before).then(|| SceneUpdate {
            deletions: Vec::new(),
            entities: self.entities.clone(),
        })
    }
}
