//! A climber that was crushed against trimesh ground recovers on the right side.

use clamber_climber::Climber;
use clamber_world::rapier3d::prelude::{
    ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use clamber_world::{BodyPoses, RapierTerrain};

use crate::cases::{pairs, triples};
use crate::defects::common::{trimesh, v};
use crate::input::IDLE;
use crate::scene::{DT, tick_among, walker};
use crate::stage::Shape;

/// Two rapier worlds, the first with trimesh ground, and a body that moves in one of them.
struct Worlds {
    worlds: [PhysicsWorld; 2],
    before: [BodyPoses; 2],
    /// The world of the body.
    other: usize,
    body: RigidBodyHandle,
}

impl Worlds {
    fn new(ground: &Shape, other: usize, collider: &ColliderBuilder, place: Vector) -> Self {
        let mut worlds = [PhysicsWorld::default(), PhysicsWorld::default()];
        worlds[0].insert_collider(trimesh(ground), None);
        let body = RigidBodyBuilder::kinematic_position_based().translation(place);
        let (body, _) = worlds[other].insert(body, collider.clone());
        for world in &mut worlds {
            world.detect_collisions(&(), &());
        }
        let before = [BodyPoses::new(), BodyPoses::new()];
        Self {
            worlds,
            before,
            other,
            body,
        }
    }

    /// Moves the body, and steps both worlds and then the climber.
    fn step(&mut self, climber: &mut Climber, place: Vector) {
        for (index, world) in self.worlds.iter_mut().enumerate() {
            self.before[index].record(&world.bodies);
            if index == self.other {
                let body = world.bodies.get_mut(self.body).unwrap();
                body.set_next_kinematic_translation(place);
            }
            world.step();
        }
        let [one, other] = [0, 1]
            .map(|index: usize| RapierTerrain::of_world(&self.worlds[index], &self.before[index]));
        tick_among(climber, &[&one, &other], &IDLE);
    }
}

/// A solid, of the ground's rapier world or of another one, comes down on a climber on trimesh ground, and lifts again.
/// Returns the number of runs, and those that ended below the ground.
fn stomped(ground: &Shape, other: usize, foot: &ColliderBuilder) -> (u32, Vec<String>) {
    let (mut runs, mut below) = (0, Vec::new());
    let depths = [(0.3, [0.3, 0.1, 0.0]), (1.0, [0.2, 0.0, -0.3])];
    for ((speed, lows), index, x) in triples(depths, 0..3, [0.0, 0.03, 0.2]) {
        runs += 1;
        let low: f64 = lows[index];
        let mut worlds = Worlds::new(ground, other, foot, Vector::new(0.0, 1.2, 0.0));
        let mut climber = walker(v(x, 0.4, 0.05));
        for k in 0..260 {
            let time = DT * f64::from(k - 20);
            let height = match k {
                0..20 => 1.2,
                20..160 => (1.2 - speed * time).max(low),
                _ => low + 0.03 * f64::from(k - 160),
            };
            worlds.step(&mut climber, Vector::new(0.0, height as f32, 0.0));
        }
        let place = climber.state().position;
        if place.y < -0.05 {
            below.push(format!("{speed} m/s to {low}, x {x}: ends at {place}"));
        }
    }
    (runs, below)
}

#[test]
fn a_stomping_solid_does_not_press_the_climber_through_trimesh_ground() {
    let field = Shape::field(v(-6.0, 0.0, -6.0), 1.0, [12, 12], |_, _| 0.0);
    let solid = ColliderBuilder::cuboid(1.0, 0.5, 1.0).translation(Vector::new(0.0, 0.5, 0.0));
    let mesh = trimesh(&Shape::boxed(v(-1.0, 0.0, -1.0), v(1.0, 1.0, 1.0)));
    let mut all = String::new();
    let mut wrong = 0;
    let grounds = [("box of 1 m", Shape::floor(6.0)), ("sheet", field)];
    let feet = [("cuboid", &solid), ("trimesh", &mesh)];
    for ((name, ground), (kind, foot), other) in triples(&grounds, feet, [0, 1]) {
        let (runs, below) = stomped(ground, other, foot);
        wrong += below.len();
        let first = below.first().map_or("", |told| told.as_str());
        let count = below.len();
        all += &format!("\n{name}, {kind} of world {other}: below in {count} of {runs} {first}");
    }
    assert_eq!(wrong, 0, "{all}");
}

#[test]
fn a_piston_does_not_press_the_climber_out_of_a_trimesh_room() {
    assert_stays_in_the_room(0);
}

#[test]
fn a_piston_of_another_world_does_not_press_the_climber_out_of_a_trimesh_room() {
    assert_stays_in_the_room(1);
}

/// In a trimesh room, a trimesh piston of the same rapier world or of another one presses a climber against the wall,
/// and goes back.
fn assert_stays_in_the_room(other: usize) {
    let room = Shape::boxed(v(-5.0, 0.0, -5.0), v(5.0, 5.0, 5.0)).flipped();
    let piston = trimesh(&Shape::boxed(v(-1.0, 0.0, -1.0), v(1.0, 2.0, 1.0)));
    let mut all = String::new();
    let mut wrong = 0;
    for speed in [0.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0] {
        let (mut runs, mut outside) = (0, Vec::new());
        let lows = [0.1, 0.0, -0.05, -0.1, -0.15, -0.2, -0.3];
        for (low, start) in pairs(lows, [0.0, 0.02, 0.05]) {
            runs += 1;
            let mut worlds = Worlds::new(&room, other, &piston, Vector::new(3.0, 0.05, 0.0));
            let mut climber = walker(v(4.6, 0.4, 0.0));
            let pressed = (1.5 / speed / DT) as i32 + 30;
            for k in 0..pressed + 60 {
                let x = if k > pressed {
                    3.0
                } else {
                    (3.0 + start + speed * DT * f64::from(k)).min(4.0 - low)
                };
                worlds.step(&mut climber, Vector::new(x as f32, 0.05, 0.0));
            }
            let p = climber.state().position;
            if p.x > 5.0 || p.y < -0.1 || p.z.abs() > 5.0 || p.y > 5.0 {
                outside.push(format!("low {low}, start {start}: ends at {p}"));
            }
        }
        wrong += outside.len();
        let first = outside.first().map_or("", |told| told.as_str());
        let count = outside.len();
        all += &format!(
            "\n{speed} m/s, piston of world {other}: outside in {count} of {runs} {first}"
        );
    }
    assert_eq!(wrong, 0, "{all}");
}
