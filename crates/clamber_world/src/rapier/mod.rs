//! A rapier world as an obstacle.

mod poses;
mod terrain;

pub use poses::BodyPoses;
pub use terrain::RapierTerrain;
