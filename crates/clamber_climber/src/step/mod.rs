//! One tick: carry, want, move, probe, decide.

mod effort;
mod flying;
mod ground;
mod hanging;
mod holding;
mod ledge;
mod pushing;
mod standing;

use clamber_world::{Obstacle, ObstacleId, PointMotion, WorldCapsule};
use glam::{DQuat, DVec3};

use crate::mover::{Moved, Path, Scratch, Touch, World};
use crate::{
    CanGrip, ClimberConfig, ClimberEvent, ClimberInput, ClimberMode, ClimberState, StepReport,
    Support,
};

/// A standing climber stays up to this many radians beyond the slope on which it would come to stand:
/// 2 degrees, more than the wobble of a breathing animal, so that it does not flicker.
const SLOPE_HYSTERESIS: f64 = 0.035;

/// A material point that was this far, metres, from where it is said to have been a tick ago was put
/// elsewhere: that is no motion. Far above rounding, far below what one sees.
const PLACED: f64 = 0.01;

/// One tick of one climber.
pub(crate) struct Step<'a> {
    config: &'a ClimberConfig,
    input: &'a ClimberInput,
    state: ClimberState,
    world: World<'a>,
    report: StepReport,
    /// Where it was at the beginning of the tick.
    began: DVec3,
    /// It got its support in this tick, which is where it will be at its end.
    attached: bool,
    /// It has moved through the air in this tick.
    has_flown: bool,
}

/// What carried a climber since the last tick.
struct Carried {
    support: Support,
    motion: PointMotion,
    /// Where the climber was a tick ago; where it would be again, had its support been put elsewhere.
    start: DVec3,
    /// Where its support has carried it.
    position: DVec3,
    /// False if the support was put elsewhere.
    swept: bool,
}

/// The climber as a capsule.
pub(crate) fn body(config: &ClimberConfig, state: &ClimberState) -> WorldCapsule {
    let axis = axis(config, state);
    WorldCapsule {
        ends: axis.map(|end| state.position + end),
        radius: config.body.radius,
    }
}

/// Ends of its axis from its position.
fn axis(config: &ClimberConfig, state: &ClimberState) -> [DVec3; 2] {
    let is_upright = !state.mode.is_holding() && !state.crouched;
    let height = if is_upright { config.body.height } else { 0.0 };
    [DVec3::ZERO, config.up() * height]
}

impl<'a> Step<'a> {
    pub(crate) fn new(
        config: &'a ClimberConfig,
        state: ClimberState,
        input: &'a ClimberInput,
        (obstacles, can_grip, dt): (&'a [(ObstacleId, &'a dyn Obstacle)], &'a CanGrip<'a>, f64),
        scratch: &'a mut Scratch,
    ) -> Self {
        Self {
            config,
            input,
            state,
            world: World::new(
                obstacles,
                can_grip,
                (dt, config.body.hard_radius()),
                scratch,
            ),
            report: StepReport {
                is_clear: true,
                ..StepReport::default()
            },
            began: state.position,
            attached: false,
            has_flown: false,
        }
    }

    pub(crate) fn run(mut self) -> (ClimberState, StepReport) {
        let before = self.state;
        self.be_struck();
        self.count_down();
        match self.state.mode {
            ClimberMode::Standing => self.stand(),
            ClimberMode::Holding => self.hold(),
            ClimberMode::Hanging => self.hang(),
            ClimberMode::LedgeHanging => self.hang_from_ledge(),
            ClimberMode::Sliding | ClimberMode::Falling | ClimberMode::Tumbling => self.fly(),
        }
        self.stand_up();
        self.tire(before.shake);
        self.weigh_down();
        if !self.state.is_finite() {
            // Obstacles of one's own may answer nonsense; the climber waits for better.
            let report = StepReport {
                events: vec![ClimberEvent::NotFinite],
                ..StepReport::default()
            };
            return (before, report);
        }
        (self.state, self.report)
    }

    fn dt(&self) -> f64 {
        self.world.dt
    }

    fn event(&mut self, event: ClimberEvent) {
        self.report.events.push(event);
    }

    /// Timers of what is forgiven.
    fn count_down(&mut self) {
        let dt = self.dt();
        let ground = &self.config.ground;
        self.state.coyote = if self.state.mode == ClimberMode::Standing {
            ground.coyote_time
        } else {
            (self.state.coyote - dt).max(0.0)
        };
        self.state.jump_buffer = if self.input.jump {
            ground.jump_buffer.max(dt)
        } else {
            (self.state.jump_buffer - dt).max(0.0)
        };
        self.state.open_handed = (self.state.open_handed - dt).max(0.0);
    }

    /// Where its support carries the climber; `None` if it has none any more.
    fn carry(&mut self) -> Option<Carried> {
        let mut support = self.state.support?;
        let mut motion = self.world.motion(support.obstacle, &support.point)?;
        let was_placed =
            !self.attached && motion.previous_position.distance(support.contact) > PLACED;
        let start = if was_placed {
            motion.previous_position + support.offset_in_world()
        } else {
            self.began
        };
        support.frame = motion.frame.unwrap_or(support.frame);
        if self.attached {
            // It felt what carried it until now.
            (motion.previous_position, motion.turn) = (motion.position, DQuat::IDENTITY);
        } else {
            self.feel(&motion, was_placed);
        }
        support.contact = motion.position;
        self.state.velocity = motion.velocity;
        self.state.support = Some(support);
        self.turn_heading(motion.turn);
        Some(Carried {
            position: motion.position + support.offset_in_world(),
            support,
            motion,
            start,
            swept: !was_placed,
        })
    }

    /// Moves the body as it stands from `start` to `target`.
    fn slide(&mut self, start: DVec3, target: DVec3, swept: bool) -> Moved {
        self.slide_along(&self.path(start, target, swept))
    }

    fn path(&self, start: DVec3, target: DVec3, swept: bool) -> Path {
        Path {
            axis: axis(self.config, &self.state),
            radius: self.config.body.radius,
            skin: self.config.body.skin_width,
            start,
            target,
            walkable: None,
            arm: None,
            swept,
        }
    }

    fn slide_along(&mut self, path: &Path) -> Moved {
        let moved = self.world.slide(path);
        self.report.pushed_out += moved.position - path.target;
        self.report.penetration = moved.penetration;
        self.report.rounds += moved.rounds;
        self.report.is_clear &= moved.is_clear;
        if moved.missed > path.skin {
            // Down to its ball, which needs least room.
            self.state.crouched = true;
            self.event(ClimberEvent::Crushed {
                depth: moved.missed - path.skin,
            });
        }
        self.push_aside(path);
        moved
    }

    /// Attaches the climber, where it is, to what it touches.
    fn attach(&mut self, touch: &Touch) {
        let motion = self.world.motion(touch.obstacle, &touch.contact.material);
        let frame = motion
            .and_then(|motion| motion.frame)
            .unwrap_or(DQuat::IDENTITY);
        // The material point's own position: it may differ from the contact by rounding, and it is
        // what the climber will be carried by.
        let contact = motion.map_or(touch.contact.point, |motion| motion.position);
        let into_frame = frame.conjugate();
        self.state.support = Some(Support {
            obstacle: touch.obstacle,
            point: touch.contact.material,
            contact,
            offset: into_frame * (self.state.position - contact),
            normal: into_frame * touch.away,
            face: into_frame * touch.contact.normal,
            frame,
        });
        self.state.support_velocity = motion.map(|motion| motion.velocity);
        self.attached = true;
    }

    /// Does something else from now on.
    fn change_to(&mut self, mode: ClimberMode) {
        let from = self.state.mode;
        if mode != from {
            debug_assert!(from.may_become(mode), "{from:?} became {mode:?}");
            self.state.mode = mode;
            self.event(ClimberEvent::Changed { from, to: mode });
        }
    }

    /// Into the air, with the velocity that it has.
    fn leave(&mut self, mode: ClimberMode) {
        self.change_to(mode);
        self.state.support = None;
        self.state.support_velocity = None;
        self.state.arm = 0.0;
        self.state.pull_up = 0.0;
        self.state.calm = 0.0;
    }

    /// Turns with the material, about up.
    fn turn_heading(&mut self, turn: DQuat) {
        self.face(turn * self.state.heading);
    }

    /// Faces a direction, as far as it is level.
    fn face(&mut self, direction: DVec3) {
        let up = self.config.up();
        let level = direction - up * direction.dot(up);
        self.state.heading = level.normalize_or(self.state.heading);
    }

    /// Uncrouches where there is room.
    fn stand_up(&mut self) {
        let height = self.config.body.height;
        if height == 0.0 {
            return;
        }
        if self.state.mode.is_holding() {
            self.state.crouched = true;
        } else if self.state.crouched {
            let up = self.config.up();
            let ball = WorldCapsule::ball(self.state.position, self.config.body.hard_radius());
            let is_free = self.world.cast(&ball, up * height).is_none();
            self.state.crouched = !is_free;
        }
    }
}

#[cfg(test)]
mod tests;
