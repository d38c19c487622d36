use clamber_body::{Body, Extremity, Figure, Side};
use clamber_scenes::bodies::{self, Scene, Stage};
use clamber_world::Obstacle;
use glam::DVec3;

use crate::figures;
use crate::play::{hips, most, play, quantile};

/// Height of a point above the nearest skin, metres; negative inside.
fn above(stage: &Stage<'_>, point: DVec3) -> f64 {
    let surfaces = stage.surfaces.iter();
    let hits = surfaces.filter_map(|surface| surface.closest_point(point, 1.0));
    let nearest = hits
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
        .unwrap();
    let out = (point - nearest.point).dot(nearest.normal);
    nearest.distance.copysign(out)
}

/// Measurements of standing feet in a scene.
#[derive(Debug, Default)]
struct Stances {
    /// Speeds of a sole's lower end along the ground below it, from frame to frame, metres a second.
    speeds: Vec<f64>,
    /// Distances that these ends move in each stance, metres.
    ways: Vec<f64>,
    /// Distances of a sole's lower end from the skin, metres, above or below.
    gaps: Vec<f64>,
    /// Distances of the sole's other end from the skin in the middle of a stance, where the foot is flat, metres.
    flat: Vec<f64>,
}

/// A foot on the ground, in the ground's frame.
#[derive(Clone, Copy)]
struct Stand {
    key: u64,
    sole: [DVec3; 2],
    way: f64,
    frames: u32,
}

fn stances(scene: &Scene, figure: &Figure) -> Stances {
    let mut seen = Stances::default();
    let mut last: [Option<Stand>; 2] = [None; 2];
    play(scene, figure, 60.0, |stage, body| {
        if stage.time < 1.5 {
            return;
        }
        for side in Side::BOTH {
            let was = &mut last[side.index()];
            let Some(hold) = body.hold(Extremity::Foot(side)) else {
                seen.ways.extend(was.take().map(|stand| stand.way));
                continue;
            };
            let sole = body.sole(figure, side).unwrap();
            let local = sole.map(|p| hold.frame.conjugate() * (p - hold.point));
            let heights = sole.map(|p| above(stage, p));
            let low = usize::from(heights[1] < heights[0]);
            seen.gaps.push(heights[low].abs());
            let surface = &stage.surfaces[hold.obstacle.0 as usize];
            let normal = surface.closest_point(hold.point, 1.0).unwrap().normal;
            let normal = hold.frame.conjugate() * normal;
            match was {
                Some(stand) if stand.key == hold.material.key => {
                    let moved = local[low] - stand.sole[low];
                    let along = (moved - normal * moved.dot(normal)).length();
                    seen.speeds.push(along * 60.0);
                    stand.way += along;
                    stand.sole = local;
                    stand.frames += 1;
                    if stand.frames == 6 {
                        seen.flat.push(heights[1 - low].abs());
                    }
                }
                _ => {
                    *was = Some(Stand {
                        key: hold.material.key,
                        sole: local,
                        way: 0.0,
                        frames: 0,
                    });
                }
            }
        }
    });
    seen
}

/// Scene B19: feet do not slide over the ground, a lift or a turntable.
#[test]
fn feet_stay_where_they_stand() {
    for (name, figure) in figures::all() {
        for speed in [0.5, 1.0, 1.4, 2.0, 3.0] {
            for scene in [
                bodies::flat(speed).unwrap(),
                bodies::lift(speed).unwrap(),
                bodies::turntable(speed).unwrap(),
            ] {
                let mut seen = stances(&scene, &figure);
                let what = format!("{name}, {}", scene.name);
                let [median, p99] = [0.5, 0.99].map(|share| quantile(&mut seen.speeds, share));
                assert!(seen.ways.len() >= 3, "{what}: {seen:?}");
                assert!(median <= 0.02 && p99 <= 0.05, "{what}: {median} {p99} m/s");
                assert!(most(&seen.ways) <= 0.01, "{what}: {} m", most(&seen.ways));
                assert!(most(&seen.gaps) <= 0.015, "{what}: {} m", most(&seen.gaps));
            }
        }
    }
}

/// Positions of the hips between two places on stairs, for each frame. Their heights are relative to a ramp of the
/// stairs' slope.
fn hips_above_ramp(scene: &Scene, figure: &Figure, slope: f64, rate: f64) -> Vec<DVec3> {
    let mut way = Vec::new();
    play(scene, figure, rate, |stage, body| {
        let place = hips(figure, body);
        if (3.0..15.0).contains(&stage.climber.state().position.z) {
            way.push(place - DVec3::Y * (slope * place.z));
        }
    });
    way
}

/// Scene B18: on stairs the pelvis follows a straight line, without bobbing at each step.
#[test]
fn the_pelvis_goes_straight_up_and_down_stairs() {
    for (name, figure) in figures::all() {
        for (up, speed) in [(true, 1.0), (true, 3.0), (false, 1.0), (false, 3.0)] {
            let scene = bodies::stairs(up, speed).unwrap();
            let slope = if up { 2.0 / 3.0 } else { -2.0 / 3.0 };
            for rate in [30.0, 60.0, 144.0] {
                let way = hips_above_ramp(&scene, &figure, slope, rate);
                let mean = way.iter().map(|p| p.y).sum::<f64>() / way.len() as f64;
                let off = way.iter().map(|p| (p.y - mean).abs()).fold(0.0, f64::max);
                let what = format!("{name}, {} at {rate} Hz", scene.name);
                // The climber's own steps differ with the rate; at 30 Hz it moves 10 cm a frame.
                let most = [(60.0, 0.06), (144.0, 0.08), (30.0, 0.12)];
                let most = most.iter().find(|(other, _)| *other == rate).unwrap().1;
                assert!(way.len() > 20 && off <= most, "{what}: {off} m");
                let rises = |p: &[DVec3]| (p[1].y - p[0].y) + slope * (p[1].z - p[0].z);
                // Less than 1 cm/s counts as no motion.
                let speeds = way.windows(2).map(|pair| rises(pair) * rate);
                let signs: Vec<f64> = speeds.filter(|v| v.abs() > 0.01).map(f64::signum).collect();
                let turns = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
                let steps = (way[way.len() - 1].z - way[0].z).abs() / 0.3;
                assert!(turns as f64 <= 2.0 * steps, "{what}: {turns} turns");
            }
        }
    }
}

/// Scene B20, and the way up: soles lie flat on slopes in the middle of their stance.
#[test]
fn soles_lie_flat_on_slopes() {
    for (name, figure) in figures::all() {
        for (angle, speed) in [(-0.611, 1.4), (-0.611, 0.8), (0.524, 1.4), (0.524, 0.0)] {
            let scene = bodies::ramp(angle, speed).unwrap();
            let mut seen = stances(&scene, &figure);
            let what = format!("{name}, {}", scene.name);
            assert!(speed == 0.0 || seen.flat.len() >= 4, "{what}: {seen:?}");
            assert!(most(&seen.gaps) <= 0.01, "{what}: {} m", most(&seen.gaps));
            // On the way up, the heel of the foot behind is lifted.
            let flat = if angle > 0.0 && speed > 0.0 {
                &[]
            } else {
                &seen.flat[..]
            };
            assert!(most(flat) <= 0.01, "{what}: {} m", most(flat));
            let p99 = quantile(&mut seen.speeds, 0.99);
            assert!(p99 <= 0.05, "{what}: {p99} m/s");
        }
    }
}

/// Angle between thigh and shin, radians: pi for a straight leg.
fn knee(figure: &Figure, body: &Body, side: Side) -> f64 {
    let leg = figure.humanoid().leg(side);
    let at = |joint| {
        let model = clamber_animation::joint_in_model(figure.skeleton(), body.pose(), joint);
        model.unwrap().translation
    };
    let [hip, knee] = [leg.upper, leg.lower].map(at);
    let ankle = leg.ik.end(figure.skeleton(), body.pose()).unwrap();
    let (a, b) = (hip - knee, ankle - knee);
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Scene B17: one foot on a block of 0.4 m with a slope of 30 degrees, the other on the ground.
#[test]
fn one_foot_stands_on_a_block() {
    for (name, figure) in figures::all() {
        let scene = bodies::block().unwrap();
        let mut lowest: f64 = 0.0;
        let mut last: Option<f64> = None;
        play(&scene, &figure, 60.0, |stage, body| {
            let root = body.world_from_model().translation;
            let down = stage.climber.state().position.y - 0.3 - root.y;
            if let Some(was) = last.replace(down) {
                lowest = lowest.max((down - was) * 60.0);
            }
            if stage.time < 1.0 {
                return;
            }
            for side in Side::BOTH {
                let what = format!("{name}, {side:?}, {:.2} s", stage.time);
                assert!(body.hold(Extremity::Foot(side)).is_some(), "{what}");
                for point in body.sole(&figure, side).unwrap() {
                    let gap = above(stage, point).abs();
                    assert!(gap <= 0.005, "{what}: {gap} m");
                }
                let knee = knee(&figure, body, side).to_degrees();
                assert!((20.0..=177.5).contains(&knee), "{what}: {knee}°");
            }
            assert!(down <= 0.5, "{name}: {down} m down");
        });
        assert!(lowest <= 1.2, "{name}: goes down at {lowest} m/s");
    }
}

/// Each step of a foot is reported with its point and its speed.
#[test]
fn steps_are_told() {
    let figure = figures::hero();
    let scene = bodies::flat(1.4).unwrap();
    let mut steps = Vec::new();
    play(&scene, &figure, 60.0, |stage, body| {
        if (0.2..0.4).contains(&stage.time) {
            assert!(
                body.plants().is_empty(),
                "nothing comes down while it stands"
            );
        }
        for plant in body.plants() {
            println!(
                "{:.3} {:?} {:.3} {:.2}",
                stage.time, plant.extremity, plant.point, plant.speed
            );
            if stage.time > 1.0 {
                steps.push(*plant);
            }
        }
    });
    // 4 s at 1.4 m/s with a stride of 1.4 m are eight steps, with alternating feet.
    assert_eq!(steps.len(), 8, "{steps:?}");
    for pair in steps.windows(2) {
        assert_ne!(pair[0].extremity, pair[1].extremity);
        let way = pair[1].point.z - pair[0].point.z;
        assert!((0.3..1.0).contains(&way), "{way} m");
    }
    for step in &steps {
        assert!((0.5..6.0).contains(&step.speed), "{} m/s", step.speed);
        assert!(step.point.y.abs() < 1e-6 && step.normal.y > 0.999);
    }
}
