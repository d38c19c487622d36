use std::error::Error;

/// Why a creature or a scene cannot be loaded, made, stepped, recorded or drawn.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
pub struct SceneError(Box<dyn Error + Send + Sync>);

impl SceneError {
    /// An error of another library, or a sentence.
    pub fn new(error: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self(error.into())
    }
}

macro_rules! from {
    ($($error:ty),+ $(,)?) => {$(
        impl From<$error> for SceneError {
            fn from(error: $error) -> Self {
                Self(error.into())
            }
        }
    )+};
}

from!(
    String,
    clamber_climber::ClimberError,
    clamber_colossus::ColossusError,
    clamber_fight::ArenaError,
    clamber_gltf::GltfError,
    clamber_navigation::NavigationError,
    clamber_surface::mesh::MeshError,
    clamber_surface::mesh::PaletteError,
    clamber_surface::rig::RigError,
    clamber_surface::surface::SurfaceError,
    clamber_world::DebrisError,
    serde_json::Error,
);
#[cfg(feature = "record")]
from!(clamber_record::RecordError);
#[cfg(feature = "render")]
from!(clamber_render::RenderError);
