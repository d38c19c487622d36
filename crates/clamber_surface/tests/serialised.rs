//! Values that are written as JSON and read again have the same bits, and invalid values are refused.
//!
//! To read a JSON number as the nearest float, serde_json needs its feature `float_roundtrip`.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber_surface::geometry::{Affine, Similarity};
use clamber_surface::mesh::{
    ColliderBuildOptions, ColliderMesh, IslandId, MeshSource, PartId, SurfaceKind, SurfaceTag,
    TriangleId, VertexId,
};
use clamber_surface::rig::{
    Joint, JointId, Palette, Playback, Pose, PoseMotion, PoseTrack, Skeleton, Transform,
};
use clamber_surface::surface::{Anchor, SkinnedSurface};
use glam::{DQuat, DVec3, Quat, Vec3};
use serde_json::{from_str, json, to_string};

/// Writes and reads a value, and compares the `Debug` text: the text of a float names exactly one float, with its sign.
fn assert_stays<T>(value: &T)
where
    T: std::fmt::Debug + serde::Serialize + serde::de::DeserializeOwned,
{
    let read: T = from_str(&to_string(value).unwrap()).unwrap();
    assert_eq!(format!("{read:?}"), format!("{value:?}"));
}

/// Any finite float.
fn f32_of(rng: &mut fastrand::Rng) -> f32 {
    let any = f32::from_bits(rng.u32(..));
    if any.is_finite() { any } else { -0.0 }
}

fn f64_of(rng: &mut fastrand::Rng) -> f64 {
    let any = f64::from_bits(rng.u64(..));
    if any.is_finite() { any } else { -0.0 }
}

fn affine(rng: &mut fastrand::Rng) -> Affine {
    Affine {
        rows: std::array::from_fn(|_| std::array::from_fn(|_| f32_of(rng))),
    }
}

#[test]
fn maps_and_poses_keep_every_bit() {
    let mut rng = fastrand::Rng::with_seed(61);
    for _ in 0..1_000 {
        assert_stays(&affine(&mut rng));
        let mut wide = || f64_of(&mut rng);
        assert_stays(&Similarity {
            rotation: DQuat::from_array(std::array::from_fn(|_| wide())),
            scale: wide(),
            translation: DVec3::from_array(std::array::from_fn(|_| wide())),
        });
        let mut narrow = || f32_of(&mut rng);
        let transform = Transform {
            translation: Vec3::from_array(std::array::from_fn(|_| narrow())),
            rotation: Quat::from_array(std::array::from_fn(|_| narrow())),
            scale: Vec3::from_array(std::array::from_fn(|_| narrow())),
        };
        assert_stays(&transform);
        assert_stays(&Pose {
            transforms: vec![transform, Transform::IDENTITY],
        });
        let count = rng.usize(0..4);
        assert_stays(&(0..count).map(|_| affine(&mut rng)).collect::<Palette>());
    }
}

#[test]
fn ids_and_tags_round_trip() {
    assert_stays(&(JointId(u32::MAX), VertexId(1), TriangleId(2), PartId(3)));
    assert_stays(&(IslandId(4), Playback::Loop));
    let tag = SurfaceTag::new(SurfaceKind::Stone).with_user(7);
    assert_stays(&tag.with_user(u32::MAX));
}

#[test]
fn a_saved_anchor_is_valid_on_a_mesh_rebuilt_and_edited_alike() {
    let made = || {
        let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
        let (mesh, _) = ColliderMesh::build(&source, &ColliderBuildOptions::default()).unwrap();
        let mut surface = SkinnedSurface::new(mesh.into());
        let added = surface.edit(|edit| {
            let tip = edit.add_vertex(Vec3::Z, source.influences.split_at(1).0)?;
            edit.add_triangle([VertexId(0), VertexId(1), tip], SurfaceTag::default())
        });
        (surface, added.unwrap())
    };
    let (surface, added) = made();
    let on_added = surface.anchor(added, [0.25, 0.25, 0.5]).unwrap();
    let on_built = surface.anchor(TriangleId(0), [0.25, 0.25, 0.5]).unwrap();
    assert_ne!(on_added.mesh, on_built.mesh);
    let (again, _) = made();
    for anchor in [on_added, on_built] {
        assert_stays(&anchor);
        let read: Anchor = from_str(&to_string(&anchor).unwrap()).unwrap();
        let moved = again.in_model().motion(&read, 0.1).unwrap();
        let expected = surface.in_model().motion(&anchor, 0.1).unwrap();
        assert_eq!(moved.position, expected.position);
        // The mesh id's two parts both count.
        let id = anchor.mesh.to_string();
        let (fingerprint, _) = id.split_once('+').unwrap_or((&id, ""));
        let of_mesh = |text: &str| {
            let mut written = serde_json::to_value(anchor).unwrap();
            written["mesh"] = json!(text);
            serde_json::from_value::<Anchor>(written)
        };
        for other in [
            format!("{fingerprint}+7"),
            id.replace(fingerprint, "0000000000000007"),
        ] {
            let read = of_mesh(&other).unwrap();
            assert!(again.in_model().motion(&read, 0.1).is_err(), "{other}");
        }
        for none in ["", "x", "7", "000000000000000G", "00000000000000007"] {
            assert!(of_mesh(none).is_err(), "{none:?}");
        }
        for end in ["+", "+x", "+0", "+07", "++7", "+-7"] {
            let none = format!("{fingerprint}{end}");
            assert!(of_mesh(&none).is_err(), "{none:?}");
        }
    }
}

/// A palette of two joints from a skeleton, so that it stores where its joints are.
fn posed() -> Palette {
    let joint = |parent, x| Joint {
        name: String::new(),
        parent,
        rest: Transform::from_translation(Vec3::X * x),
        inverse_bind: Affine::IDENTITY,
    };
    let joints = vec![joint(None, 0.1), joint(Some(JointId(0)), 0.7)];
    let skeleton = Skeleton::new(joints).unwrap();
    skeleton.palette(&skeleton.rest_pose()).unwrap()
}

#[test]
fn a_palette_still_knows_where_its_joints_are_after_a_round_trip() {
    let palette = posed();
    assert_stays(&palette);
    let read: Palette = from_str(&to_string(&palette).unwrap()).unwrap();
    assert!(read.model_from_joint(JointId(1)).is_some());
}

#[test]
fn a_palette_whose_lists_differ_in_length_is_refused() {
    let mut stored = serde_json::to_value(posed()).unwrap();
    stored["model_from_joint"].as_array_mut().unwrap().pop();
    let refused = serde_json::from_value::<Palette>(stored.clone()).unwrap_err();
    let told = refused.to_string();
    assert!(told.contains("expected 2 joints, found 1"), "{told}");
    stored["model_from_joint"] = json!([]);
    assert!(serde_json::from_value::<Palette>(stored).is_ok());
}

/// Runs ticks at 60 Hz. A wandering joint's pose is recorded in every third tick, except tick 9.
fn wander(
    track: &mut PoseTrack,
    ticks: std::ops::Range<u32>,
) -> Vec<(PoseMotion, Pose, Similarity)> {
    let tick = |tick: u32| {
        let now = f64::from(tick) / 60.0;
        if tick.is_multiple_of(3) && tick != 9 {
            let far = Vec3::new(now as f32, (now * now) as f32, 0.1);
            let pose = Pose {
                transforms: vec![Transform::from_translation(far)],
            };
            let place = Similarity::from_translation(DVec3::Z * (now / 3.0));
            track.record(now, &pose, place).unwrap();
        }
        let motion = track.tick(now, 1.0 / 60.0).unwrap();
        (motion, track.pose().clone(), *track.world_from_model())
    };
    ticks.map(tick).collect()
}

#[test]
fn a_restored_track_of_poses_goes_on_equally() {
    for saved in 1..40 {
        let mut track = PoseTrack::default();
        wander(&mut track, 0..saved);
        assert_stays(track.clock());
        let mut restored: PoseTrack = from_str(&to_string(&track).unwrap()).unwrap();
        assert_eq!(restored, track, "after {saved} ticks");
        let mut copied = track.clone();
        let goes_on = wander(&mut track, saved..60);
        assert_eq!(wander(&mut restored, saved..60), goes_on, "{saved}");
        assert_eq!(wander(&mut copied, saved..60), goes_on, "{saved}");
        assert_eq!(restored, track, "after {saved} ticks");
    }
}

#[test]
fn a_track_of_poses_that_do_not_fit_is_refused() {
    let mut track = PoseTrack::default();
    wander(&mut track, 0..20);
    let stored = serde_json::to_value(&track).unwrap();
    assert!(serde_json::from_value::<PoseTrack>(stored.clone()).is_ok());
    let refused = |path: &str, value: serde_json::Value| {
        let mut stored = stored.clone();
        *stored.pointer_mut(path).unwrap() = value;
        let refused = serde_json::from_value::<PoseTrack>(stored);
        refused.unwrap_err().to_string()
    };
    let sample = "/history/samples/0";
    let told = refused(&format!("{sample}/pose/pose/transforms"), json!([]));
    assert!(told.contains("expected 1 joints, found 0"), "{told}");
    let told = refused(&format!("{sample}/from"), json!(7.0));
    assert!(told.contains("time"), "{told}");
    let told = refused(&format!("{sample}/pose/world_from_model/scale"), json!(0.0));
    assert!(told.contains("world_from_model"), "{told}");
    let nothing = json!([0.0, 0.0, 0.0, 0.0]);
    let told = refused(
        &format!("{sample}/pose/pose/transforms/0/rotation"),
        nothing,
    );
    assert!(told.contains("rotation"), "{told}");
}
