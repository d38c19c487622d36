//! `foresee` predicts the coming pose of a creature, as long as its brain decides nothing else.

use crate::carried::Deck;
use crate::support::{
    TICK, brain_with, creature, joint_place, kind, level_ground, noise, with_noises,
};
use clamber_animation::rig::Palette;
use clamber_colossus::{CreatureConfig, Foresight};
use clamber_surface::geometry::{Similarity, rotation_from_axis_angle};
use clamber_world::Obstacle;
use glam::DVec3;

/// States in which the giant turns to a noise and then walks there, as JSON.
const HUNTS: &str = r#"{
    "waits": { "transitions": [{ "to": "turns", "when": ["noise > 0"] }] },
    "turns": { "act": { "turn": { "to": "noise", "within_deg": 10 } }, "transitions": [
        { "to": "walks", "when": ["done"] }] },
    "walks": { "act": { "walk": { "to": "noise", "within": 5 } }, "transitions": [
        { "to": "waits", "when": ["done"] }] }
}"#;

/// While the giant walks, turns and stops, a hand is foreseen two seconds ahead to 0.3 m.
#[test]
fn a_hand_is_foreseen_walking_and_turning() {
    let terrain = level_ground();
    for scale in [1.0, 0.1, 4.0] {
        // Times scale with the square root of the size.
        let slow = f64::sqrt(scale);
        let ahead = 2.0 * slow.min(1.0);
        let ticks = (ahead / TICK) as usize;
        let round = (12.0 * slow / TICK) as usize;
        let ahead = ticks as f64 * TICK;
        let kind = kind(&brain_with("waits", HUNTS));
        let config = CreatureConfig {
            scale,
            arena: 1e4,
            ..CreatureConfig::default()
        };
        let mut giant = creature(&kind, config);
        let hand = kind.skeleton().find("hand.L").unwrap();
        let (mut memory, mut palette) = (Foresight::default(), Palette::default());
        let (mut foreseen, mut states) = (Vec::new(), Vec::new());
        let mut worst = [0f64; 2];
        let mut judged = [0; 2];
        for tick in 0..5 * round {
            // In each round it hears a noise at another place.
            let angle = (tick / round) as f64 * 2.2 + 0.7;
            let place = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle)) * (70.0 * scale);
            let noises = [noise(place)];
            giant
                .step(&with_noises(
                    &terrain,
                    &noises[..usize::from(tick % round < 5)],
                ))
                .unwrap();
            let now = joint_place(&giant, hand);
            let state = giant.state().current();
            let key = (state, giant.state().animator().layers()[0].clip);
            // A noise within the foreseen time changes its goal, so such ticks are skipped.
            if tick >= ticks && tick % round > ticks + 5 {
                let (before, seen): (DVec3, bool) = foreseen[tick - ticks];
                let same = states[tick - ticks..].iter().all(|known| *known == key);
                // A change of the gait's clip is not foreseen, so such ticks are skipped.
                if same && seen {
                    let kind_of = usize::from(kind.brain().path(state) == "turns");
                    worst[kind_of] = worst[kind_of].max(before.distance(now));
                    judged[kind_of] += 1;
                }
            }
            let world = giant.foresee(ahead, &mut memory, &mut palette).unwrap();
            let frame = palette.model_from_joint(hand).unwrap();
            let moves = giant.state().speed() > 0.0 || kind.brain().path(state) == "turns";
            foreseen.push((world.transform_point(frame.translation), moves));
            states.push(key);
        }
        println!(
            "scale {scale}: walking {:.3} m, turning {:.3} m, of {judged:?}",
            worst[0], worst[1]
        );
        assert!(judged.iter().all(|count| *count > 15), "{judged:?}");
        // The limit is 0.3 m, or 1 % of the height of a larger giant.
        let most = if scale > 1.0 {
            0.01 * giant.height()
        } else {
            0.3
        };
        assert!(worst.iter().all(|off| *off <= most), "{scale}: {worst:?}");
    }
    // Invalid times are refused.
    let giant = creature(
        &kind(&brain_with("waits", HUNTS)),
        CreatureConfig::default(),
    );
    let (mut memory, mut palette) = (Foresight::default(), Palette::default());
    for seconds in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(giant.foresee(seconds, &mut memory, &mut palette).is_err());
    }
    assert!(giant.foresee(1e9, &mut memory, &mut palette).is_ok());
}

/// On a ship that sails, turns and rises, the hand of a standing or walking giant is foreseen as on ground at rest.
#[test]
fn on_moving_ground_a_hand_is_foreseen_too() {
    let kind = kind(&brain_with("waits", HUNTS));
    let hand = kind.skeleton().find("hand.L").unwrap();
    for (velocity, turns) in [
        (DVec3::new(3.0, 0.0, 0.0), 0.0),
        (DVec3::new(2.0, 0.5, -2.0), 0.0),
        (DVec3::ZERO, 0.2),
        (DVec3::new(0.0, 0.0, 4.0), -0.1),
    ] {
        for walks in [false, true] {
            let mut giant = creature(&kind, CreatureConfig::default());
            let (mut memory, mut palette) = (Foresight::default(), Palette::default());
            let mut at = Similarity::IDENTITY;
            let (mut foreseen, mut worst, mut judged) = (Vec::new(), 0f64, 0);
            for tick in 0..600 {
                let before = at;
                // The ship sails along its own heading.
                let turn = rotation_from_axis_angle(DVec3::Y, turns * TICK);
                at.rotation = turn * at.rotation;
                at.translation += at.rotation * velocity * TICK;
                let deck = Deck { before, now: at };
                let terrain: [&dyn Obstacle; 1] = [&deck];
                let noises = [noise(at.transform_point(DVec3::Z * 90.0))];
                giant
                    .step(&with_noises(&terrain, &noises[..usize::from(walks)]))
                    .unwrap();
                let place = |palette: &Palette, world: &Similarity| {
                    let frame = palette.model_from_joint(hand).unwrap();
                    world.transform_point(frame.translation)
                };
                let now = place(giant.palette(), giant.surface().world_from_model());
                // When this tick was foreseen, the giant had already begun to walk.
                if tick >= 420 {
                    let before: DVec3 = foreseen[tick - 120];
                    worst = worst.max(before.distance(now));
                    judged += 1;
                }
                let world = giant
                    .foresee(120.0 * TICK, &mut memory, &mut palette)
                    .unwrap();
                foreseen.push(place(&palette, &world));
            }
            println!("{velocity} {turns}, walks {walks}: {worst:.3} m of {judged}");
            assert!(worst < 0.35, "{velocity} {turns} {walks}: {worst}");
        }
    }
}
