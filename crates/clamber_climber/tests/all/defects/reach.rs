//! No tick moves the body farther than its speed and its reach allow, and a support out of reach is let go.

use clamber_climber::{Climber, ClimberInput, ClimberMode};
use clamber_surface::surface::SkinnedSurface;
use clamber_world::Obstacle;
use glam::{DVec3, Vec3};

use crate::cases::pairs;
use crate::defects::common::v;
use crate::input::HOLD;
use crate::scene::{DT, FUR, STONE, climber, cuboid, cuboid_at, moved, tick_among};

/// Checks the displacement of a climber in each tick, and how long it keeps a support that is out of reach.
#[derive(Default)]
struct Watch {
    out_of_reach: u32,
}

impl Watch {
    fn step(
        &mut self,
        climber: &mut Climber,
        obstacles: &[&dyn Obstacle],
        input: &ClimberInput,
        told: &str,
    ) {
        let before = *climber.state();
        let report = tick_among(climber, obstacles, input);
        let state = climber.state();
        let config = climber.config();
        let (grip, ledge) = (config.grip.unwrap(), config.ledge.unwrap());
        let speed = before.velocity.length().max(state.velocity.length());
        let fastest = speed.max(3.0 * grip.climb_speed);
        let way = state.position.distance(before.position);
        let arms = match before.mode {
            ClimberMode::Hanging => config.hang.arm_length,
            ClimberMode::LedgeHanging => ledge.reach,
            _ => grip.reach,
        };
        let most = fastest * DT + arms;
        assert!(
            way <= most,
            "{told}: {way} m, most {most}; from {:?} {} at {} to {:?} {} at {}, {:?}",
            before.mode,
            before.position,
            before.velocity,
            state.mode,
            state.position,
            state.velocity,
            report.events
        );
        let radius = config.body.radius;
        let reach = match state.mode {
            ClimberMode::Holding => 1.25 * radius + grip.reach,
            ClimberMode::LedgeHanging => radius + ledge.reach + ledge.reach_up + ledge.drop,
            ClimberMode::Hanging => 1.5 * config.hang.arm_length,
            _ => 1.25 * radius,
        };
        let offset = state
            .support
            .map_or(0.0, |support| support.attachment.offset.length());
        self.out_of_reach = if offset > reach {
            self.out_of_reach + 1
        } else {
            0
        };
        let time = f64::from(self.out_of_reach) * DT;
        assert!(
            time <= 0.25,
            "{told}: {offset} m from its support for {time} s, {state:?}"
        );
    }
}

fn directions() -> impl Iterator<Item = DVec3> {
    (0..26).map(|k| {
        let k = if k < 13 { k } else { k + 1 };
        v(
            f64::from(k % 3 - 1),
            f64::from(k / 3 % 3 - 1),
            f64::from(k / 9 - 1),
        )
        .normalize()
    })
}

/// Walls of fur on five sides.
fn hollow() -> [SkinnedSurface; 5] {
    let half = 1.0;
    [
        (v(-half - 1.0, 0.0, 0.0), Vec3::new(1.0, 3.0, 3.0)),
        (v(half + 1.0, 0.0, 0.0), Vec3::new(1.0, 3.0, 3.0)),
        (v(0.0, 0.0, -half - 1.0), Vec3::new(1.0, 3.0, 1.0)),
        (v(0.0, half + 1.0, 0.0), Vec3::new(1.0, 1.0, 1.0)),
        (v(0.0, -half - 1.0, 0.0), Vec3::new(1.0, 1.0, 1.0)),
    ]
    .map(|(place, half)| cuboid_at(half, FUR, place))
}

#[test]
fn climbing_in_a_hollow_keeps_within_reach() {
    let walls = hollow();
    let obstacles: Vec<&dyn Obstacle> = walls.iter().map(|wall| wall as &dyn Obstacle).collect();
    for (first, second) in pairs(directions(), [DVec3::X, -DVec3::Y, DVec3::Z]) {
        let mut climber = climber(v(0.1, 0.0, -0.55));
        let mut watch = Watch::default();
        for k in 0..90 {
            let climb = if k % 30 < 20 { first } else { second };
            let input = ClimberInput { climb, ..HOLD };
            watch.step(
                &mut climber,
                &obstacles,
                &input,
                &format!("{first} {second} tick {k}"),
            );
        }
    }
}

/// Climbs around the edges of a block, where a plate blocks one of them.
#[test]
fn climbing_around_a_blocked_edge_keeps_within_reach() {
    let block = cuboid(Vec3::ONE, FUR);
    for gap in [0.1, 0.3, 0.5, 0.7, 0.85] {
        let plate = cuboid_at(Vec3::new(0.1, 3.0, 3.0), STONE, v(1.1 + gap, 0.0, 0.0));
        for first in directions() {
            let mut climber = climber(v(0.0, 0.0, 1.42));
            let mut watch = Watch::default();
            for k in 0..120 {
                let climb = if k < 60 { first } else { -DVec3::Z };
                let input = ClimberInput { climb, ..HOLD };
                let told = format!("plate {gap} m from the edge, {first}, tick {k}");
                watch.step(&mut climber, &[&block, &plate], &input, &told);
            }
        }
    }
}

/// The support moves away while a post holds the climber back. Or it moves towards the post, and crushes the climber
/// against it.
fn against_a_post(is_crushed: bool) {
    for (name, start, walk, out) in [
        ("fur", v(0.0, 1.0, 3.42), DVec3::ZERO, DVec3::Z),
        ("ledge", v(0.3, 2.75, 3.45), -DVec3::Z * 0.1, DVec3::Z),
        ("ground", v(0.0, 3.41, 0.0), DVec3::ZERO, DVec3::Y),
    ] {
        let ways = directions().filter(|way| (way.dot(out) > 0.1) == is_crushed);
        for way in ways {
            let speeds = [0.5, 2.0, 8.0, 20.0].into_iter();
            let posts = speeds.flat_map(|speed| [0.1, 0.3, 0.6].map(|half| (speed, half)));
            for (speed, half) in posts {
                let tag = if name == "fur" { FUR } else { STONE };
                let mut block = cuboid(Vec3::new(4.0, 3.0, 3.0), tag);
                let mut climber = climber(start);
                let mut watch = Watch::default();
                for k in 0..20 {
                    moved(&mut block, DVec3::ZERO);
                    let input = ClimberInput { walk, ..HOLD };
                    let told = format!("{name} tick {k}");
                    watch.step(&mut climber, &[&block], &input, &told);
                }
                let place = climber.state().position + way * (0.65 + half);
                let post = cuboid_at(Vec3::splat(half as f32), STONE, place);
                for k in 0..60 {
                    let by = way * (speed * DT * f64::from(k));
                    moved(&mut block, by);
                    let told = format!("{name} goes {way} at {speed} m/s, post {half}, tick {k}");
                    watch.step(&mut climber, &[&block, &post], &HOLD, &told);
                }
            }
        }
    }
}

#[test]
fn a_climber_held_back_by_a_post_lets_go_out_of_reach() {
    against_a_post(false);
}

#[test]
fn a_climber_crushed_against_a_post_is_not_flung() {
    against_a_post(true);
}
