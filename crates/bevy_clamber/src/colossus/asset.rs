use bevy_asset::io::Reader;
use bevy_asset::{Asset, AssetLoader, LoadContext};
use bevy_reflect::TypePath;
use clamber_colossus::{Brain, BrainError};
use thiserror::Error;

/// Ending of brain files, which [`ColossusPlugin`](super::ColossusPlugin) loads.
const EXTENSION: &str = "brain.json";

/// A brain is checked at this length of a tick when it is loaded, seconds; it is made for the app's own tick later.
const ANY_TICK: f64 = 1.0 / 60.0;

/// A brain, loaded from a file whose name ends with `.brain.json`: see [`clamber_colossus::brain`] for its content.
#[derive(Asset, TypePath, Clone, Debug, PartialEq)]
pub struct ColossusBrain {
    text: String,
}

/// Why a brain file cannot be loaded.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BrainLoadError {
    /// The file cannot be read.
    #[error("cannot read it: {0}")]
    Read(#[from] std::io::Error),
    /// The file is not UTF-8.
    #[error("it is not UTF-8")]
    NotText,
    /// The brain is not valid.
    #[error(transparent)]
    Brain(#[from] BrainError),
}

impl ColossusBrain {
    /// A brain from the text of a file.
    ///
    /// # Errors
    /// [`BrainError`], which names the state and the line.
    pub fn from_json(text: impl Into<String>) -> Result<Self, BrainError> {
        let text = text.into();
        Brain::from_json(&text, ANY_TICK)?;
        Ok(Self { text })
    }

    /// The brain for ticks of this length, seconds.
    pub(super) fn for_ticks(&self, tick: f64) -> Result<Brain, BrainError> {
        Brain::from_json(&self.text, tick)
    }
}

/// Loads [`ColossusBrain`]s.
#[derive(Clone, Copy, Debug, Default, TypePath)]
pub(super) struct BrainLoader;

impl AssetLoader for BrainLoader {
    type Asset = ColossusBrain;
    type Settings = ();
    type Error = BrainLoadError;

    async fn load(
        &self,
        reader: &mut dyn Reader,
        _settings: &(),
        _context: &mut LoadContext<'_>,
    ) -> Result<ColossusBrain, BrainLoadError> {
        let mut bytes = Vec::new();
        reader.read_to_end(&mut bytes).await?;
        let text = String::from_utf8(bytes).map_err(|_| BrainLoadError::NotText)?;
        Ok(ColossusBrain::from_json(text)?)
    }

    fn extensions(&self) -> &[&str] {
        &[EXTENSION]
    }
}
