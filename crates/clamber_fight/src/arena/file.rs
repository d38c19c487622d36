//! A saved arena as bytes: a version, the hash of the configuration, the state, and a checksum.

use super::{Arena, ArenaState};
use crate::error::ArenaError;
use clamber_surface::Fingerprint;

/// First bytes of a saved arena. Other bytes are refused.
const MAGIC: [u8; 8] = *b"clamarna";

/// Version of the format. Raise it with every change to the saved data; other versions are refused.
const VERSION: u32 = 9;

/// Bytes before the state: [`MAGIC`], version, hash of the configuration, checksum.
const HEADER: usize = 8 + 4 + 8 + 8;

impl Arena {
    /// The arena's state as bytes, for a file or a network. A header with the version, the hash of the configuration
    /// and a checksum comes first, then the state in the format of the crate postcard.
    ///
    /// # Errors
    /// [`ArenaError::Damaged`] if the state cannot be written, which does not happen.
    pub fn to_bytes(&self) -> Result<Vec<u8>, ArenaError> {
        let state = postcard::to_stdvec(&self.save())
            .map_err(|error| ArenaError::Damaged(error.to_string()))?;
        let mut bytes = Vec::with_capacity(HEADER + state.len());
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(self.config_hash().to_le_bytes());
        bytes.extend(checksum(&state).to_le_bytes());
        bytes.extend(state);
        Ok(bytes)
    }

    /// Restores a state from the bytes of [`Arena::to_bytes`].
    ///
    /// # Errors
    /// [`ArenaError::Damaged`] if the bytes are something else, [`ArenaError::Version`] if they have another version,
    /// and the errors of [`Arena::restore`]. Nothing is changed then.
    pub fn restore_bytes(&mut self, bytes: &[u8]) -> Result<(), ArenaError> {
        self.restore(&self.read(bytes)?)
    }

    fn read(&self, bytes: &[u8]) -> Result<ArenaState, ArenaError> {
        let damaged = |reason: &str| ArenaError::Damaged(reason.to_owned());
        let (magic, rest) = split::<8>(bytes).ok_or_else(|| damaged("it is too short"))?;
        if magic != MAGIC {
            return Err(damaged("it begins otherwise"));
        }
        let (version, rest) = split::<4>(rest).ok_or_else(|| damaged("it is too short"))?;
        let (found, expected) = (u32::from_le_bytes(version), VERSION);
        if found != expected {
            return Err(ArenaError::Version { found, expected });
        }
        let (config, rest) = split::<8>(rest).ok_or_else(|| damaged("it is too short"))?;
        let (sum, state) = split::<8>(rest).ok_or_else(|| damaged("it is too short"))?;
        if u64::from_le_bytes(sum) != checksum(state) {
            return Err(damaged("its checksum is another one"));
        }
        let (found, expected) = (u64::from_le_bytes(config), self.config_hash());
        if found != expected {
            return Err(ArenaError::Config { found, expected });
        }
        let read = postcard::take_from_bytes::<ArenaState>(state);
        let (state, rest) = read.map_err(|error| ArenaError::Damaged(error.to_string()))?;
        if rest.is_empty() {
            Ok(state)
        } else {
            Err(damaged("there is something after its end"))
        }
    }
}

fn split<const N: usize>(bytes: &[u8]) -> Option<([u8; N], &[u8])> {
    let (first, rest) = bytes.split_first_chunk::<N>()?;
    Some((*first, rest))
}

fn checksum(bytes: &[u8]) -> u64 {
    let mut hash = Fingerprint::default();
    hash.bytes(bytes);
    hash.value()
}
