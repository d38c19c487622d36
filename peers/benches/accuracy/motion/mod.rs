//! Methods of keeping a sphere or a climber out of a moving limb: the time of each, and the penetration that it leaves.

mod climbers;
mod limb;
mod methods;

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use clamber_peers::Plot;
use clamber_scenes::measure::{Table, measure_file, quantile};
use clamber_surface::mesh::ColliderMesh;
use climbers::{GROUND, Stance};
use glam::DVec3;
use limb::{AT, Course, LENGTH, RADIUS, limb, signed_distance};
use methods::{Body, Method, RIDING, SPHERES, STRUCK};

/// Radius of the sphere, metres.
const SPHERE: f64 = 0.4;

/// Angle by which the limb swings beyond the sphere's place, radians: enough to have passed the sphere.
const BEYOND: f64 = 0.35;

/// Share of the sum of both radii. A sphere that gets behind the limb has passed through it, not around it, if its
/// distance from the limb's axis is less than this share.
const THROUGH: f64 = 0.9;

/// Columns of the table.
const COLUMNS: [&str; 10] = [
    "scene",
    "m/s",
    "Hz",
    "method",
    "us a tick",
    "median depth, m",
    "99 %, m",
    "worst, m",
    "passed through",
    "drift, m",
];

/// The results of one method in one scene.
#[derive(Default)]
struct Outcome {
    microseconds: Vec<f64>,
    depths: Vec<f64>,
    /// Trials in which the limb passed through the sphere.
    passed: usize,
    trials: usize,
    drift: f64,
}

impl Outcome {
    /// Runs a tick that starts at `time`, and adds its duration to the list. The duration does not include
    /// [`Body::end`], which prepares the next tick.
    fn tick(
        &mut self,
        body: &mut Body,
        course: &Course,
        time: f64,
        dt: f64,
    ) -> Result<(), Box<dyn Error>> {
        let start = Instant::now();
        body.tick(course, time, dt)?;
        let us = start.elapsed().as_secs_f64() * 1e6;
        self.microseconds.push(us);
        Ok(body.end(course, time + dt)?)
    }
}

/// Measures all methods in all scenes.
pub(crate) fn run(brief: bool) -> Result<(), Box<dyn Error>> {
    let mesh = limb()?;
    let (trials, seconds) = if brief { (2, 0.2) } else { (100, 10.0) };
    let mut table = Table::new(&COLUMNS);
    let mut plot = Plot {
        title: "A limb swings into a sphere: depth against cost, a dot for each speed and rate"
            .into(),
        x: "us a tick".into(),
        y: "worst depth at the end of a tick, m".into(),
        ..Plot::default()
    };
    for rate in [30.0, 60.0, 120.0] {
        for speed in [5.0, 20.0, 60.0, 100.0] {
            for (method, name) in SPHERES.into_iter().chain(STRUCK) {
                let swung = swing(&mesh, method, speed, rate, trials)?;
                let scene = ["a limb swings", name];
                report(&mut table, &mut plot, scene, [speed, rate], swung);
            }
        }
        for speed in [1.0, 5.0] {
            for (method, name) in SPHERES.into_iter().chain(RIDING) {
                let rode = ride(&mesh, method, speed, rate, seconds)?;
                let scene = ["riding on a limb", name];
                report(&mut table, &mut plot, scene, [speed, rate], rode);
            }
        }
    }
    println!("\n{table}");
    table.write("accuracy_motion", brief)?;
    plot.write_svg(&measure_file("accuracy_motion", brief, "svg"))
}

/// A limb swings into a sphere or a climber. The limb's axis passes the centre at a random distance of up to half the
/// sum of both radii; for a climber on the ground, at a sixth of that sum.
fn swing(
    mesh: &Arc<ColliderMesh>,
    method: Method,
    speed: f64,
    rate: f64,
    trials: usize,
) -> Result<Outcome, Box<dyn Error>> {
    let mut rng = fastrand::Rng::with_seed(12);
    let dt = 1.0 / rate;
    let mut outcome = Outcome::default();
    for _ in 0..trials {
        // The limb starts at a random place within one tick's motion, so that ticks hit the sphere in any phase.
        let before = 0.3 + speed / AT * dt * rng.f64();
        let course = Course::Swing {
            speed,
            from: -before,
        };
        let beside = 0.5 * (RADIUS + SPHERE) * (2.0 * rng.f64() - 1.0);
        let along = AT + rng.f64() - 0.5;
        let stands = method == Method::Climber(Stance::OnGround);
        let height = if stands { SPHERE - GROUND } else { beside };
        let place = DVec3::new(along, 0.0, height);
        let mut body = Body::new(mesh, method, &course, place, SPHERE)?;
        if stands {
            body.rest(dt)?;
        }
        let (mut was_before, mut passed) = (true, false);
        let ticks = ((before + BEYOND) * AT / speed / dt).ceil() as usize;
        for tick in 0..ticks {
            let time = tick as f64 * dt;
            outcome.tick(&mut body, &course, time, dt)?;
            let palette = course.palette(time + dt);
            let at = course
                .model_from_joint(time + dt)
                .inverse()
                .transform_point3(body.center);
            // Beyond the tip, there is no limb, and so no depth.
            if at.x < LENGTH {
                let depth = body.core() - signed_distance(mesh, &palette, body.center);
                outcome.depths.push(depth.max(0.0));
            }
            // The limb swings towards its Y.
            if at.y < 0.0 && was_before {
                was_before = false;
                passed |= at.z.abs() < THROUGH * (RADIUS + SPHERE) && at.x < LENGTH;
            }
        }
        let is_climber = matches!(method, Method::Climber(_));
        if is_climber && body.center.distance(place) < 0.1 * SPHERE {
            return Err(format!("the limb did not reach the climber at {place}").into());
        }
        outcome.trials += 1;
        outcome.passed += usize::from(passed);
    }
    Ok(outcome)
}

/// A sphere or a climber rides on a limb that moves up and down and rolls.
fn ride(
    mesh: &Arc<ColliderMesh>,
    method: Method,
    speed: f64,
    rate: f64,
    seconds: f64,
) -> Result<Outcome, Box<dyn Error>> {
    let dt = 1.0 / rate;
    let course = Course::Heave { speed };
    // On top of the limb at the start.
    let top = DVec3::new(5.0, RADIUS + SPHERE, 0.0);
    let place = course.model_from_joint(0.0).transform_point3(top);
    let mut body = Body::new(mesh, method, &course, place, SPHERE)?;
    body.rest(dt)?;
    let from_joint = |time: f64, point: DVec3| {
        course
            .model_from_joint(time)
            .inverse()
            .transform_point3(point)
    };
    let start = from_joint(0.0, body.center);
    let mut outcome = Outcome {
        trials: 1,
        ..Outcome::default()
    };
    for tick in 0..(seconds * rate) as usize {
        let time = tick as f64 * dt;
        outcome.tick(&mut body, &course, time, dt)?;
        let depth = body.core() - signed_distance(mesh, &course.palette(time + dt), body.center);
        outcome.depths.push(depth.max(0.0));
        // Relative to the limb. Being lifted off counts as well.
        let drift = from_joint(time + dt, body.center).distance(start);
        outcome.drift = outcome.drift.max(drift);
    }
    outcome.passed = usize::from(!outcome.drift.is_finite() || outcome.drift > SPHERE);
    Ok(outcome)
}

fn report(
    table: &mut Table,
    plot: &mut Plot,
    [scene, method]: [&str; 2],
    [speed, rate]: [f64; 2],
    mut outcome: Outcome,
) {
    // The mean, not the median: most ticks have no limb near, and the others make up the cost.
    let cost = outcome.microseconds.iter().sum::<f64>() / outcome.microseconds.len() as f64;
    let depths = [0.5, 0.99, 1.0].map(|part| quantile(&mut outcome.depths, part));
    let mut row = [scene, &format!("{speed}"), &format!("{rate}"), method]
        .map(str::to_owned)
        .to_vec();
    row.push(format!("{cost:.1}"));
    row.extend(depths.map(|depth| format!("{depth:.4}")));
    row.push(format!("{} of {}", outcome.passed, outcome.trials));
    let rides = scene.starts_with("riding");
    row.push(if rides {
        format!("{:.4}", outcome.drift)
    } else {
        String::new()
    });
    println!("{}", row.join(", "));
    table.push(row);
    if !rides {
        plot.add(method, (cost, depths[2].max(1e-6)));
    }
}
