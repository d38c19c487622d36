//! The preludes of clamber and rapier can be glob-imported together: a name in both is a compile error here.

// An ambiguous name in `use` is only a lint.
#![deny(ambiguous_glob_imports)]

use clamber::prelude::*;
#[expect(unused_imports, reason = "only its names matter")]
use clamber::world::rapier3d::prelude::*;

/// Uses every name, so that an ambiguous one is an error, and lists the names.
macro_rules! use_each {
    ($($name:ident)*) => {
        $(
            #[expect(unused_imports, reason = "that it is no error is enough")]
            use crate::$name as _;
        )*
        /// All names of the list.
        const NAMES: &[&str] = &[$(stringify!($name)),*];
    };
}

use_each! {
    Affine Anchor Attachment BodyConfig BodyPoses CastOptions Climber ClimberConfig ClimberContact
    ClimberError ClimberEvent ClimberGroup ClimberInput ClimberMode ClimberProxy ClimberState Clip ColliderBuildOptions
    ColliderMesh
    ContactPhase ContactQuery ContactRule CustomMode Debris DebrisConfig GripConfig Influence JointId MaterialPoint
    MeshSource ModeContext Motion NextMode Obstacle ObstacleId Others Palette Playback PointMotion PoseClock PoseTrack
    RapierTerrain Rig Similarity Skeleton SkinnedSurface StepReport StepRules Support SurfaceHit SurfaceKind SurfacePoint
    SurfaceTag SweepHit TargetMotion Transform TriangleId
}

#[expect(unused_imports, reason = "the names in the list are those of types")]
use crate::apply_push as _;

/// Finds names that were added to the prelude, but not to the list above.
#[test]
fn every_name_of_the_prelude_is_used() {
    let source = include_str!("../crates/clamber/src/lib.rs");
    let (_, prelude) = source.split_once("pub mod prelude").unwrap();
    let words = prelude.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    let mut names: Vec<&str> = words
        .filter(|w| w.starts_with(char::is_uppercase))
        .collect();
    names.sort_unstable();
    assert_eq!(names, NAMES);
}
