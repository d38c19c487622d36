//! Effects that make a fight readable on film: the sword's gleam and its charge, the trails of arrows, hits, dust where
//! the giant strikes the ground, and a mark over a climber that is small in the picture.

mod dust;
mod mark;
mod weapons;

use clamber::render::{Camera, Overlay};
use clamber_scenes::battle::Battle;
use glam::DVec3;

use dust::Dust;
use weapons::Weapons;

/// The effects, with their data from earlier ticks.
#[derive(Debug)]
pub(crate) struct Effects {
    dust: Dust,
    weapons: Weapons,
}

/// A camera, and the rows of pixels of its picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View {
    pub(crate) camera: Camera,
    pub(crate) rows: u32,
}

impl Effects {
    /// Effects for a creature `height` metres tall.
    pub(crate) fn new(height: f64) -> Self {
        Self {
            dust: Dust::new(height),
            weapons: Weapons::default(),
        }
    }

    /// Records a tick. Call it before the first tick and after every one.
    pub(crate) fn watch(&mut self, battle: &Battle<'_>) {
        self.dust.watch(battle);
        self.weapons.watch(battle);
    }

    /// Draws all effects. `sword` has the grip and the tip of the sword, if it is in the hand.
    pub(crate) fn draw(
        &self,
        over: &mut Overlay,
        battle: &Battle<'_>,
        view: &View,
        sword: Option<[DVec3; 2]>,
    ) {
        self.dust.draw(over, view);
        self.weapons.draw(over, battle, view, sword);
        mark::draw(over, battle, view);
    }
}

impl View {
    /// Metres that a pixel covers at a place; 0 behind the eye.
    fn pixel(&self, place: DVec3) -> f64 {
        let ahead = (self.camera.target - self.camera.eye).normalize_or_zero();
        let depth = (place - self.camera.eye).dot(ahead).max(0.0);
        let half = 0.5 * self.camera.field_of_view;
        2.0 * depth * (libm::sin(half) / libm::cos(half)) / f64::from(self.rows.max(1))
    }

    /// Unit vectors to the right and up in the picture, at a place.
    fn sides(&self, place: DVec3) -> [DVec3; 2] {
        let ahead = (place - self.camera.eye).normalize_or(DVec3::NEG_Z);
        let right = ahead.cross(self.camera.up).normalize_or(DVec3::X);
        [right, right.cross(ahead)]
    }
}

/// Draws a disc that faces the eye and fades to its rim, as several discs over each other.
fn glow(over: &mut Overlay, view: &View, place: DVec3, radius: f64, color: [f32; 4]) {
    /// Number of corners of a disc.
    const SIDES: u32 = 16;
    /// Radii of the discs, as shares of the largest one.
    const LAYERS: [f64; 7] = [1.0, 0.9, 0.79, 0.67, 0.54, 0.4, 0.22];
    let [right, up] = view.sides(place);
    let [red, green, blue, opacity] = color;
    for layer in LAYERS {
        let rim = |side: u32| {
            let angle = f64::from(side) / f64::from(SIDES) * core::f64::consts::TAU;
            let (sin, cos) = libm::sincos(angle);
            place + (right * cos + up * sin) * (radius * layer)
        };
        for side in 0..SIDES {
            let color = [red, green, blue, 1.5 * opacity / LAYERS.len() as f32];
            over.triangle([place, rim(side), rim(side + 1)], color);
        }
    }
}
