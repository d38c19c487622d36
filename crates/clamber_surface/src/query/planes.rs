//! Planes that move with a ball or capsule and touch it, on the side that faces a cluster.
//!
//! The distance of a vertex from such a plane changes linearly. A triangle whose corners are beyond a plane at both
//! ends of the motion is therefore beyond it all the time between. Where a sphere rests on skin, its bounding box holds
//! hundreds of triangles that it does not touch; these planes leave few.

use glam::{DVec3, Vec3};

use super::broad::SLACK;
use super::probe::Probe;
use crate::geometry::{round_to_f32, widen};

/// Number of planes: as many as a code has bits.
pub(super) const PLANES: usize = 8;

/// Largest size of the lengths involved. Above it, products overflow, and no triangle is ruled out.
const LARGEST: f32 = 1e30;

/// Cosine and sine of the angle between the normals of the near planes and the direction to the cluster: 25 degrees,
/// for a sphere that rests on flat skin.
const NEAR: [f32; 2] = [0.906_307_8, 0.422_618_26];

/// The same of the far planes: 55 degrees, for a sphere in a corner.
const FAR: [f32; 2] = [0.573_576_45, 0.819_152];

/// Half-spaces `normal . (p - origin) > limit` that contain nothing of a probe. For vertices that move (P = 2) there is
/// one limit for time 0 and one for the last time that matters; otherwise one limit holds at both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planes<const P: usize> {
    pub(super) origin: [f32; 3],
    pub(super) normals: [[f32; PLANES]; 3],
    pub(super) limits: [[f32; PLANES]; P],
}

impl<const P: usize> Planes<P> {
    /// Planes around all that a probe reaches up to the time `until`, facing a target that moves from the first of
    /// `targets` to the last by then.
    #[cfg_attr(not(unoptimized), inline(always))]
    pub(super) fn facing<const N: usize>(probe: &Probe<N>, until: f32, targets: [Vec3; P]) -> Self {
        let [origin, last] = probe.segment();
        let axis = last - origin;
        let motions = [probe.motions[0] * until, probe.motions[N - 1] * until];
        let facing = if N == 1 && P == 1 && motions[0] == Vec3::ZERO {
            straight(origin, targets[0])
        } else {
            direction(axis, motions, origin, [targets[0], targets[P - 1]])
        };
        let normals = about(round_to_f32(facing));
        let radius = probe.reach * (1.0 + SLACK);
        let largest = origin
            .abs()
            .max(axis.abs())
            .max(motions[0].abs().max(motions[1].abs()));
        let size = largest.max_element().max(radius);
        // The last term is for products that underflow.
        let beside = radius + SLACK * size + f32::MIN_POSITIVE;
        let beside = if size < LARGEST {
            beside
        } else {
            f32::INFINITY
        };
        let (start, end) = ([0.0; PLANES], along(&normals, motions[0]));
        let (mut first, mut last) = (start, end);
        if N == 2 {
            first = larger(start, along(&normals, axis));
            last = larger(end, along(&normals, axis + motions[1]));
        }
        let mut limits = [if P == 1 { larger(first, last) } else { first }; P];
        if P == 2 {
            limits[P - 1] = last;
        }
        for limit in limits.as_flattened_mut() {
            *limit += beside;
        }
        Self {
            origin: origin.to_array(),
            normals,
            limits,
        }
    }
}

/// The product of a vector with each normal.
#[cfg_attr(not(unoptimized), inline(always))]
fn along(normals: &[[f32; PLANES]; 3], v: Vec3) -> [f32; PLANES] {
    let mut found = [0.0; PLANES];
    for (plane, found) in found.iter_mut().enumerate() {
        *found = normals[0][plane] * v.x + normals[1][plane] * v.y + normals[2][plane] * v.z;
    }
    found
}

#[cfg_attr(not(unoptimized), inline(always))]
fn larger(a: [f32; PLANES], b: [f32; PLANES]) -> [f32; PLANES] {
    let mut found = a;
    for (found, b) in found.iter_mut().zip(b) {
        *found = if *found > b { *found } else { b };
    }
    found
}

/// [`direction`] to a target for a core that is a point, where nothing moves.
#[cfg_attr(not(unoptimized), inline(always))]
fn straight(origin: Vec3, target: Vec3) -> DVec3 {
    let way = widen(target) - widen(origin);
    way.try_normalize().unwrap_or(DVec3::Y)
}

/// Approximate direction from the core to the target when they are nearest. Any direction gives valid planes.
fn direction(axis: Vec3, motions: [Vec3; 2], origin: Vec3, targets: [Vec3; 2]) -> DVec3 {
    // In f64: in f32, squares of small numbers underflow, and normals come out too long.
    let axis = widen(axis);
    let motions = motions.map(widen);
    let [start, end] = targets.map(|target| widen(target) - widen(origin));
    let middle = start - axis * 0.5;
    let change = (end - start) - (motions[0] + motions[1]) * 0.5;
    let time = share(-middle.dot(change), change.length_squared());
    let from = start + (end - start) * time - motions[0] * time;
    let axis = axis + (motions[1] - motions[0]) * time;
    let along = share(from.dot(axis), axis.length_squared());
    let aside = (from - axis * along).try_normalize();
    aside.or((-change).try_normalize()).unwrap_or(DVec3::Y)
}

fn share(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 {
        (numerator / denominator).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// Unit vectors around `facing`, by coordinate: itself, and others tilted away from it.
#[cfg_attr(not(unoptimized), inline(always))]
fn about(facing: Vec3) -> [[f32; PLANES]; 3] {
    let (across, up) = facing.any_orthonormal_pair();
    let half_root_3 = 0.866_025_4;
    // Components along `facing`, `across` and `up`.
    let along = [
        1.0, NEAR[0], NEAR[0], NEAR[0], NEAR[0], FAR[0], FAR[0], FAR[0],
    ];
    let (half, side) = (-0.5 * FAR[1], half_root_3 * FAR[1]);
    let aside = [0.0, NEAR[1], -NEAR[1], 0.0, 0.0, 0.0, side, -side];
    let above = [0.0, 0.0, 0.0, NEAR[1], -NEAR[1], FAR[1], half, half];
    let mut normals = [[0.0; PLANES]; 3];
    for (axis, normals) in normals.iter_mut().enumerate() {
        let (facing, across, up) = (facing[axis], across[axis], up[axis]);
        for plane in 0..PLANES {
            normals[plane] = facing * along[plane] + across * aside[plane] + up * above[plane];
        }
    }
    normals
}
