//! The skinning error against f64 stays within the stated bound, over all clips of real models.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

use clamber_scenes::giant::giant;
use clamber_scenes::{Creature, test_data};
use clamber_surface::rig::Playback;
use clamber_surface::skin::skin;
use clamber_verify::posed::skinning_error_share;
use glam::Vec3;

/// Number of poses of each clip in which the error is measured.
const POSES: u32 = 12;

/// The largest error of any coordinate of any vertex over the poses of all clips, as a share of its bound, and the
/// number of vertices that were compared.
fn worst_share(creature: &Creature) -> (f64, usize) {
    let rest = creature.rig.skeleton.rest_pose();
    let (mut worst, mut compared) = (0.0f64, 0);
    for clip in &creature.rig.clips {
        for k in 0..POSES {
            let time = clip.duration() * f64::from(k) / f64::from(POSES);
            let pose = clip.sample(&rest, time, Playback::Loop).unwrap();
            let palette = creature.rig.skeleton.palette(&pose).unwrap();
            let matrices = palette.matrices();
            let skinned = skin(&creature.rig.collider, matrices).unwrap();
            let share = skinning_error_share(&creature.rig.collider, matrices, &skinned);
            let context = format!("{}, {}, {time} s", creature.name, clip.name);
            assert!(share <= 1.0, "{context}: {share}");
            worst = worst.max(share);
            compared += skinned.len();
        }
    }
    (worst, compared)
}

#[test]
fn a_moved_vertex_and_nan_exceed_the_bound() {
    let giant = giant().unwrap();
    let palette = giant.rest_palette().unwrap();
    let mesh = &giant.rig.collider;
    let mut positions = skin(mesh, palette.matrices()).unwrap();
    let share = |p: &[Vec3]| skinning_error_share(mesh, palette.matrices(), p);
    assert!((0.01..1.0).contains(&share(&positions)));
    positions[7].x += 1e-3;
    assert!(share(&positions) > 10.0);
    positions[8].y = f32::NAN;
    assert_eq!(share(&positions), f64::INFINITY);
}

#[test]
fn the_giant_stays_within_the_bound() {
    let (worst, compared) = worst_share(&giant().unwrap());
    println!("giant: {worst:.3} of the bound, {compared} vertices");
    assert!(compared > 50_000 && worst > 0.1);
}

#[test]
fn five_models_stay_within_the_bound_over_all_clips() {
    for creature in test_data::five_creatures("skinning accuracy").unwrap() {
        let name = &creature.name;
        assert!(!creature.rig.clips.is_empty(), "{name}");
        let (worst, compared) = worst_share(&creature);
        println!("{name}: {worst:.3} of the bound, {compared} vertices");
        assert!(worst > 0.05, "{name}: nothing was measured");
    }
}
