#![cfg_attr(
    all(feature = "gltf", feature = "rapier"),
    doc = include_str!("../../../README.md")
)]
#![cfg_attr(
    not(all(feature = "gltf", feature = "rapier")),
    doc = "clamber without the feature `gltf` or `rapier`. The front page is built with both features on."
)]

#[doc(inline)]
pub use clamber_animation as animation;
#[doc(inline)]
pub use clamber_body as body;
#[doc(inline)]
pub use clamber_climber as climber;
#[cfg(feature = "colossus")]
#[doc(inline)]
pub use clamber_colossus as colossus;
#[cfg(feature = "fight")]
#[doc(inline)]
pub use clamber_fight as fight;
#[cfg(feature = "gltf")]
#[doc(inline)]
pub use clamber_gltf as gltf;
#[doc(inline)]
pub use clamber_mover as mover;
#[cfg(feature = "navigation")]
#[doc(inline)]
pub use clamber_navigation as navigation;
#[cfg(feature = "record")]
#[doc(inline)]
pub use clamber_record as record;
#[cfg(feature = "render")]
#[doc(inline)]
pub use clamber_render as render;
pub use clamber_surface::Fingerprint;
#[doc(hidden)]
pub use clamber_surface::{SimdLevel, measure};
#[doc(inline)]
pub use clamber_surface::{geometry, mesh, rig, skin, surface};
#[doc(inline)]
pub use clamber_world as world;
pub use glam;

/// The items that most programs need: `use clamber::prelude::*;`.
///
/// No name in it is also in rapier's prelude, so both can be glob-imported. For that reason it lacks
/// [`Ray`](crate::geometry::Ray), [`Capsule`](crate::geometry::Capsule), [`Pose`](crate::rig::Pose),
/// [`Contact`](crate::world::Contact) and [`HalfSpace`](crate::world::HalfSpace).
pub mod prelude {
    pub use clamber_climber::{
        BodyConfig, Climber, ClimberConfig, ClimberContact, ClimberError, ClimberEvent,
        ClimberGroup, ClimberInput, ClimberMode, ClimberState, ContactPhase, ContactQuery,
        ContactRule, CustomMode, GripConfig, ModeContext, NextMode, Others, StepReport, StepRules,
        Support,
    };
    pub use clamber_surface::geometry::{Affine, Similarity};
    pub use clamber_surface::mesh::{
        ColliderBuildOptions, ColliderMesh, Influence, MeshSource, Rig, SurfaceKind, SurfaceTag,
        TriangleId,
    };
    pub use clamber_surface::rig::{
        Clip, JointId, Palette, Playback, PoseClock, PoseTrack, Skeleton, Transform,
    };
    pub use clamber_surface::surface::{
        Anchor, CastOptions, Motion, SkinnedSurface, SurfaceHit, SurfacePoint, SweepHit,
        TargetMotion,
    };
    pub use clamber_world::{Attachment, MaterialPoint, Obstacle, ObstacleId, PointMotion};
    #[cfg(feature = "rapier")]
    pub use clamber_world::{
        BodyPoses, ClimberProxy, Debris, DebrisConfig, RapierTerrain, apply_push,
    };
}
