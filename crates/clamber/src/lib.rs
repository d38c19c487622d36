#![cfg_attr(
    all(feature = "gltf", feature = "rapier"),
    doc = include_str!("../../../README.md")
)]
#![cfg_attr(
    not(all(feature = "gltf", feature = "rapier")),
    doc = "clamber without some of its features; its front page is that of all features."
)]

#[doc(inline)]
pub use clamber_climber as climber;
#[cfg(feature = "gltf")]
#[doc(inline)]
pub use clamber_gltf as gltf;
#[doc(inline)]
pub use clamber_mover as mover;
#[cfg(feature = "record")]
#[doc(inline)]
pub use clamber_record as record;
#[cfg(feature = "render")]
#[doc(inline)]
pub use clamber_render as render;
#[cfg(feature = "parry")]
#[doc(inline)]
pub use clamber_surface::parry;
#[doc(inline)]
pub use clamber_surface::{SimdLevel, geometry, mesh, rig, skin, surface};
#[doc(inline)]
pub use clamber_world as world;
pub use glam;

/// What most programs need: `use clamber::prelude::*;`.
pub mod prelude {
    pub use clamber_climber::{
        Climber, ClimberConfig, ClimberContact, ClimberEvent, ClimberInput, ClimberMode,
        ClimberState, ContactPhase, CustomMode, GripConfig, ModeContext, NextMode, StepReport,
        StepRules, Support,
    };
    pub use clamber_surface::geometry::{Affine, Capsule, Ray, Similarity, Sphere};
    pub use clamber_surface::mesh::{
        BuildOptions, ColliderMesh, Influence, MeshSource, SurfaceKind, SurfaceTag, TriangleId,
    };
    pub use clamber_surface::rig::{Clip, JointId, Palette, Playback, Pose, Skeleton, Transform};
    pub use clamber_surface::surface::{Anchor, Motion, SkinnedSurface, SurfaceHit, SweepHit};
    pub use clamber_world::{
        Attachment, Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion,
    };
    #[cfg(feature = "rapier")]
    pub use clamber_world::{BodyPoses, Debris, DebrisConfig, RapierTerrain};
}
