//! Places that a creature can walk into but not turn in: blind alleys, narrow lanes, and boulders all around.

use std::sync::Arc;

use clamber_animation::rig::Palette;
use clamber_colossus::{Creature, CreatureConfig, CreatureEvent, CreatureKind, Foresight};
use clamber_world::Obstacle;
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, Pose};
use glam::{DVec3, Vec3};

use crate::animals::{animals, kind as animal};
use crate::support::{TICK, add_block, creature, ground, on_terrain, terrain_of};
use crate::walls::{creatures, reach};

/// The end of an errand, with its time, seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Arrived(f64),
    Stopped(f64),
    /// The errand did not end within its time limit.
    Never,
}

impl End {
    fn seconds(self) -> f64 {
        match self {
            Self::Arrived(seconds) | Self::Stopped(seconds) => seconds,
            Self::Never => f64::INFINITY,
        }
    }
}

/// Errands of a creature in a world at rest.
struct Errands<'a> {
    one: Creature,
    terrain: &'a dyn Obstacle,
    /// The longest time on an errand in which the creature neither walked nor turned, seconds.
    still: f64,
    /// Half the width, the height and the length of an alley, metres.
    alley: [f64; 3],
    /// Largest depth of the creature's skin in the walls of the alley, metres.
    deepest: f64,
    /// True if the creature walked backwards.
    backs: bool,
    /// Largest distance, while it walked backwards, from the place that was foreseen a second before, metres.
    off: f64,
}

impl<'a> Errands<'a> {
    fn of(one: Creature, terrain: &'a dyn Obstacle) -> Self {
        Self {
            one,
            terrain,
            still: 0.0,
            alley: [0.0; 3],
            deepest: 0.0,
            backs: false,
            off: 0.0,
        }
    }

    fn go(&mut self, to: DVec3, most: f64) -> End {
        assert!(self.one.send(Some(to)));
        let terrain = [self.terrain];
        let around = on_terrain(&terrain);
        let (mut still, mut foreseen) = (0.0, Vec::new());
        let mut skin: Vec<Vec3> = Vec::new();
        for tick in 0..(most / TICK) as u32 {
            let before = (self.one.state().position(), self.one.state().yaw());
            let report = self.one.step(&around).unwrap();
            let seconds = f64::from(tick) * TICK;
            for event in &report.events {
                match event {
                    CreatureEvent::Arrived { .. } => return End::Arrived(seconds),
                    CreatureEvent::Stopped { .. } => return End::Stopped(seconds),
                    _ => {}
                }
            }
            let now = (self.one.state().position(), self.one.state().yaw());
            self.backs |= self.one.state().speed() < 0.0;
            foreseen.retain(|(due, place): &(u32, DVec3)| {
                if *due == tick && self.one.state().speed() < 0.0 {
                    self.off = self.off.max((now.0 - *place).with_y(0.0).length());
                }
                *due > tick
            });
            if tick.is_multiple_of(10) && self.one.state().speed() < 0.0 {
                let mut palette = Palette::default();
                let then = self
                    .one
                    .foresee(1.0, &mut Foresight::default(), &mut palette);
                foreseen.push((
                    tick + (1.0 / TICK).round() as u32,
                    then.unwrap().translation,
                ));
            }
            still = if now == before { still + TICK } else { 0.0 };
            self.still = self.still.max(still);
            if tick.is_multiple_of(20) {
                self.one.surface().clone().skin_all(&mut skin);
                let origin = self.one.surface().world_from_model();
                for place in &skin {
                    let place = origin.transform_point(place.as_dvec3());
                    let [half, high, long] = self.alley;
                    let depth = (place.x.abs() - half).min(high - place.y);
                    self.deepest = self.deepest.max(depth.min(place.z).min(long - place.z));
                }
            }
        }
        End::Never
    }
}

/// An alley of two parallel walls, half as high as the creature, with a third wall at its end.
fn alley(half: f64, long: f64, height: f64) -> PhysicsWorld {
    let mut world = ground(|_, _| 0.0);
    let mut wall = |at: DVec3, half: DVec3| add_block(&mut world, at, half);
    let (high, thick) = (0.25 * height, 0.1 * height);
    for side in [-1.0, 1.0] {
        let at = DVec3::new(side * (half + thick), high, 0.5 * long);
        wall(at, DVec3::new(thick, high, 0.5 * long));
    }
    let at = DVec3::new(0.0, high, long + thick);
    wall(at, DVec3::new(half + 2.0 * thick, high, thick));
    world
}

/// Two animals at a height of 3 m and of 60 m.
fn others() -> Vec<(&'static str, Arc<CreatureKind>, f64)> {
    let mut all = Vec::new();
    for height in [3.0, 60.0] {
        for one in animals() {
            let is_one = ["Trex", "Bull"]
                .iter()
                .any(|name| one.file.starts_with(name));
            if let Some(kind) = is_one.then(|| animal(&one, height)).flatten() {
                all.push((one.file, kind, height));
            }
        }
    }
    all
}

#[test]
fn who_walked_into_a_blind_alley_comes_out_again() {
    let (mut entered, mut backed) = (0, 0);
    for (name, kind, height) in creatures().into_iter().chain(others()) {
        let reach = reach(&kind, height);
        for share in [0.5, 0.75, 1.0] {
            let (half, long) = (share * reach, 2.0 * reach + height);
            let world = alley(half, long, height);
            let terrain = terrain_of(&world);
            let outside = DVec3::new(0.0, 0.0, -2.0 * reach);
            let config = CreatureConfig {
                position: outside,
                ..CreatureConfig::default()
            };
            let mut errands = Errands {
                alley: [half, 0.5 * height, long],
                ..Errands::of(creature(&kind, config), &terrain)
            };
            let most = 60.0 * height.sqrt();
            let inside = DVec3::new(0.0, 0.0, long - reach - 0.2 * height);
            let end = errands.go(inside, most);
            if !matches!(end, End::Arrived(_)) {
                println!("{name:<24} {share}: goes not in {end:?}");
                assert_ne!(end, End::Never, "{name}");
                continue;
            }
            entered += 1;
            errands.deepest = 0.0;
            let out = errands.go(outside, most);
            let deep = errands.deepest;
            println!(
                "{name:<24} {height} m, {share}: {end:?} {out:?} still {:.1} s, {:.3} m off, {deep:.3} m in the walls",
                errands.still, errands.off,
            );
            assert!(
                matches!(out, End::Arrived(_)),
                "{name} at {height} m, {share}: {out:?}"
            );
            assert!(deep < 0.02 * height && errands.still < 1.0, "{name} {deep}");
            assert!(errands.off < 0.3, "{name}: {} m off", errands.off);
            backed += u32::from(errands.backs);
        }
    }
    println!("{entered} went in, {backed} of them went back");
    let is_there = std::env::var_os("CLAMBER_TEST_DATA").is_some();
    assert!(
        !is_there || entered > 25 && backed > 20,
        "{entered} {backed}"
    );
}

/// The goal is in a lane that crosses the creature's lane, and the crossing may be too narrow to turn in. The errand
/// still ends: the creature arrives, or reports that it stopped.
#[test]
fn lanes_in_which_it_cannot_turn_do_not_keep_it_for_ever() {
    for (name, kind, height) in creatures() {
        let reach = reach(&kind, height);
        for share in [0.4, 0.6, 1.3] {
            let (half, long) = (share * reach, 3.0 * reach);
            let mut world = ground(|_, _| 0.0);
            // Four blocks around a crossing.
            for (x, z) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let at = DVec3::new(x, 0.0, z) * (half + 0.5 * long) + DVec3::Y * 0.25 * height;
                let size = DVec3::new(0.5 * long, 0.25 * height, 0.5 * long);
                add_block(&mut world, at, size);
            }
            let terrain = terrain_of(&world);
            let config = CreatureConfig {
                position: DVec3::new(0.0, 0.0, -2.0 * reach),
                ..CreatureConfig::default()
            };
            let mut errands = Errands::of(creature(&kind, config), &terrain);
            let aside = DVec3::new(2.0 * reach, 0.0, 0.0);
            let end = errands.go(aside, 240.0 * height.sqrt());
            println!("{name:<24} {share}: {end:?}, back {}", errands.backs);
            assert_ne!(end, End::Never, "{name} {share}");
        }
    }
}

#[test]
fn boulders_all_around_are_no_trap() {
    for (name, kind, height) in creatures() {
        let (mut arrived, mut stopped, mut never) = (0, 0, 0);
        let (mut seconds, mut still) = (0.0, 0f64);
        for seed in 0..4 {
            let mut random = fastrand::Rng::with_seed(seed);
            let mut world = ground(|_, _| 0.0);
            let mut lot = |from: f64, to: f64| (from + (to - from) * random.f64()) * height;
            for _ in 0..150 {
                let (x, z, radius) = (lot(-4.5, 4.5), lot(-4.5, 4.5), lot(0.1, 0.15));
                let y = lot(0.015, 0.1) - radius;
                if libm::hypot(x, z) < height {
                    continue;
                }
                let place = Pose::from_translation(DVec3::new(x, y, z).as_vec3());
                world.insert_collider(ColliderBuilder::ball(radius as f32).position(place), None);
            }
            world.detect_collisions(&(), &());
            let terrain = terrain_of(&world);
            let mut errands = Errands::of(creature(&kind, CreatureConfig::default()), &terrain);
            for _ in 0..6 {
                let to = DVec3::new(lot(-4.0, 4.0), 0.0, lot(-4.0, 4.0));
                let end = errands.go(to, 60.0 * height.sqrt());
                match end {
                    End::Arrived(_) => arrived += 1,
                    End::Stopped(_) => stopped += 1,
                    End::Never => never += 1,
                }
                seconds += end.seconds().min(60.0 * height.sqrt());
            }
            still = still.max(errands.still);
        }
        assert_eq!(never, 0, "{name}");
        assert!(arrived >= 15 && still < 1.0, "{name}: {arrived}, {still} s");
        println!(
            "{name:<24} {arrived} arrived, {stopped} stopped, {never} never, {seconds:.0} s, still {still:.1} s"
        );
    }
}
