//! A wall run from the air: up to 1.5 s along walls in all, until the climber stands on its feet again.

use clamber::climber::{ClimberMode, CustomMode, ModeContext, NextMode};
use clamber::glam::DVec3;
use clamber::mover::MoverContact;

/// Index into [`ModeContext::memory`] of the seconds of wall runs since the climber last stood.
const RAN: usize = 3;

/// Largest distance of the wall from the body, metres.
const REACH: f64 = 0.15;

/// Sine of the largest angle by which a wall may lean: 12 degrees.
const LEAN: f64 = 0.2;

/// Speed of the run, metres a second.
const SPEED: f64 = 5.0;
/// Least speed along the wall at which a run begins, metres a second.
const LEAST_SPEED: f64 = 1.5;

/// Longest run, seconds.
const DURATION: f64 = 1.5;

/// The handler of wall runs. A run goes on while the bit `action` of the input's `actions` is held.
pub(crate) struct WallRun {
    pub(crate) action: u32,
}

/// The nearest wall beside the climber. The edge at a wall's end does not count.
fn wall_beside(context: &mut ModeContext<'_, '_>) -> Option<MoverContact> {
    let (body, up, position) = (context.body(), context.up(), context.position());
    let touches = context.mover().overlap(&body, position, REACH);
    let is_wall = |touch: &&MoverContact| {
        touch.normal.dot(up).abs() < LEAN && touch.normal.dot(touch.contact.normal) > 0.9
    };
    let distance = |touch: &&MoverContact| touch.contact.distance;
    let walls = touches.iter().filter(is_wall);
    let nearest = walls.min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.copied()
}

/// The level part of a vector along the touched face, not around its edges.
fn along(wall: &MoverContact, vector: DVec3, up: DVec3) -> DVec3 {
    let level = wall.contact.normal.cross(up).normalize_or_zero();
    level * level.dot(vector)
}

impl CustomMode for WallRun {
    fn id(&self) -> u16 {
        3
    }

    fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
        let (mode, input) = (context.state().mode, *context.input());
        if mode == ClimberMode::Standing {
            context.custom_slots()[RAN] = 0.0;
        }
        let may_run = context.custom_slots()[RAN] + 0.5 * context.dt() < DURATION;
        if mode != ClimberMode::Falling || input.actions & self.action == 0 || !may_run {
            return false;
        }
        let own = context.velocity() - context.base_velocity();
        let up = context.up();
        let run = wall_beside(context).map(|wall| along(&wall, own, up));
        let run = run.filter(|run| run.length() > LEAST_SPEED);
        let run = run.filter(|run| run.dot(input.walk) > 0.5 * run.length());
        run.inspect(|run| context.face(*run)).is_some()
    }

    fn step(&self, context: &mut ModeContext<'_, '_>) -> NextMode {
        let (input, velocity, dt) = (*context.input(), context.velocity(), context.dt());
        let (heading, up) = (context.state().heading, context.up());
        let wants = input.actions & self.action != 0 && context.knockback().is_none();
        let (Some(wall), true) = (wall_beside(context), wants) else {
            return context.let_go();
        };
        if input.jump {
            let jump = (wall.normal + up) * context.config().ground.jump_speed;
            return context.fall(velocity + jump);
        }
        context.custom_slots()[RAN] += dt;
        let is_last = context.custom_slots()[RAN] + 0.5 * dt > DURATION;
        // From now on velocities are relative to the wall, which may move.
        context.attach(&wall);
        let run = along(&wall, heading, up).normalize_or_zero() * SPEED;
        let gap = (wall.contact.distance - context.body().radius).max(0.0);
        let toward = wall.normal * (gap / dt).min(SPEED);
        let base = context.base_velocity();
        context.move_by(base + run - toward);
        context.face(run);
        let own = context.state().velocity - base;
        if is_last || own.dot(run) < 0.5 * run.length_squared() {
            return context.let_go();
        }
        NextMode::Stay
    }
}
