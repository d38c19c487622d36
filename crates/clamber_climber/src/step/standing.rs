//! On its feet.

use glam::DVec3;

use super::{Carried, SLOPE_HYSTERESIS, Step};
use crate::{ClimberEvent, ClimberMode, Support};

/// Pushed farther than this share of the radius, and two skin widths, from where it stands straight on its point, it looks
/// for new ground. On slopes a core that came straight down leaves it up to a skin width or so off.
const SHOVED: f64 = 0.1;

impl Step<'_> {
    pub(super) fn stand(&mut self) {
        let was = self.state.velocity;
        let Some(carried) = self.carry() else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        let normal = carried.support.normal_in_world();
        if self.is_thrown(normal, was) || self.is_knocked_down(was) {
            return self.fly();
        }
        if self.grip_or_catch() {
            return;
        }
        let limit = self.config.ground.max_slope + SLOPE_HYSTERESIS;
        if self.config.slope(normal) > limit && !self.is_wedged(&carried) {
            self.event(ClimberEvent::Slipped);
            self.leave(ClimberMode::Sliding);
            return self.fly();
        }
        let walk = self.walk_velocity(normal);
        if self.state.jump_buffer > 0.0 {
            return self.jump(walk);
        }
        if walk == DVec3::ZERO {
            self.stay(&carried);
        } else {
            self.walk(&carried, walk);
        }
    }

    /// Off the ground, with the velocity of what it leaves.
    pub(super) fn jump(&mut self, walk: DVec3) {
        self.state.velocity += walk + self.config.up() * self.config.ground.jump_speed;
        self.event(ClimberEvent::Jumped);
        self.state.jump_buffer = 0.0;
        self.state.coyote = 0.0;
        self.leave(ClimberMode::Falling);
        self.fly();
    }

    /// Stays on its material point, leaning where it is pushed.
    fn stay(&mut self, carried: &Carried) {
        let moved = self.slide(carried.start, carried.position, carried.swept);
        self.state.position = moved.position;
        if moved.position == carried.position {
            return;
        }
        // In all, not in this tick: what pushes slowly would else push it off its point by metres.
        let body = &self.config.body;
        let upright = carried.support.normal_in_world() * body.radius;
        let leaning = (moved.position - carried.support.contact).distance(upright);
        if leaning > SHOVED * body.radius + 2.0 * body.skin_width {
            self.find_ground(carried, DVec3::ZERO);
            return;
        }
        let support = &carried.support;
        self.state.support = Some(Support {
            offset: support.frame.conjugate() * (moved.position - support.contact),
            ..*support
        });
    }

    /// Walks relative to what carried it, and finds new ground.
    fn walk(&mut self, carried: &Carried, walk: DVec3) {
        self.face(walk);
        let target = carried.position + walk * self.dt();
        let mut path = self.path(carried.start, target, carried.swept);
        let limit = self.config.ground.max_slope + SLOPE_HYSTERESIS;
        path.walkable = Some((self.config.up(), libm::cos(limit)));
        let moved = self.slide_along(&path);
        self.state.position = moved.position;
        self.step_up(carried.position, target);
        self.find_ground(carried, walk);
    }

    /// Where walking was blocked: over a step, if there is one.
    fn step_up(&mut self, from: DVec3, target: DVec3) {
        let up = self.config.up();
        let level = |v: DVec3| v - up * v.dot(up);
        let wanted = level(target - from);
        let direction = wanted.normalize_or_zero();
        let missing = wanted.length() - level(self.state.position - from).dot(direction);
        let height = self.config.ground.step_height;
        if height == 0.0 || missing <= wanted.length() * BLOCKED {
            return;
        }
        let mut core = super::body(self.config, &self.state);
        core.radius = self.config.body.hard_radius();
        let room = self.world.cast(&core, up * height);
        let rise = up * (height * room.map_or(1.0, |(_, hit)| hit.time));
        let raised = core.moved(rise);
        let position = [missing, self.onto_a_tread().max(missing)]
            .into_iter()
            .find_map(|way| {
                let forward = direction * way;
                let is_free = self.world.cast(&raised, forward).is_none();
                let over = self.state.position + rise + forward;
                is_free
                    .then(|| self.tread_below(over, rise.length()))
                    .flatten()
            });
        self.state.position = position.unwrap_or(self.state.position);
    }

    /// How far the ball has to go from where an edge first stops it to where it stands on that edge.
    fn onto_a_tread(&self) -> f64 {
        let steepest = libm::sin(self.config.ground.max_slope);
        self.config.body.radius * (1.0 - steepest) + self.config.body.skin_width
    }

    /// Where it stands after a step up, if that is level enough, and higher than here.
    fn tread_below(&mut self, over: DVec3, depth: f64) -> Option<DVec3> {
        let ground = self.ground_straight_below(over, depth)?;
        let rise = (ground.position - self.state.position).dot(self.config.up());
        let is_level = self.config.slope(ground.touch.away) <= self.config.ground.max_slope;
        (is_level && rise > self.config.body.skin_width).then_some(ground.position)
    }

    /// Stands on what is below it now, or leaves the ground.
    fn find_ground(&mut self, carried: &Carried, walk: DVec3) {
        let reach = self.config.ground.snap_distance;
        if let Some(ground) = self.ground_below(self.state.position, reach) {
            self.state.position = ground.position;
            self.attach(&ground.touch);
            self.state.velocity += (ground.position - carried.position) / self.dt();
            return;
        }
        let limit = self.config.ground.max_slope + SLOPE_HYSTERESIS;
        if let Some(touch) = self.held_up_by(limit) {
            self.attach(&touch);
            self.state.velocity += (self.state.position - carried.position) / self.dt();
            return;
        }
        let is_steep = self
            .world
            .touched()
            .iter()
            .any(|touch| touch.away.dot(self.config.up()) > 0.0);
        self.state.velocity += walk;
        if is_steep {
            self.event(ClimberEvent::Slipped);
            self.leave(ClimberMode::Sliding);
        } else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
        }
    }

    /// Slopes on all sides hold it up.
    fn is_wedged(&mut self, carried: &Carried) -> bool {
        let down = carried.position - self.config.up() * self.config.body.skin_width;
        self.slide(carried.start, down, carried.swept);
        self.held_up_by(0.0).is_some()
    }

    /// What the input asks for, along the ground.
    fn walk_velocity(&self, normal: DVec3) -> DVec3 {
        let up = self.config.up();
        let walk = self.input.walk;
        let level = walk - up * walk.dot(up);
        let share = level.length().min(1.0);
        let along = level - normal * level.dot(normal);
        along.normalize_or_zero() * (share * self.config.ground.walk_speed)
    }
}

/// Share of a way that may be missing before it counts as blocked.
const BLOCKED: f64 = 0.05;
