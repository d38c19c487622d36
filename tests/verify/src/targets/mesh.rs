//! Meshes made from bytes. They are small, and as unlike a limb as the contract allows.

use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, CrackPolicy, Influence, MeshSource, SurfaceKind,
    SurfaceTag, Winding,
};
use clamber_surface::rig::JointId;
use glam::Vec3;

use super::bytes::Bytes;

/// Largest coordinate of a valid mesh, 2^98: a vector of three such coordinates is shorter than 2^99.
const FARTHEST: f32 = (1u128 << 98) as f32;

/// Factors for a mesh's coordinates: some are 1, the others make very small or very large meshes.
const SCALES: [f32; 8] = [1.0, 1.0, 1.0, 1e-3, 1e3, 1e-20, 1e20, FARTHEST / 8.0];

/// A [`MeshSource`] that owns its data.
#[derive(Debug)]
pub(crate) struct Source {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) influences: Vec<Influence>,
    pub(crate) influence_ends: Vec<u32>,
    pub(crate) tags: Vec<SurfaceTag>,
    pub(crate) rest_spaces: Vec<u32>,
    pub(crate) joint_count: usize,
}

impl Source {
    /// A source without faults. It may lack a triangle with area.
    pub(crate) fn valid(bytes: &mut Bytes<'_>) -> Self {
        let scale = bytes.pick(&SCALES);
        let (mut positions, triangles) = if bytes.one_in(4) {
            grid(bytes)
        } else {
            soup(bytes)
        };
        for position in &mut positions {
            *position = (*position * scale).clamp(Vec3::splat(-FARTHEST), Vec3::splat(FARTHEST));
        }
        let joint_count = 1 + bytes.below(20);
        let (influences, influence_ends) = influences(bytes, positions.len(), joint_count);
        let tags = triangles.iter().map(|_| tag(bytes));
        Self {
            tags: tags.collect(),
            rest_spaces: Vec::new(),
            positions,
            triangles,
            influences,
            influence_ends,
            joint_count,
        }
    }

    /// [`Source::valid`], sometimes with rest spaces, sometimes with faults. The flag is true if the source has faults.
    pub(crate) fn any(bytes: &mut Bytes<'_>) -> (Self, bool) {
        let mut source = Self::valid(bytes);
        if bytes.one_in(4) {
            source.rest_spaces = (0..source.positions.len())
                .map(|_| u32::from(bytes.one_in(3)))
                .collect();
        }
        let faults = bytes.below(6).saturating_sub(3);
        for _ in 0..faults {
            source.spoil(bytes);
        }
        (source, faults > 0)
    }

    /// Makes one random change. The source may be invalid after it.
    fn spoil(&mut self, bytes: &mut Bytes<'_>) {
        let vertex = bytes.below(self.positions.len().max(1));
        let index = bytes.pick(&[0, self.positions.len() as u32, u32::MAX]);
        match bytes.below(10) {
            0 => self
                .positions
                .iter_mut()
                .skip(vertex)
                .take(1)
                .for_each(|p| *p = bytes.hostile_point()),
            1 => self.triangles.push([index, 0, 1]),
            2 => self.influences.push(Influence {
                joint: JointId(index),
                weight: bytes.hostile(),
            }),
            3 => {
                self.influences.pop();
            }
            4 => {
                self.influence_ends.pop();
            }
            5 => {
                self.influence_ends.reverse();
            }
            6 => {
                self.tags.pop();
            }
            7 => self.rest_spaces.push(index),
            8 => {
                let influence = vertex % self.influences.len().max(1);
                let influences = self.influences.iter_mut().skip(influence).take(3);
                influences.for_each(|i| i.weight = bytes.hostile());
            }
            _ => self.joint_count = bytes.pick(&[0, 1, usize::MAX]),
        }
    }

    pub(crate) fn source(&self) -> MeshSource<'_> {
        MeshSource {
            positions: &self.positions,
            triangles: &self.triangles,
            influences: &self.influences,
            influence_ends: &self.influence_ends,
            tags: &self.tags,
            rest_spaces: &self.rest_spaces,
            joint_count: self.joint_count,
        }
    }
}

/// A mesh from a valid source; `None` if no triangle of the source has area.
pub(crate) fn built(bytes: &mut Bytes<'_>) -> Option<ColliderMesh> {
    let source = Source::valid(bytes);
    let built = ColliderMesh::build(&source.source(), &options(bytes));
    built.ok().map(|(mesh, _)| mesh)
}

pub(crate) fn options(bytes: &mut Bytes<'_>) -> ColliderBuildOptions {
    ColliderBuildOptions {
        cracks: bytes.pick(&[CrackPolicy::Report, CrackPolicy::Unify]),
        winding: bytes.pick(&[Winding::Keep, Winding::Flip]),
    }
}

pub(crate) fn tag(bytes: &mut Bytes<'_>) -> SurfaceTag {
    SurfaceTag {
        kind: bytes.pick(&[SurfaceKind::Skin, SurfaceKind::Fur, SurfaceKind::Stone]),
        user: 0,
    }
}

type Shape = (Vec<Vec3>, Vec<[u32; 3]>);

/// Triangles between random vertices. They may share vertices, be duplicates, cross each other, or have no area.
fn soup(bytes: &mut Bytes<'_>) -> Shape {
    let many = bytes.one_in(4);
    let vertices = 3 + bytes.below(if many { 198 } else { 12 });
    let mut positions: Vec<Vec3> = Vec::with_capacity(vertices);
    for k in 0..vertices {
        let copied = k > 0 && bytes.one_in(8);
        positions.push(if copied {
            positions[bytes.below(k)]
        } else {
            bytes.point()
        });
    }
    let many = bytes.one_in(4);
    let triangles = 1 + bytes.below(if many { 100 } else { 10 });
    let mut corner = || bytes.below(vertices) as u32;
    let triangles = (0..triangles).map(|_| [corner(), corner(), corner()]);
    let triangles = triangles.collect();
    (positions, triangles)
}

/// A sheet of squares, flat, bent or crumpled; a large one has several clusters.
fn grid(bytes: &mut Bytes<'_>) -> Shape {
    let (width, height) = (1 + bytes.below(16), 1 + bytes.below(16));
    let crumple = bytes.pick(&[0.0, 0.0, 1e-6, 0.1, 2.0]);
    let bend = bytes.number().clamp(-1.0, 1.0);
    let mut positions = Vec::new();
    for y in 0..=height {
        for x in 0..=width {
            let (x, y) = (x as f32, y as f32);
            let z = if crumple > 0.0 { bytes.share() } else { 0.0 };
            positions.push(Vec3::new(x, y, bend * x * x / 16.0 + crumple * z));
        }
    }
    let mut triangles = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let a = (y * (width + 1) + x) as u32;
            let above = a + width as u32 + 1;
            triangles.push([a, a + 1, above + 1]);
            triangles.push([a, above + 1, above]);
        }
    }
    (positions, triangles)
}

/// Influences of every vertex, and the end of each vertex's influences. The first influence of a vertex has a positive
/// weight. If all vertices have equally many influences, no ends are given.
fn influences(bytes: &mut Bytes<'_>, vertices: usize, joints: usize) -> (Vec<Influence>, Vec<u32>) {
    let most = bytes.pick(&[1, 2, 4, 16]);
    let uneven = bytes.one_in(2);
    let unit = bytes.pick(&[1.0, 1.0, 1.0, 1e-30, 1e30]);
    let mut all: Vec<Influence> = Vec::new();
    let mut ends = Vec::new();
    let first = bytes.below(joints);
    for _ in 0..vertices {
        let count = if uneven { 1 + bytes.below(most) } else { most };
        for k in 0..count {
            let spread = bytes.pick(&[0, 1, most, joints]);
            let weight = match bytes.byte() % 8 {
                0 => 0.0,
                1 => 1e-9,
                _ => bytes.share(),
            };
            all.push(Influence {
                joint: JointId(((first + bytes.below(spread + 1)) % joints) as u32),
                weight: if k == 0 { weight + 1e-3 } else { weight } * unit,
            });
        }
        if uneven {
            ends.push(all.len() as u32);
        }
    }
    (all, ends)
}
