//! The giant's clips: what riders feel, and how limbs start. Scenes B43 and B46.

#![allow(clippy::unwrap_used, reason = "helpers of tests")]

mod support;

use clamber_animation::rig::{Clip, JointId, Playback};
use clamber_colossus::CreatureKind;
use glam::DVec3;
use support::{Feel, TICK, brain_file, kind};

const LOOPS: [&str; 6] = [
    "idle",
    "walk",
    "turn_left",
    "turn_right",
    "breathe",
    "shake_loop",
];

/// Places of joints in a clip, one list for each tick, after a round of it if it is a loop.
fn places(kind: &CreatureKind, clip: &Clip, joints: &[JointId]) -> Vec<Vec<DVec3>> {
    let rest = kind.skeleton().rest_pose();
    let loops = LOOPS.contains(&clip.name.as_str());
    let playback = if loops {
        Playback::Loop
    } else {
        Playback::Clamp
    };
    let rounds = if loops { 2.0 } else { 1.0 };
    let ticks = (clip.duration() * rounds / TICK) as usize;
    (0..ticks)
        .map(|tick| {
            let pose = clip.sample(&rest, tick as f64 * TICK, playback).unwrap();
            let palette = kind.skeleton().palette(&pose).unwrap();
            joints
                .iter()
                .map(|joint| palette.model_from_joint(*joint).unwrap().translation)
                .collect()
        })
        .collect()
}

#[test]
fn what_is_felt() {
    let kind = kind(&brain_file());
    let names = ["pelvis", "chest", "head", "hand.L", "hand.R", "forearm.L"];
    let joints = names.map(|name| kind.skeleton().find(name).unwrap());
    for clip in kind.clips().clips() {
        let places = places(&kind, clip, &joints);
        let felt: Vec<f64> = (0..joints.len())
            .map(|joint| {
                let mut feel = Feel::default();
                let all = places.iter().map(|places| feel.step(places[joint]));
                all.fold(0.0, f64::max)
            })
            .collect();
        println!("{:15} {:.1?}", clip.name, felt);
    }
}

#[test]
fn debug_idle() {
    let kind = kind(&brain_file());
    let head = kind.skeleton().find("head").unwrap();
    for name in ["idle", "walk", "stomp"] {
        let clip = kind
            .clips()
            .clips()
            .iter()
            .find(|clip| clip.name == name)
            .unwrap();
        let places = places(&kind, clip, &[head]);
        let mut feel = Feel::default();
        for (tick, place) in places.iter().enumerate() {
            let felt = feel.step(place[0]);
            if felt > 8.0 {
                println!(
                    "{name} {tick} {:.3} s felt {felt:.1} at {:.4}",
                    tick as f64 * TICK,
                    place[0]
                );
            }
        }
    }
}
