//! A scene, and how a character fares in it.

use glam::DVec3;

use super::set::{IDLE, Input, Set};
use super::{ground, platforms, walls};
use crate::SceneError;
use crate::measure::{larger, quantile};

/// A character's positions in a scene.
pub struct Seen {
    /// Where it came to rest before anything moved; see [`Controller::position`](super::Controller::position).
    pub start: DVec3,
    /// The position after each tick.
    pub positions: Vec<DVec3>,
    /// Seconds a tick.
    pub dt: f64,
}

impl Seen {
    /// The last position.
    pub fn end(&self) -> DVec3 {
        self.positions.last().copied().unwrap_or(self.start)
    }

    /// The largest value of a function of time and position; at least 0.
    pub fn most(&self, of: impl Fn(f64, DVec3) -> f64) -> f64 {
        let ticks = self.positions.iter().enumerate();
        let values = ticks.map(|(tick, p)| of(self.dt * (tick as f64 + 1.0), *p));
        values.fold(0.0, larger)
    }
}

/// A scene: a set, an input for each tick, and an error that is measured after the last.
pub struct Scene {
    /// The number of the scenario in `clamber_climber`'s table that it follows.
    pub number: u32,
    /// What is played, for reports.
    pub name: &'static str,
    /// The largest error that passes, in metres.
    pub asked: f64,
    /// Length of the scene.
    pub ticks: u32,
    /// Whether the character has to stand in every tick.
    pub always_stands: bool,
    /// The world.
    pub set: Set,
    /// What the character is told in each tick, the first of which is 1.
    pub input: Box<dyn Fn(u32) -> Input>,
    /// Measures the error, in metres; negative counts as 0.
    pub error: Box<dyn Fn(&Seen) -> f64>,
}

impl Scene {
    /// An idle character that has to stand in every tick, with an error of at most a millimetre.
    pub(super) fn new(
        number: u32,
        name: &'static str,
        ticks: u32,
        set: Set,
        error: impl Fn(&Seen) -> f64 + 'static,
    ) -> Self {
        Self {
            number,
            name,
            asked: 1e-3,
            ticks,
            always_stands: true,
            set,
            input: Box::new(|_| IDLE),
            error: Box::new(error),
        }
    }

    /// The same scene with a walk at this velocity, in metres per second.
    pub(super) fn walking(mut self, walk: DVec3) -> Self {
        self.set.speed = walk.length();
        self.input = Box::new(move |_| Input { walk, ..IDLE });
        self
    }

    /// The same scene with another bound for the error, in metres.
    pub(super) fn within(self, asked: f64) -> Self {
        Self { asked, ..self }
    }

    /// The same scene with a character that need not stand in every tick.
    pub(super) fn in_the_air(self) -> Self {
        Self {
            always_stands: false,
            ..self
        }
    }
}

/// All thirty scenes.
pub fn all() -> Vec<Scene> {
    let mut all = platforms::scenes();
    all.extend(walls::scenes());
    all.extend(ground::scenes());
    all
}

/// Ticks in which nothing moves, for the character to come to rest.
const SETTLE: u32 = 60;

/// A character controller in a world of its own.
pub trait Controller {
    /// Takes the world to a time, in seconds, and the character with it. Returns the time that the character's part of
    /// the tick took, in microseconds.
    fn step(&mut self, time: f64, input: &Input) -> Result<f64, SceneError>;

    /// The centre of the capsule's lower ball: [`RADIUS`](super::RADIUS) above the feet.
    fn position(&self) -> DVec3;

    /// Whether the controller reports that it stands on something.
    fn stands(&self) -> bool;
}

/// How a character fared in a scene.
pub struct Outcome {
    /// Metres; NaN if a position was not finite.
    pub error: f64,
    /// Ticks in which it did not stand.
    pub in_air: u32,
    /// Whether the error is within the scene's bound, and it stood throughout where the scene asks for that.
    pub passes: bool,
    /// Median time of a tick, in microseconds.
    pub micros: f64,
}

/// Plays a scene, or its first `most` ticks.
pub fn play(
    scene: &Scene,
    character: &mut dyn Controller,
    most: u32,
) -> Result<Outcome, SceneError> {
    for _ in 0..SETTLE {
        character.step(0.0, &IDLE)?;
    }
    let mut seen = Seen {
        start: character.position(),
        positions: Vec::new(),
        dt: scene.set.dt,
    };
    let mut in_air = 0;
    let mut times = Vec::new();
    for tick in 1..=scene.ticks.min(most) {
        let time = f64::from(tick) * scene.set.dt;
        times.push(character.step(time, &(scene.input)(tick))?);
        seen.positions.push(character.position());
        in_air += u32::from(!character.stands());
    }
    // Checked here, because a scene's error may be that of a part of the positions.
    let is_finite = seen.positions.iter().all(|p| p.is_finite());
    let error = if is_finite {
        larger((scene.error)(&seen), 0.0)
    } else {
        f64::NAN
    };
    Ok(Outcome {
        error,
        in_air,
        passes: error <= scene.asked && !(scene.always_stands && in_air > 0),
        micros: quantile(&mut times, 0.5),
    })
}
