//! Climbers on the giants.

use std::error::Error;

use clamber::climber::{Climber, ClimberConfig, ClimberInput, ClimberMode, ClimberState};
use clamber::world::{Obstacle, ObstacleId};
use glam::DVec3;
use rayon::prelude::*;

use crate::herd::{Herd, RATE, Seat};

/// Smallest Y of a seat's unit normal, so that a climber can stand there while the giant walks.
const LEVEL: f32 = 0.85;

/// The largest number of riders that a thread takes at a time. By default rayon halves a list only two or three times,
/// and one thread then waits for the other's last piece: a tenth of a millisecond for each dozen riders.
const GRAIN: usize = 16;

/// Distance from its seat at which a climber is put back, metres.
const AWAY: f64 = 4.0;

pub(crate) struct Riders {
    climbers: Vec<Climber>,
    seats: Vec<Seat>,
}

impl Riders {
    /// `count` climbers with seats on level skin, spread over the first `mounts` giants.
    pub(crate) fn new(herd: &Herd, count: usize, mounts: usize) -> Result<Self, Box<dyn Error>> {
        let mut rng = fastrand::Rng::with_seed(9);
        let mut seats = Vec::with_capacity(count);
        while seats.len() < count {
            // The riders of a giant are side by side in the list, so that threads share few giants.
            let (seat, up) = herd.seat(seats.len() * mounts / count, &mut rng)?;
            if up > LEVEL {
                seats.push(seat);
            }
        }
        let climber = || Climber::new(ClimberConfig::default(), DVec3::Y * 1e4);
        let climbers = (0..count).map(|_| climber()).collect::<Result<_, _>>()?;
        Ok(Self { climbers, seats })
    }

    /// Puts climbers that fell or walked off back, just above their seats.
    pub(crate) fn sit(&mut self, herd: &Herd) -> Result<(), Box<dyn Error>> {
        for (climber, seat) in self.climbers.iter_mut().zip(&self.seats) {
            herd.sit(climber, seat, AWAY)?;
        }
        Ok(())
    }

    /// Runs one tick of all climbers.
    pub(crate) fn step(
        &mut self,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
    ) -> Result<(), Box<dyn Error>> {
        for (index, climber) in self.climbers.iter_mut().enumerate() {
            climber.step(&input(index), obstacles, 1.0 / RATE)?;
        }
        Ok(())
    }

    /// As [`Riders::step`], on rayon's threads.
    pub(crate) fn step_in_parallel(
        &mut self,
        obstacles: &[(ObstacleId, &(dyn Obstacle + Sync))],
    ) -> Result<(), Box<dyn Error>> {
        let stepped = self.climbers.par_iter_mut().enumerate().with_max_len(GRAIN);
        let stepped = stepped.try_for_each_init(
            || -> Vec<(ObstacleId, &dyn Obstacle)> {
                let all = obstacles.iter();
                all.map(|(id, obstacle)| (*id, *obstacle as &dyn Obstacle))
                    .collect()
            },
            |obstacles, (index, climber)| {
                climber.step(&input(index), obstacles, 1.0 / RATE).map(drop)
            },
        );
        Ok(stepped?)
    }

    pub(crate) fn states(&self) -> Vec<ClimberState> {
        self.climbers
            .iter()
            .map(|climber| *climber.state())
            .collect()
    }

    /// Share of the climbers that stand, 0 to 1.
    pub(crate) fn standing(&self) -> f64 {
        let modes = self.climbers.iter().map(|climber| climber.state().mode);
        let standing = modes.filter(|mode| *mode == ClimberMode::Standing).count();
        standing as f64 / self.climbers.len() as f64
    }
}

/// The input of a climber. Every other climber walks, in one of eight directions.
fn input(index: usize) -> ClimberInput {
    let direction = [
        (1, 0),
        (1, 1),
        (0, 1),
        (-1, 1),
        (-1, 0),
        (-1, -1),
        (0, -1),
        (1, -1),
    ];
    let (x, z) = direction[index / 2 % 8];
    let walk = DVec3::new(f64::from(x), 0.0, f64::from(z)).normalize();
    ClimberInput {
        walk: walk * (index % 2) as f64,
        ..ClimberInput::default()
    }
}
