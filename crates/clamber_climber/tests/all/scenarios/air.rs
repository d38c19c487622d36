//! Climbers in the air that have left a moving support, and the obstacles that they run into next.

use clamber_climber::{ClimberConfig, ClimberMode, ClimberState};
use clamber_surface::geometry::Similarity;
use glam::DVec3;

use crate::cases::{pairs, triples};
use crate::input::{IDLE, walk};
use crate::stage::{Played, Run, Shape, Stage, kinds, radians, shifted, turned};

/// Tick rates, hertz.
const RATES: [f64; 3] = [30.0, 60.0, 240.0];

/// A notch between two walls that meet at x = 8 and open towards -X, each at an angle from the X axis.
fn notch(played: Played, rate: f64, half: f64) -> Stage {
    let stage = Stage::at_rate(played, rate);
    let walls = [(-half, -20.0, 0.0), (half, 0.0, 20.0)];
    walls.into_iter().fold(stage, |stage, (turn, from, to)| {
        let wall = Shape::boxed(DVec3::new(-12.0, -40.0, from), DVec3::new(30.0, 9.0, to));
        stage.with(&wall, move |_| Similarity {
            translation: DVec3::X * 8.0,
            ..turned(DVec3::Y, turn)
        })
    })
}

/// A climber that flies at a velocity, after it left a support with another velocity.
fn flying(stage: Stage, config: ClimberConfig, velocity: DVec3, base_velocity: DVec3) -> Run {
    let mut run = Run::new(stage, config, DVec3::ZERO);
    let state = ClimberState {
        velocity,
        base_velocity,
        ..*run.state()
    };
    run.put(state);
    run
}

pub(crate) fn a_notch_stops_a_climber_that_left_a_train() {
    for (&played, rate, degrees) in triples(kinds(), RATES, [3.5, 7.0, 10.0, 13.0, 20.0]) {
        for (speed, rise) in pairs([10.0, 15.0, 20.0, 40.0], [0.0, 3.0]) {
            let velocity = DVec3::new(speed, rise, 0.013 * speed);
            let stage = notch(played, rate, radians(degrees));
            let base = DVec3::X * speed;
            let mut run = flying(stage, ClimberConfig::walker(), velocity, base);
            let told =
                format!("{played:?} at {rate} Hz, {degrees} degrees, {speed} and {rise} m/s");
            for _ in 0..(2.0 * rate) as u32 {
                run.step(&IDLE);
                let p = run.position();
                assert!(p.x < 8.0 && p.z.abs() < 3.0, "{told}: in the rock at {p}");
            }
            let ahead = run.state().velocity.x;
            assert!(ahead < 0.1, "{told}: still goes on at {ahead} m/s");
        }
    }
}

pub(crate) fn a_wall_that_squeezes_a_falling_climber_does_not_lift_it() {
    let bases = [DVec3::ZERO, DVec3::Y * 12.0, DVec3::Z * 12.0];
    for (&played, rate, base) in triples(kinds(), RATES, bases) {
        let stage = Stage::at_rate(played, rate)
            .with_still(&Shape::boxed(
                DVec3::new(0.5, -60.0, -9.0),
                DVec3::new(9.0, 60.0, 9.0),
            ))
            // The gap is 0.7 m for a second, although the ball needs 0.8 m.
            .with(
                &Shape::boxed(DVec3::new(-1.0, -60.0, -9.0), DVec3::new(0.0, 60.0, 9.0)),
                |time| {
                    let gap = (2.0 * time - 1.0).min(-0.2).min(-0.2 - 2.0 * (time - 1.4));
                    shifted(DVec3::X * gap)
                },
            );
        let mut run = flying(stage, ClimberConfig::walker(), DVec3::ZERO, base);
        let (start, mut crushed) = (run.position(), 0);
        for _ in 0..(4.0 * rate) as u32 {
            run.step(&IDLE);
            crushed += u32::from(run.state().crushed);
            let p = run.position();
            let told = format!("{played:?} at {rate} Hz, left {base} m/s: {p}");
            assert!(p.y <= start.y + 0.01, "{told}: rises");
            assert!((p.z - start.z).abs() < 0.5, "{told}: goes aside");
        }
        assert!(crushed > 20, "{crushed} ticks");
    }
}

/// Jumps off a deck of 15 m/s against a cliff, then pulls the stick away from it.
pub(crate) fn steering_away_from_a_cliff_counts_from_the_cliff() {
    for (&played, rate) in pairs(kinds(), RATES) {
        let mut config = ClimberConfig::walker();
        config.ground.air_acceleration = 10.0;
        let cliff = Shape::boxed(DVec3::new(2.0, -90.0, -9.0), DVec3::new(9.0, 60.0, 9.0));
        let stage = Stage::at_rate(played, rate).with_still(&cliff);
        let deck = DVec3::X * 15.0;
        let mut run = flying(stage, config, deck + DVec3::Y * 5.0, deck);
        let mut hit = 0;
        for tick in 0..(1.5 * rate) as u32 {
            let has_hit = run.position().x > 1.59;
            if has_hit && hit == 0 {
                hit = tick;
            }
            let stick = if hit > 0 { DVec3::NEG_X } else { DVec3::ZERO };
            run.step(&walk(stick));
            let since = f64::from(tick - hit.min(tick)) / rate;
            if hit > 0 && since > 0.5 {
                let vx = run.state().velocity.x;
                let told = format!("{played:?} at {rate} Hz, {since} s after the hit");
                assert!((vx + 3.0).abs() < 0.01, "{told}: {vx} m/s");
            }
        }
        assert!(hit > 0 && run.mode() == ClimberMode::Falling);
    }
}

/// The frame is kept for a second, and becomes the air's frame in the next second.
pub(crate) fn the_frame_of_a_fall_becomes_that_of_the_air() {
    for (&played, rate) in pairs(kinds(), RATES) {
        let mut config = ClimberConfig::walker();
        config.ground.air_acceleration = 8.0;
        let far = Shape::floor(3.0).placed(&shifted(DVec3::NEG_Y * 900.0));
        let stage = Stage::at_rate(played, rate).with_still(&far);
        let train = DVec3::new(20.0, 4.0, 0.0);
        let mut run = flying(stage, config, train, train);
        for tick in 1..=(3.0 * rate) as u32 {
            run.step(&IDLE);
            let time = f64::from(tick) / rate;
            let share = (2.0 - time).clamp(0.0, 1.0);
            let off = run.state().base_velocity.distance(train * share);
            assert!(off < 1e-6, "{played:?} at {rate} Hz, {time} s: {off} m/s");
        }
    }
}

/// Slopes of every steepness above the limit, every acceleration: only a jump gains height.
pub(crate) fn steering_in_the_air_climbs_no_steep_slope() {
    let accelerations = [10.0, 13.0, 20.0, 30.0, 100.0];
    let slopes = [53.0, 60.0, 65.0, 70.0, 80.0];
    for (acceleration, degrees, &played) in triples(accelerations, slopes, kinds()) {
        let mut config = ClimberConfig::walker();
        config.ground.air_acceleration = acceleration;
        // The slope's edge lies in the ground at x = 0.
        let slope = Shape::boxed(DVec3::new(-0.5, -1.0, -20.0), DVec3::new(60.0, 0.0, 20.0));
        let angle = radians(degrees);
        let stage = Stage::new(played)
            .with_still(&Shape::floor(20.0))
            .with(&slope, move |_| turned(DVec3::Z, angle));
        let mut run = Run::new(stage, config, DVec3::new(-2.0, 0.02, 0.0)).settle();
        let (start, mut top) = (run.position().y, 0.0f64);
        for tick in 0..480 {
            let mut input = walk(DVec3::new(1.0, 0.0, 0.02));
            input.jump = tick % 60 == 50;
            run.step(&input);
            top = top.max(run.position().y - start);
        }
        // A jump rises by 1.27 m; the walk's 3 m/s, turned up along the slope, by less than 0.46 m.
        let told = format!("{played:?}, {acceleration} m/s^2, {degrees} degrees");
        assert!(top < 1.75, "{told}: {top} m up");
    }
}
