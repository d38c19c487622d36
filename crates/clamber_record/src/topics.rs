//! Names of a recording's topics, each with the type of its messages.

/// Every tick: input and knockback, state, a summary of the step's report, and fingerprints (`tick.Tick`).
pub const TICK: &str = "/tick";
/// Snapshots of the scene, which the caller records, to resume from a tick (`saved.Saved`).
pub const SNAPSHOT: &str = "/snapshot";
/// Transforms of creature, joints and climber (`foxglove.FrameTransforms`).
pub const TRANSFORMS: &str = "/transforms";
/// Joints of drawn figures (`foxglove.FrameTransforms`).
pub const FIGURE: &str = "/figure";
/// Brain of the creature: state, moods, senses (`brain.Brain`).
pub const BRAIN: &str = "/brain";
/// Triangles that queries reached, the triangle that supports the climber, and the climber's body
/// (`foxglove.SceneUpdate`).
pub const SCENE: &str = "/scene";
/// Ground, rocks and other meshes that the caller records for people to look at (`foxglove.SceneUpdate`).
pub const SCENERY: &str = "/scenery";
/// Vertices of the posed skin (`foxglove.PointCloud`).
pub const SKIN: &str = "/skin";
/// Counts of clusters, vertices and triangles that queries touched (`touched.Touched`).
pub const TOUCHED: &str = "/touched";
/// Events of climber and creature (`foxglove.Log`).
pub const LOG: &str = "/log";
/// Every tick of an arena: inputs, orders and fingerprints (`arenatick.ArenaTick`).
pub const ARENA: &str = "/arena";
/// Saved states of an arena, to resume from (`saved.Saved`).
pub const ARENA_SNAPSHOT: &str = "/arena_snapshot";
