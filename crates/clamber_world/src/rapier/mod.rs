//! A rapier world as an obstacle.

mod poses;
mod push;
mod terrain;

pub use poses::BodyPoses;
pub use push::apply_push;
pub use terrain::RapierTerrain;
