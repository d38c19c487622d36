#![doc = include_str!("../README.md")]

mod anchor;
#[cfg(feature = "fight")]
mod arena;
mod camera;
mod climber;
mod collider;
#[cfg(feature = "colossus")]
mod colossus;
#[cfg(feature = "input")]
mod controls;
#[cfg(feature = "clamber_gltf")]
mod creature;
#[cfg(feature = "diagnostics")]
mod diagnostics;
#[cfg(feature = "clamber_gltf")]
mod figure;
#[cfg(feature = "gizmos")]
mod gizmos;
mod needs;
#[cfg(any(feature = "avian", feature = "rapier"))]
mod obstacles;
#[cfg(feature = "picking")]
mod picking;
mod plugins;
pub mod prelude;
mod query;
mod surface;
mod tell;

pub use anchor::{
    AnchorError, AnchorLost, AnchoredTo, SurfaceAnchor, SurfaceAnchorPlugin, SurfaceAnchors,
};
#[cfg(feature = "fight")]
pub use arena::{
    ArenaCreature, ArenaFighter, ArenaPlugin, ArenaProjectile, ArenaTerrain, FightArena, FightEvent,
};
pub use camera::{ClimberCamera, ClimberCameraInput, ClimberCameraPlugin};
#[cfg(feature = "colossus")]
pub use climber::TerrainId;
pub use climber::{
    AirVelocity, Climber, ClimberBlow, ClimberBody, ClimberFilter, ClimberInput, ClimberModes,
    ClimberPlugin, ClimberRule, ClimberState, ClimberTouch, CustomObstacle, DefaultClimberRule,
    events,
};
pub use collider::{
    ColliderError, ColliderFailure, ColliderNeeds, ColliderStatus, ColliderTag, SkinnedCollider,
};
#[cfg(feature = "colossus")]
pub use colossus::{
    BrainLoadError, Colossus, ColossusBody, ColossusBrain, ColossusBurst, ColossusEntered,
    ColossusHurt, ColossusMarker, ColossusNoise, ColossusPlanted, ColossusPlugin,
    ColossusStaggered, ColossusStruck, ColossusThrew, ColossusWave,
};
#[cfg(feature = "input")]
pub use controls::{
    ClimberControls, ClimberControlsPlugin, ControlBindings, ControlButton, ControlDevice,
};
#[cfg(feature = "clamber_gltf")]
pub use creature::{
    RigAssets, RigJoints, RigMarkerPassed, RigMaterial, RigPlayer, RigPlayerPlugin, SpawnedRig,
    TooManyJoints,
};
#[cfg(feature = "diagnostics")]
pub use diagnostics::SurfaceDiagnosticsPlugin;
#[cfg(feature = "clamber_gltf")]
pub use figure::{
    ClimberFigure, ClimberFigurePlugin, ClimberFigures, ClimberPlant, FigureOf, WrongJoints,
};
#[cfg(feature = "gizmos")]
pub use gizmos::{SurfaceGizmos, SurfaceGizmosPlugin};
#[cfg(feature = "avian")]
pub use obstacles::{
    AvianObstacles, AvianObstaclesPlugin, AvianProxy, AvianProxyPlugin, AvianTerrain,
};
#[cfg(feature = "rapier")]
pub use obstacles::{
    Debris, DebrisBodies, DebrisHooks, DebrisPlugin, RapierObstacles, RapierObstaclesPlugin,
    RapierProxy, RapierProxyPlugin,
};
#[cfg(feature = "picking")]
pub use picking::{SurfacePick, SurfacePickingPlugin};
pub(crate) use plugins::ClimberTicks;
pub use plugins::{ClamberPlugins, ClamberSystems};
pub use query::{
    DrawnPose, DrawnSurfaceQuery, EntityHit, EntitySweepHit, SurfaceFilter, SurfacePose,
    SurfaceQuery, TickPose,
};
pub use surface::{DrawnSurface, PoseError, PoseTiming, PosedSurface, SurfacePlugin, WorldOrigin};

#[cfg(feature = "clamber_gltf")]
pub use clamber_animation;
#[cfg(feature = "clamber_gltf")]
pub use clamber_body;
/// The character.
pub use clamber_climber;
#[cfg(feature = "colossus")]
pub use clamber_colossus;
#[cfg(feature = "fight")]
pub use clamber_fight;
#[cfg(feature = "clamber_gltf")]
pub use clamber_gltf;
/// Surfaces, their queries and meshes.
pub use clamber_surface;
/// The obstacles that a climber can touch.
pub use clamber_world;
/// Vectors and rotations; the same as in `bevy_math`.
pub use glam;
