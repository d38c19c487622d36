//! Draws a creature from four sides, coloured by the climbing time between each place and the ground.

use std::fs::File;
use std::io::{self, BufWriter};
use std::path::Path;

use clamber_navigation::{ClimbGraph, ClimbReport};
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use glam::{DVec2, DVec3};

/// Height of the picture, pixels.
const ROWS: usize = 720;
/// Border around each of the four views, pixels.
const BORDER: usize = 20;

/// Largest ratio of a creature's width to the height of its drawing. A flatter creature is scaled by its width.
const WIDEST: f64 = 4.0;

/// RGB colours at equal steps of climbing time, from 0 to the longest time: matplotlib's viridis.
const COLORS: [[u8; 3]; 5] = [
    [68, 1, 84],
    [59, 82, 139],
    [33, 145, 140],
    [94, 201, 98],
    [253, 231, 37],
];
/// RGB colour of skin that no climber reaches: grey.
const UNREACHABLE: [u8; 3] = [150, 150, 150];
/// RGB colour of the discs at weak points: red.
const WEAK_POINT: [u8; 3] = [220, 40, 40];
/// RGB colour of the background: white.
const PAPER: [u8; 3] = [255, 255, 255];

/// The four views, each by the direction in the world that points right in the picture. +Y points up in all of them.
const SIDES: [DVec3; 4] = [DVec3::X, DVec3::NEG_Z, DVec3::NEG_X, DVec3::Z];

/// An RGB picture with a depth buffer. A pixel of greater nearness is closer to the eye.
struct Picture {
    columns: usize,
    pixels: Vec<[u8; 3]>,
    nearness: Vec<f64>,
}

impl Picture {
    fn set(&mut self, x: usize, y: usize, nearness: f64, color: [u8; 3]) {
        let at = y * self.columns + x;
        if x < self.columns && self.nearness.get(at).is_some_and(|known| nearness > *known) {
            (self.pixels[at], self.nearness[at]) = (color, nearness);
        }
    }

    /// Fills a triangle. A corner is its column, its row and its nearness.
    fn fill(&mut self, corners: [DVec3; 3], color: [u8; 3]) {
        let [a, b, c] = corners.map(DVec3::truncate);
        let doubled = (b - a).perp_dot(c - a);
        if doubled.abs() < 1e-12 {
            return;
        }
        let low = a.min(b).min(c).floor().max(DVec2::ZERO);
        let high = a.max(b).max(c).ceil();
        for y in low.y as usize..=(high.y as usize).min(ROWS - 1) {
            for x in low.x as usize..=(high.x as usize).min(self.columns - 1) {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let u = (c - b).perp_dot(p - b) / doubled;
                let v = (a - c).perp_dot(p - c) / doubled;
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    let nearness = corners[0].z * u + corners[1].z * v + corners[2].z * w;
                    self.set(x, y, nearness, color);
                }
            }
        }
    }

    /// Fills a triangle in pieces of a few pixels, each with the colour at its middle: the triangle may have many
    /// patches. `color` takes the weights of the corners.
    fn fill_in_pieces(&mut self, [a, b, c]: [DVec3; 3], color: impl Fn([f32; 3]) -> [u8; 3]) {
        let parts = ((b - a).length().max((c - a).length()) / 6.0)
            .ceil()
            .clamp(1.0, 64.0);
        let color = |i: f64, j: f64| {
            let (u, v) = (i / parts, j / parts);
            color([1.0 - u - v, u, v].map(|w| w as f32))
        };
        let corner = |i: u32, j: u32| {
            let (u, v) = (f64::from(i) / parts, f64::from(j) / parts);
            a + (b - a) * u + (c - a) * v
        };
        let n = parts as u32;
        for i in 0..n {
            for j in 0..n - i {
                let (x, y) = (f64::from(i), f64::from(j));
                let upright = [corner(i, j), corner(i + 1, j), corner(i, j + 1)];
                self.fill(upright, color(x + 1.0 / 3.0, y + 1.0 / 3.0));
                if i + j + 1 < n {
                    let inverted = [corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j)];
                    self.fill(inverted, color(x + 2.0 / 3.0, y + 2.0 / 3.0));
                }
            }
        }
    }

    /// Draws a weak point's disc over everything else. The radius is in pixels.
    fn mark(&mut self, middle: DVec3, radius: f64) {
        let low = (middle.truncate() - radius).max(DVec2::ZERO);
        for y in low.y as usize..=(middle.y + radius) as usize {
            for x in low.x as usize..=(middle.x + radius) as usize {
                let apart = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - middle.truncate();
                if apart.length() <= radius && y < ROWS {
                    self.set(x, y, f64::INFINITY, WEAK_POINT);
                }
            }
        }
    }
}

/// Draws a creature at rest and writes a PNG. `skin` holds the vertices of `mesh` in the world. Returns the longest
/// climbing time between a reachable patch and the ground, seconds.
///
/// # Errors
/// [`io::Error`] if the file cannot be written.
pub(super) fn draw(
    path: &Path,
    mesh: &ColliderMesh,
    skin: &[DVec3],
    graph: &ClimbGraph,
    report: &ClimbReport,
) -> io::Result<f64> {
    let entries: Vec<usize> = graph.entries().iter().map(|entry| entry.patch).collect();
    let ground = graph.goal(&entries);
    let reachable = graph.reachable();
    let seconds = |patch: usize| ground.least_seconds_from(patch);
    let longest = (0..reachable.len())
        .filter(|patch| reachable[*patch])
        .map(seconds)
        .filter(|seconds| seconds.is_finite())
        .fold(0.0, f64::max);
    let color = |triangle: usize, weights: [f32; 3]| {
        let patch = graph.patch_of(TriangleId(triangle as u32), weights);
        match patch.filter(|patch| reachable[*patch]) {
            Some(patch) => shade(seconds(patch) / longest.max(1e-9)),
            None => UNREACHABLE,
        }
    };
    let low = skin.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = skin.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let (middle, size) = ((low + high) * 0.5, high - low);
    // The scale comes from the height, or for a flat creature from its width.
    let tall = size.y.max(size.max_element() / WIDEST).max(1e-9);
    let scale = (ROWS - 2 * BORDER) as f64 / tall;
    let width = |side: &DVec3| (size.dot(side.abs()) * scale) as usize + 2 * BORDER;
    let columns: usize = SIDES.iter().map(width).sum();
    let mut picture = Picture {
        columns,
        pixels: vec![PAPER; columns * ROWS],
        nearness: vec![f64::NEG_INFINITY; columns * ROWS],
    };
    let mut left = 0;
    for right in SIDES {
        let toward = right.cross(DVec3::Y);
        let center = (left + width(&right) / 2) as f64;
        let at = |place: DVec3| {
            let from = place - middle;
            let (x, y) = (from.dot(right) * scale, from.y * scale);
            DVec3::new(center + x, ROWS as f64 * 0.5 - y, from.dot(toward))
        };
        for (index, triangle) in mesh.triangles().iter().enumerate() {
            let corners = triangle.map(|vertex| skin[vertex.index()]);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let facing = normal.normalize_or_zero().dot(toward);
            if facing <= 0.0 {
                continue;
            }
            picture.fill_in_pieces(corners.map(at), |weights| {
                lit(color(index, weights), facing)
            });
        }
        for point in &report.weak_points {
            picture.mark(at(point.place), 5.0);
        }
        left += width(&right);
    }
    write(path, &picture)?;
    Ok(longest)
}

/// The colour for a time, given as a share of the longest time.
fn shade(share: f64) -> [u8; 3] {
    let steps = (COLORS.len() - 1) as f64;
    let along = (share * steps).clamp(0.0, steps);
    let first = (along as usize).min(COLORS.len() - 2);
    let part = along - first as f64;
    std::array::from_fn(|k| {
        let [a, b] = [COLORS[first][k], COLORS[first + 1][k]].map(f64::from);
        (a + (b - a) * part) as u8
    })
}

/// Shades a colour by the cosine `facing` between the skin's normal and the direction to the eye.
fn lit(color: [u8; 3], facing: f64) -> [u8; 3] {
    color.map(|part| (f64::from(part) * (0.55 + 0.45 * facing)) as u8)
}

fn write(path: &Path, picture: &Picture) -> io::Result<()> {
    let file = BufWriter::new(File::create(path)?);
    let mut encoder = png::Encoder::new(file, picture.columns as u32, ROWS as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(io::Error::other)?;
    let bytes: Vec<u8> = picture.pixels.iter().flatten().copied().collect();
    writer.write_image_data(&bytes).map_err(io::Error::other)?;
    writer.finish().map_err(io::Error::other)
}
