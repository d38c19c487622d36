//! Weight on a support, and landings.

use clamber_climber::ClimberInput;
use clamber_world::rapier3d::prelude::{
    RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use glam::DVec3;

use crate::input::{IDLE, walk};
use crate::pushing::scene::{MASS, Scene, cuboid, landing_speed, sum};
use crate::scene::DT;

/// Weight of the climber, newtons.
const WEIGHT: f64 = MASS * 9.81;

/// Walks in a circle within 2 m.
fn about(tick: u32) -> ClimberInput {
    let angle = f64::from(tick) * 0.05;
    walk(DVec3::new(libm::cos(angle), 0.0, libm::sin(angle)))
}

fn still(_: u32) -> ClimberInput {
    IDLE
}

type Way = fn(u32) -> ClimberInput;

/// Ways to move, by name.
const WAYS: [(&str, Way); 2] = [("standing", still), ("walking", about)];

/// A raft with a mass and its top at height 0, which floats without gravity and does not turn, and a climber above it.
fn above_a_raft(height: f64, mass: f64) -> (Scene, RigidBodyHandle) {
    let mut scene = Scene::new(0.0, DVec3::new(0.3, 0.4 + height, -0.2));
    let body = RigidBodyBuilder::dynamic()
        .translation(Vector::new(0.0, -0.5, 0.0))
        .lock_rotations();
    let handle = scene.add(body, [(cuboid(9.0, 0.5, 9.0), mass)]);
    (scene, handle)
}

#[test]
fn a_raft_gets_the_climbers_weight_every_tick_standing_or_walking() {
    for (name, input) in WAYS {
        let (mut scene, raft) = above_a_raft(0.01, 4_000.0);
        scene.ticks(30, &IDLE);
        scene.assert_standing(name);
        for tick in 0..300 {
            let before = scene.momentum(raft);
            let report = scene.tick(&input(tick));
            let gained = (scene.momentum(raft) - before) / DT;
            let told = format!("{name}, tick {tick}: {gained} N, {report:?}");
            scene.assert_standing(&told);
            assert!((gained.y + WEIGHT).abs() < 0.01 * WEIGHT, "{told}");
            if name == "standing" {
                let aside = gained - DVec3::Y * gained.y;
                assert!(aside.length() < 0.01 * WEIGHT, "{told}");
            }
            assert_eq!(report.pushes.len(), 1, "{told}");
            // The push acts at the climber's feet.
            let feet = scene.climber.state().position - DVec3::Y * 0.4;
            assert!(report.pushes[0].point.distance(feet) < 0.02, "{told}");
        }
    }
}

/// Scales: a platform of 200 kg on a spring, with its top at height 0 when empty.
struct Scales {
    scene: Scene,
    platform: RigidBodyHandle,
}

impl Scales {
    /// Stiffness of the spring, newtons per metre.
    const STIFFNESS: f64 = 40_000.0;

    /// Damping of the spring, newton seconds per metre.
    const DAMPING: f64 = 4_000.0;

    fn new() -> Self {
        let mut scene = Scene::new(0.0, DVec3::new(0.0, 0.41, 0.0));
        let body = RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.0, -0.5, 0.0))
            .lock_rotations()
            .enabled_translations(false, true, false);
        let platform = scene.add(body, [(cuboid(9.0, 0.5, 9.0), 200.0)]);
        Self { scene, platform }
    }

    /// The displayed weight, newtons.
    fn shown(&self) -> f64 {
        -(self.scene.place(self.platform).y + 0.5) * Self::STIFFNESS
    }

    fn tick(&mut self, input: &ClimberInput) {
        let speed = self.scene.velocity(self.platform).y;
        let spring = (self.shown() - Self::DAMPING * speed) * DT;
        let body = &mut self.scene.world.bodies[self.platform];
        body.apply_impulse(Vector::new(0.0, spring as f32, 0.0), true);
        self.scene.tick(input);
    }
}

#[test]
fn scales_show_the_climbers_weight_standing_or_walking() {
    for (name, input) in WAYS {
        let mut scales = Scales::new();
        for tick in 0..900 {
            scales.tick(&input(tick));
            if tick >= 300 {
                scales.scene.assert_standing(name);
                let shown = scales.shown();
                let off = (shown / WEIGHT - 1.0).abs();
                assert!(off < 0.01, "{name}, tick {tick}: {shown} N");
            }
        }
    }
}

#[test]
fn a_landing_brings_the_raft_and_the_climber_to_one_speed() {
    for mass in [20.0, 400.0, 8_000.0] {
        let (mut scene, raft) = above_a_raft(2.0, mass);
        let mut landed = None;
        for tick in 0..60 {
            let report = scene.tick(&IDLE);
            if landed.is_none() {
                assert_eq!(scene.velocity(raft), DVec3::ZERO, "tick {tick}");
            }
            landed = landing_speed(&report);
            if landed.is_some() {
                break;
            }
        }
        let speed = landed.unwrap();
        assert!((speed - 6.2).abs() < 0.3, "{speed}");
        let given = sum(&scene.pushes);
        scene.apply();
        let together = -DVec3::Y * (speed * MASS / (MASS + mass));
        let told = format!("{mass} kg at {speed} m/s: {given}");
        assert!((scene.velocity(raft) - together).length() < 1e-4, "{told}");
        // The climber's momentum is shared by both, which now have the same velocity.
        assert!(
            (given.y + MASS * (speed + together.y)).abs() < 1e-3,
            "{told}"
        );
        scene.step(&IDLE);
        scene.assert_standing(&told);
        let own = scene.climber.state().velocity;
        assert!((own - together).length() < 1e-3, "{told}: {own}");
        // From now on the raft gets the climber's weight.
        let given = sum(&scene.pushes);
        assert!(
            (given + DVec3::Y * (WEIGHT * DT)).length() < 1e-9,
            "{told}: {given}"
        );
    }
}

#[test]
fn a_plank_on_a_pivot_tips_to_the_climbers_side() {
    for side in [-1.0, 1.0] {
        let mut scene = Scene::new(9.81, DVec3::new(1.5 * side, 0.41, 0.0));
        let post = scene.add(RigidBodyBuilder::fixed(), []);
        let body = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, -0.1, 0.0));
        let plank = scene.add(body, [(cuboid(2.0, 0.1, 1.0), 500.0)]);
        let hinge = RevoluteJointBuilder::new(Vector::Z).local_anchor1(Vector::new(0.0, -0.1, 0.0));
        scene.world.insert_impulse_joint(post, plank, hinge);
        scene.ticks(15, &IDLE);
        scene.assert_standing("on the plank");
        let spin = f64::from(scene.world.bodies[plank].angvel().z) * side;
        // Weight times arm over the plank's moment of inertia: about 1.7 rad/s after a second.
        assert!((-0.5..-0.3).contains(&spin), "{side}: {spin}");
    }
}
