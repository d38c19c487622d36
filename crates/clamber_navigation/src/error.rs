use clamber_climber::ClimberError;
use clamber_surface::rig::RigError;
use clamber_surface::surface::SurfaceError;
use thiserror::Error;

/// Why a graph could not be built, or a prediction could not be made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum NavigationError {
    /// A number is out of its range.
    #[error("{name} must be {range}, but is {found}")]
    OutOfRange {
        /// Name of the field.
        name: &'static str,
        /// The range that it must be in.
        range: &'static str,
        /// The value that was found.
        found: f64,
    },
    /// No triangle of the creature's skin has an area.
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
        /// The size of a patch, metres.
        spacing: f64,
    },
    /// A clip is too long to be measured: longer than about 14 hours, or the slices of all clips so far would take more
    /// than 300 MB on this many patches.
    #[error(
        "clip `{clip}` lasts {seconds} s at the rate at which it is played, which is too long for this many patches; shorten it, raise \
         the rate, or choose a larger spacing"
    )]
    TooLong {
        /// The clip's name.
        clip: String,
        /// The clip's length at its rate, seconds.
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
    /// The skin cannot be posed, or one of [`GraphConfig::plates`](crate::GraphConfig::plates) has a triangle that the
    /// skin does not have.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
}
