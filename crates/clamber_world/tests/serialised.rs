//! The values that a save game stores are the same, bit for bit, after they were written as JSON and read again.
//!
//! Reading the nearest float from JSON needs serde_json's feature `float_roundtrip`.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{
    Attachment, Continuity, FollowResult, MaterialPoint, Obstacle, ObstacleId, PointMotion,
    WorldCapsule,
};
use glam::{DQuat, DVec3, Vec3};
use serde_json::{from_str, from_value, to_string, to_value};

/// Any finite float.
fn any(rng: &mut fastrand::Rng) -> f64 {
    let any = f64::from_bits(rng.u64(..));
    if any.is_finite() { any } else { -0.0 }
}

fn vector(rng: &mut fastrand::Rng) -> DVec3 {
    DVec3::new(any(rng), any(rng), any(rng))
}

fn rotation(rng: &mut fastrand::Rng) -> DQuat {
    DQuat::from_xyzw(any(rng), any(rng), any(rng), any(rng))
}

fn attachment(rng: &mut fastrand::Rng) -> Attachment {
    Attachment {
        obstacle: ObstacleId(rng.u64(..)),
        material: MaterialPoint {
            key: rng.u64(..),
            coordinates: vector(rng).to_array(),
        },
        point: vector(rng),
        frame: rotation(rng),
        offset: vector(rng),
    }
}

fn motion(rng: &mut fastrand::Rng) -> PointMotion {
    PointMotion {
        position: vector(rng),
        previous_position: vector(rng),
        velocity: vector(rng),
        was_teleported: rng.bool(),
        frame: rng.bool().then_some(rotation(rng)),
        turn: rotation(rng),
        area_ratio: any(rng),
        stretches: [any(rng), any(rng)],
    }
}

/// The result of following an attachment on a triangle that moved by `by` metres along X.
fn followed(by: f64) -> FollowResult {
    let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
    let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
    let mut skin = SkinnedSurface::new(mesh.into());
    let place = DVec3::new(0.2, 0.3, 0.4);
    let contact = skin.closest_point(place, 1.0).unwrap();
    let mut arrow = Attachment::new(ObstacleId(1), &skin, &contact, place);
    let moved = Similarity::from_translation(DVec3::X * by);
    let rest = Palette::from_iter([Affine::IDENTITY]);
    skin.advance(&rest, moved).unwrap();
    arrow.follow(&skin, 1.0 / 60.0, 0.01).unwrap()
}

type Held = (
    Attachment,
    (PointMotion, Continuity),
    FollowResult,
    WorldCapsule,
);

#[test]
fn attachments_and_their_motion_keep_every_bit() {
    let mut rng = fastrand::Rng::with_seed(62);
    let ways = [
        Continuity::Moved,
        Continuity::Teleported,
        Continuity::SkippedTicks,
    ];
    for round in 0..300 {
        let held: Held = (
            attachment(&mut rng),
            (motion(&mut rng), ways[round % 3]),
            followed(rng.f64()),
            WorldCapsule::ball(vector(&mut rng), any(&mut rng)),
        );
        let json = to_string(&held).unwrap();
        let read: Held = from_str(&json).unwrap();
        // `Debug` output identifies a float exactly, its sign included.
        assert_eq!(format!("{read:?}"), format!("{held:?}"), "{json}");
    }
}

#[test]
fn an_attachment_without_its_obstacle_is_refused() {
    let mut stored = to_value(attachment(&mut fastrand::Rng::with_seed(63))).unwrap();
    stored.as_object_mut().unwrap().remove("obstacle");
    assert!(from_value::<Attachment>(stored).is_err());
}
