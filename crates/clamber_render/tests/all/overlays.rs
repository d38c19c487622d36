//! Tests that arrows and lines are drawn with their length and width.

use crate::common;

use clamber_render::{Camera, Frame, Image, Light, Overlay, Renderer};
use glam::DVec3;

/// Width of the picture, pixels.
const WIDTH: u32 = 240;
/// Height of the picture, pixels.
const ROWS: u32 = 120;

/// First and last column, and first and last row, of the red pixels.
fn extent(image: &Image) -> [u32; 4] {
    let red = image.pixels.chunks_exact(4).enumerate().filter(|(_, p)| {
        // Mostly red: edges are smoothed.
        p[0] > 180 && p[1] < 140 && p[2] < 140
    });
    let start = [u32::MAX, 0, u32::MAX, 0];
    red.fold(start, |[a, b, c, d], (index, _)| {
        let (column, row) = (index as u32 % WIDTH, index as u32 / WIDTH);
        [a.min(column), b.max(column), c.min(row), d.max(row)]
    })
}

#[test]
fn arrows_and_lines_have_their_ends_and_width() {
    /// Colour of the overlay, which [`extent`] looks for.
    const RED: [f32; 4] = [1.0, 0.0, 0.0, 1.0];
    let Some(gpu) = common::gpu("an arrow") else {
        return;
    };
    let mut renderer = Renderer::new(gpu, WIDTH, ROWS).unwrap();
    // Half of the picture's height shows 6 m times the tangent of half the field of view.
    let metre = f64::from(ROWS) / 2.0 / (6.0 * libm::tan(25f64.to_radians()));
    let middle = DVec3::new(f64::from(WIDTH) / 2.0, f64::from(ROWS) / 2.0, 0.0);
    for (from, along) in [
        (DVec3::new(-2.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 0.0)),
        (DVec3::new(3.0, 1.0, 0.0), DVec3::new(-2.0, 0.0, 0.0)),
        (DVec3::new(1.0, -1.5, 0.0), DVec3::new(0.0, 3.0, 0.0)),
    ] {
        let draw = |overlay| Frame {
            camera: Camera::new(DVec3::Z * 6.0, DVec3::ZERO),
            light: Light::over(DVec3::ZERO, 8.0),
            drawn: Vec::new(),
            overlay,
        };
        let mut arrow = Overlay::default();
        arrow.arrow(from, along, 3.0, RED);
        let mut line = Overlay::default();
        line.line(from, from + along, 3.0, RED);
        let flip = DVec3::new(metre, -metre, 0.0);
        let [start, tip] = [from, from + along].map(|place| middle + place * flip);
        let is_level = along.y == 0.0;
        let [low, high] = if is_level {
            [start.x.min(tip.x), start.x.max(tip.x)]
        } else {
            [start.y.min(tip.y), start.y.max(tip.y)]
        };
        // An arrow is as wide as its head.
        for (what, overlay, wide, within) in [("arrow", arrow, 0.12, 2.5), ("line", line, 0.0, 1.0)]
        {
            let image = renderer.draw(&draw(overlay)).unwrap();
            let [left, right, top, bottom] = extent(&image);
            let (along, across) = if is_level {
                ([left, right], bottom + 1 - top)
            } else {
                ([top, bottom], right + 1 - left)
            };
            // Near its end, a tip is thinner than a pixel.
            assert!(
                (f64::from(along[0]) - low).abs() < 3.5,
                "{what} from {from}: {along:?} {low}"
            );
            assert!(
                (f64::from(along[1]) - high).abs() < 3.5,
                "{what} from {from}: {along:?} {high}"
            );
            let wide = f64::max(wide * (high - low), 3.0);
            assert!(
                (f64::from(across) - wide).abs() <= within,
                "{what} from {from}: {across} {wide}"
            );
        }
    }
}
