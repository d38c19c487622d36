use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use crate::RenderError;

/// A picture in sRGB: rows from the top, four bytes for each pixel (red, green, blue, opacity).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Width, pixels.
    pub width: u32,
    /// Height, pixels.
    pub height: u32,
    /// `width * height * 4` bytes.
    pub pixels: Vec<u8>,
}

impl Image {
    /// Writes the picture to a PNG file.
    ///
    /// # Errors
    /// [`RenderError::Write`] if the file cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<(), RenderError> {
        let failed = |reason: String| RenderError::Write {
            path: path.to_path_buf(),
            reason,
        };
        let file = File::create(path).map_err(|error| failed(error.to_string()))?;
        let mut encoder = png::Encoder::new(BufWriter::new(file), self.width, self.height);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        let written = encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&self.pixels));
        written.map_err(|error| failed(error.to_string()))
    }

    /// The picture at half its width and height, each at least 1. Each pixel is the mean of four pixels, in sRGB.
    #[must_use]
    pub fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let at = |x: u32, y: u32, channel: usize| {
            let (x, y) = (x.min(self.width - 1), y.min(self.height - 1));
            u32::from(self.pixels[(y * self.width + x) as usize * 4 + channel])
        };
        let mut pixels = Vec::with_capacity((width * height * 4) as usize);
        for y in 0..height {
            for x in 0..width {
                for channel in 0..4 {
                    let (x, y) = (2 * x, 2 * y);
                    let sum = at(x, y, channel)
                        + at(x + 1, y, channel)
                        + at(x, y + 1, channel)
                        + at(x + 1, y + 1, channel);
                    pixels.push(((sum + 2) / 4) as u8);
                }
            }
        }
        Self {
            width,
            height,
            pixels,
        }
    }
}
