//! The preludes of this crate and of Bevy can be glob-imported together: a name in two of them does not compile here.

// An ambiguous name in `use` is only a lint.
#![deny(ambiguous_glob_imports)]

#[expect(unused_imports, reason = "only their names matter")]
use {
    bevy_app::prelude::*, bevy_asset::prelude::*, bevy_camera::prelude::*, bevy_ecs::prelude::*,
    bevy_math::prelude::*, bevy_mesh::prelude::*, bevy_picking::prelude::*,
    bevy_reflect::prelude::*, bevy_time::prelude::*, bevy_transform::prelude::*,
    bevy_window::prelude::*,
};

use bevy_clamber::prelude::*;

/// Uses every name under its `cfg`, so that an ambiguous one is an error, and lists the names.
macro_rules! use_each {
    ($list:ident, $when:meta, $($name:ident)*) => {
        $(
            #[$when]
            #[expect(unused_imports, reason = "that it is no error is enough")]
            use crate::preludes::$name as _;
        )*
        const $list: &[&str] = &[$(stringify!($name)),*];
    };
}

use_each! { ALWAYS, cfg(all()),
    AirVelocity AnchorLost ClamberPlugins ClamberSystems Climber ClimberBlow ClimberBody ClimberCamera
    ClimberCameraInput ClimberCameraPlugin ClimberFilter ClimberInput ClimberModes ClimberPlugin ClimberRule
    ClimberState ColliderStatus ColliderTag CustomObstacle DefaultClimberRule DrawnSurfaceQuery ContactRule EntityHit PoseTiming
    PosedSurface SkinnedCollider SurfaceAnchor SurfaceFilter SurfaceKind SurfaceQuery SurfaceTag TargetMotion WorldOrigin
}
use_each! { AVIAN, cfg(feature = "avian"), AvianProxy AvianProxyPlugin }
use_each! { COLOSSUS, cfg(feature = "colossus"),
    Colossus ColossusBody ColossusBrain ColossusBurst ColossusEntered ColossusHurt ColossusMarker ColossusNoise
    ColossusPlanted ColossusPlugin ColossusStaggered ColossusStruck ColossusThrew ColossusWave TerrainId
}
use_each! { DIAGNOSTICS, cfg(feature = "diagnostics"), SurfaceDiagnosticsPlugin }
use_each! { FIGHT, cfg(feature = "fight"),
    ArenaCreature ArenaFighter ArenaPlugin ArenaProjectile ArenaTerrain FightArena FightEvent
}
use_each! { GIZMOS, cfg(feature = "gizmos"), SurfaceGizmos SurfaceGizmosPlugin }
use_each! { INPUT, cfg(feature = "input"), ClimberControls ClimberControlsPlugin }
use_each! { PICKING, cfg(feature = "picking"), SurfacePick SurfacePickingPlugin }
use_each! { RAPIER, cfg(feature = "rapier"), Debris DebrisPlugin RapierProxy RapierProxyPlugin }
use_each! { RIGS, cfg(feature = "clamber_gltf"),
    ClimberFigure ClimberFigurePlugin ClimberPlant RigAssets RigJoints RigMarkerPassed RigMaterial RigPlayer
    RigPlayerPlugin SpawnedRig
}

/// Otherwise a name that is added to the prelude would not be checked above.
#[test]
fn every_name_of_the_prelude_is_used() {
    let lines = include_str!("../../src/prelude.rs").lines();
    let code = lines.filter(|line| !line.starts_with("//"));
    let words = code.flat_map(|line| line.split(|c: char| !(c.is_alphanumeric() || c == '_')));
    let mut names: Vec<&str> = words
        .filter(|w| w.starts_with(char::is_uppercase))
        .collect();
    names.sort_unstable();
    let mut used = [
        ALWAYS,
        AVIAN,
        COLOSSUS,
        DIAGNOSTICS,
        FIGHT,
        GIZMOS,
        INPUT,
        PICKING,
        RAPIER,
        RIGS,
    ]
    .concat();
    used.sort_unstable();
    assert_eq!(names, used);
}
