//! Measures a tick of climbers that are obstacles to each other.
//!
//! Climbers walk on level ground, 2 m apart, each in its own circle, as one [`ClimberGroup`]. They are stepped in two
//! ways: with all others among their obstacles, and with the ground alone.

use std::error::Error;
use std::time::Instant;

use clamber::prelude::*;
use clamber::world::HalfSpace;
use clamber_scenes::climbs::RATE;
use clamber_scenes::measure::{Cells, quantile};
use glam::DVec3;

/// Length of a tick, seconds.
const DT: f64 = 1.0 / RATE;

/// Adds rows for 2, 8, 64 and 512 climbers.
pub(crate) fn measure(ticks: u32, cells: &mut Cells) -> Result<(), Box<dyn Error>> {
    for count in [2, 8, 64, 512] {
        let alone = tick(count, ticks, false)?;
        let together = tick(count, ticks, true)?;
        let name = format!("{count} climbers on level ground, us for each");
        cells.value(&format!("{name}, as if alone"), alone);
        cells.value(&format!("{name}, as obstacles to each other"), together);
    }
    Ok(())
}

/// The median time of a tick divided by the number of climbers, microseconds.
fn tick(count: u64, ticks: u32, together: bool) -> Result<f64, Box<dyn Error>> {
    let ground = HalfSpace::below(0.0);
    let side = (count as f64).sqrt().ceil() as u64;
    let place = |id: u64| DVec3::new((id % side) as f64, 0.2, (id / side) as f64) * 2.0;
    let mut climbers = (0..count)
        .map(|id| {
            Ok((
                ObstacleId(id + 1),
                Climber::new(ClimberConfig::walker(), place(id))?,
            ))
        })
        .collect::<Result<Vec<_>, ClimberError>>()?;
    let (mut group, mut times) = (ClimberGroup::default(), Vec::new());
    for tick in 0..ticks {
        let angle = f64::from(tick) * DT * 4.0;
        let walk = DVec3::new(libm::cos(angle), 0.0, libm::sin(angle));
        let input = ClimberInput {
            walk,
            ..ClimberInput::IDLE
        };
        let start = Instant::now();
        let ground: [(ObstacleId, &dyn Obstacle); 1] = [(ObstacleId(0), &ground)];
        if together {
            let all = climbers.iter().map(|(id, climber)| (*id, climber));
            group.update(all, &ground, DT);
        }
        let mut around = Vec::new();
        for (id, climber) in &mut climbers {
            let rules = StepRules {
                id: Some(*id),
                ..StepRules::default()
            };
            around.clear();
            around.extend_from_slice(&ground);
            if together {
                around.extend(group.others(*id));
            }
            climber.step_with(&input, &around, &rules, DT)?;
        }
        times.push(start.elapsed().as_secs_f64() * 1e6 / count as f64);
    }
    Ok(quantile(&mut times, 0.5))
}
