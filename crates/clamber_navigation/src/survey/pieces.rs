//! Divides the skin at rest into pieces.
//!
//! Triangles are cut into bits. Neighbouring bits that face the same way form one piece. So the number of pieces grows
//! with the area of the skin, and not with its number of triangles.

use clamber_surface::mesh::{ColliderMesh, SurfaceTag, TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use super::split;
use crate::{GraphConfig, NavigationError};

/// The most pieces, and bits, of a graph. It limits its memory and the time of its build.
const MOST_PIECES: u64 = 4_000_000;

/// Angle between two triangles, radians, above which an outward edge gets seats of its own: the ball rolls over such an
/// edge.
const SHARP_EDGE_ANGLE: f64 = 0.35;

/// A piece of skin: one or more bits that face the same way. One of them stands for all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    /// The triangle of the bit that stands for the piece.
    pub(crate) triangle: TriangleId,
    /// Barycentric weights of that bit's middle.
    pub(crate) barycentric: [f64; 3],
    /// Area at rest, square metres. Zero for a seat on an edge.
    pub(crate) area: f64,
    /// The material.
    pub(crate) tag: SurfaceTag,
    /// That bit's middle at rest, in the world.
    pub(crate) point: DVec3,
    /// Outward unit normal at rest. On an edge, a direction between the normals of both sides.
    pub(crate) normal: DVec3,
    /// The middle of the climber's ball on this piece, at rest; `None` if the ball has no room there.
    pub(crate) seat: Option<DVec3>,
    /// The plate that has to be removed before the ball has room; `None` if it has room already or never.
    pub(crate) below: Option<u16>,
    /// The plate that the piece belongs to, or `NO_PLATE`.
    pub(crate) plate: u32,
}

/// A part of a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bit {
    /// The triangle.
    pub(crate) triangle: TriangleId,
    /// Barycentric weights of the bit's middle.
    pub(crate) barycentric: [f32; 3],
    /// The piece that the bit belongs to.
    pub(crate) piece: u32,
}

/// The divided skin.
#[derive(Clone, Debug)]
pub(super) struct Division {
    pub(super) pieces: Vec<Piece>,
    /// All bits, sorted by their pieces.
    pub(super) bits: Vec<Bit>,
    /// For each piece, other bits of it on which the ball is tried if it has no room on the first one.
    pub(super) others: Vec<Vec<Piece>>,
}

/// Divides a surface in its rest pose into pieces. They are sorted by position, so that the order of triangles does not
/// matter, and neighbours in space are near in memory. `plate` returns the plate of a triangle.
pub(super) fn divide(
    surface: &SkinnedSurface,
    config: &GraphConfig,
    plate: &dyn Fn(TriangleId) -> u32,
) -> Result<Division, NavigationError> {
    let mesh = surface.mesh();
    let mut positions = Vec::new();
    surface.skin_all(&mut positions);
    let place = surface.world_from_model();
    let places: Vec<DVec3> = positions
        .iter()
        .map(|p| place.transform_point(p.as_dvec3()))
        .collect();
    let all = (0..mesh.triangles().len() as u32).map(TriangleId);
    let there: Vec<Face> = all
        .filter(|triangle| surface.is_enabled(*triangle))
        .filter_map(|triangle| Face::new(mesh, &places, triangle))
        .collect();
    let found: u64 = there
        .iter()
        .map(|face| u64::from(split::parts(&face.corners, config.spacing)).pow(2))
        .sum();
    if found > MOST_PIECES {
        return Err(NavigationError::TooManyPatches {
            found,
            most: MOST_PIECES,
            spacing: config.spacing,
        });
    }
    let mut bits = Vec::with_capacity(found as usize);
    for face in &there {
        face.add_bits(config.spacing, &mut bits);
        face.add_edges(mesh, &places, config, &mut bits);
        if bits.len() as u64 > MOST_PIECES {
            return Err(NavigationError::TooManyPatches {
                found: bits.len() as u64,
                most: MOST_PIECES,
                spacing: config.spacing,
            });
        }
    }
    for bit in &mut bits {
        bit.plate = plate(bit.triangle);
    }
    if bits.is_empty() {
        return Err(NavigationError::NoSkin);
    }
    Ok(gather(bits, CELL_SIZE * config.spacing))
}

/// Size of the cells within which bits are gathered into pieces, as a share of the largest side of a patch.
const CELL_SIZE: f64 = 0.5;
/// Bits of one piece have normals with at least this cosine.
const ALIKE_COSINE: f64 = 0.94;
/// Bits of one piece lie at most this far off the first bit's plane, as a share of the cell's size.
const MOST_OFF_PLANE: f64 = 0.3;

/// The most bits of a piece on which a ball is tried. More find more seats, and cost more.
const MOST_TRIED_BITS: usize = 4;

/// Gathers bits into pieces.
fn gather(mut bits: Vec<Piece>, size: f64) -> Division {
    let lowest = bits
        .iter()
        .fold(DVec3::INFINITY, |low, bit| low.min(bit.point));
    let cell = |bit: &Piece| morton((bit.point - lowest) / size);
    bits.sort_by_cached_key(|bit| Key(cell(bit), *bit));
    let mut division = Division {
        pieces: Vec::new(),
        bits: Vec::with_capacity(bits.len()),
        others: Vec::new(),
    };
    let mut groups: Vec<Vec<&Piece>> = Vec::new();
    for cell in bits.chunk_by(|a, b| cell(a) == cell(b)) {
        groups.clear();
        for bit in cell {
            let is_alike = |group: &&mut Vec<&Piece>| {
                group.first().is_some_and(|first| {
                    let off = (bit.point - first.point).dot(first.normal);
                    first.tag == bit.tag
                        && first.normal.dot(bit.normal) >= ALIKE_COSINE
                        && off.abs() <= MOST_OFF_PLANE * size
                        && first.plate == bit.plate
                })
            };
            match groups.iter_mut().find(is_alike) {
                Some(group) => group.push(bit),
                None => groups.push(vec![bit]),
            }
        }
        for group in &groups {
            division.add(group);
        }
    }
    division
}

impl Division {
    /// Adds a piece of some bits.
    fn add(&mut self, group: &[&Piece]) {
        let middle = group.iter().map(|bit| bit.point).sum::<DVec3>() / group.len() as f64;
        let apart = |bit: &&Piece| bit.point.distance_squared(middle);
        let mut nearest = group.to_vec();
        nearest.sort_by(|a, b| apart(a).total_cmp(&apart(b)));
        let Some((first, others)) = nearest.split_first() else {
            return;
        };
        let piece = self.pieces.len() as u32;
        self.bits.extend(group.iter().map(|bit| Bit {
            triangle: bit.triangle,
            barycentric: bit.barycentric.map(|weight| weight as f32),
            piece,
        }));
        let area = group.iter().map(|bit| bit.area).sum();
        self.pieces.push(Piece { area, ..**first });
        // The outermost bit first: bits that lie under other skin have no room.
        let out = |bit: &&&Piece| (bit.point - middle).dot(first.normal);
        let outermost = others.iter().max_by(|a, b| out(a).total_cmp(&out(b)));
        let others = outermost
            .into_iter()
            .chain(others.iter().take(MOST_TRIED_BITS - 2));
        let others = others.map(|bit| Piece { area, ..**bit });
        self.others.push(others.collect());
    }
}

/// Sort key of bits: the cell, then the position.
struct Key(u64, Piece);

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Key {}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.cmp(&other.0).then_with(|| order(&self.1, &other.1))
    }
}

/// Interleaves the bits of a position's coordinates, which are rounded down and must not be negative. Positions that
/// are near each other get near numbers (Morton 1966).
fn morton(place: DVec3) -> u64 {
    let bits = |coordinate: f64| {
        let whole = coordinate as u64;
        (0..21).fold(0, |spread, bit| spread | (whole >> bit & 1) << (3 * bit))
    };
    bits(place.x) | bits(place.y) << 1 | bits(place.z) << 2
}

fn order(a: &Piece, b: &Piece) -> std::cmp::Ordering {
    let key = |piece: &Piece| {
        let (p, n) = (piece.point, piece.normal);
        [p.x, p.y, p.z, n.x, n.y, n.z, piece.area]
    };
    let (a, b) = ((key(a), (a.tag, a.plate)), (key(b), (b.tag, b.plate)));
    let by_place = a.0.iter().zip(&b.0).map(|(a, b)| a.total_cmp(b));
    by_place
        .fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
        .then(a.1.cmp(&b.1))
}

/// A triangle of the skin at rest.
struct Face {
    triangle: TriangleId,
    vertices: [VertexId; 3],
    corners: [DVec3; 3],
    normal: DVec3,
    area: f64,
    tag: SurfaceTag,
}

impl Face {
    /// The face of a triangle; `None` for a triangle without area.
    fn new(mesh: &ColliderMesh, places: &[DVec3], triangle: TriangleId) -> Option<Self> {
        let vertices = *mesh.triangles().get(triangle.index())?;
        let [a, b, c] = vertices.map(|vertex| places[vertex.index()]);
        let doubled = (b - a).cross(c - a);
        Some(Self {
            triangle,
            vertices,
            corners: [a, b, c],
            normal: doubled.try_normalize()?,
            area: 0.5 * doubled.length(),
            tag: *mesh.tags().get(triangle.index())?,
        })
    }

    fn add_bits(&self, spacing: f64, bits: &mut Vec<Piece>) {
        let split = split::pieces(split::parts(&self.corners, spacing));
        bits.extend(split.map(|piece| Piece {
            area: self.area * piece.share,
            ..self.at(piece.barycentric, self.normal)
        }));
    }

    /// Adds seats on the edges at which the skin bends outwards: the ball rolls over them.
    fn add_edges(
        &self,
        mesh: &ColliderMesh,
        places: &[DVec3],
        config: &GraphConfig,
        pieces: &mut Vec<Piece>,
    ) {
        for (k, beyond) in mesh.neighbours(self.triangle).into_iter().enumerate() {
            let other = beyond.and_then(|triangle| Self::new(mesh, places, triangle));
            // Each edge once, not from both sides.
            let Some(other) = other.filter(|other| self.is_first(k, other)) else {
                continue;
            };
            let (from, to) = (self.corners[k], self.corners[(k + 1) % 3]);
            let along = to - from;
            let angle = libm::acos(self.normal.dot(other.normal).clamp(-1.0, 1.0));
            let bends_out = self.normal.cross(other.normal).dot(along) > 0.0;
            if angle <= SHARP_EDGE_ANGLE || !bends_out {
                continue;
            }
            let across = (angle * config.radius() / config.spacing).ceil().max(1.0);
            let along = (along.length() / config.spacing).ceil().max(1.0);
            for i in 0..along as u32 {
                let share = (f64::from(i) + 0.5) / along;
                let mut barycentric = [0.0; 3];
                (barycentric[k], barycentric[(k + 1) % 3]) = (1.0 - share, share);
                for j in 0..across as u32 {
                    let turned = (f64::from(j) + 0.5) / across;
                    let normal = self.normal.lerp(other.normal, turned);
                    if let Some(normal) = normal.try_normalize() {
                        pieces.push(self.at(barycentric, normal));
                    }
                }
            }
        }
    }

    /// True if this face, and not `other`, adds the seats of their common edge. Decided by position, so that the order
    /// of triangles does not matter.
    fn is_first(&self, corner: usize, other: &Self) -> bool {
        let edge = [self.vertices[corner], self.vertices[(corner + 1) % 3]];
        let apex = |face: &Self| {
            let apex = (0..3).find(|k| !edge.contains(&face.vertices[*k]));
            face.corners[apex.unwrap_or(0)]
        };
        let (ours, theirs) = (apex(self), apex(other));
        let order = ours.to_array().into_iter().zip(theirs.to_array());
        let order = order
            .map(|(a, b)| a.total_cmp(&b))
            .fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then);
        order.then(self.triangle.cmp(&other.triangle)).is_lt()
    }

    fn at(&self, barycentric: [f64; 3], normal: DVec3) -> Piece {
        let weighted = self.corners.iter().zip(barycentric).map(|(c, w)| *c * w);
        Piece {
            triangle: self.triangle,
            barycentric,
            area: 0.0,
            tag: self.tag,
            point: weighted.fold(DVec3::ZERO, |sum, part| sum + part),
            normal,
            seat: None,
            below: None,
            plate: 0,
        }
    }
}
