//! The plays of each configuration, at 60 Hz.

use clamber_climber::{
    Climber, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, Knockback, StepReport,
    StepRules,
};
use clamber_world::{HalfSpace, Obstacle, TriangleTerrain};
use glam::{DVec3, Vec3};

use crate::input::{HOLD, IDLE, blow, grip_walk, high_jump, walk};
use crate::scene::{DT, FUR, list_owned};

/// Ticks a second.
const RATE: f64 = 60.0;

/// Longest time in a mode other than standing, holding and hanging, seconds.
const LONGEST: f64 = 10.0;

type Outcome = Result<(), String>;

struct Run {
    climber: Climber,
    obstacles: Vec<Box<dyn Obstacle>>,
    /// The blow in the next step.
    knockback: Option<Knockback>,
}

impl Run {
    fn new(config: &ClimberConfig, position: DVec3, obstacles: Vec<Box<dyn Obstacle>>) -> Self {
        let climber = Climber::new(*config, position).unwrap();
        Self {
            climber,
            obstacles,
            knockback: None,
        }
    }

    fn step(&mut self, input: &ClimberInput) -> StepReport {
        let rules = StepRules {
            knockback: self.knockback.take(),
            ..StepRules::default()
        };
        let obstacles = list_owned(&self.obstacles);
        self.climber
            .step_with(input, &obstacles, &rules, DT)
            .unwrap()
    }

    fn mode(&self) -> ClimberMode {
        self.climber.state().mode
    }

    fn place(&self) -> DVec3 {
        self.climber.state().position
    }

    /// Steps without input until the climber stands.
    fn comes_to_stand(&mut self) -> Outcome {
        for _ in 0..(LONGEST * RATE) as u32 {
            self.step(&IDLE);
            if self.mode() == ClimberMode::Standing {
                return Ok(());
            }
        }
        let state = self.climber.state();
        Err(format!("is {:?} at {} m/s", state.mode, state.velocity))
    }

    /// The climber's mean speed along a direction over a second, after another second.
    fn speed(&mut self, input: &ClimberInput, along: DVec3) -> f64 {
        (0..RATE as u32).for_each(|_| drop(self.step(input)));
        let from = self.place();
        (0..RATE as u32).for_each(|_| drop(self.step(input)));
        (self.place() - from).dot(along)
    }
}

fn floor() -> Box<dyn Obstacle> {
    Box::new(HalfSpace::below(0.0))
}

fn near(what: &str, found: f64, due: f64, slack: f64) -> Outcome {
    let is_near = (found - due).abs() <= 0.05 * due + slack;
    let told = || format!("{what} {found}, configured {due}");
    if is_near { Ok(()) } else { Err(told()) }
}

fn tireless(config: &ClimberConfig) -> ClimberConfig {
    let stamina = None;
    ClimberConfig { stamina, ..*config }
}

fn standing(config: &ClimberConfig) -> Result<Run, String> {
    let height = config.body.radius * 1.5;
    let mut run = Run::new(config, DVec3::Y * height, vec![floor()]);
    run.comes_to_stand()?;
    Ok(run)
}

pub(crate) fn drops_and_stands(config: &ClimberConfig) -> Outcome {
    let mut run = standing(config)?;
    (0..60).for_each(|_| drop(run.step(&IDLE)));
    match run.mode() {
        ClimberMode::Standing => Ok(()),
        mode => Err(format!("{mode:?} a second after it stood")),
    }
}

pub(crate) fn walks(config: &ClimberConfig) -> Outcome {
    let mut run = standing(config)?;
    let walk = walk(DVec3::X);
    let due = config.ground.walk_speed;
    if config.ground.acceleration * 0.9 < due {
        return Ok(());
    }
    let found = run.speed(&walk, DVec3::X);
    near("walks at", found, due, 1e-9)
}

pub(crate) fn jumps(config: &ClimberConfig) -> Outcome {
    let mut run = standing(config)?;
    let from = run.place().y;
    let speed = config.ground.jump_speed;
    let gravity = config.gravity.length();
    let mut top = 0.0f64;
    for tick in 0..=(2.0 * speed / gravity * RATE) as u32 {
        run.step(&high_jump(tick == 0));
        top = top.max(run.place().y - from);
    }
    // The highest position is seen at the end of a tick only.
    let slack = 0.5 * gravity * DT * DT + config.body.margin;
    near("jumps", top, speed * speed / (2.0 * gravity), slack)?;
    run.comes_to_stand()
}

pub(crate) fn falls_from_high(config: &ClimberConfig) -> Outcome {
    let start = DVec3::Y * (config.body.radius * 30.0);
    Run::new(config, start, vec![floor()]).comes_to_stand()
}

pub(crate) fn slides_down(config: &ClimberConfig) -> Outcome {
    let angle = (config.ground.max_slope + 0.2).min(1.55);
    let normal = DVec3::new(-libm::sin(angle), libm::cos(angle), 0.0);
    let slope = HalfSpace::behind(DVec3::ZERO, normal).unwrap();
    let along = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0);
    // Friction leaves a tenth of gravity's acceleration along the slope.
    let radius = config.body.radius;
    let pull = 0.1 * config.gravity.length() * libm::sin(angle);
    let way = (3.0 * radius).min(0.5 * pull * 16.0);
    let start = along * way + normal * (1.01 * radius);
    let lift = DVec3::Y * (radius * (1.0 / libm::cos(angle * 0.5)) - radius).clamp(0.0, radius);
    let mut run = Run::new(config, start + lift, vec![floor(), Box::new(slope)]);
    run.comes_to_stand()
}

pub(crate) fn is_knocked_over(config: &ClimberConfig) -> Outcome {
    let mut run = standing(config)?;
    let speed = libm::sqrt(config.gravity.length() * config.body.radius);
    run.knockback = blow(DVec3::new(3.0, 1.0, 0.5) * speed);
    run.step(&IDLE);
    run.comes_to_stand()
}

/// A climber that holds on to a wall of fur above the ground, if its configuration can.
fn holding(config: &ClimberConfig) -> Result<Option<Run>, String> {
    let radius = config.body.radius;
    let wall = HalfSpace::behind(DVec3::X * radius, DVec3::NEG_X).unwrap();
    let ground = HalfSpace::below(-10.0 * radius);
    let obstacles: Vec<Box<dyn Obstacle>> = vec![Box::new(ground), Box::new(wall.with_tag(FUR))];
    let mut run = Run::new(config, DVec3::ZERO, obstacles);
    run.step(&HOLD);
    let grip = config.grip.unwrap();
    let slow = config.gravity.length() * DT;
    let catches = grip.reach > 0.0 && grip.catch_speed >= slow;
    match (run.mode(), catches) {
        (ClimberMode::Holding, true) => Ok(Some(run)),
        (ClimberMode::Falling, false) => Ok(None),
        (mode, _) => Err(format!("{mode:?} at the wall, catches {catches}")),
    }
}

pub(crate) fn climbs(config: &ClimberConfig) -> Outcome {
    let Some(mut run) = holding(&tireless(config))? else {
        return Ok(());
    };
    let grip = config.grip.unwrap();
    if grip.max_overhang < 1.58 {
        return Ok(());
    }
    let up = grip_walk(DVec3::X);
    let found = run.speed(&up, DVec3::Y);
    near("climbs at", found, grip.climb_speed, 1e-9)
}

pub(crate) fn lets_go(config: &ClimberConfig) -> Outcome {
    let Some(mut run) = holding(config)? else {
        return Ok(());
    };
    for _ in 0..120 {
        run.step(&HOLD);
    }
    run.comes_to_stand()
}

/// A block whose top is at height 0 and whose front is at x = 0, with ground far below.
fn block(radius: f64) -> Vec<Box<dyn Obstacle>> {
    let size = (20.0 * radius) as f32;
    let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z) * size;
    let positions = [
        corner(0.0, 0.0, -1.0),
        corner(0.0, 0.0, 1.0),
        corner(2.0, 0.0, 1.0),
        corner(2.0, 0.0, -1.0),
        corner(0.0, -2.0, -1.0),
        corner(0.0, -2.0, 1.0),
    ];
    let triangles = [[0, 1, 2], [0, 2, 3], [4, 5, 1], [4, 1, 0]];
    let terrain = TriangleTerrain::new(&positions, &triangles, &[], DVec3::ZERO).unwrap();
    let ground = HalfSpace::below(-20.0 * radius);
    vec![Box::new(terrain), Box::new(ground)]
}

/// A climber that hangs from a ledge, if its configuration can.
fn hanging(config: &ClimberConfig) -> Result<Option<Run>, String> {
    let (radius, ledge) = (config.body.radius, config.ledge.unwrap());
    // Hands need room above the edge, and the wall within reach.
    let below = 0.7 * ledge.reach_up;
    let start = DVec3::new(-1.02 * radius, -below, 0.0);
    let mut run = Run::new(config, start, block(radius));
    let ahead = grip_walk(DVec3::X * 0.01);
    run.step(&ahead);
    let can = below > radius && ledge.reach > 0.05 * radius;
    match run.mode() {
        ClimberMode::LedgeHanging => Ok(Some(run)),
        _ if can && ledge.catch_speed > config.gravity.length() * DT => {
            Err(format!("{:?} below the ledge", run.mode()))
        }
        _ => Ok(None),
    }
}

pub(crate) fn hangs(config: &ClimberConfig) -> Outcome {
    let Some(mut run) = hanging(&tireless(config))? else {
        return Ok(());
    };
    for _ in 0..180 {
        run.step(&HOLD);
    }
    let speed = run.climber.state().velocity.length();
    match run.mode() {
        ClimberMode::LedgeHanging if speed == 0.0 => Ok(()),
        // The climber stands if its hands are so low that the body rests on the edge.
        ClimberMode::Standing => Ok(()),
        mode => Err(format!("{mode:?} at {speed} m/s after three seconds")),
    }
}

pub(crate) fn pulls_up(config: &ClimberConfig) -> Outcome {
    let Some(mut run) = hanging(&tireless(config))? else {
        return Ok(());
    };
    // First, the climber is drawn into its place.
    for _ in 0..120 {
        run.step(&HOLD);
    }
    if run.mode() == ClimberMode::Standing {
        return Ok(());
    }
    let up = grip_walk(DVec3::X);
    let due = config.ledge.unwrap().pull_up_time;
    for tick in 1..=((due + 1.0) * 1.1 * RATE) as u32 {
        let report = run.step(&up);
        if report.events.contains(&ClimberEvent::Mantled) {
            return near("pulls up in", f64::from(tick) * DT, due, 2.0 * DT);
        }
    }
    let memory = run.climber.state().ledge_hanging;
    let mode = run.mode();
    Err(format!("{mode:?}, {memory:?} after {due} s and one"))
}
