use glam::{DVec3, Vec3};

use clamber_surface::geometry::rotation_from_axis_angle;

/// Colour of an overlay: linear red, green, blue and opacity, 0 to 1.
pub type Color = [f32; 4];

/// Lines and triangles to draw over the meshes of a picture, in world space. Parts behind a mesh are drawn faintly.
#[derive(Clone, Debug, Default)]
pub struct Overlay {
    lines: Vec<Line>,
    triangles: Vec<([DVec3; 3], Color)>,
}

#[derive(Clone, Copy, Debug)]
struct Line {
    ends: [DVec3; 2],
    /// Pixels.
    width: f32,
    color: Color,
}

/// Number of lines of a circle, even, so that half circles end on a corner.
const SIDES: u32 = 32;

/// Length of an arrow's head as a share of the arrow.
const HEAD: f64 = 0.25;

/// Radius of an arrow's head as a share of the head's length.
const SLENDER: f64 = 0.24;

/// Number of sides of an arrow's head.
const HEAD_SIDES: u32 = 12;

/// Points on a circle around an axis; the first one is repeated at the end.
fn ring(
    center: DVec3,
    axis: DVec3,
    radius: f64,
    sides: u32,
) -> impl Iterator<Item = DVec3> + Clone {
    let start = axis.any_orthonormal_vector() * radius;
    (0..=sides).map(move |side| {
        let angle = f64::from(side) / f64::from(sides) * core::f64::consts::TAU;
        center + rotation_from_axis_angle(axis, angle) * start
    })
}

impl Overlay {
    /// Adds a line, `width` pixels wide.
    pub fn line(&mut self, from: DVec3, to: DVec3, width: f32, color: Color) {
        let ends = [from, to];
        self.lines.push(Line { ends, width, color });
    }

    /// Adds a path of lines through points, `width` pixels wide.
    pub fn path(&mut self, points: &[DVec3], width: f32, color: Color) {
        for pair in points.windows(2) {
            self.line(pair[0], pair[1], width, color);
        }
    }

    /// Adds an arrow from `from` to `from + along`: a line, `width` pixels wide, and a cone.
    pub fn arrow(&mut self, from: DVec3, along: DVec3, width: f32, color: Color) {
        let tip = from + along;
        let neck = tip - along * HEAD;
        self.line(from, neck, width, color);
        let Some(axis) = along.try_normalize() else {
            return;
        };
        let rim = ring(neck, axis, along.length() * HEAD * SLENDER, HEAD_SIDES);
        for (a, b) in rim.clone().zip(rim.skip(1)) {
            self.triangle([a, b, tip], color);
            self.triangle([b, a, neck], color);
        }
    }

    /// Adds a triangle, visible from both sides.
    pub fn triangle(&mut self, corners: [DVec3; 3], color: Color) {
        self.triangles.push((corners, color));
    }

    /// Adds a circle around an axis of any length, of lines `width` pixels wide. If the axis has length 0, Y is used.
    pub fn circle(&mut self, center: DVec3, axis: DVec3, radius: f64, width: f32, color: Color) {
        let points = ring(center, axis.normalize_or(DVec3::Y), radius, SIDES);
        for (a, b) in points.clone().zip(points.skip(1)) {
            self.line(a, b, width, color);
        }
    }

    /// Adds a half circle from `center + across` over `center + top` to `center - across`.
    fn half_circle(&mut self, center: DVec3, across: DVec3, top: DVec3, width: f32, color: Color) {
        let point = |side: u32| {
            let angle = f64::from(side) / f64::from(SIDES) * core::f64::consts::TAU;
            center + across * libm::cos(angle) + top * libm::sin(angle)
        };
        for side in 0..SIDES / 2 {
            self.line(point(side), point(side + 1), width, color);
        }
    }

    /// Adds a sphere, as three circles of lines `width` pixels wide.
    pub fn sphere(&mut self, center: DVec3, radius: f64, width: f32, color: Color) {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            self.circle(center, axis, radius, width, color);
        }
    }

    /// Adds a capsule about the segment from `a` to `b`, as circles and half circles at its ends and four lines between
    /// them, all `width` pixels wide.
    pub fn capsule(&mut self, a: DVec3, b: DVec3, radius: f64, width: f32, color: Color) {
        let axis = (b - a).normalize_or(DVec3::Y);
        let side = axis.any_orthonormal_vector() * radius;
        let other = axis.cross(side);
        for end in [a, b] {
            self.circle(end, axis, radius, width, color);
        }
        for (end, outward) in [(a, -axis), (b, axis)] {
            for across in [side, other] {
                self.half_circle(end, across, outward * radius, width, color);
            }
        }
        for aside in [side, -side, other, -other] {
            self.line(a + aside, b + aside, width, color);
        }
    }

    /// True if nothing was added.
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty() && self.triangles.is_empty()
    }

    /// Vertices for the shader, relative to the eye: triangles first.
    pub(crate) fn vertices(&self, eye: DVec3) -> Vec<[f32; 12]> {
        let mut vertices = Vec::with_capacity(self.triangles.len() * 3 + self.lines.len() * 6);
        let mut push = |p: Vec3, width: f32, other: Vec3, side: f32, color: Color| {
            let [r, g, b, a] = color;
            vertices.push([
                p.x, p.y, p.z, width, other.x, other.y, other.z, side, r, g, b, a,
            ]);
        };
        for (corners, color) in &self.triangles {
            for corner in corners {
                push((corner - eye).as_vec3(), 0.0, Vec3::ZERO, 0.0, *color);
            }
        }
        for line in &self.lines {
            let [a, b] = line.ends.map(|end| (end - eye).as_vec3());
            // Side -1 of the line, as seen from one end, is side 1 as seen from the other end.
            for (p, other, side) in [
                (a, b, -1.0),
                (a, b, 1.0),
                (b, a, -1.0),
                (b, a, -1.0),
                (b, a, 1.0),
                (a, b, -1.0),
            ] {
                push(p, line.width, other, side, line.color);
            }
        }
        vertices
    }
}
