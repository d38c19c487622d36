//! B59: 500 random rides on the giant, compared with their predictions.

#![allow(clippy::unwrap_used, reason = "a test")]

use std::sync::Arc;

use clamber::climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ContactQuery, StepRules,
};
use clamber::geometry::Similarity;
use clamber::rig::{Palette, Playback};
use clamber::surface::SkinnedSurface;
use clamber::world::{Obstacle, ObstacleId};
use clamber_navigation::FutureSkin;
use clamber_scenes::{Creature, giant};
use fastrand::Rng;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;
/// Number of rides.
const RIDES: u64 = 500;
/// Longest ride, seconds.
const SECONDS: f64 = 12.0;
/// Id of the giant.
const CREATURE: ObstacleId = ObstacleId(1);

/// A clip that is played from a time on, at a speed.
#[derive(Clone, Copy)]
struct Play<'a> {
    creature: &'a Creature,
    clip: usize,
    from: f64,
    speed: f64,
    place: Similarity,
}

impl Play<'_> {
    fn pose(&self, seconds: f64, palette: &mut Palette) -> Option<Similarity> {
        let clip = &self.creature.rig.clips[self.clip];
        let mut pose = self.creature.rig.skeleton.rest_pose();
        let time = self.from + self.speed * seconds;
        clip.sample_into(time, Playback::Clamp, &mut pose).ok()?;
        let skeleton = &self.creature.rig.skeleton;
        skeleton.palette_into(&pose, palette).ok()?;
        Some(self.place)
    }
}

/// Time at which the climber was thrown off, seconds; `None` if it was not.
fn ride(climber: &mut Climber, surface: &mut SkinnedSurface, play: Play<'_>) -> Option<f64> {
    let holds = climber.state().mode != ClimberMode::Standing;
    let input = ClimberInput {
        grip: holds,
        ..ClimberInput::IDLE
    };
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(true);
    let mut palette = Palette::default();
    for tick in 1..=(SECONDS / TICK) as u64 {
        let seconds = tick as f64 * TICK;
        play.pose(seconds, &mut palette).unwrap();
        surface.advance(&palette, play.place).unwrap();
        let around: [(ObstacleId, &dyn Obstacle); 1] = [(CREATURE, surface)];
        let rules = StepRules::by(&rule);
        let report = climber.step_with(&input, &around, &rules, TICK).unwrap();
        let ends = |event: &ClimberEvent| {
            matches!(
                event,
                ClimberEvent::Thrown { .. }
                    | ClimberEvent::ShakenOff { .. }
                    | ClimberEvent::Tumbled { .. }
                    | ClimberEvent::Slipped
            )
        };
        if report.events.iter().any(ends) {
            return Some(seconds);
        }
        // A climber that is pushed off is not thrown off.
        climber.state().support?;
    }
    None
}

/// A climber that stands or holds on at a random place of the skin; `None` if it does not stay there.
fn mount(rng: &mut Rng, surface: &SkinnedSurface) -> Option<Climber> {
    let mesh = surface.mesh();
    let triangle = mesh.triangles()[rng.usize(0..mesh.triangles().len())];
    let corners = triangle.map(|vertex| {
        let place = surface.in_model().position(vertex).unwrap();
        surface.world_from_model().transform_point_f32(place)
    });
    let normal = (corners[1] - corners[0])
        .cross(corners[2] - corners[0])
        .normalize_or_zero();
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    let config = ClimberConfig::colossus_climber();
    let position = middle + normal * (config.body.radius + 0.02);
    let mut climber = Climber::new(config, position).unwrap();
    let stands = normal.y > 0.8 && rng.bool();
    let input = ClimberInput {
        grip: !stands,
        ..ClimberInput::IDLE
    };
    let rule = |query: &ContactQuery<'_>| query.usual().with_grip(true);
    let around: [(ObstacleId, &dyn Obstacle); 1] = [(CREATURE, surface)];
    for _ in 0..30 {
        climber
            .step_with(&input, &around, &StepRules::by(&rule), TICK)
            .unwrap();
    }
    let mode = climber.state().mode;
    let wanted = if stands {
        ClimberMode::Standing
    } else {
        ClimberMode::Holding
    };
    if mode != wanted {
        return None;
    }
    let mut state = *climber.state();
    state.stamina = 0.05 + 0.95 * rng.f64();
    climber.restore(state).unwrap();
    Some(climber)
}

#[test]
fn b59_throw_offs_are_foreseen() {
    let creature = giant::giant().unwrap();
    let (place, _) = creature.standing(40.0).unwrap();
    let mut rng = Rng::with_seed(59);
    let mut skin = FutureSkin::new(Arc::clone(&creature.rig.collider));
    let (mut rides, mut ended, mut foreseen, mut right, mut timed) = (0, 0, 0, 0, 0);
    let mut pushed = 0;
    while rides < RIDES {
        let clip = rng.usize(0..creature.rig.clips.len());
        let play = Play {
            creature: &creature,
            clip,
            from: rng.f64() * creature.rig.clips[clip].duration(),
            speed: 0.6 + 0.9 * rng.f64(),
            place,
        };
        let mut surface = SkinnedSurface::new(Arc::clone(&creature.rig.collider));
        let mut palette = Palette::default();
        play.pose(0.0, &mut palette).unwrap();
        surface.teleport(&palette, place).unwrap();
        let Some(mut climber) = mount(&mut rng, &surface) else {
            continue;
        };
        rides += 1;
        let mut future = |seconds: f64, palette: &mut Palette| play.pose(seconds, palette);
        let said = skin
            .ride(&climber, CREATURE, &mut future, TICK, SECONDS)
            .unwrap()
            .end();
        let is = ride(&mut climber, &mut surface, play);
        pushed += u32::from(is.is_none() && climber.state().support.is_none());
        ended += u32::from(is.is_some());
        foreseen += u32::from(said.is_some());
        if let (Some(said), Some(is)) = (said, is) {
            right += 1;
            let off = (said.seconds - is).abs();
            timed += u32::from(off <= (TICK + 1e-9).max(0.03 * is));
        }
    }
    let share = f64::from(ended) / RIDES as f64;
    let precision = f64::from(right) / f64::from(foreseen);
    let recall = f64::from(right) / f64::from(ended);
    let in_time = f64::from(timed) / f64::from(right);
    eprintln!(
        "{RIDES} rides, {ended} thrown off, {foreseen} foreseen, {right} right, {timed} in time, {pushed} pushed off"
    );
    eprintln!("precision {precision:.3}, recall {recall:.3}, in time {in_time:.3}");
    assert!((0.4..=0.6).contains(&share), "{share}");
    assert!(precision >= 0.95, "{precision}");
    assert!(recall >= 0.95, "{recall}");
    assert!(in_time >= 0.95, "{in_time}");
}
