//! Stepping off an edge, and hanging from it.

use clamber_mover::{Ledge, LedgeProbe};
use glam::DVec3;

use super::super::{NextMode, Tick};
use crate::config::LedgeConfig;
use crate::{ClimberEvent, ClimberMode};

/// Level part of a unit normal, above which the normal tells in which direction an edge leads out. Less is a slope, or
/// rounding.
const LEAST_OUTWARD_PART: f64 = 0.3;

/// Smallest height of the ball's centre above the top of an edge that the climber steps off, as a fraction of the
/// radius.
const LEAST_EDGE_HEIGHT: f64 = 0.3;

/// Distance by which the wall below an edge may bulge out, as a fraction of the radius: the climber then hangs that
/// much farther out.
const MAX_WALL_BULGE: f64 = 0.25;

impl Tick<'_> {
    /// Takes hold of the edge that the climber steps off, and turns to the wall below it, if `grip` is held and there
    /// is room. `position` is the position at which the ground ends, `normal` is the normal of the last contact with
    /// the ground, and `own` is the climber's velocity relative to the ground.
    pub(in super::super) fn drop_to_hang(
        &mut self,
        position: DVec3,
        normal: DVec3,
        own: DVec3,
    ) -> Option<NextMode> {
        let config = self.config.ledge?;
        let has_hands = self.state.stamina > 0.0 && self.state.grip_cooldown == 0.0;
        if !self.input.grip || !has_hands {
            return None;
        }
        let up = self.config.up();
        let level = |v: DVec3| v - up * v.dot(up);
        let going = level(own).try_normalize()?;
        let tilt = level(normal);
        let out = if tilt.length() > LEAST_OUTWARD_PART {
            tilt.normalize_or(going)
        } else {
            going
        };
        if going.dot(out) <= 0.0 {
            return None;
        }
        let passed = own.length() * self.dt();
        let ledge = self.edge_behind(position, out, passed, &config)?;
        if !self.has_room_below(position, &ledge, &config) {
            return None;
        }
        let touch = ledge.touch;
        self.attach(&touch, position);
        self.face(ledge.facing);
        self.state.velocity = self.state.base_velocity;
        self.state.ledge_hanging.returns = true;
        self.event(ClimberEvent::LedgeCaught {
            obstacle: touch.obstacle,
            point: touch.contact.point,
        });
        Some(NextMode::Change(ClimberMode::LedgeHanging))
    }

    /// The edge behind and below a position. Along `out`, the position is past the edge by at most a radius and the
    /// distance that the climber moves in a tick.
    fn edge_behind(
        &mut self,
        position: DVec3,
        out: DVec3,
        passed: f64,
        config: &LedgeConfig,
    ) -> Option<Ledge> {
        let up = self.config.up();
        let body = self.body().crouched();
        let deep = config.drop + body.radius;
        // The search starts from the outermost place where the climber would hang: a radius before the edge, and as far
        // below.
        let probe = LedgeProbe {
            body,
            up,
            facing: -out,
            reach_up: deep,
            reach: body.radius + passed,
            max_slope: self.config.ground.max_slope,
        };
        let from = position + out * body.radius - up * deep;
        let ledge = self.mover.find_ledge(&probe, from)?;
        let below = (position - ledge.touch.contact.point).dot(up);
        let is_edge = below > LEAST_EDGE_HEIGHT * body.radius && self.can_hang_from(&ledge.touch);
        is_edge.then_some(ledge)
    }

    /// True if the ball has room to go out over the edge, down to where it hangs, and there. False if that is no deeper
    /// than a step, which the climber can step down.
    fn has_room_below(&mut self, position: DVec3, ledge: &Ledge, config: &LedgeConfig) -> bool {
        let up = self.config.up();
        let body = self.body().crouched();
        let place = self.place_below(ledge, config);
        let deep = (position - place).dot(up);
        let step = self.config.ground.step_height;
        if deep <= step {
            return false;
        }
        [0.0, MAX_WALL_BULGE].into_iter().any(|bulge| {
            let hung = place - ledge.facing * (bulge * body.radius);
            let beside = hung + up * deep;
            let over = body.core_at(position);
            let before = body.core_at(beside);
            self.mover.is_free(&over, beside - position) && self.mover.is_free(&before, -up * deep)
        })
    }
}
