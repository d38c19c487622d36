//! A flying climber lands at the predicted place on the moving giant.

#![allow(clippy::unwrap_used, reason = "a test")]

use std::sync::Arc;

use clamber::climber::{Climber, ClimberConfig, ClimberInput, ContactQuery, StepRules};
use clamber::rig::{Palette, Playback};
use clamber::surface::SkinnedSurface;
use clamber::world::{HalfSpace, Obstacle, ObstacleId};
use clamber_navigation::{Airborne, FutureSkin};
use clamber_scenes::giant;
use fastrand::Rng;
use glam::DVec3;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;
/// Id of the ground.
const GROUND: ObstacleId = ObstacleId(0);
/// Id of the giant.
const GIANT: ObstacleId = ObstacleId(1);

#[test]
fn landings_are_foreseen_on_moving_skin() {
    let creature = giant::giant().unwrap();
    let (place, ground) = creature.standing(40.0).unwrap();
    let floor = HalfSpace::below(ground);
    let mut rng = Rng::with_seed(28);
    let mut skin = FutureSkin::new(Arc::clone(&creature.rig.collider));
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(query.id == GIANT);
    let rules = StepRules::by(&rule);
    let (mut on_skin, mut elsewhere) = (0, 0);
    for _ in 0..200 {
        let clip = &creature.rig.clips[rng.usize(0..creature.rig.clips.len())];
        let from = rng.f64() * clip.duration();
        let pose = |seconds: f64, palette: &mut Palette| {
            let mut pose = creature.rig.skeleton.rest_pose();
            clip.sample_into(from + seconds, Playback::Clamp, &mut pose)
                .ok()?;
            creature.rig.skeleton.palette_into(&pose, palette).ok()?;
            Some(place)
        };
        let aside = DVec3::new(rng.f64() - 0.5, 0.0, rng.f64() - 0.5) * 16.0;
        let above = aside + DVec3::Y * (ground + 30.0 + 15.0 * rng.f64());
        let mut climber = Climber::new(ClimberConfig::colossus_climber(), above).unwrap();
        let input = ClimberInput {
            grip: rng.bool(),
            ..ClimberInput::IDLE
        };
        let others: [(ObstacleId, &dyn Obstacle); 1] = [(GROUND, &floor)];
        let flight = Airborne {
            climber: &climber,
            input: &input,
            rules: &rules,
            creature: GIANT,
            others: &others,
        };
        let mut future = pose;
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(skin.landing(&flight, &mut future, wrong, 6.0).is_err());
            assert!(
                skin.shake_ahead(&climber, GIANT, &mut future, wrong, 6.0)
                    .is_err()
            );
            assert!(skin.ride(&climber, GIANT, &mut future, wrong, 6.0).is_err());
        }
        let said = skin.landing(&flight, &mut future, TICK, 6.0).unwrap();
        // The prediction for a giant that keeps still.
        let mut still = |_: f64, palette: &mut Palette| pose(0.0, palette);
        let still = skin.landing(&flight, &mut still, TICK, 6.0).unwrap();

        let mut surface = SkinnedSurface::new(Arc::clone(&creature.rig.collider));
        let mut palette = Palette::default();
        pose(0.0, &mut palette).unwrap();
        surface.teleport(&palette, place).unwrap();
        let mut is = None;
        for tick in 1..=360 {
            let seconds = f64::from(tick) * TICK;
            pose(seconds, &mut palette).unwrap();
            surface.advance(&palette, place).unwrap();
            let around: [(ObstacleId, &dyn Obstacle); 2] = [(GROUND, &floor), (GIANT, &surface)];
            climber.step_with(&input, &around, &rules, TICK).unwrap();
            if climber.state().support.is_some() {
                is = Some((seconds, *climber.state()));
                break;
            }
        }
        assert_eq!(said.map(|said| (said.seconds, said.state)), is);
        let Some((_, state)) = is else {
            continue;
        };
        let support = state.support.unwrap().attachment.obstacle;
        on_skin += u32::from(support == GIANT);
        let apart = still.map_or(f64::INFINITY, |still| {
            still.state.position.distance(state.position)
        });
        elsewhere += u32::from(apart > 0.1);
    }
    eprintln!(
        "{on_skin} of 200 come down on the giant, {elsewhere} elsewhere than if it kept still"
    );
    assert!(on_skin > 80, "{on_skin}");
    assert!(elsewhere > 20, "{elsewhere}: the pose of now would do");
}
