//! A mark over a climber that is small in the picture.

use clamber::render::Overlay;
use clamber_scenes::battle::Battle;

use super::View;
use crate::colors::{ORANGE, WHITE, seen_through};
use crate::overlays::nearer;

/// Height of the drawn climber, metres.
const TALL: f64 = 1.75;

/// A climber of this height or more in the picture has no mark, pixels.
const LARGE: f64 = 18.0;
/// A climber of this height or less has the opaque mark, pixels.
const SMALL: f64 = 12.0;

/// Width of the mark, an arrow head, pixels.
const WIDE: f64 = 11.0;
/// Height of the mark, pixels.
const HIGH: f64 = 9.0;
/// Distance of the mark above the climber's head, pixels.
const ABOVE: f64 = 4.0;

/// Distance by which the mark is drawn nearer to the eye, metres, so that fur does not hide it.
const NEARER: f64 = 2.5;
/// The same for the mark's outline: so near that no mesh hides it. For a climber on the far side, hardly more than the
/// outline is visible.
const NEAREST: f64 = 1e3;

/// Draws the mark, if the climber is small enough.
pub(super) fn draw(over: &mut Overlay, battle: &Battle<'_>, view: &View) {
    let climber = battle.climber();
    let feet = climber.state().position - climber.config().up() * climber.config().body.radius;
    let head = feet + climber.config().up() * TALL;
    let pixel = view.pixel(head);
    if pixel <= 0.0 {
        return;
    }
    let opacity = ((LARGE - TALL / pixel) / (LARGE - SMALL)).clamp(0.0, 1.0) as f32;
    if opacity == 0.0 {
        return;
    }
    let [right, up] = view.sides(head);
    // On pictures of more than 540 rows, the mark covers the same share of the picture.
    let pixel = pixel * (f64::from(view.rows) / 540.0).max(1.0);
    let tip = head + up * (ABOVE * pixel);
    let corners = [[0.0, 0.0], [-0.5, 1.0], [0.5, 1.0]]
        .map(|[side, high]| tip + up * (high * HIGH * pixel) + right * (side * WIDE * pixel));
    let eye = view.camera.eye;
    let fill = corners.map(|corner| nearer(corner, eye, NEARER));
    over.triangle(fill, seen_through(ORANGE, 0.9 * opacity));
    let [a, b, c] = corners.map(|corner| nearer(corner, eye, NEAREST));
    over.path(&[a, b, c, a], 1.5, seen_through(WHITE, 0.9 * opacity));
}
