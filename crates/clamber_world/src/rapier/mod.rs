//! A rapier world as an obstacle, and climbers that its bodies collide with.

mod poses;
mod proxy;
mod push;
mod terrain;

pub use poses::BodyPoses;
pub use proxy::{ClimberProxy, ProxyImpulse};
pub use push::apply_push;
pub use terrain::RapierTerrain;
