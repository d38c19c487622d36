//! Colours of the overlays: from Okabe and Ito's set, which colour-blind people can tell apart, and white and magenta.

use clamber::render::Color;

/// Orange, linear red, green and blue.
pub(crate) const ORANGE: [f32; 3] = [0.79, 0.35, 0.0];
/// Sky blue, linear red, green and blue.
pub(crate) const SKY_BLUE: [f32; 3] = [0.09, 0.46, 0.82];
/// Yellow, linear red, green and blue.
pub(crate) const YELLOW: [f32; 3] = [0.87, 0.78, 0.05];
/// Vermilion, linear red, green and blue.
pub(crate) const VERMILION: [f32; 3] = [0.67, 0.11, 0.0];
/// Magenta, linear red, green and blue.
pub(crate) const MAGENTA: [f32; 3] = [1.0, 0.2, 0.8];
/// White, linear red, green and blue.
pub(crate) const WHITE: [f32; 3] = [1.0; 3];

pub(crate) fn opaque([red, green, blue]: [f32; 3]) -> Color {
    [red, green, blue, 1.0]
}

pub(crate) fn seen_through([red, green, blue]: [f32; 3], opacity: f32) -> Color {
    [red, green, blue, opacity]
}
