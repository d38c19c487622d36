//! On its feet.

use glam::DVec3;

use super::flying::GRAZING;
use super::{Carried, Step};
use crate::mover::Touch;
use crate::{ClimberEvent, ClimberMode, Support};

/// Pushed farther than this share of the radius from where it would stand upright on its material point, be it by and
/// by, it looks for new ground.
const SHOVED: f64 = 0.1;

impl Step<'_> {
    pub(super) fn stand(&mut self) {
        let was = self.state.velocity;
        let Some(carried) = self.carry() else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
            return self.fly();
        };
        self.stand_carried(&carried, was);
    }

    /// Once it has been carried; `was` is its velocity before that.
    pub(super) fn stand_carried(&mut self, carried: &Carried, was: DVec3) {
        let normal = carried.support.normal_in_world();
        if self.is_thrown(normal, was) || self.is_knocked_down(was) {
            return self.fly();
        }
        // From where it has been carried.
        self.state.position = carried.position;
        if self.grip_or_catch() {
            return;
        }
        self.state.position = self.began;
        let limit = self.stood_on();
        if self.config.slope(normal) > limit && !self.is_wedged(carried) {
            self.event(ClimberEvent::Slipped);
            self.leave(ClimberMode::Sliding);
            return self.fly();
        }
        let walk = self.walk_velocity(normal);
        if self.state.jump_buffer > 0.0 {
            return self.jump(walk);
        }
        if walk == DVec3::ZERO {
            self.stay(carried);
        } else {
            self.walk(carried, walk);
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
        let support = &carried.support;
        let radius = self.config.body.radius;
        let upright = support.contact + support.normal_in_world() * radius;
        if moved.position.distance(upright) > SHOVED * radius {
            self.find_ground(carried, DVec3::ZERO);
            return;
        }
        if moved.position == carried.position {
            return;
        }
        self.state.support = Some(Support {
            offset: support.frame.conjugate() * (moved.position - support.contact),
            ..*support
        });
    }

    /// Walks relative to what carried it, and finds new ground.
    fn walk(&mut self, carried: &Carried, walk: DVec3) {
        self.face(walk);
        let limit = self.stood_on();
        let (up, normal) = (self.config.up(), carried.support.normal_in_world());
        // Pressed onto the ground, so that the ground is among what it touches; between slopes onto all of them alike.
        let onto = if self.config.slope(normal) > limit {
            up
        } else {
            normal
        };
        let press = onto * (PRESS * self.config.body.skin_width);
        let target = carried.position + walk * self.dt();
        let mut path = self.path(carried.start, target - press, carried.swept);
        path.walkable = Some((up, libm::cos(limit)));
        let moved = self.slide_along(&path);
        self.report.pushed_out -= press;
        self.state.position = moved.position;
        if self.step_up(carried.position, target) {
            self.find_ground(carried, walk);
            return;
        }
        match self.held_up_by(limit) {
            Some(touch) => self.stand_on(carried, &touch),
            None => self.find_ground(carried, walk),
        }
    }

    /// Stands where it is.
    fn stand_on(&mut self, carried: &Carried, touch: &Touch) {
        self.attach(touch);
        self.state.velocity =
            carried.motion.velocity + (self.state.position - carried.position) / self.dt();
    }

    /// Where walking was blocked: over a step, if there is one; whether it is on it now.
    fn step_up(&mut self, from: DVec3, target: DVec3) -> bool {
        let up = self.config.up();
        let level = |v: DVec3| v - up * v.dot(up);
        let wanted = level(target - from);
        let direction = wanted.normalize_or_zero();
        let missing = wanted.length() - level(self.state.position - from).dot(direction);
        let height = self.config.ground.step_height;
        if height == 0.0 || missing <= wanted.length() * BLOCKED {
            return false;
        }
        let mut core = super::body(self.config, &self.state);
        core.radius = self.config.body.hard_radius();
        let room = self.world.cast(&core, up * height);
        // Not up to the touch, or what is above would be on every way from there.
        let rise = room.map_or(height, |(_, hit)| {
            (height * hit.time - self.config.body.skin_width).max(0.0)
        });
        let rise = up * rise;
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
        position.is_some()
    }

    /// How far the ball has to go from where an edge first stops it to where it stands on that edge.
    fn onto_a_tread(&self) -> f64 {
        let steepest = libm::sin(self.config.ground.max_slope);
        self.config.body.radius * (1.0 - steepest) + self.config.body.skin_width
    }

    /// Where it stands after a step up, if that is level enough, higher than here, and below what is above it there.
    fn tread_below(&mut self, over: DVec3, depth: f64) -> Option<DVec3> {
        let ground = self.ground_straight_below(over, depth)?;
        let up = self.config.up();
        let rise = (ground.position - self.state.position).dot(up);
        let is_level = self.config.slope(ground.touch.away) <= self.config.ground.max_slope;
        if !is_level || rise <= self.config.body.skin_width {
            return None;
        }
        // Its skin stands off what its core has come down on: perhaps higher than from where that came.
        let lift = (ground.position - over).dot(up);
        let body = super::body(self.config, &self.state).moved(over - self.state.position);
        let core = body.with_radius(self.config.body.hard_radius());
        let is_free = lift <= 0.0 || self.world.cast(&core, up * lift).is_none();
        is_free.then_some(ground.position)
    }

    /// Stands on what is below it now, or leaves the ground.
    fn find_ground(&mut self, carried: &Carried, walk: DVec3) {
        let reach = self.config.ground.snap_distance;
        if let Some(ground) = self.ground_below(self.state.position, reach) {
            let moved = self.slide(ground.position, ground.position, false);
            self.state.position = moved.position;
            self.stand_on(carried, &ground.touch);
            return;
        }
        let limit = self.stood_on();
        if let Some(touch) = self.held_up_by(limit) {
            self.stand_on(carried, &touch);
            return;
        }
        self.state.velocity += walk;
        if self.is_on_slope(limit) {
            self.event(ClimberEvent::Slipped);
            self.leave(ClimberMode::Sliding);
        } else {
            self.event(ClimberEvent::LostFooting);
            self.leave(ClimberMode::Falling);
        }
    }

    /// A slope that tips is slipped on; over the edge of level ground, the ground ends, whichever of the two faces that meet
    /// there is said to touch.
    fn is_on_slope(&mut self, limit: f64) -> bool {
        let up = self.config.up();
        let skin = self.config.body.skin_width;
        let mut body = super::body(self.config, &self.state);
        body.radius += skin;
        self.world.touching(&body);
        let is_steep = |touch: &Touch| self.config.slope(touch.contact.normal) > limit;
        let ends = |slope: &Touch| {
            let mut level = self.world.found().iter().filter(|touch| !is_steep(touch));
            level.any(|touch| touch.contact.point.distance(slope.contact.point) <= skin)
        };
        let mut touched = self.world.touched().iter();
        touched.any(|touch| touch.away.dot(up) > GRAZING && is_steep(touch) && !ends(touch))
    }

    /// Slopes on all sides hold it up.
    fn is_wedged(&mut self, carried: &Carried) -> bool {
        let down = carried.position - self.config.up() * self.config.body.skin_width;
        // A trial, of which nothing stays.
        let before = (self.report.clone(), self.state.crouched);
        self.slide(carried.start, down, carried.swept);
        (self.report, self.state.crouched) = before;
        self.holding_up(0.0).is_some()
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

/// With this share of the skin width it is pressed onto the ground that it walks on.
const PRESS: f64 = 0.5;

/// Share of a way that may be missing before it counts as blocked.
const BLOCKED: f64 = 0.05;
