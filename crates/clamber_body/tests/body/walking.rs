use clamber_body::{Extremity, Side};
use clamber_scenes::bodies::{self, Scene};
use glam::DVec3;

use crate::figures;
use crate::play::{play, quantile};

/// How feet slip over what they stand on.
#[derive(Debug)]
struct Slip {
    median: f64,
    p99: f64,
    stance: f64,
    stances: usize,
    /// Largest distance of the lower end of the sole from the ground plane.
    gap: f64,
}

fn slip(scene: &Scene, figure: &clamber_body::Figure) -> Slip {
    // Per foot: material, place of heel and ball in its frame, way in this stance.
    let mut last: [Option<(u64, [DVec3; 2], f64)>; 2] = [None; 2];
    let (mut speeds, mut ways, mut gap) = (Vec::new(), Vec::new(), 0.0f64);
    let mut stances = 0;
    play(scene, figure, 60.0, |stage, body| {
        if stage.time < 1.2 {
            return;
        }
        for side in Side::BOTH {
            let place = &mut last[side.index()];
            let Some(hold) = body.hold(Extremity::Foot(side)) else {
                if let Some((_, _, way)) = place.take() {
                    ways.push(way);
                }
                continue;
            };
            let sole = body.sole(figure, side).unwrap();
            let local = sole.map(|p| hold.frame.conjugate() * (p - hold.point));
            // The ground's normal in its own frame: what rigid ground has in common in these scenes.
            let up = DVec3::Y;
            let low = usize::from(local[1].dot(up) < local[0].dot(up));
            gap = gap.max(local[low].dot(up).abs());
            let key = hold.material.key;
            match place {
                Some((was_key, was, way)) if *was_key == key => {
                    let moved = local[low] - was[low];
                    let along = moved - up * moved.dot(up);
                    speeds.push(along.length() * 60.0);
                    *way += along.length();
                    *was = local;
                }
                _ => {
                    stances += 1;
                    *place = Some((key, local, 0.0));
                }
            }
        }
    });
    Slip {
        median: quantile(&mut speeds, 0.5),
        p99: quantile(&mut speeds, 0.99),
        stance: ways.iter().copied().fold(0.0, f64::max),
        stances,
        gap,
    }
}

/// Scene B19.
#[test]
fn feet_stay_where_they_stand() {
    for (name, figure) in figures::all() {
        for speed in [0.5, 1.0, 1.4, 2.0, 3.0] {
            for scene in [
                bodies::flat(speed).unwrap(),
                bodies::lift(speed).unwrap(),
                bodies::turntable(speed).unwrap(),
            ] {
                let slip = slip(&scene, &figure);
                println!("{name} {}: {slip:?}", scene.name);
            }
        }
    }
}

/// Scene B18.
#[test]
fn the_pelvis_goes_straight_up_and_down_stairs() {
    for (name, figure) in figures::all() {
        for (up, speed) in [(true, 1.0), (true, 3.0), (false, 1.0), (false, 3.0)] {
            let scene = bodies::stairs(up, speed).unwrap();
            let mut way: Vec<DVec3> = Vec::new();
            play(&scene, &figure, 60.0, |stage, body| {
                let world = body.world_from_model();
                let hips = figure.humanoid().hips;
                let model = clamber_animation::joint_in_model(figure.skeleton(), body.pose(), hips);
                let z = stage.climber.state().position.z;
                if (3.0..15.0).contains(&z) {
                    way.push(world.transform_point(model.unwrap().translation));
                }
            });
            let slope = if up { 2.0 / 3.0 } else { -2.0 / 3.0 };
            let heights: Vec<f64> = way.iter().map(|p| p.y - slope * p.z).collect();
            let mean = heights.iter().sum::<f64>() / heights.len() as f64;
            let off = heights.iter().map(|h| (h - mean).abs()).fold(0.0, f64::max);
            let velocity: Vec<f64> = way.windows(2).map(|p| p[1].y - p[0].y).collect();
            let turns = velocity.windows(2).filter(|v| v[0] * v[1] < 0.0).count();
            println!(
                "{name} {}: off {off:.3} turns {turns} of {} steps, mean {mean:.3}",
                scene.name,
                12.0 / 0.3
            );
        }
    }
}

/// Scenes B17 and B20.
#[test]
fn soles_lie_on_slopes_and_blocks() {
    for (name, figure) in figures::all() {
        for scene in [
            bodies::block().unwrap(),
            bodies::ramp(-0.61, 1.4).unwrap(),
            bodies::ramp(0.52, 1.4).unwrap(),
            bodies::ramp(0.52, 0.0).unwrap(),
        ] {
            let slip = slip(&scene, &figure);
            let mut soles = String::new();
            play(&scene, &figure, 60.0, |stage, body| {
                if stage.time > scene.seconds - 0.02 {
                    for side in Side::BOTH {
                        let hold = body.hold(Extremity::Foot(side)).copied();
                        let sole = body.sole(&figure, side).unwrap();
                        let gaps = hold.map(|hold| {
                            sole.map(|p| (hold.frame.conjugate() * (p - hold.point)).y)
                        });
                        soles += &format!("{gaps:.4?} ");
                    }
                }
            });
            println!("{name} {}: {slip:?} {soles}", scene.name);
        }
    }
}
