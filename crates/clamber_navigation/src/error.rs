use clamber_climber::ClimberError;
use clamber_surface::rig::RigError;
use clamber_surface::surface::SurfaceError;
use thiserror::Error;

/// Why a graph could not be built.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NavigationError {
    /// A number is out of its range.
    #[error("{name} must be {range}, but is {found}")]
    OutOfRange {
        /// Name of the field.
        name: &'static str,
        /// What it may be.
        range: &'static str,
        /// What it is.
        found: f64,
    },
    /// The creature has no skin with an area.
    #[error("the creature has no skin: none of its triangles has an area")]
    NoSkin,
    /// The skin is too large for patches of this size.
    #[error(
        "the skin would have {found} patches, and {most} is the limit; choose a larger spacing than {spacing} m, or a smaller scale"
    )]
    TooManyPatches {
        /// Number of patches.
        found: u64,
        /// The limit.
        most: u64,
        /// Their size, metres.
        spacing: f64,
    },
    /// A clip lasts too long to be looked at: 14 hours, or together with the others and on so many patches it would
    /// take more than 300 MB.
    #[error(
        "clip `{clip}` lasts {seconds} s at the rate at which it is played, which is too long for this many patches; shorten it, raise \
         the rate, or choose a larger spacing"
    )]
    TooLong {
        /// The clip.
        clip: String,
        /// How long it lasts, seconds.
        seconds: f64,
    },
    /// The caller cancelled the build.
    #[error("cancelled")]
    Cancelled,
    /// The climber's configuration is not valid.
    #[error(transparent)]
    Climber(#[from] ClimberError),
    /// The skeleton cannot be posed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The skin cannot be posed.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}
