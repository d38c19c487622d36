//! Draws text on a finished picture.

use core::convert::Infallible;

use embedded_graphics::mono_font::ascii::{FONT_6X13, FONT_10X20};
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{Dimensions, DrawTarget, Drawable, Pixel, Point, RgbColor, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};

use crate::Image;

/// The size of text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextSize {
    /// 6 x 13 pixels a character: for pictures of less than 600 rows.
    Small,
    /// 10 x 20 pixels a character.
    Large,
}

/// Margin between the text and the edge of its box, pixels.
const MARGIN: u32 = 8;

/// Share of the picture's colours that shows through the box behind the text, from 0 to 1.
const THROUGH: f32 = 0.35;

impl TextSize {
    fn font(self) -> &'static MonoFont<'static> {
        match self {
            Self::Small => &FONT_6X13,
            Self::Large => &FONT_10X20,
        }
    }
}

impl Image {
    /// Draws lines of text, white on a dark box with its top left corner at this column and row of pixels.
    ///
    /// The font has only ASCII characters: others, and tabs, become question marks. Text that reaches beyond the
    /// picture is cut off. Empty text draws nothing.
    pub fn text(&mut self, [column, row]: [u32; 2], size: TextSize, text: &str) {
        if text.is_empty() || column >= self.width || row >= self.height {
            return;
        }
        let font = size.font();
        let Size { width, height } = font.character_size;
        // The text is cut to the characters that fit into the picture, so that long text does not overflow a
        // coordinate.
        let fit = |pixels: u32, each: u32| (pixels / each) as usize + 1;
        let (columns, rows) = (fit(self.width, width), fit(self.height, height));
        let shown = |c: char| {
            let known = c == ' ' || c.is_ascii_graphic();
            if known { c } else { '?' }
        };
        let lines = text.lines().take(rows);
        let lines: Vec<String> = lines
            .map(|line| line.chars().take(columns).map(shown).collect())
            .collect();
        let longest = lines.iter().map(String::len).max().unwrap_or(0);
        let mut canvas = Canvas {
            image: self,
            origin: [column, row],
        };
        canvas.darken([
            longest as u32 * width + 2 * MARGIN,
            lines.len() as u32 * height + 2 * MARGIN,
        ]);
        let style = MonoTextStyle::new(font, Rgb888::WHITE);
        let corner = Point::new(MARGIN as i32, MARGIN as i32);
        let text = lines.join("\n");
        let text = Text::with_baseline(&text, corner, style, Baseline::Top);
        let Ok(_) = text.draw(&mut canvas);
    }
}

/// A picture with the origin moved to one of its pixels.
struct Canvas<'a> {
    image: &'a mut Image,
    origin: [u32; 2],
}

impl Canvas<'_> {
    /// The colours of a pixel, counted from the origin; `None` outside of the picture.
    fn pixel(&mut self, [x, y]: [u32; 2]) -> Option<&mut [u8]> {
        let [column, row] = self.origin;
        let (x, y) = (column.checked_add(x)?, row.checked_add(y)?);
        if x >= self.image.width || y >= self.image.height {
            return None;
        }
        let at = (y as usize * self.image.width as usize + x as usize) * 4;
        self.image.pixels.get_mut(at..at + 3)
    }

    fn darken(&mut self, [width, height]: [u32; 2]) {
        for y in 0..height.min(self.image.height) {
            for x in 0..width.min(self.image.width) {
                for channel in self.pixel([x, y]).into_iter().flatten() {
                    *channel = (f32::from(*channel) * THROUGH) as u8;
                }
            }
        }
    }
}

impl Dimensions for Canvas<'_> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(
            Point::zero(),
            Size::new(self.image.width, self.image.height),
        )
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb888>>,
    {
        for Pixel(place, color) in pixels {
            let place = (u32::try_from(place.x), u32::try_from(place.y));
            if let (Ok(x), Ok(y)) = place
                && let Some(pixel) = self.pixel([x, y])
            {
                pixel.copy_from_slice(&[color.r(), color.g(), color.b()]);
            }
        }
        Ok(())
    }
}
