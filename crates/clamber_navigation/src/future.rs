//! The future pose of a creature, for predictions.

use std::sync::Arc;

use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::{ColliderMesh, TriangleId};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;

use crate::NavigationError;

/// Predicts a creature's pose: fills in the palette for a time from now on, in seconds, and returns the creature's
/// transform in the world then. `None` if it does not know that far ahead.
///
/// The clips that the creature plays give this pose, until its brain chooses other clips.
pub trait PoseForecast {
    /// The pose at a time, seconds from now on, not negative. At time 0 it is the creature's present pose.
    fn pose(&mut self, seconds: f64, palette: &mut Palette) -> Option<Similarity>;
}

impl<F: FnMut(f64, &mut Palette) -> Option<Similarity>> PoseForecast for F {
    fn pose(&mut self, seconds: f64, palette: &mut Palette) -> Option<Similarity> {
        self(seconds, palette)
    }
}

/// A skin that predictions pose at future times, reused so that they do not allocate. It keeps no results: it serves
/// any creature that has this mesh and has lost the same triangles.
#[derive(Clone, Debug)]
pub struct FutureSkin {
    surface: SkinnedSurface,
    palette: Palette,
}

impl FutureSkin {
    /// A skin for predictions about creatures with this mesh ([`SkinnedSurface::mesh`]), with all its triangles.
    pub fn new(mesh: Arc<ColliderMesh>) -> Self {
        Self {
            surface: SkinnedSurface::new(mesh),
            palette: Palette::default(),
        }
    }

    /// Removes a triangle: no landing is predicted on it. Call it when the creature's own skin loses the triangle, as
    /// with a broken plate. [`FutureSkin::enable_triangle`] puts it back.
    ///
    /// # Errors
    /// [`NavigationError::Surface`] if the mesh does not have it.
    pub fn disable_triangle(&mut self, triangle: TriangleId) -> Result<(), NavigationError> {
        Ok(self.surface.disable_triangle(triangle)?)
    }

    /// Puts a triangle back.
    ///
    /// # Errors
    /// [`NavigationError::Surface`] if the mesh does not have it.
    pub fn enable_triangle(&mut self, triangle: TriangleId) -> Result<(), NavigationError> {
        Ok(self.surface.enable_triangle(triangle)?)
    }

    /// The skin as posed last.
    pub(crate) fn surface(&self) -> &SkinnedSurface {
        &self.surface
    }

    /// Poses the skin at a future time, without motion. False if that pose is not known.
    pub(crate) fn place(
        &mut self,
        forecast: &mut dyn PoseForecast,
        seconds: f64,
    ) -> Result<bool, NavigationError> {
        let Some(place) = forecast.pose(seconds, &mut self.palette) else {
            return Ok(false);
        };
        self.surface.teleport(&self.palette, place)?;
        Ok(true)
    }

    /// Moves the skin on to a future time. False if that pose is not known.
    pub(crate) fn advance(
        &mut self,
        forecast: &mut dyn PoseForecast,
        seconds: f64,
    ) -> Result<bool, NavigationError> {
        let Some(place) = forecast.pose(seconds, &mut self.palette) else {
            return Ok(false);
        };
        self.surface.advance(&self.palette, place)?;
        Ok(true)
    }
}

/// Refuses a time step, seconds, that is not positive and finite.
pub(crate) fn check_step(dt: f64) -> Result<(), NavigationError> {
    if dt > 0.0 && dt.is_finite() {
        return Ok(());
    }
    Err(NavigationError::OutOfRange {
        name: "dt",
        range: "positive and finite",
        found: dt,
    })
}
