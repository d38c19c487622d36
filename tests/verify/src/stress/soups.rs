//! Bad meshes that users will have nevertheless: slivers, duplicate triangles, spikes, T-junctions.

use glam::{DQuat, DVec3};

use super::shapes::Shape;

/// Loose triangles in and near a ball of diameter 1. Each is 0.05 long; its height is 1 to 1e-6 times its length.
pub(super) fn slivers(triangles: usize, rng: &mut fastrand::Rng) -> Shape {
    let mut shape = Shape {
        positions: Vec::new(),
        triangles: Vec::new(),
    };
    for index in 0..triangles as u32 {
        let turn = random_turn(rng);
        let (long, across) = (turn * DVec3::X * 0.05, turn * DVec3::Y * 0.05);
        let width = libm::exp10(-6.0 * rng.f64());
        let place = random_direction(rng) * (0.5 * libm::cbrt(rng.f64()));
        // The third corner of a needle is beside one end of the long edge. A cap has it beside the edge's interior.
        let foot = if rng.bool() { 0.0 } else { rng.f64() };
        let third = place + long * foot + across * width;
        shape.positions.extend([place, place + long, third]);
        shape.triangles.push([0, 1, 2].map(|k| 3 * index + k));
    }
    shape
}

/// A shape with two additional copies of each triangle: equal, flipped, with corners of its own (which may follow other
/// joints), or with two equal corners.
pub(super) fn copied(mut shape: Shape, rng: &mut fastrand::Rng) -> Shape {
    for index in 0..shape.triangles.len() {
        let [a, b, c] = shape.triangles[index];
        for _ in 0..2 {
            let copy = match rng.u32(0..6) {
                0 => [a, b, c],
                1 => [b, c, a],
                2 => [a, c, b],
                3 => [a, b, b],
                _ => {
                    let first = shape.positions.len() as u32;
                    let corners = [a, b, c].map(|v| shape.positions[v as usize]);
                    shape.positions.extend(corners);
                    [first, first + 1, first + 2]
                }
            };
            shape.triangles.push(copy);
        }
    }
    shape
}

/// A shape with about every fiftieth vertex moved out to a hundred to ten thousand times its distance from the origin.
pub(super) fn spiked(mut shape: Shape, rng: &mut fastrand::Rng) -> Shape {
    for position in &mut shape.positions {
        if rng.u32(0..50) == 0 {
            *position *= libm::exp10(2.0 + 2.0 * rng.f64());
        }
    }
    shape
}

/// A shape with about every third triangle cut in two at the middle of an edge. The neighbour at that edge is not cut.
pub(super) fn with_t_junctions(mut shape: Shape, rng: &mut fastrand::Rng) -> Shape {
    for index in 0..shape.triangles.len() {
        if rng.u32(0..3) > 0 {
            continue;
        }
        let [a, b, c] = shape.triangles[index];
        let middle = (shape.positions[a as usize] + shape.positions[b as usize]) * 0.5;
        let m = shape.positions.len() as u32;
        shape.positions.push(middle);
        shape.triangles[index] = [a, m, c];
        shape.triangles.push([m, b, c]);
    }
    shape
}

/// A random unit vector, uniformly distributed.
pub(super) fn random_direction(rng: &mut fastrand::Rng) -> DVec3 {
    loop {
        let p = DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 2.0 - DVec3::ONE;
        let length = p.length();
        if (0.01..=1.0).contains(&length) {
            return p / length;
        }
    }
}

/// A random rotation.
pub(super) fn random_turn(rng: &mut fastrand::Rng) -> DQuat {
    let angle = core::f64::consts::TAU * rng.f64();
    clamber_surface::geometry::rotation_from_axis_angle(random_direction(rng), angle)
}
