//! What moves below a creature carries it: a ship that turns, a lift that rises.

use clamber_world::PointMotion;
use glam::{DQuat, DVec3};

use super::state::{GROUND, NO_GROUND};
use super::{Creature, Surroundings};
use crate::angle::nearest_turn;
use crate::feet::Carried;

/// Ground carries it that is no further from its origin than this share of its height.
const NEAR: f64 = 0.15;

impl Creature {
    /// Goes with the ground, as that has moved in this tick: the creature's place and heading, its feet, and the places
    /// that it knows. Returns true if the ground moved.
    pub(super) fn be_carried(&mut self, around: &Surroundings<'_>, dt: f64) -> bool {
        let Some(motion) = self.ground_motion(around, dt) else {
            return false;
        };
        let carried = Carried {
            from: motion.previous_position,
            to: motion.position,
            turn: motion.turn,
            yaw: yaw_of(motion.turn),
        };
        let state = &mut self.state;
        let known = [
            &mut state.position,
            &mut state.home,
            &mut state.patrol,
            &mut state.noise,
        ];
        let prey = state.prey.iter_mut().map(|(_, place)| place);
        for place in known
            .into_iter()
            .chain(prey)
            .chain(&mut state.walked.corners)
        {
            *place = carried.place(*place);
        }
        state.gaze.value = carried.place(state.gaze.value);
        state.gaze.velocity = carried.vector(state.gaze.velocity);
        state.aim = carried.vector(state.aim);
        state.yaw = nearest_turn(state.yaw + carried.yaw);
        state.hips.turn(&carried);
        for foot in &mut state.feet {
            foot.be_carried(&carried);
        }
        // The ground below the places at which it is looked for.
        let rise = motion.position.y - motion.previous_position.y;
        for level in state.ground.iter_mut().take(GROUND) {
            if *level < NO_GROUND {
                *level += rise;
            }
        }
        true
    }

    /// How the ground below it has moved in this tick; `None` if it has not, or if there is none.
    fn ground_motion(&self, around: &Surroundings<'_>, dt: f64) -> Option<PointMotion> {
        let reach = NEAR * self.size.height;
        let from = self.state.position + DVec3::Y * reach;
        let hits = around.terrain.iter().filter_map(|obstacle| {
            // Where the ground was in this tick's beginning, the creature still is.
            let hit = obstacle.cast_ray(from, DVec3::NEG_Y, 2.0 * reach)?;
            Some((hit, obstacle))
        });
        let (hit, obstacle) = hits.max_by(|a, b| a.0.point.y.total_cmp(&b.0.point.y))?;
        let motion = obstacle.motion(&hit.material, dt)?;
        let moves = motion.position != motion.previous_position || motion.turn != DQuat::IDENTITY;
        (moves && !motion.placed && motion.is_finite()).then_some(motion)
    }
}

/// The turn about up of a rotation, radians: its twist about Y.
fn yaw_of(turn: DQuat) -> f64 {
    nearest_turn(2.0 * libm::atan2(turn.y, turn.w))
}
