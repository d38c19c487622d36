//! One tick: carry, want, move, resolve, probe.

use clamber_world::{Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion};
use glam::DVec3;

use crate::{Climber, ClimberError, ClimberInput, ClimberMode, Footing, PushOut, average_push_out};

/// A standing climber keeps its footing up to this many radians beyond the slope on which it would
/// find one: 2 degrees, more than the wobble of a breathing animal, so that it does not flicker.
const SLOPE_HYSTERESIS: f64 = 0.035;

/// What lies within this share of the radius beyond the sphere is touched: 0.4 mm by default. A
/// push-out ends where rounding puts it, half a step of f32 beyond the sphere or short of it; that
/// is less than this for surfaces up to a kilometre across. Larger lands visibly early.
const REACH: f64 = 1e-3;

/// How often the velocity into each contact is taken away, for corners where one undoes another.
const STOPS: usize = 4;

/// Contacts that part faster than this many metres a second are being left, not landed on: far
/// below a jump, above the rounding of velocities.
const PARTING_SPEED: f64 = 0.1;

/// Something that happened in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClimberEvent {
    /// Came down on something that can be stood on.
    Landed {
        /// On what.
        obstacle: ObstacleId,
        /// Speed towards it, metres a second.
        speed: f64,
    },
    /// Jumped off what it stood on.
    Jumped,
    /// What it stood on became too steep.
    Slipped,
    /// What it stood on ended, or was removed.
    LostFooting,
}

/// What a step did, beside the new state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepReport {
    /// In the order in which they happened; empty in most ticks, and then without memory.
    pub events: Vec<ClimberEvent>,
    /// How the contacts pushed.
    pub push_out: PushOut,
}

/// A contact and the obstacle that it belongs to.
#[derive(Clone, Copy)]
struct Ground {
    obstacle: ObstacleId,
    contact: Contact,
}

/// One tick's view of the world.
struct Tick<'a> {
    obstacles: &'a [(ObstacleId, &'a dyn Obstacle)],
    dt: f64,
}

impl Climber {
    /// One tick of `dt` seconds. Obstacles must already stand where they stand at its end.
    ///
    /// Obstacles may come in any order; of two with the same id the first counts.
    ///
    /// # Errors
    /// [`ClimberError`] if `dt` is not positive or the input is not finite; the climber is
    /// unchanged then.
    pub fn step(
        &mut self,
        input: &ClimberInput,
        obstacles: &[(ObstacleId, &dyn Obstacle)],
        dt: f64,
    ) -> Result<StepReport, ClimberError> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(ClimberError::OutOfRange {
                name: "dt",
                range: "positive",
                found: dt,
            });
        }
        if !input.walk.is_finite() {
            return Err(ClimberError::NotFinite("walk"));
        }
        let before = self.state;
        let tick = Tick { obstacles, dt };
        self.surroundings.forget();
        let mut report = StepReport::default();
        match self.state.mode {
            ClimberMode::Standing => self.stand(input, &tick, &mut report),
            ClimberMode::Falling => self.fall(&tick, &mut report),
        }
        if !self.state.is_finite() {
            // Obstacles of one's own may answer nonsense; the climber waits for better.
            self.state = before;
            report = StepReport::default();
        }
        Ok(report)
    }

    /// A tick that begins on its feet.
    fn stand(&mut self, input: &ClimberInput, tick: &Tick<'_>, report: &mut StepReport) {
        let carried = self
            .state
            .footing
            .and_then(|footing| Some((footing, tick.motion(footing.obstacle, &footing.point)?)));
        let Some((mut footing, motion)) = carried else {
            self.leave(ClimberEvent::LostFooting, report);
            return self.fall(tick, report);
        };
        footing.frame = motion.frame.unwrap_or(footing.frame);
        let offset = footing.frame * footing.offset;
        let support = offset.normalize_or(self.config.up());
        self.state.velocity = motion.velocity;
        self.state.position = motion.position + offset;
        footing.contact = motion.position;
        self.state.footing = Some(footing);
        self.turn_heading(&motion);
        if self.config.slope(support) > self.config.max_slope + SLOPE_HYSTERESIS {
            self.leave(ClimberEvent::Slipped, report);
            return;
        }
        let walk = self.walk_velocity(input.walk, support);
        if input.jump {
            self.state.velocity += walk + self.config.up() * self.config.jump_speed;
            self.leave(ClimberEvent::Jumped, report);
        } else if walk == DVec3::ZERO {
            self.stay(footing, tick, report);
        } else {
            self.walk(walk, tick, report);
        }
    }

    /// Stays on its material point. Pushes roll the sphere around that point, so the contact does
    /// not move: to second order a roll is a push along the surface.
    fn stay(&mut self, footing: Footing, tick: &Tick<'_>, report: &mut StepReport) {
        report.push_out = self.push_out(tick);
        if report.push_out.contacts == 0 {
            return;
        }
        let pushed = self.state.position + report.push_out.displacement - footing.contact;
        let offset = pushed.normalize_or(self.config.up()) * self.config.radius;
        self.state.position = footing.contact + offset;
        self.state.footing = Some(Footing {
            offset: footing.frame.conjugate() * offset,
            ..footing
        });
    }

    /// Walks relative to what carried it, and finds new ground.
    fn walk(&mut self, walk: DVec3, tick: &Tick<'_>, report: &mut StepReport) {
        let start = self.state.position;
        self.move_by(walk * tick.dt, tick);
        report.push_out = self.push_out(tick);
        self.state.position += report.push_out.displacement;
        let up = self.config.up();
        self.state.heading = (walk - up * walk.dot(up)).normalize_or(self.state.heading);
        let reach = self.config.radius + self.config.snap_distance;
        let limit = self.config.max_slope + SLOPE_HYSTERESIS;
        if let Some(ground) = self.ground(tick, reach, limit, |_| true) {
            self.stand_on(&ground, tick);
            self.state.velocity += (self.state.position - start) / tick.dt;
        } else {
            // Over the edge of level ground, the ground ends; a slope that tips is slipped on.
            let nearest = self.ground(tick, reach, core::f64::consts::PI, |_| true);
            let tipped =
                nearest.is_some_and(|ground| self.config.slope(ground.contact.normal) > limit);
            self.state.velocity += walk;
            let event = if tipped {
                ClimberEvent::Slipped
            } else {
                ClimberEvent::LostFooting
            };
            self.leave(event, report);
        }
    }

    /// A tick in the air, which may end on the ground.
    fn fall(&mut self, tick: &Tick<'_>, report: &mut StepReport) {
        self.state.velocity += self.config.gravity * tick.dt;
        self.move_by(self.state.velocity * tick.dt, tick);
        report.push_out = self.push_out(tick);
        self.state.position += report.push_out.displacement;

        let velocity = self.state.velocity;
        let center = self.state.position;
        let reach = self.config.radius * (1.0 + REACH);
        let closing = |ground: &Ground| {
            let away = ground.contact.away(center);
            (velocity - tick.velocity_of(ground)).dot(away) < PARTING_SPEED
        };
        if let Some(ground) = self.ground(tick, reach, self.config.max_slope, closing) {
            let away = ground.contact.away(center);
            let speed = -(velocity - tick.velocity_of(&ground)).dot(away);
            self.stand_on(&ground, tick);
            self.state.velocity = tick.velocity_of(&ground);
            self.state.mode = ClimberMode::Standing;
            report.events.push(ClimberEvent::Landed {
                obstacle: ground.obstacle,
                speed: speed.max(0.0),
            });
        } else {
            self.stop_at_contacts(tick, reach);
        }
    }

    /// Takes away the velocity into everything that is touched, relative to its own: contact by
    /// contact, some rounds of it. In a corner some of it may remain.
    fn stop_at_contacts(&mut self, tick: &Tick<'_>, reach: f64) {
        let center = self.state.position;
        self.planes.clear();
        let near = self.surroundings.near(tick.obstacles, center, reach);
        for (id, obstacle) in near {
            self.contacts.clear();
            obstacle.overlap_sphere(center, reach, &mut self.contacts);
            self.planes.extend(self.contacts.iter().map(|contact| {
                let ground = Ground {
                    obstacle: id,
                    contact: *contact,
                };
                (contact.away(center), tick.velocity_of(&ground))
            }));
        }
        for _ in 0..STOPS {
            for (away, velocity) in &self.planes {
                let into = (self.state.velocity - *velocity).dot(*away);
                if into < 0.0 {
                    self.state.velocity -= *away * into;
                }
            }
        }
    }

    /// Moves the centre, but not through a surface: a ray along the way stops it half a radius
    /// short of what it meets, from where push-outs still lead to the right side.
    fn move_by(&mut self, displacement: DVec3, tick: &Tick<'_>) {
        let length = displacement.length();
        if length == 0.0 {
            return;
        }
        let mut allowed = length;
        let margin = 0.5 * self.config.radius;
        let (start, reach) = (self.state.position, length + margin);
        for (_, obstacle) in self.surroundings.near(tick.obstacles, start, reach) {
            let hit = obstacle.cast_ray(start, displacement, reach);
            if let Some(hit) = hit.filter(|hit| hit.distance.is_finite()) {
                allowed = allowed.min((hit.distance - margin).max(0.0));
            }
        }
        self.state.position += displacement * (allowed / length);
    }

    /// The mean push-out of everything that the sphere overlaps.
    fn push_out(&mut self, tick: &Tick<'_>) -> PushOut {
        self.contacts.clear();
        let (center, radius) = (self.state.position, self.config.radius);
        for (_, obstacle) in self.surroundings.near(tick.obstacles, center, radius) {
            obstacle.overlap_sphere(center, radius, &mut self.contacts);
        }
        average_push_out(&self.contacts, center, radius)
    }

    /// The nearest contact within `reach` that is no steeper than `max_slope`.
    fn ground(
        &mut self,
        tick: &Tick<'_>,
        reach: f64,
        max_slope: f64,
        accept: impl Fn(&Ground) -> bool,
    ) -> Option<Ground> {
        let center = self.state.position;
        let mut best: Option<Ground> = None;
        let near = self.surroundings.near(tick.obstacles, center, reach);
        for (id, obstacle) in near {
            self.contacts.clear();
            obstacle.overlap_sphere(center, reach, &mut self.contacts);
            for contact in &self.contacts {
                let ground = Ground {
                    obstacle: id,
                    contact: *contact,
                };
                // In ascending order of obstacle and material: the first of equals stays.
                let nearer = contact.distance < best.map_or(f64::INFINITY, |b| b.contact.distance);
                let stands = || self.config.slope(contact.away(center)) <= max_slope;
                if nearer && stands() && accept(&ground) {
                    best = Some(ground);
                }
            }
        }
        best
    }

    /// Puts the sphere so that it touches a contact, and its footing there.
    fn stand_on(&mut self, ground: &Ground, tick: &Tick<'_>) {
        let away = ground.contact.away(self.state.position);
        let mut footing = Footing {
            obstacle: ground.obstacle,
            point: ground.contact.material,
            contact: ground.contact.point,
            offset: away * self.config.radius,
            frame: glam::DQuat::IDENTITY,
        };
        // The material point's own position: it may differ from the contact by rounding, and it is
        // what the climber will be carried by.
        if let Some(motion) = tick.motion(footing.obstacle, &footing.point) {
            footing.contact = motion.position;
            footing.frame = motion.frame.unwrap_or(footing.frame);
        }
        self.state.position = footing.contact + footing.offset;
        footing.offset = footing.frame.conjugate() * footing.offset;
        self.state.footing = Some(footing);
    }

    /// Into the air, with the velocity that it has.
    fn leave(&mut self, event: ClimberEvent, report: &mut StepReport) {
        self.state.mode = ClimberMode::Falling;
        self.state.footing = None;
        report.events.push(event);
    }

    /// What the input asks for, along the surface.
    fn walk_velocity(&self, walk: DVec3, support: DVec3) -> DVec3 {
        let up = self.config.up();
        let level = walk - up * walk.dot(up);
        let share = level.length().min(1.0);
        let along = level - support * level.dot(support);
        along.normalize_or_zero() * (share * self.config.walk_speed)
    }

    /// Turns with the material underfoot, about up.
    fn turn_heading(&mut self, motion: &PointMotion) {
        let up = self.config.up();
        let turned = motion.turn * self.state.heading;
        self.state.heading = (turned - up * turned.dot(up)).normalize_or(self.state.heading);
    }
}

impl<'a> Tick<'a> {
    fn motion(&self, obstacle: ObstacleId, point: &MaterialPoint) -> Option<PointMotion> {
        let (_, obstacle) = self.obstacles.iter().find(|(id, _)| *id == obstacle)?;
        obstacle.motion(point, self.dt).filter(|motion| {
            motion.position.is_finite()
                && motion.velocity.is_finite()
                && motion.turn.is_finite()
                && motion.frame.is_none_or(|frame| frame.is_finite())
        })
    }

    fn velocity_of(&self, ground: &Ground) -> DVec3 {
        self.motion(ground.obstacle, &ground.contact.material)
            .map_or(DVec3::ZERO, |motion| motion.velocity)
    }
}

#[cfg(test)]
mod tests;
