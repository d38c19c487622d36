//! Supports that vanish between two ticks: disabled, with another shape, without motion, or replaced by another
//! creature with the same id.

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, StepReport, StepRules,
};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, ColliderHandle, PhysicsWorld, SharedShape,
};
use clamber_world::{Attachment, BodyPoses, Obstacle, RapierTerrain, SurfaceTag};
use glam::{DVec3, Vec3};

use crate::cases::{pairs, triples};
use crate::defects::common::{Mute, tick_gripping, v};
use crate::events::{count, is_attached, is_landed, is_lost_footing};
use crate::input::{HOLD, IDLE, blow, grip_walk};
use crate::scene::{DT, FUR, STONE, climber, cuboid, cuboid_at, list, moved, tick_among};

/// The support of a climber on a block of 8 x 6 x 6 m around the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
enum On {
    Fur,
    Ledge,
    Ground,
}

/// All kinds of support.
const ALL: [On; 3] = [On::Fur, On::Ledge, On::Ground];

impl On {
    fn start(self) -> DVec3 {
        match self {
            Self::Fur => v(0.0, 1.0, 3.5),
            Self::Ledge => v(0.3, 2.75, 3.5),
            Self::Ground => v(0.0, 3.41, 0.0),
        }
    }

    fn input(self) -> ClimberInput {
        match self {
            Self::Fur => HOLD,
            Self::Ledge => grip_walk(-DVec3::Z * 0.1),
            Self::Ground => IDLE,
        }
    }

    fn mode(self) -> ClimberMode {
        match self {
            Self::Fur => ClimberMode::Holding,
            Self::Ledge => ClimberMode::LedgeHanging,
            Self::Ground => ClimberMode::Standing,
        }
    }

    fn tag(self) -> SurfaceTag {
        if self == Self::Fur { FUR } else { STONE }
    }

    fn step(self, climber: &mut Climber, obstacles: &[&dyn Obstacle]) -> StepReport {
        tick_gripping(climber, obstacles, &self.input(), self == Self::Fur)
    }
}

fn block() -> ColliderBuilder {
    ColliderBuilder::cuboid(4.0, 3.0, 3.0)
}

/// Changes the block of a rapier world below a climber. Returns the climber after some ticks, its attachment before the
/// change, and the reports since the change.
fn changed(
    on: On,
    steps_after: bool,
    change: impl Fn(&mut PhysicsWorld, ColliderHandle),
) -> (Climber, Attachment, Vec<StepReport>) {
    let mut world = PhysicsWorld::default();
    let handle = world.insert_collider(block(), None);
    let mut before = BodyPoses::new();
    let mut climber = climber(on.start());
    let mut held = None;
    let mut reports = Vec::new();
    for k in 0..26 {
        before.record(&world.bodies);
        if k == 6 && steps_after {
            change(&mut world, handle);
        }
        world.step();
        if k == 6 && !steps_after {
            change(&mut world, handle);
        }
        if k == 6 {
            assert_eq!(climber.state().mode, on.mode(), "{on:?}");
            held = climber.state().support.map(|support| support.attachment);
        }
        let terrain = RapierTerrain::of_world(&world, &before);
        let report = on.step(&mut climber, &[&terrain]);
        if k >= 6 {
            reports.push(report);
        }
    }
    (climber, held.unwrap(), reports)
}

/// Asserts that the climber lost its support once, in the first tick, that the event names the support, and that the
/// climber has fallen since.
fn assert_lost(on: On, told: &str, climber: &Climber, held: &Attachment, reports: &[StepReport]) {
    let events: Vec<_> = reports.iter().flat_map(|report| &report.events).collect();
    let lost = reports[0].events.iter().find_map(|event| match event {
        ClimberEvent::LostFooting { from } => Some(*from),
        _ => None,
    });
    let lost = lost.unwrap_or_else(|| panic!("{told}, {on:?}: not lost in a tick: {events:?}"));
    assert_eq!(
        (lost.obstacle, lost.material),
        (held.obstacle, held.material),
        "{told}, {on:?}: what was lost"
    );
    let all: Vec<_> = events.into_iter().copied().collect();
    assert_eq!(count(&all, is_lost_footing), 1, "{told}, {on:?}: {all:?}");
    assert_eq!(count(&all, is_attached), 0, "{told}, {on:?}: {all:?}");
    let state = climber.state();
    assert_eq!(state.mode, ClimberMode::Falling, "{told}, {on:?}");
    // The climber falls from the tick of the loss on.
    let time = DT * reports.len() as f64;
    let fallen = 0.5 * 9.81 * time * time;
    let from = held.position().y;
    assert!(
        (from - state.position.y - fallen).abs() < 0.05,
        "{told}, {on:?}: fell from {from} to {}, free fall is {fallen}",
        state.position.y
    );
}

fn disable(world: &mut PhysicsWorld, handle: ColliderHandle) {
    world.colliders.get_mut(handle).unwrap().set_enabled(false);
}

fn shrink(world: &mut PhysicsWorld, handle: ColliderHandle) {
    let shape = SharedShape::cuboid(1.0, 0.2, 1.0);
    world.colliders.get_mut(handle).unwrap().set_shape(shape);
}

#[test]
fn a_collider_that_is_disabled_or_shrinks_is_lost_once_and_not_stood_on_again() {
    type Change = fn(&mut PhysicsWorld, ColliderHandle);
    let changes: [(&str, Change); 2] = [("disabled", disable), ("shrunk", shrink)];
    for (on, steps_after, (name, change)) in triples(ALL, [false, true], changes) {
        let (climber, held, reports) = changed(on, steps_after, change);
        let told = format!("{name}, stepped after it: {steps_after}");
        assert_lost(on, &told, &climber, &held, &reports);
    }
}

#[test]
fn an_obstacle_without_motion_is_not_held_again_and_again() {
    for (on, told_for, tumble) in triples(ALL, [0, 10], [true, false]) {
        let wall = cuboid(Vec3::new(4.0, 3.0, 3.0), on.tag());
        let mut config = ClimberConfig::colossus_climber();
        if !tumble {
            config.tumble = None;
        }
        let mut climber = Climber::new(config, on.start()).unwrap();
        let mut events = Vec::new();
        for k in 0..60 {
            let mute = Mute {
                inner: &wall,
                tells: k < told_for,
            };
            let report = on.step(&mut climber, &[&mute]);
            if k >= told_for {
                events.extend(report.events);
            }
        }
        let told = format!("{on:?}, told for {told_for} ticks, tumble {tumble}: {events:?}");
        let lost = count(&events, is_lost_footing);
        assert_eq!(lost, usize::from(told_for > 0), "{told}");
        assert_eq!(count(&events, is_attached), 0, "{told}");
        assert!(events.len() <= 3, "{told}");
        let state = climber.state();
        assert!(!state.mode.is_supported(), "{:?}: {told}", state.mode);
        // In front of the wall the climber falls; above the block, the block stops it.
        let low = if on == On::Ground { 3.45 } else { 0.0 };
        assert!(state.position.y < low, "{}: {told}", state.position);
    }
}

#[test]
fn a_support_whose_id_names_another_creature_is_lost_without_a_teleport() {
    let others = [(5.0, 0.0), (5.0, 1.0), (5.0, 20.0), (0.5, 1.0), (0.1, 0.0)];
    for (on, (gap, speed)) in pairs(ALL, others) {
        let block = |place| cuboid_at(Vec3::new(4.0, 3.0, 3.0), on.tag(), place);
        let away = v(0.0, -gap, 0.0);
        let (mut one, mut other) = (block(DVec3::ZERO), block(away));
        let go = |surface: &mut SkinnedSurface, from: DVec3, k: u32| {
            let by = DVec3::Y * (speed * DT * f64::from(k));
            moved(surface, from + by);
        };
        // The creature reaches its speed in one tick; this must not throw or shake off the climber.
        let mut config = ClimberConfig::colossus_climber();
        config.tumble = None;
        config.ground.throw_acceleration = f64::INFINITY;
        config.grip.as_mut().unwrap().hang_acceleration = f64::INFINITY;
        let mut climber = Climber::new(config, on.start()).unwrap();
        for _ in 0..6 {
            moved(&mut one, DVec3::ZERO);
            on.step(&mut climber, &[&one]);
        }
        for k in 1..4 {
            go(&mut one, DVec3::ZERO, k);
            go(&mut other, away, k);
            on.step(&mut climber, &[&one]);
        }
        let told = format!("{on:?}, {gap} m beside, both at {speed} m/s");
        assert_eq!(climber.state().mode, on.mode(), "{told}");
        go(&mut other, away, 4);
        let before = *climber.state();
        let report = on.step(&mut climber, &[&other]);
        let way = climber.state().position - before.position;
        let lost = count(&report.events, is_lost_footing);
        let most = before.velocity.length() * DT + 0.01;
        assert_eq!(lost, 1, "{told}: {:?} way {way}", report.events);
        assert!(way.length() <= most, "{told}: way {way}, most {most}");
    }
}

/// Every event that reports a lost support has the attachment of the state before.
#[test]
fn events_carry_the_attachment_that_was_lost() {
    let mut seen = [false; 5];
    for (on, way) in pairs([On::Fur, On::Ground], 0..5) {
        let mut one = cuboid(Vec3::new(4.0, 3.0, 3.0), on.tag());
        let mut config = ClimberConfig::colossus_climber();
        if way != 3 {
            config.tumble = None;
        }
        let mut climber = Climber::new(config, on.start()).unwrap();
        for _ in 0..10 {
            moved(&mut one, DVec3::ZERO);
            on.step(&mut climber, &[&one]);
        }
        let mut place = 0.0;
        for k in 0..600 {
            let held = climber.state().support.map(|support| support.attachment);
            let Some(held) = held else { break };
            let input = on.input();
            let mut rules = StepRules::default();
            match way {
                // The support accelerates down, which throws off a standing climber and tires a holding one.
                1 => place -= DT * DT * 60.0 * f64::from(k),
                2..=4 if k == 0 => rules.knockback = blow(v(0.0, 9.0, 9.0)),
                _ => {}
            }
            moved(&mut one, v(0.0, place, 0.0));
            let report = match (way, k) {
                (0, 3) => tick_among(&mut climber, &[], &input),
                (2..=4, 0) => {
                    let step = climber.step_with(&input, &list(&[&one]), &rules, DT);
                    step.unwrap()
                }
                _ => on.step(&mut climber, &[&one]),
            };
            for event in &report.events {
                let (index, from) = match event {
                    ClimberEvent::LostFooting { from } => (0, Some(*from)),
                    ClimberEvent::Thrown { from, .. } => (1, Some(*from)),
                    ClimberEvent::ShakenOff { from, .. } => (2, Some(*from)),
                    ClimberEvent::Tumbled { from, .. } => (3, *from),
                    ClimberEvent::KnockedOff { from, .. } => (4, Some(*from)),
                    _ => continue,
                };
                seen[index] = true;
                let from = from.unwrap_or_else(|| panic!("{on:?} {way} tick {k}: {event:?}"));
                assert_eq!(
                    (from.obstacle, from.material),
                    (held.obstacle, held.material),
                    "{on:?} {way} tick {k}: {event:?}"
                );
            }
        }
    }
    assert_eq!(
        seen, [true; 5],
        "lost, thrown, shaken off, tumbled, knocked off"
    );
}

#[test]
fn ground_that_is_disabled_is_not_landed_on_in_that_tick() {
    for steps_after in [false, true] {
        let (_, _, reports) = changed(On::Ground, steps_after, disable);
        for (k, report) in reports.iter().enumerate() {
            let told = format!(
                "stepped after it: {steps_after}, tick {k}: {:?}",
                report.events
            );
            assert_eq!(
                count(&report.events, is_lost_footing),
                usize::from(k == 0),
                "{told}"
            );
            assert_eq!(count(&report.events, is_landed), 0, "{told}");
        }
    }
}
