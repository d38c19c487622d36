//! A climber that was crushed against trimesh ground recovers on the right side.

use clamber_climber::{Climber, ClimberConfig};
use clamber_world::rapier3d::prelude::{ColliderBuilder, PhysicsWorld, RigidBodyBuilder, Vector};
use clamber_world::{BodyPoses, RapierTerrain};

use crate::defects::common::{tick, trimesh, v};
use crate::scene::DT;
use crate::stage::{IDLE, Shape};

/// A solid, of the ground's rapier world or of another one, comes down on a climber on trimesh ground, and lifts again.
/// Returns the number of runs, and those that ended below the ground.
fn stomped(ground: &Shape, other: usize, foot: &ColliderBuilder) -> (u32, Vec<String>) {
    let (mut runs, mut below) = (0, Vec::new());
    let lows = [
        (0.3, [0.3, 0.1, 0.0].as_slice()),
        (1.0, [0.2, 0.0, -0.3].as_slice()),
    ];
    for (speed, lows) in lows {
        for low in lows {
            for x in [0.0, 0.03, 0.2] {
                runs += 1;
                let mut worlds = [PhysicsWorld::default(), PhysicsWorld::default()];
                let mut before = [BodyPoses::new(), BodyPoses::new()];
                worlds[0].insert_collider(trimesh(ground), None);
                let body = RigidBodyBuilder::kinematic_position_based();
                let body = body.translation(Vector::new(0.0, 1.2, 0.0));
                let (handle, _) = worlds[other].insert(body, foot.clone());
                let mut climber = Climber::new(ClimberConfig::walker(), v(x, 0.4, 0.05)).unwrap();
                for world in &mut worlds {
                    world.detect_collisions(&(), &());
                }
                for k in 0..260 {
                    let time = DT * f64::from(k - 20);
                    let height = match k {
                        0..20 => 1.2,
                        20..160 => (1.2 - speed * time).max(*low),
                        _ => low + 0.03 * f64::from(k - 160),
                    };
                    for (index, world) in worlds.iter_mut().enumerate() {
                        before[index].record(&world.bodies);
                        if index == other {
                            let place = Vector::new(0.0, height as f32, 0.0);
                            let body = world.bodies.get_mut(handle).unwrap();
                            body.set_next_kinematic_translation(place);
                        }
                        world.step();
                    }
                    let terrain = [0, 1].map(|index: usize| {
                        RapierTerrain::of_world(&worlds[index], &before[index])
                    });
                    tick(&mut climber, &[&terrain[0], &terrain[1]], &IDLE);
                }
                let place = climber.state().position;
                if place.y < -0.05 {
                    below.push(format!("{speed} m/s to {low}, x {x}: ends at {place}"));
                }
            }
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
    for (name, ground) in [("box of 1 m", Shape::floor(6.0)), ("sheet", field)] {
        for (kind, foot) in [("cuboid", &solid), ("trimesh", &mesh)] {
            for other in [0, 1] {
                let (runs, below) = stomped(&ground, other, foot);
                wrong += below.len();
                let first = below.first().map_or("", |told| told.as_str());
                all += &format!(
                    "\n{name}, {kind} of world {other}: below in {} of {runs} {first}",
                    below.len()
                );
            }
        }
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
    let piston = Shape::boxed(v(-1.0, 0.0, -1.0), v(1.0, 2.0, 1.0));
    let mut all = String::new();
    let mut wrong = 0;
    for speed in [0.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0] {
        let (mut runs, mut outside) = (0, Vec::new());
        for low in [0.1, 0.0, -0.05, -0.1, -0.15, -0.2, -0.3] {
            for start in [0.0, 0.02, 0.05] {
                runs += 1;
                let mut worlds = [PhysicsWorld::default(), PhysicsWorld::default()];
                let mut before = [BodyPoses::new(), BodyPoses::new()];
                worlds[0].insert_collider(trimesh(&room), None);
                let body = RigidBodyBuilder::kinematic_position_based();
                let body = body.translation(Vector::new(3.0, 0.05, 0.0));
                let (handle, _) = worlds[other].insert(body, trimesh(&piston));
                let mut climber = Climber::new(ClimberConfig::walker(), v(4.6, 0.4, 0.0)).unwrap();
                for world in &mut worlds {
                    world.detect_collisions(&(), &());
                }
                let pressed = (1.5 / speed / DT) as i32 + 30;
                for k in 0..pressed + 60 {
                    let x = if k > pressed {
                        3.0
                    } else {
                        (3.0 + start + speed * DT * f64::from(k)).min(4.0 - low)
                    };
                    for (index, world) in worlds.iter_mut().enumerate() {
                        before[index].record(&world.bodies);
                        if index == other {
                            let place = Vector::new(x as f32, 0.05, 0.0);
                            let body = world.bodies.get_mut(handle).unwrap();
                            body.set_next_kinematic_translation(place);
                        }
                        world.step();
                    }
                    let terrain = [0, 1].map(|index: usize| {
                        RapierTerrain::of_world(&worlds[index], &before[index])
                    });
                    tick(&mut climber, &[&terrain[0], &terrain[1]], &IDLE);
                }
                let p = climber.state().position;
                if p.x > 5.0 || p.y < -0.1 || p.z.abs() > 5.0 || p.y > 5.0 {
                    outside.push(format!("low {low}, start {start}: ends at {p}"));
                }
            }
        }
        wrong += outside.len();
        let first = outside.first().map_or("", |told| told.as_str());
        all += &format!(
            "\n{speed} m/s, piston of world {other}: outside in {} of {runs} {first}",
            outside.len()
        );
    }
    assert_eq!(wrong, 0, "{all}");
}
