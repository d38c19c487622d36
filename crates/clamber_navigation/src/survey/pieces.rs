//! The skin, divided into pieces at rest, and where the climber's ball rests on each.

use clamber_surface::mesh::{ColliderMesh, SurfaceTag, TriangleId, VertexId};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use super::split;
use crate::{GraphConfig, NavigationError};

/// Most pieces of a graph.
const MOST: u64 = 4_000_000;

/// Where skin bends outwards by more than this angle, radians, the ball rolls over the edge through seats of its own.
const SHARP: f64 = 0.35;

/// A piece of skin: a part of one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    /// The triangle.
    pub(crate) triangle: TriangleId,
    /// Weights of the triangle's corners for the middle of the piece.
    pub(crate) barycentric: [f64; 3],
    /// Area at rest, square metres. Zero for a seat on an edge.
    pub(crate) area: f64,
    /// The material.
    pub(crate) tag: SurfaceTag,
    /// The middle at rest, in the world.
    pub(crate) point: DVec3,
    /// Outward unit normal at rest. On an edge, a direction between those of both sides.
    pub(crate) normal: DVec3,
    /// Where the climber's ball rests on it, at rest; `None` if it has no room there.
    pub(crate) seat: Option<DVec3>,
    /// The plate that has to be removed for the ball to have room.
    pub(crate) below: Option<u16>,
}

/// Divides a surface, which stands at rest, into pieces. They are sorted by place, so that the numbers of triangles do
/// not matter, and what is near in space is near in memory.
pub(crate) fn divide(
    surface: &SkinnedSurface,
    config: &GraphConfig,
) -> Result<Vec<Piece>, NavigationError> {
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
    if found > MOST {
        return Err(NavigationError::TooManyPatches {
            found,
            most: MOST,
            spacing: config.spacing,
        });
    }
    let mut pieces = Vec::with_capacity(found as usize);
    for face in &there {
        face.add_pieces(config.spacing, &mut pieces);
        face.add_edges(mesh, &places, config, &mut pieces);
    }
    if pieces.is_empty() {
        return Err(NavigationError::NoSkin);
    }
    let lowest = pieces
        .iter()
        .fold(DVec3::INFINITY, |low, piece| low.min(piece.point));
    let cell = |piece: &Piece| morton((piece.point - lowest) / config.spacing);
    let mut sorted: Vec<(u64, Piece)> = pieces.iter().map(|piece| (cell(piece), *piece)).collect();
    sorted.sort_by(|a, b| a.0.cmp(&b.0).then_with(|| order(&a.1, &b.1)));
    Ok(sorted.into_iter().map(|(_, piece)| piece).collect())
}

/// The bits of a place's coordinates, whole and not negative, in turn: the order of numbers that are near each other
/// where the places are (Morton 1966).
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
    let (a, b) = ((key(a), a.tag), (key(b), b.tag));
    let by_place = a.0.iter().zip(&b.0).map(|(a, b)| a.total_cmp(b));
    by_place
        .fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
        .then(a.1.cmp(&b.1))
}

/// A triangle that stands at rest.
struct Face {
    triangle: TriangleId,
    vertices: [VertexId; 3],
    corners: [DVec3; 3],
    normal: DVec3,
    area: f64,
    tag: SurfaceTag,
}

impl Face {
    /// `None` for a triangle without an area.
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

    fn add_pieces(&self, spacing: f64, pieces: &mut Vec<Piece>) {
        let split = split::pieces(split::parts(&self.corners, spacing));
        pieces.extend(split.map(|piece| Piece {
            area: self.area * piece.share,
            ..self.at(piece.barycentric, self.normal)
        }));
    }

    /// Seats on the edges over which it bends outwards: the ball rolls over them.
    fn add_edges(
        &self,
        mesh: &ColliderMesh,
        places: &[DVec3],
        config: &GraphConfig,
        pieces: &mut Vec<Piece>,
    ) {
        for (k, beyond) in mesh.neighbours(self.triangle).into_iter().enumerate() {
            let other = beyond.and_then(|triangle| Self::new(mesh, places, triangle));
            // Once for both sides.
            let Some(other) = other.filter(|other| self.is_first(k, other)) else {
                continue;
            };
            let (from, to) = (self.corners[k], self.corners[(k + 1) % 3]);
            let along = to - from;
            let angle = libm::acos(self.normal.dot(other.normal).clamp(-1.0, 1.0));
            let bends_out = self.normal.cross(other.normal).dot(along) > 0.0;
            if angle <= SHARP || !bends_out {
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

    /// True if this one adds the seats of an edge between both: by place, so that numbers of triangles do not matter.
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
        }
    }
}
