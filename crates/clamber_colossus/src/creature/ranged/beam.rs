use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::line::Line;
use crate::brain::{Beam, StateId};
use crate::creature::report::{ActiveBeam, StrikeHit};
use crate::creature::{Creature, Surroundings};

/// Distance that the end of a beam moves between two checks, metres, in addition to the beam's radius.
const BEAM_CHECK_STEP: f64 = 0.3;

/// Most checks in a tick.
const MOST_STEPS: f64 = 32.0;

/// Start and direction of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Ray {
    pub(super) from: DVec3,
    pub(super) direction: DVec3,
}

impl Creature {
    /// Moves the beam from its place in the last tick to a new start and towards the target, and strikes the people
    /// that it touches on the way.
    pub(super) fn shine(
        &mut self,
        state: StateId,
        from: DVec3,
        file: &Beam,
        around: &Surroundings<'_>,
    ) {
        let way = self.state.ranged.mark - from;
        let direction = way.try_normalize().unwrap_or(self.state.heading());
        let now = Ray { from, direction };
        let was = self.state.ranged.beam.replace(now).unwrap_or(now);
        let moved = was.from.distance(from) + file.length * was.direction.distance(direction);
        let steps = (moved / (BEAM_CHECK_STEP + file.radius))
            .ceil()
            .clamp(1.0, MOST_STEPS);
        for step in 1..=steps as u32 {
            let share = f64::from(step) / steps;
            let turned = was.direction.lerp(direction, share);
            let ray = Ray {
                from: was.from.lerp(from, share),
                direction: turned.try_normalize().unwrap_or(direction),
            };
            self.shine_along(ray, state, file, around);
        }
    }

    fn shine_along(&mut self, ray: Ray, state: StateId, file: &Beam, around: &Surroundings<'_>) {
        let line = Line {
            from: ray.from,
            way: ray.direction * file.length,
            radius: file.radius,
        };
        let end = line.stop(0.0, around).map_or(1.0, |(share, _)| share);
        self.report.beam = Some(ActiveBeam {
            state,
            from: ray.from,
            to: line.at(end),
            radius: file.radius,
        });
        let people = if file.strikes() { around.people } else { &[] };
        for person in people {
            if self.state.striking.struck().contains(&person.id) {
                continue;
            }
            let touched = line.touch(person, around);
            let Some(share) = touched.filter(|share| *share <= end) else {
                continue;
            };
            self.mark_struck(person.id);
            self.report.blows.push(StrikeHit {
                person: person.id,
                velocity: ray.direction * file.throw,
                damage: file.damage,
                place: line.at(share),
                state,
            });
        }
    }
}
