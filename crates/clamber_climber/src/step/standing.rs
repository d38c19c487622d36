//! Standing, walking and jumping.

use clamber_mover::{Ground, GroundProbe, Path, StepUp, Walking};
use glam::DVec3;

use super::carrying::Carried;
use super::moving::{Intent, towards};
use super::{NextMode, Tick};
use crate::{ClimberEvent, ClimberMode};

/// Distance from the upright position on the material point, as a fraction of the radius, beyond which a climber that
/// was pushed, at once or over many ticks, looks for new ground.
const SHOVED_DISTANCE: f64 = 0.1;

/// Speed at which a climber above its material point sinks towards it, radii a second, after an obstacle pushed it up
/// or it let go of a hold. It stops sinking when its height above the point is at most the margin plus its distance to
/// the side. It does not go back to the side: the obstacle that pushed it may still be there.
const SETTLE_SPEED: f64 = 0.5;

/// Depth, as a fraction of its radius, to which a climber may be crushed into its ground and still stands on it.
const MAX_SUNK_DEPTH: f64 = 0.5;

/// Depth to which a walking climber is pressed onto its ground, as a fraction of the margin.
const PRESS_DEPTH: f64 = 0.5;

/// Multiple of the walking speed above which friction brakes the climber; a smaller excess may be rounding.
const BRAKED_SPEED_FACTOR: f64 = 1.05;

/// Memory of a climber that stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct StandingMemory {
    /// True while it slides along the ground after a blow, braked by friction instead of its feet.
    pub shoved: bool,
}

impl Tick<'_> {
    pub(super) fn stand(&mut self) -> NextMode {
        let Some(carried) = self.carried else {
            return self.leave(ClimberMode::Falling);
        };
        let normal = carried.normal();
        let own = self.own_velocity();
        if let Some(next) = self
            .be_refused_by_ground(own)
            .or_else(|| self.be_thrown(normal))
            .or_else(|| self.be_knocked_down())
            .or_else(|| self.be_lifted_off(normal, own))
            .or_else(|| self.grip_or_catch())
        {
            return next;
        }
        if self.config.slope(normal) > self.standing_slope() && !self.is_wedged(&carried) {
            if let Some(next) = self.drop_to_hang(carried.position, normal, own) {
                return next;
            }
            self.event(ClimberEvent::Slipped);
            self.state.velocity += own;
            return self.leave(ClimberMode::Sliding);
        }
        let kept = own - self.left_behind(normal);
        let (walk, has_slipped) = self.walk_velocity(normal, kept);
        if self.state.jump_buffer > 0.0 {
            return self.jump(walk);
        }
        // Feet that grip reach their velocity at once. A slide does not, so it moves at the mean of its velocities.
        let mean = if self.is_slippery() {
            // Feet that did not slip have followed their ground at once.
            let begins = if has_slipped { kept } else { own };
            (begins - normal * begins.dot(normal) + walk) * 0.5
        } else {
            walk
        };
        if walk == DVec3::ZERO && mean == DVec3::ZERO {
            self.stay(&carried)
        } else {
            self.walk(&carried, walk, mean)
        }
    }

    /// Lifts the climber off the ground if a blow moves it fast enough away from it.
    fn be_lifted_off(&mut self, normal: DVec3, own: DVec3) -> Option<NextMode> {
        let lifts = own.dot(normal) > self.slow();
        (lifts && self.struck != DVec3::ZERO).then(|| {
            self.state.velocity += own;
            self.be_knocked_off()
        })
    }

    /// Jumps, starting from the velocity of the ground.
    fn jump(&mut self, walk: DVec3) -> NextMode {
        self.face(self.input.walk);
        let speed = self.config.ground.jump_speed * self.jump_share();
        self.state.velocity += walk + self.config.up() * speed;
        self.push_off();
        self.begin_jump();
        self.leave(ClimberMode::Falling)
    }

    pub(super) fn begin_jump(&mut self) {
        self.event(ClimberEvent::Jumped);
        self.state.jump_buffer = 0.0;
        self.state.coyote = 0.0;
        self.state.flying.jumping = true;
    }

    /// Stays on the material point; obstacles may push the climber aside a little.
    fn stay(&mut self, carried: &Carried) -> NextMode {
        let radius = self.config.body.radius;
        let upright = carried.motion.position + carried.normal() * radius;
        let off = carried.position - upright;
        let above = off.dot(carried.normal());
        let aside = (off - carried.normal() * above).length();
        let too_far = (above - aside - self.config.body.margin).max(0.0);
        let settles = too_far.min(SETTLE_SPEED * radius * self.dt());
        let down = carried.normal() * -settles;
        let path = self.path(carried.position + down);
        // The velocity excludes settling, which neither hits nor pushes obstacles.
        let wanted = (path.target - down - path.start) / self.dt();
        let moved = self.slide_at(&path, Intent::Stay, wanted);
        let went = (moved.position - carried.position).dot(-carried.normal());
        let stopped = settles - went.clamp(0.0, settles);
        self.report.pushed_out -= carried.normal() * stopped;
        self.state.position = moved.position;
        let apart = moved.position - upright;
        // An obstacle that crushes it into its ground does not push it off.
        let into = apart
            .dot(carried.normal())
            .clamp(-MAX_SUNK_DEPTH * radius, 0.0);
        let is_shoved = (apart - carried.normal() * into).length() > SHOVED_DISTANCE * radius;
        if is_shoved && moved.missing_room > self.config.body.margin {
            // Crushed away from its ground: the climber does not stand on the obstacle that is below it now.
            self.state.velocity = carried.velocity();
            return self.lose_footing();
        }
        if is_shoved {
            let struck = self.struck_on_ice();
            return self.find_new_ground(carried, struck);
        }
        if moved.position != carried.position {
            self.keep_support(carried, moved.position);
        }
        self.state.velocity = self.stopped(carried.velocity());
        NextMode::Stay
    }

    /// Change of the climber's velocity by hits, if its feet slip; otherwise zero. Slipping feet do not brake it, so
    /// its ground gets no reaction.
    fn struck_on_ice(&mut self) -> DVec3 {
        let struck = if self.is_slippery() {
            self.motion.recoil
        } else {
            DVec3::ZERO
        };
        self.rides += struck;
        struck
    }

    /// The climber's velocity on its ground, clipped by the contacts of the last movement. Feet that slip do not brace
    /// it against these contacts, so the ground gets no reaction to their impulses.
    fn stopped(&mut self, velocity: DVec3) -> DVec3 {
        let clipped = self.clipped(velocity);
        if self.is_slippery() {
            self.rides += clipped - velocity;
        }
        clipped
    }

    /// Walks relative to its ground, and finds the ground at its new position. `mean` is the climber's own velocity
    /// over the tick.
    fn walk(&mut self, carried: &Carried, walk: DVec3, mean: DVec3) -> NextMode {
        if self.input.walk != DVec3::ZERO {
            let slides = self.is_slippery();
            self.face(if slides { self.input.walk } else { walk });
        }
        let limit = self.standing_slope();
        let (up, normal) = (self.config.up(), carried.normal());
        // The target is pressed onto the ground, so that the ground is among the contacts; between steep slopes, it is
        // pressed straight down, onto all of them alike.
        let onto = if self.config.slope(normal) > limit {
            up
        } else {
            normal
        };
        let press = onto * (PRESS_DEPTH * self.config.body.margin);
        let target = carried.position + mean * self.dt();
        let path = Path {
            walking: Some(Walking {
                up,
                max_slope: limit,
            }),
            ..self.path(target - press)
        };
        let moved = if self.is_slippery() {
            // Hits get the momentum of the slide, without the press onto the ground and the parting from other
            // climbers.
            self.slide_at(&path, Intent::Go, carried.velocity() + mean)
        } else {
            self.slide(&path, Intent::Go)
        };
        self.report.pushed_out -= press;
        self.state.position = moved.position;
        let walk = walk + self.struck_on_ice();
        if let Some(position) = self.step_up(carried, target) {
            self.state.position = position;
            // The climber keeps its speed, but not the rise by which it rolled up the step's edge.
            let level = walk - up * walk.dot(up).max(0.0);
            let walk = level.normalize_or_zero() * walk.length();
            return self.find_new_ground(carried, walk);
        }
        match self.held_up(moved.position, limit) {
            Some(ground) => self.stand_on(&ground, walk),
            None => self.find_new_ground(carried, walk),
        }
    }

    fn step_up(&mut self, carried: &Carried, target: DVec3) -> Option<DVec3> {
        let ground = &self.config.ground;
        let from = self.state.position;
        let position = self.mover.step_up(&StepUp {
            probe: GroundProbe {
                max_slope: ground.max_slope,
                ..self.ground_probe(ground.step_height)
            },
            from: carried.position,
            target,
            position: from,
        })?;
        self.is_corrected_clear(carried, position)
            .then_some(position)
    }

    /// True if no moving obstacle is in the way of the tick's movement, shifted by a correction of its end. Always true
    /// if the support was teleported, since the body is not swept then.
    pub(super) fn is_corrected_clear(&mut self, carried: &Carried, corrected: DVec3) -> bool {
        let moved = self.state.position;
        let body = self.body();
        !carried.swept
            || self
                .mover
                .is_clear_with(&body, [carried.start, moved], corrected - moved)
    }

    /// Stands on ground, with the climber's own velocity clipped by the contacts of the last movement.
    fn stand_on(&mut self, ground: &Ground, own: DVec3) -> NextMode {
        let slips = self.friction_of(&ground.touch) < 1.0;
        let from = self.carried.as_ref().filter(|_| slips);
        let from = from.map(Carried::velocity);
        self.state.position = ground.position;
        self.attach(&ground.touch, ground.position);
        let base = self.state.base_velocity;
        // On ice, each point has its own velocity, and only friction brings the climber to it.
        let change = from.map_or(DVec3::ZERO, |from| from - base);
        let kept = change - ground.touch.normal * change.dot(ground.touch.normal);
        self.state.velocity = self.stopped(base + own + kept);
        NextMode::Stay
    }

    /// Stands on the ground below the climber now, or leaves the ground.
    fn find_new_ground(&mut self, carried: &Carried, walk: DVec3) -> NextMode {
        let reach = self.config.ground.snap_distance;
        if let Some(ground) = self.ground_below(self.state.position, reach)
            && !self.is_far_onto_another(carried, &ground)
            && self.is_corrected_clear(carried, ground.position)
        {
            let path = Path::placed(self.body(), ground.position);
            // This is a correction of the same movement, so the hits of that movement are kept.
            let (wanted, recoil) = (self.motion.wanted, self.motion.recoil);
            let moved = self.slide_at(&path, Intent::Go, wanted);
            self.motion.recoil += recoil;
            let ground = Ground {
                position: moved.position,
                ..ground
            };
            return self.stand_on(&ground, walk);
        }
        let limit = self.standing_slope();
        if let Some(ground) = self.held_up(self.state.position, limit) {
            return self.stand_on(&ground, walk);
        }
        if let Some(next) = self.drop_to_hang(self.state.position, carried.normal(), walk) {
            return next;
        }
        self.state.velocity = carried.velocity() + walk;
        if self.is_on_slope(self.state.position, limit) {
            self.event(ClimberEvent::Slipped);
            self.leave(ClimberMode::Sliding)
        } else {
            self.lose_footing()
        }
    }

    /// True if ground is farther than the margin, and either the ground or the climber's support is another climber:
    /// another climber is never a step down, and a climber that leaves another one falls.
    fn is_far_onto_another(&self, carried: &Carried, ground: &Ground) -> bool {
        let from = carried.support.attachment.obstacle;
        let far = self.state.position.distance(ground.position) > self.config.body.margin;
        let is_from_another = || {
            let from = self.mover.obstacle(from);
            from.is_some_and(|from| from.character().is_some())
        };
        from != ground.touch.obstacle
            && far
            && (self.mover.is_character(&ground.touch) || is_from_another())
    }

    /// True if steep slopes on all sides hold the climber up.
    fn is_wedged(&mut self, carried: &Carried) -> bool {
        let up = self.config.up();
        let path = self.path(carried.position - up * self.config.body.margin);
        self.mover.slide(&path);
        self.mover.holding_up(up, 0.0).is_some()
    }

    /// The climber's own velocity along the ground, accelerated towards the velocity that the input asks for, and
    /// whether it has not reached that velocity yet.
    fn walk_velocity(&mut self, normal: DVec3, own: DVec3) -> (DVec3, bool) {
        let ground = &self.config.ground;
        let up = self.config.up();
        let walk = self.input.walk;
        let level = walk - up * walk.dot(up);
        let share = level.length().min(1.0);
        // Along the ground, in the input's direction as seen from above.
        let rise = up * (-level.dot(normal) / normal.dot(up).max(f64::MIN_POSITIVE));
        let along = (level + rise).try_normalize().unwrap_or(DVec3::ZERO);
        let fastest = ground.walk_speed / self.slowness();
        let wanted = along * (share * fastest);
        let mut own = own - normal * own.dot(normal);
        let is_fast = own.length() > fastest * BRAKED_SPEED_FACTOR;
        let friction = self.on.usable_friction();
        let mut change = if is_fast || self.state.standing.shoved {
            ground.friction * friction.max(1.0)
        } else {
            ground.acceleration
        };
        if friction < 1.0 {
            change = change.min(ground.friction * friction);
            let gravity = self.config.gravity;
            own += (gravity - normal * gravity.dot(normal)) * self.dt();
        }
        let mut most = change * self.dt();
        if friction < 1.0 {
            // Friction ends once a light body and the climber have the same velocity.
            let way = wanted - own;
            most = most.min(way.length() / (1.0 + self.relative(way)));
        }
        let walk = towards(own, wanted, most);
        self.state.standing.shoved &= walk != wanted;
        (walk, walk != wanted)
    }

    /// Change of the ground's velocity since the last tick, along the ground, if the ground is slippery; otherwise
    /// zero. Feet that slip do not follow this change by themselves: only friction takes them along.
    fn left_behind(&mut self, normal: DVec3) -> DVec3 {
        let known = |carried: &&Carried| carried.velocity_before.is_some();
        let Some(carried) = self.carried.as_ref().filter(known) else {
            return DVec3::ZERO;
        };
        if !self.is_slippery() {
            return DVec3::ZERO;
        }
        let kept = self.before.velocity - carried.velocity();
        let change = self.own_velocity() - kept;
        let along = change - normal * change.dot(normal);
        self.rides -= along;
        along
    }

    /// True if the climber's feet slip on its ground.
    pub(super) fn is_slippery(&self) -> bool {
        self.on.usable_friction() < 1.0
    }

    /// Factor by which the climber walks and climbs more slowly than usual on its support.
    pub(super) fn slowness(&self) -> f64 {
        self.on.usable_friction().max(1.0)
    }
}
