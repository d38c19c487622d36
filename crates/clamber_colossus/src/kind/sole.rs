use clamber_animation::rig::{JointId, Skeleton};
use clamber_surface::mesh::{ColliderMesh, VertexId};
use glam::DVec3;

use super::{BlendedSole, RestSkin};

/// Thickness of a sole above the lowest skin of its foot, as a share of the leg's length.
const SOLE_THICKNESS: f64 = 0.03;

/// A sole is skinned in each tick if less than this share of its low vertices follow the foot alone.
const RIGID_VERTEX_SHARE: f64 = 0.6;

/// Height above the lowest skin at rest up to which vertices that also follow the shin may become the lowest ones in
/// another pose, as a share of the leg's length.
const BLENDED_HEIGHT: f64 = 0.15;

/// Lower bounds of the foot's weight in a vertex of the sole, from the strictest to the laxest. A vertex that also
/// follows the shin leaves the ground with the shin, but in a coarse mesh most vertices may do so. The strictest bound
/// is taken with which the lowest skin is within [`EQUALLY_LOW`] of the lowest skin with the laxest bound.
const RIGID_WEIGHTS: [f32; 3] = [0.99, 0.9, 0.5];
/// Heights that differ by no more than this share of the leg's length count as equally low; see [`RIGID_WEIGHTS`].
const EQUALLY_LOW: f64 = 0.01;

/// Rows along X and columns along Z of the grid of points on a sole.
const GRID_POINTS: [usize; 2] = [17, 25];
/// Distance of the grid from the edge of the sole, as a share of the sole's size.
const GRID_EDGE_DISTANCE: f64 = 0.01;

/// Points along the rim are at most the sole's diagonal divided by this apart.
const RIM_POINTS: f64 = 50.0;

/// The sole of a foot at rest, level, relative to the ball of the foot, in the model's axes and units.
#[derive(Clone, Debug)]
pub(crate) struct SoleShape {
    /// Corners of a rectangle around the sole: right heel, left heel, right toe, left toe.
    pub(crate) corners: [DVec3; 4],
    /// Points of the sole's skin, evenly spread, with its vertices and rim.
    pub(crate) points: Vec<DVec3>,
    /// Height of the ball above the lowest skin.
    pub(crate) ball_height: f64,
    /// All low vertices of the foot, if many of the lowest also follow the shin ([`RIGID_VERTEX_SHARE`]); empty if most
    /// follow the foot alone.
    pub(crate) blended: BlendedSole,
}

impl SoleShape {
    /// The sole of the skin that moves with an ankle; `None` if no skin does. `ball` is the ball's place at rest.
    pub(crate) fn new(
        (skeleton, mesh, skin): (&Skeleton, &ColliderMesh, &RestSkin),
        ankle: JointId,
        ball: DVec3,
        leg: f64,
    ) -> Option<Self> {
        let share = |vertex: VertexId| {
            let influences = mesh.influences(vertex);
            let ours =
                influences.filter(|(joint, _)| skeleton.is_descendant_or_self(*joint, ankle));
            ours.map(|(_, weight)| weight).sum::<f32>()
        };
        let shares: Vec<f32> = (0..skin.positions.len() as u32)
            .map(|index| share(VertexId(index)))
            .collect();
        let low_of = |rigid: f32| {
            let ours = skin.positions.iter().zip(&shares);
            let heights = ours.filter(|(_, share)| **share > rigid);
            heights
                .map(|(place, _)| f64::from(place.y))
                .fold(f64::INFINITY, f64::min)
        };
        let least = low_of(RIGID_WEIGHTS[2]);
        let is_as_low =
            |rigid: &f32| least.is_finite() && low_of(*rigid) <= least + EQUALLY_LOW * leg;
        let rigid = RIGID_WEIGHTS.into_iter().find(is_as_low)?;
        let places: Vec<Option<DVec3>> = (skin.positions.iter().zip(&shares))
            .map(|(place, share)| (*share > rigid).then(|| place.as_dvec3() - ball))
            .collect();
        let lowest = places
            .iter()
            .flatten()
            .map(|p| p.y)
            .fold(f64::INFINITY, f64::min);
        let is_low = |p: &DVec3| p.y < lowest + SOLE_THICKNESS * leg;
        let (mut low, mut high) = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
        for p in places.iter().flatten().filter(|p| is_low(p)) {
            (low, high) = (low.min(*p), high.max(*p));
        }
        if !low.is_finite() {
            (low, high) = (DVec3::ZERO, DVec3::ZERO);
        }
        let blended = blended_sole((skeleton, mesh, skin), &shares, least, leg);
        let triangles: Vec<[DVec3; 3]> = (mesh.triangles().iter())
            .filter_map(|triangle| {
                let corners = triangle.map(|vertex| places[vertex.0 as usize].filter(is_low));
                Some([corners[0]?, corners[1]?, corners[2]?])
            })
            .collect();
        let corner = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        Some(Self {
            corners: [
                corner(low.x, low.z),
                corner(high.x, low.z),
                corner(low.x, high.z),
                corner(high.x, high.z),
            ],
            points: spread(
                &triangles,
                places.iter().flatten().copied().filter(is_low),
                [low, high],
            ),
            ball_height: -low.y,
            blended,
        })
    }

    /// Centre of the rectangle around the sole, on the ground.
    pub(crate) fn middle(&self) -> DVec3 {
        0.5 * (self.corners[0] + self.corners[3]) - DVec3::Y * self.ball_height
    }

    /// Width and length of the sole.
    pub(crate) fn size(&self) -> [f64; 2] {
        let way = self.corners[3] - self.corners[0];
        [way.x, way.z]
    }
}

/// The low vertices of a foot, if many of the lowest also follow the shin ([`RIGID_VERTEX_SHARE`]). `shares` has the
/// foot's weight in each vertex, `least` the height of the lowest skin, `leg` the leg's length.
fn blended_sole(
    (skeleton, mesh, skin): (&Skeleton, &ColliderMesh, &RestSkin),
    shares: &[f32],
    least: f64,
    leg: f64,
) -> BlendedSole {
    let half = (0..skin.positions.len()).filter(|index| {
        let height = f64::from(skin.positions[*index].y);
        shares[*index] > RIGID_WEIGHTS[2] && height < least + BLENDED_HEIGHT * leg
    });
    let half: Vec<VertexId> = half.map(|index| VertexId(index as u32)).collect();
    let low_half = half.iter().map(|vertex| vertex.index());
    let low_half =
        low_half.filter(|index| f64::from(skin.positions[*index].y) < least + SOLE_THICKNESS * leg);
    let (all, alone) = low_half.fold((0.0, 0.0), |(all, alone), index| {
        (
            all + 1.0,
            alone + f64::from(u8::from(shares[index] > RIGID_WEIGHTS[0])),
        )
    });
    let is_blended = alone < RIGID_VERTEX_SHARE * all;
    let ours = half.into_iter().filter(|_| is_blended);
    BlendedSole::new(skeleton, mesh, ours)
}

/// The vertices of a sole, and points of its triangles on a grid over X and Z. Where triangles overlap, the point is on
/// the lowest one.
fn spread(
    triangles: &[[DVec3; 3]],
    vertices: impl Iterator<Item = DVec3>,
    [low, high]: [DVec3; 2],
) -> Vec<DVec3> {
    let share = |index: usize, count: usize| {
        GRID_EDGE_DISTANCE + (1.0 - 2.0 * GRID_EDGE_DISTANCE) * index as f64 / (count - 1) as f64
    };
    let mut points = Vec::new();
    for row in 0..GRID_POINTS[0] {
        for column in 0..GRID_POINTS[1] {
            let x = low.x + (high.x - low.x) * share(row, GRID_POINTS[0]);
            let z = low.z + (high.z - low.z) * share(column, GRID_POINTS[1]);
            let heights = triangles
                .iter()
                .filter_map(|corners| height_at(corners, x, z));
            let lowest = heights.fold(f64::INFINITY, f64::min);
            if lowest.is_finite() {
                points.push(DVec3::new(x, lowest, z));
            }
        }
    }
    // Vertices may be lower than the grid's points beside them, and the rim is outside the grid.
    points.extend(vertices);
    let gap = (high - low).with_y(0.0).length() / RIM_POINTS;
    for [from, to] in rim(triangles) {
        let cuts = (from.distance(to) / gap.max(1e-9)).ceil().min(RIM_POINTS);
        points.extend((1..cuts as u32).map(|cut| from.lerp(to, f64::from(cut) / cuts)));
    }
    points.sort_by(|a, b| {
        (a.x, a.z, a.y)
            .partial_cmp(&(b.x, b.z, b.y))
            .unwrap_or(core::cmp::Ordering::Equal)
    });
    points.dedup();
    points
}

/// Edges that belong to a single triangle.
fn rim(triangles: &[[DVec3; 3]]) -> Vec<[DVec3; 2]> {
    let sides =
        |corners: &[DVec3; 3]| [0, 1, 2].map(|side| [corners[side], corners[(side + 1) % 3]]);
    let all: Vec<[DVec3; 2]> = triangles.iter().flat_map(sides).collect();
    let is_same = |a: &[DVec3; 2], b: &[DVec3; 2]| a == b || a[0] == b[1] && a[1] == b[0];
    let is_alone =
        |side: &&[DVec3; 2]| all.iter().filter(|other| is_same(side, other)).count() == 1;
    all.iter().filter(is_alone).copied().collect()
}

/// Height of a triangle at X and Z; `None` outside the triangle.
fn height_at([a, b, c]: &[DVec3; 3], x: f64, z: f64) -> Option<f64> {
    let side = |p: &DVec3, q: &DVec3| (q.x - p.x) * (z - p.z) - (q.z - p.z) * (x - p.x);
    let (u, v, w) = (side(b, c), side(c, a), side(a, b));
    let area = u + v + w;
    let is_inside = area != 0.0 && [u, v, w].iter().all(|part| part * area >= 0.0);
    is_inside.then(|| (u * a.y + v * b.y + w * c.y) / area)
}
