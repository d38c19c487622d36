use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use color_quant::NeuQuant;

use crate::{Image, RenderError};

/// Writes an animated GIF, picture by picture. The animation repeats without end.
///
/// All pictures share one palette: colours of the first picture, chosen by NeuQuant (Dekker 1994, "Kohonen neural
/// networks for optimal colour quantization"), and evenly spaced colours for later pictures. A pixel that keeps its
/// colour within 8 of 255 in each channel is left out, so that a still background costs nothing. A pixel within 8 of
/// the colour of the pixel before it takes that colour. A file without a picture stays empty.
pub struct Gif {
    path: PathBuf,
    size: (u16, u16),
    /// Time that each picture is shown, in hundredths of a second.
    delay: u16,
    /// The file until the first picture, from which the palette is made.
    file: Option<File>,
    film: Option<Film>,
}

/// The encoder and the palette, made from the first picture.
struct Film {
    encoder: gif::Encoder<BufWriter<File>>,
    palette: Palette,
    /// Index in the palette of the colour that each pixel shows.
    shown: Vec<u8>,
}

/// Number of colours of the palette that are evenly spaced: every combination of four levels of each channel.
const EVEN: usize = 64;

/// The index of pixels that are left out; the palette's colours come before it.
const LEFT_OUT: u8 = u8::MAX;

/// Largest difference in a channel, of 255, at which a pixel keeps the colour that it shows. With this and [`RUN`], ten
/// seconds of a battle at 640 by 360 and 15 pictures a second take 3.8 MB; with 6 and 4, they take 4.8 MB. With larger
/// values, the differences are visible.
const KEPT: u8 = 8;

/// Largest difference in a channel, of 255, at which a pixel takes the colour of the pixel before it, since runs of one
/// colour take less space.
const RUN: u8 = 8;

/// NeuQuant learns the palette from one in so many pixels: 23,000 of a picture of 640 by 360.
const SAMPLED: i32 = 10;

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
        Ok(Self {
            path: path.to_path_buf(),
            size: (width, height),
            delay,
            file: Some(file),
            film: None,
        })
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// [`RenderError::Write`] if the file cannot be written, or the picture has another size.
    pub fn push(&mut self, image: &Image) -> Result<(), RenderError> {
        let path = self.path.clone();
        let failed = |reason: String| RenderError::Write { path, reason };
        let (width, height) = self.size;
        if (image.width, image.height) != (u32::from(width), u32::from(height)) {
            let (found, wanted) = ((image.width, image.height), self.size);
            return Err(failed(format!(
                "a picture of size {found:?} in a file of size {wanted:?}"
            )));
        }
        let (size, delay) = (self.size, self.delay);
        self.film(image)
            .and_then(|film| film.push(image, size, delay))
            .map_err(|error| failed(error.to_string()))
    }

    /// The film; if it does not exist yet, it begins with this picture.
    fn film(&mut self, first: &Image) -> Result<&mut Film, gif::EncodingError> {
        if let Some(file) = self.file.take() {
            let palette = Palette::of(first);
            let (width, height) = self.size;
            let writer = BufWriter::new(file);
            let mut encoder = gif::Encoder::new(writer, width, height, &palette.bytes())?;
            encoder.set_repeat(gif::Repeat::Infinite)?;
            self.film = Some(Film {
                encoder,
                palette,
                shown: vec![LEFT_OUT; usize::from(width) * usize::from(height)],
            });
        }
        let closed = || std::io::Error::other("an earlier picture could not be written");
        self.film.as_mut().ok_or_else(|| closed().into())
    }
}

impl Film {
    fn push(
        &mut self,
        image: &Image,
        (width, height): (u16, u16),
        delay: u16,
    ) -> Result<(), gif::EncodingError> {
        let mut indices = Vec::with_capacity(self.shown.len());
        let mut before = LEFT_OUT;
        for (pixel, shown) in image.pixels.chunks_exact(4).zip(&mut self.shown) {
            let color = [pixel[0], pixel[1], pixel[2]];
            if self.palette.is_near(*shown, color, KEPT) {
                indices.push(LEFT_OUT);
            } else {
                if self.palette.is_near(before, color, RUN) {
                    *shown = before;
                } else {
                    *shown = self.palette.nearest(color);
                }
                indices.push(*shown);
            }
            before = *shown;
        }
        let frame = gif::Frame {
            width,
            height,
            delay,
            transparent: Some(LEFT_OUT),
            dispose: gif::DisposalMethod::Keep,
            buffer: indices.into(),
            ..gif::Frame::default()
        };
        self.encoder.write_frame(&frame)
    }
}

/// The colours of a film, and a cache of the nearest colour to each colour that was asked for.
struct Palette {
    colors: Vec<[u8; 3]>,
    /// For five bits of each channel, the index of the nearest colour plus 1; 0 if it is not known yet.
    known: Vec<u8>,
}

impl Palette {
    /// A palette of the colours of a picture and evenly spaced colours.
    fn of(image: &Image) -> Self {
        let learned = usize::from(LEFT_OUT) - EVEN;
        let mut colors: Vec<[u8; 3]> = Vec::with_capacity(usize::from(LEFT_OUT));
        // NeuQuant needs some pixels to learn from.
        if image.pixels.len() / 4 >= 1024 {
            let net = NeuQuant::new(SAMPLED, learned, &image.pixels);
            let found = net.color_map_rgb();
            colors.extend(found.chunks_exact(3).map(|c| [c[0], c[1], c[2]]));
        }
        let level = |k: usize| (k % 4 * 85) as u8;
        colors.extend((0..EVEN).map(|k| [level(k), level(k / 4), level(k / 16)]));
        Self {
            colors,
            known: vec![0; 1 << 15],
        }
    }

    /// The palette in the file's format: 256 colours of three bytes, the unused ones black.
    fn bytes(&self) -> Vec<u8> {
        let mut bytes = self.colors.concat();
        bytes.resize(3 << 8, 0);
        bytes
    }

    /// True if a colour of the palette differs by at most `most` in each channel; false for [`LEFT_OUT`].
    fn is_near(&self, index: u8, color: [u8; 3], most: u8) -> bool {
        self.colors.get(usize::from(index)).is_some_and(|shown| {
            let channels = shown.iter().zip(color);
            channels.into_iter().all(|(a, b)| a.abs_diff(b) <= most)
        })
    }

    /// The index of the colour that is nearest to a colour, whose channels are rounded to five bits.
    fn nearest(&mut self, color: [u8; 3]) -> u8 {
        let five = |channel: u8| usize::from(channel >> 3);
        let key = five(color[0]) << 10 | five(color[1]) << 5 | five(color[2]);
        if self.known[key] == 0 {
            let middle = color.map(|channel| i32::from(channel & !7 | 4));
            let apart = |shown: &[u8; 3]| -> i32 {
                let channels = shown.iter().zip(middle);
                channels.map(|(a, b)| (i32::from(*a) - b).pow(2)).sum()
            };
            let all = self.colors.iter().enumerate();
            let nearest = all.min_by_key(|(_, shown)| apart(shown));
            self.known[key] = nearest.map_or(0, |(index, _)| index as u8) + 1;
        }
        self.known[key] - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Width and height of the test pictures, pixels. NeuQuant needs 1,024 pixels or more.
    const SIDE: u32 = 96;

    /// A sky that shades from blue to white, and a red square whose first column and row are `square`.
    fn picture(square: u32) -> Image {
        let mut pixels = Vec::new();
        for y in 0..SIDE {
            for x in 0..SIDE {
                let light = (y * 255 / SIDE) as u8;
                let inside = |at: u32| (square..square + 20).contains(&at);
                let color = match inside(x) && inside(y) {
                    true => [200, 30, 20],
                    false => [light, light, 255],
                };
                pixels.extend(color);
                pixels.push(255);
            }
        }
        Image {
            width: SIDE,
            height: SIDE,
            pixels,
        }
    }

    fn written(name: &str, pictures: &[Image]) -> Vec<u8> {
        let path = std::env::temp_dir().join(format!("{}-{name}.gif", std::process::id()));
        let mut gif = Gif::create(&path, SIDE, SIDE, 5).unwrap();
        for picture in pictures {
            gif.push(picture).unwrap();
        }
        drop(gif);
        let bytes = std::fs::read(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        bytes
    }

    /// The pictures as a viewer shows them, three bytes a pixel.
    fn shown(bytes: &[u8]) -> Vec<Vec<u8>> {
        let mut decoder = gif::DecodeOptions::new();
        decoder.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = decoder.read_info(bytes).unwrap();
        let mut canvas = vec![0; (SIDE * SIDE * 3) as usize];
        let mut shown = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            assert_eq!(frame.delay, 5);
            for (old, new) in canvas.chunks_exact_mut(3).zip(frame.buffer.chunks_exact(4)) {
                if new[3] > 0 {
                    old.copy_from_slice(&new[..3]);
                }
            }
            shown.push(canvas.clone());
        }
        shown
    }

    #[test]
    fn a_viewer_shows_what_was_pushed() {
        let pictures: Vec<Image> = (0..5).map(|step| picture(10 * step)).collect();
        let shown = shown(&written("shows", &pictures));
        assert_eq!(shown.len(), pictures.len());
        for (frame, (shown, pushed)) in shown.iter().zip(&pictures).enumerate() {
            let pairs = shown.chunks_exact(3).zip(pushed.pixels.chunks_exact(4));
            for (pixel, (shown, pushed)) in pairs.enumerate() {
                let off = shown.iter().zip(pushed).map(|(a, b)| a.abs_diff(*b)).max();
                let case = format!("frame {frame}, pixel {pixel}: {shown:?} for {pushed:?}");
                assert!(off.unwrap() <= 16, "{case}");
            }
        }
    }

    #[test]
    fn what_does_not_change_costs_next_to_nothing() {
        let once = written("once", &[picture(10)]).len();
        let often = written("often", &vec![picture(10); 50]).len();
        assert!(often < once + 50 * 200, "{once} bytes, {often} for fifty");
    }

    #[test]
    fn a_colour_that_the_first_picture_lacks_is_shown_by_a_near_one() {
        let mut green = picture(0);
        for pixel in green.pixels.chunks_exact_mut(4) {
            pixel.copy_from_slice(&[10, 220, 40, 255]);
        }
        let shown = shown(&written("green", &[picture(0), green]));
        let [r, g, b] = [shown[1][0], shown[1][1], shown[1][2]];
        assert!(r < 60 && g > 160 && b < 90, "{r} {g} {b}");
    }

    #[test]
    fn a_picture_of_another_size_is_refused() {
        let path = std::env::temp_dir().join(format!("{}-size.gif", std::process::id()));
        let mut gif = Gif::create(&path, SIDE + 1, SIDE, 5).unwrap();
        let error = gif.push(&picture(0)).unwrap_err().to_string();
        assert!(error.contains("97"), "{error}");
        gif.push(&Image {
            width: SIDE + 1,
            height: SIDE,
            pixels: vec![9; ((SIDE + 1) * SIDE * 4) as usize],
        })
        .unwrap();
        std::fs::remove_file(&path).unwrap();
    }
}
