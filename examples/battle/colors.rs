//! Colours of what is drawn over the pictures: of Okabe and Ito's set, which colour-blind people can tell apart, with
//! white and magenta added.

use clamber::render::Color;

pub(crate) const ORANGE: [f32; 3] = [0.79, 0.35, 0.0];
pub(crate) const SKY_BLUE: [f32; 3] = [0.09, 0.46, 0.82];
pub(crate) const YELLOW: [f32; 3] = [0.87, 0.78, 0.05];
pub(crate) const VERMILION: [f32; 3] = [0.67, 0.11, 0.0];
pub(crate) const MAGENTA: [f32; 3] = [1.0, 0.2, 0.8];
pub(crate) const WHITE: [f32; 3] = [1.0; 3];

pub(crate) fn opaque([red, green, blue]: [f32; 3]) -> Color {
    [red, green, blue, 1.0]
}

pub(crate) fn seen_through([red, green, blue]: [f32; 3], opacity: f32) -> Color {
    [red, green, blue, opacity]
}
