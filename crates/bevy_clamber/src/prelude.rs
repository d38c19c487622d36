//! The items that most apps need: `use bevy_clamber::prelude::*;`.

#[cfg(feature = "diagnostics")]
pub use crate::SurfaceDiagnosticsPlugin;
pub use crate::{
    AirVelocity, AnchorLost, ClamberPlugins, ClamberSystems, Climber, ClimberBlow, ClimberBody,
    ClimberCamera, ClimberCameraInput, ClimberCameraPlugin, ClimberFilter, ClimberInput,
    ClimberModes, ClimberPlugin, ClimberRule, ClimberState, ColliderStatus, ColliderTag,
    CustomObstacle, DefaultClimberRule, DrawnSurfaceQuery, EntityHit, PoseTiming, PosedSurface,
    SkinnedCollider, SurfaceAnchor, SurfaceFilter, SurfaceQuery, WorldOrigin,
};
#[cfg(feature = "fight")]
pub use crate::{
    ArenaCreature, ArenaFighter, ArenaPlugin, ArenaProjectile, ArenaTerrain, FightArena, FightEvent,
};
#[cfg(feature = "avian")]
pub use crate::{AvianProxy, AvianProxyPlugin};
#[cfg(feature = "input")]
pub use crate::{ClimberControls, ClimberControlsPlugin};
#[cfg(feature = "clamber_gltf")]
pub use crate::{
    ClimberFigure, ClimberFigurePlugin, ClimberPlant, RigAssets, RigJoints, RigMarkerPassed,
    RigMaterial, RigPlayer, RigPlayerPlugin, SpawnedRig,
};
#[cfg(feature = "colossus")]
pub use crate::{
    Colossus, ColossusBody, ColossusBrain, ColossusBurst, ColossusEntered, ColossusHurt,
    ColossusMarker, ColossusNoise, ColossusPlanted, ColossusPlugin, ColossusStaggered,
    ColossusStruck, ColossusThrew, ColossusWave, TerrainId,
};
#[cfg(feature = "rapier")]
pub use crate::{Debris, DebrisPlugin, RapierProxy, RapierProxyPlugin};
#[cfg(feature = "gizmos")]
pub use crate::{SurfaceGizmos, SurfaceGizmosPlugin};
#[cfg(feature = "picking")]
pub use crate::{SurfacePick, SurfacePickingPlugin};
pub use clamber_climber::ContactRule;
pub use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
pub use clamber_surface::surface::TargetMotion;
