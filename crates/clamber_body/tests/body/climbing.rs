use clamber_body::{Body, Extremity, Figure, Side};
use clamber_scenes::bodies::{self, Scene, Stage};
use clamber_scenes::giant;
use glam::DVec3;

use crate::figures;
use crate::play::{play, quantile};

#[derive(Default, Debug)]
struct Held {
    drift: f64,
    median: f64,
    p99: f64,
    most: f64,
    least_held: usize,
    hands_off: usize,
    frames: usize,
    stride: f64,
    plants: usize,
}

fn held(scene: &Scene, figure: &Figure, from: f64) -> Held {
    let mut seen = Held {
        least_held: 4,
        ..Held::default()
    };
    let mut errors = Vec::new();
    let mut last: [Option<DVec3>; 4] = [None; 4];
    let mut start: [Option<(u64, DVec3)>; 4] = [None; 4];
    play(scene, figure, 60.0, |stage: &Stage<'_>, body: &Body| {
        let mode = stage.climber.state().mode;
        if stage.time < from || !mode.is_holding() {
            start = [None; 4];
            return;
        }
        seen.frames += 1;
        let mut count = 0;
        let mut hands = 0;
        for extremity in Extremity::ALL {
            let index = extremity.index();
            let Some(hold) = body.hold(extremity) else {
                start[index] = None;
                continue;
            };
            count += 1;
            hands += usize::from(extremity.is_hand());
            let touch = body.touching_point(figure, extremity).unwrap();
            if !extremity.is_hand() {
                continue;
            }
            errors.push(touch.distance(hold.point));
            let local = hold.frame.conjugate() * (touch - hold.point);
            match start[index] {
                Some((key, was)) if key == hold.material.key => {
                    seen.drift = seen.drift.max(was.distance(local))
                }
                _ => {
                    start[index] = Some((hold.material.key, local));
                    if let Some(before) = last[index] {
                        seen.stride = seen.stride.max(before.distance(hold.point));
                    }
                }
            }
            last[index] = Some(hold.point);
        }
        seen.plants += body.plants().len();
        seen.least_held = seen.least_held.min(count);
        if (hands == 0
            || (stage.time > 42.08 && stage.time < 42.2)
            || count < 3 && scene.name.contains("wall at 0.80"))
            && std::env::var_os("SHOW").is_some()
        {
            let st = stage.climber.state();
            println!(
                "{:.3} {mode:?} {:.2} {:.2} v {:.2} {:?}",
                stage.time,
                st.position,
                st.support.unwrap().normal_in_world(),
                (st.velocity - st.base_velocity).length(),
                Extremity::ALL.map(|e| body.describe(e))
            );
        }
        seen.hands_off += usize::from(hands == 0);
    });
    seen.median = quantile(&mut errors, 0.5);
    seen.p99 = quantile(&mut errors, 0.99);
    seen.most = quantile(&mut errors, 1.0);
    seen
}

/// Scene B14.
#[test]
fn enough_of_them_hold_at_every_speed() {
    for (name, figure) in figures::all() {
        for way in [0.2, 0.5333, 1.0] {
            for direction in [
                DVec3::Y,
                DVec3::X,
                DVec3::NEG_Y,
                DVec3::new(-1.0, 1.0, 0.0).normalize(),
            ] {
                let scene = bodies::wall(direction * way).unwrap();
                println!(
                    "{name} {direction} {}: {:?}",
                    scene.name,
                    held(&scene, &figure, 1.0)
                );
            }
        }
    }
}

/// Scenes B12 and B13.
#[test]
fn palms_stay_on_skin() {
    let giant = giant::giant().unwrap();
    for (name, figure) in figures::all() {
        for (height, from) in [(0.35, DVec3::Z), (0.7, DVec3::NEG_Z)] {
            let mount = bodies::Mount {
                clip: "walk",
                height,
                from,
            };
            let scene = bodies::climb(&giant, &mount, 1.0).unwrap();
            println!("{name} {}: {:?}", scene.name, held(&scene, &figure, 0.7));
        }
    }
}

/// Scene B23.
#[test]
fn a_body_that_is_shaken_hangs_on() {
    for (name, figure) in figures::all() {
        let scene = bodies::hang(3.0, 0.25).unwrap();
        println!("{name} {}: {:?}", scene.name, held(&scene, &figure, 1.3));
    }
    let _ = Side::Left;
}
