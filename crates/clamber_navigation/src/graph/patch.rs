//! Merges pieces of skin into patches: places of about the size of the climber.

use std::collections::BTreeMap;

use clamber_surface::mesh::{SurfaceTag, TriangleId};
use clamber_surface::surface::SkinnedSurface;
use glam::DVec3;

use super::ways::{Corner, Way, Ways};
use crate::survey::Survey;

/// A place on the skin where a climber can be on the creature at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub struct Patch {
    /// The triangle of the skin on which `point`, the patch's middle, lies. With `barycentric` it gives the middle on
    /// the skin as it moves.
    pub triangle: TriangleId,
    /// Barycentric weights of the patch's middle for the corners of `triangle`, in the mesh's order. Their sum is 1.
    pub barycentric: [f64; 3],
    /// The surface tag, with the material, of the skin at the middle.
    pub tag: SurfaceTag,
    /// The patch's middle in world space, metres, on the creature in its rest pose, placed by
    /// [`GraphConfig::world_from_model`](crate::GraphConfig::world_from_model): a point on the skin. From `seat` the
    /// climber touches this point, except in a corner, where other skin may keep it off.
    pub point: DVec3,
    /// Outward unit normal of the skin at `point`, in world space, with the creature at rest as for `point`.
    pub normal: DVec3,
    /// The seat: where the centre of the climber's ball is when the climber stands or holds on at the patch's middle,
    /// off the skin. It is in world space, metres, with the creature at rest as for `point`.
    pub seat: DVec3,
    /// Area at rest, square metres.
    pub area: f64,
    /// True if a climber can stand there at rest.
    pub can_stand: bool,
    /// True if a climber can hold on there at rest.
    pub can_hold: bool,
    /// Index in [`GraphConfig::plates`](crate::GraphConfig::plates): a climber has room here only without that plate.
    /// `None` if it has room with all plates. The index stays after the plate breaks.
    pub below: Option<u16>,
    /// The vector from the middle to the seat at rest, along the axes of the triangle, metres.
    pub(crate) away: [f64; 3],
}

/// The corners of a triangle of the skin in its present pose, in model space.
pub(crate) fn corners(surface: &SkinnedSurface, triangle: TriangleId) -> Option<[DVec3; 3]> {
    let vertices = *surface.mesh().triangles().get(triangle.index())?;
    let [a, b, c] = vertices.map(|vertex| surface.in_model().position(vertex));
    Some([a?, b?, c?].map(|corner| corner.as_dvec3()))
}

/// Axes that move with a triangle: along its first side, perpendicular to that in its plane, and its normal. `None` if
/// the triangle has no area.
pub(crate) fn axes([a, b, c]: [DVec3; 3]) -> Option<[DVec3; 3]> {
    let normal = (b - a).cross(c - a).try_normalize()?;
    let along = (b - a).try_normalize()?;
    Some([along, normal.cross(along), normal])
}

/// The patch of a piece without one: a climber can neither stand nor hold on there. No patch has this number.
pub(crate) const NO_PATCH: u32 = u32::MAX;

/// Merges pieces into patches, and returns the patch of each piece.
///
/// All pieces of a patch are alike: a climber can stand on all or none of them, can hold on at all or none of them, and
/// they face the same way. From each piece every other one is reached within the patch. So a climber that reaches one
/// piece reaches all.
pub(super) fn merge(survey: &Survey) -> (Vec<Patch>, Vec<u32>) {
    let (pieces, reach) = (&survey.pieces, survey.config.reach());
    let kinds: Vec<[bool; 2]> = (0..pieces.len())
        .map(|piece| [survey.can_stand(piece), survey.can_hold(piece, reach)])
        .collect();
    let mut patch_of = vec![NO_PATCH; pieces.len()];
    let mut patches = Vec::new();
    let mut members: Vec<usize> = Vec::new();
    for first in 0..pieces.len() {
        let Some(start) = pieces[first].seat else {
            continue;
        };
        if patch_of[first] != NO_PATCH || kinds[first] == [false; 2] {
            continue;
        }
        let id = patches.len() as u32;
        patch_of[first] = id;
        members.clear();
        members.push(first);
        let mut next = 0;
        while let Some(&piece) = members.get(next) {
            next += 1;
            for beside in survey.links.of(piece) {
                let seat = pieces[beside].seat;
                let is_near =
                    seat.is_some_and(|seat| seat.distance(start) <= survey.config.spacing);
                let is_alike = patch_of[beside] == NO_PATCH
                    && kinds[beside] == kinds[first]
                    && !survey.bends([first, beside])
                    && pieces[beside].below == pieces[first].below
                    && pieces[beside].plate == pieces[first].plate;
                let [stands, holds] = kinds[first];
                let ends = ends(piece, beside);
                let leads =
                    (!stands || survey.can_walk(ends)) && (!holds || survey.can_climb(ends));
                if is_near && is_alike && leads {
                    patch_of[beside] = id;
                    members.push(beside);
                }
            }
        }
        patches.push(patch(survey, &members, kinds[first]));
    }
    (patches, patch_of)
}

fn patch(survey: &Survey, members: &[usize], [can_stand, can_hold]: [bool; 2]) -> Patch {
    let seat = |piece: usize| survey.pieces[piece].seat.unwrap_or_default();
    let sum: DVec3 = members.iter().map(|piece| seat(*piece)).sum();
    let middle = sum / members.len() as f64;
    let apart = |piece: &&usize| seat(**piece).distance_squared(middle);
    let nearest = members.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
    let nearest = nearest.copied().unwrap_or(0);
    let piece = &survey.pieces[nearest];
    let away = seat(nearest) - piece.point;
    let axes = corners(&survey.surface, piece.triangle).and_then(axes);
    Patch {
        away: axes.map_or([0.0, 0.0, survey.config.radius()], |axes| {
            let turned = survey.surface.world_from_model().rotation.conjugate() * away;
            axes.map(|axis| turned.dot(axis))
        }),
        triangle: piece.triangle,
        barycentric: piece.barycentric,
        tag: piece.tag,
        point: piece.point,
        normal: piece.normal,
        seat: seat(nearest),
        area: members.iter().map(|piece| survey.pieces[*piece].area).sum(),
        can_stand,
        can_hold,
        below: piece.below,
    }
}

/// The ways between patches, from the links between their pieces.
pub(super) fn ways(survey: &Survey, patches: &[Patch], patch_of: &[u32]) -> Ways {
    let mut found: BTreeMap<(u32, u32), Way> = BTreeMap::new();
    // For each pair of patches with a corner between them, the two pieces with the nearest seats: there the ball
    // touches both.
    let mut nearest: BTreeMap<(u32, u32), (f64, [usize; 2])> = BTreeMap::new();
    for piece in 0..survey.pieces.len() {
        let from = patch_of[piece];
        if from == NO_PATCH {
            continue;
        }
        for beside in survey.links.of(piece) {
            let to = patch_of[beside];
            // Each way is stored once, for both directions.
            if to == NO_PATCH || to <= from {
                continue;
            }
            let [a, b] = [from, to].map(|patch| &patches[patch as usize]);
            let ends = ends(piece, beside);
            let known = found.get(&(from, to)).copied().unwrap_or_default();
            let walks = a.can_stand && b.can_stand;
            let climbs = a.can_hold && b.can_hold;
            let way = Way {
                walks: known.walks || walks && survey.can_walk(ends),
                climbs: known.climbs || climbs && survey.can_climb(ends),
            };
            if way.walks || way.climbs {
                found.insert((from, to), way);
            }
            if climbs && survey.is_corner([piece, beside]) && survey.can_climb(ends) {
                let apart = survey.apart([piece, beside]);
                let known = nearest
                    .entry((from, to))
                    .or_insert((apart, [piece, beside]));
                if apart < known.0 {
                    *known = (apart, [piece, beside]);
                }
            }
        }
    }
    let corner = |pieces: [usize; 2]| corner(survey, pieces);
    let corners = nearest
        .into_iter()
        .map(|(ends, (_, pieces))| (ends, corner(pieces)));
    Ways::new(patches, &found, corners.collect())
}

fn corner(survey: &Survey, pieces: [usize; 2]) -> Corner {
    let [here, there] = pieces.map(|piece| &survey.pieces[piece]);
    let away = here.seat.unwrap_or(here.point) - here.point;
    // The vector from the point to the ball as a sum of both normals.
    let cosine = here.normal.dot(there.normal);
    let (a, b) = (away.dot(here.normal), away.dot(there.normal));
    let squared = (1.0 - cosine * cosine).max(1e-3);
    Corner {
        triangle: here.triangle,
        barycentric: here.barycentric,
        other: there.triangle,
        apart: [(a - b * cosine) / squared, (b - a * cosine) / squared],
    }
}

fn ends(a: usize, b: usize) -> [usize; 2] {
    [a.min(b), a.max(b)]
}
