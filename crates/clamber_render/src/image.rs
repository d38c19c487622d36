use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

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

    /// The picture at half its width and height, at least 1. Each pixel is the mean of four, in sRGB.
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

/// Writes an animated GIF, picture by picture. The animation repeats for ever.
pub struct Gif {
    path: PathBuf,
    encoder: gif::Encoder<BufWriter<File>>,
    size: (u16, u16),
    /// Time that each picture is shown, in hundredths of a second.
    delay: u16,
}

/// Speed of the GIF encoder: from 1, slow with the best colours, to 30.
const SPEED: i32 = 10;

impl Gif {
    /// Creates a GIF file for pictures of a size in pixels, each shown for `delay` hundredths of a second.
    ///
    /// # Errors
    /// [`RenderError::Write`] if the file cannot be created, or a side has more than 65535 pixels.
    pub fn create(path: &Path, width: u32, height: u32, delay: u16) -> Result<Self, RenderError> {
        let failed = |reason: String| RenderError::Write {
            path: path.to_path_buf(),
            reason,
        };
        let size = (u16::try_from(width), u16::try_from(height));
        let (Ok(width), Ok(height)) = size else {
            return Err(failed(
                "GIF pictures have at most 65535 pixels a side".into(),
            ));
        };
        let file = File::create(path).map_err(|error| failed(error.to_string()))?;
        let encoder = gif::Encoder::new(BufWriter::new(file), width, height, &[]);
        let mut encoder = encoder.map_err(|error| failed(error.to_string()))?;
        let repeat = encoder.set_repeat(gif::Repeat::Infinite);
        repeat.map_err(|error| failed(error.to_string()))?;
        Ok(Self {
            path: path.to_path_buf(),
            encoder,
            size: (width, height),
            delay,
        })
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// [`RenderError::Write`] if the file cannot be written, or the picture has another size.
    pub fn push(&mut self, image: &Image) -> Result<(), RenderError> {
        let failed = |reason: String| RenderError::Write {
            path: self.path.clone(),
            reason,
        };
        let (width, height) = self.size;
        if (image.width, image.height) != (u32::from(width), u32::from(height)) {
            let (found, wanted) = ((image.width, image.height), self.size);
            return Err(failed(format!(
                "a picture of size {found:?} in a file of size {wanted:?}"
            )));
        }
        let mut pixels = image.pixels.clone();
        let mut frame = gif::Frame::from_rgba_speed(width, height, &mut pixels, SPEED);
        frame.delay = self.delay;
        let written = self.encoder.write_frame(&frame);
        written.map_err(|error| failed(error.to_string()))
    }
}
