//! What a recording's topics are called.

/// Every tick: input, state, how the movement went, and fingerprints (`tick.Tick`).
pub const TICK: &str = "/tick";
/// Now and then: what the scene needs to go on from a tick (`snapshot.Snapshot`).
pub const SNAPSHOT: &str = "/snapshot";
/// Where creature, joints and climber are (`foxglove.FrameTransforms`).
pub const TRANSFORMS: &str = "/transforms";
/// Skin that queries touched, the triangle that supports the climber, the climber (`foxglove.SceneUpdate`).
pub const SCENE: &str = "/scene";
/// Vertices of the posed skin (`foxglove.PointCloud`).
pub const SKIN: &str = "/skin";
/// What queries touched, in numbers (`touched.Touched`).
pub const TOUCHED: &str = "/touched";
/// What happened to the climber (`foxglove.Log`).
pub const LOG: &str = "/log";
