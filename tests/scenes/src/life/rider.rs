//! A rider of the giant's life: it wanders, runs to the giant, climbs on it and about on it, and gets up again.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode};
use clamber_colossus::Creature;
use clamber_surface::mesh::{SurfaceKind, TriangleId};
use clamber_world::{Obstacle, ObstacleId};
use glam::DVec3;

use super::LifeError;

/// Seconds after which it thinks of something else.
const BETWEEN: [f64; 2] = [4.0, 14.0];

/// With less stamina than this it stands still where it can.
const TIRED: f64 = 0.3;

/// How far it goes away, metres.
const FAR: f64 = 100.0;

/// The rider that teases the giant.
const TEASER: u64 = 0;

/// What it wants.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Wish {
    /// Walks to a place.
    Wander(DVec3),
    /// Stays so far ahead of the giant, metres, where its hands strike.
    Tease(f64),
    /// Runs to the giant.
    Come,
    /// Climbs in a direction.
    Climb(DVec3),
}

/// A rider.
pub(super) struct Rider {
    pub(super) climber: Climber,
    pub(super) id: u64,
    /// The blow that it gets with the next tick.
    pub(super) blow: Option<clamber_climber::Blow>,
    wish: Wish,
    until: f64,
    random: fastrand::Rng,
}

impl Rider {
    pub(super) fn new(id: u64, place: DVec3, seed: u64) -> Result<Self, LifeError> {
        Ok(Self {
            climber: Climber::new(ClimberConfig::colossus_climber(), place)?,
            id,
            blow: None,
            wish: Wish::Come,
            until: 0.0,
            random: fastrand::Rng::with_seed(seed ^ id.wrapping_mul(0x9e37_79b9_7f4a_7c15)),
        })
    }

    /// True if it stands on the giant or holds it.
    pub(super) fn rides(&self, giant: ObstacleId) -> bool {
        let support = self.climber.state().support;
        support.is_some_and(|support| support.attachment.obstacle == giant)
    }

    /// What it does in a tick.
    pub(super) fn input(
        &mut self,
        giant: &Creature,
        id: ObstacleId,
        seconds: f64,
        is_quiet: bool,
    ) -> ClimberInput {
        if seconds >= self.until {
            self.think(giant, id, seconds);
        }
        if is_quiet {
            self.leave(giant);
        }
        let state = self.climber.state();
        let blow = self.blow.take();
        let to = |place: DVec3| (place - state.position).with_y(0.0);
        match self.wish {
            Wish::Tease(far) => ClimberInput {
                walk: to(ahead(giant, far)).clamp_length_max(1.0),
                blow,
                ..ClimberInput::default()
            },
            Wish::Wander(place) => ClimberInput {
                walk: (to(place) * 0.3).clamp_length_max(0.6),
                blow,
                ..ClimberInput::default()
            },
            Wish::Come => {
                let way = to(giant.state().position());
                let jumps = state.mode == ClimberMode::Standing && way.length() < 14.0;
                ClimberInput {
                    walk: way.normalize_or_zero(),
                    grip: true,
                    jump: jumps && self.random.u32(..30) == 0,
                    blow,
                    ..ClimberInput::default()
                }
            }
            Wish::Climb(direction) => {
                let rests = state.stamina < TIRED || state.shake.length() > 3.0;
                let way = if rests { DVec3::ZERO } else { direction };
                // It stands up to rest where it can.
                let is_level = state
                    .support
                    .is_some_and(|support| support.normal_in_world().y > 0.8);
                ClimberInput {
                    climb: way,
                    walk: way,
                    grip: !(is_level && state.stamina < TIRED && state.shake.length() < 2.0),
                    blow,
                    ..ClimberInput::default()
                }
            }
        }
    }

    fn think(&mut self, giant: &Creature, id: ObstacleId, seconds: f64) {
        let mut lot = |from: f64, to: f64| from + (to - from) * self.random.f64();
        self.until = seconds + lot(BETWEEN[0], BETWEEN[1]);
        let angle = lot(0.0, core::f64::consts::TAU);
        let level = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let support = self.climber.state().support;
        self.wish = if support.is_some_and(|support| support.attachment.obstacle == id) {
            Wish::Climb(level + DVec3::Y * lot(-0.5, 1.5))
        } else if self.id == TEASER {
            Wish::Tease(lot(15.5, 18.0))
        } else if lot(0.0, 1.0) < 0.35 {
            Wish::Come
        } else {
            Wish::Wander(giant.state().position() + level * lot(10.0, 90.0))
        };
    }

    /// Lets go, and goes far away.
    fn leave(&mut self, giant: &Creature) {
        let from = giant.state().position();
        let way = (self.climber.state().position - from).with_y(0.0);
        self.wish = Wish::Wander(from + way.normalize_or(DVec3::X) * FAR);
    }

    /// Puts it on fur of the giant, on a joint whose name begins with one of these.
    pub(super) fn lift(&mut self, giant: &Creature, joints: &[&str]) -> Result<(), LifeError> {
        let surface = giant.surface();
        let tags = surface.mesh().tags();
        let fur: Vec<usize> = (0..tags.len())
            .filter(|index| tags[*index].kind == SurfaceKind::Fur)
            .filter(|index| belongs(giant, TriangleId(*index as u32), joints))
            .collect();
        let Some(index) = self.random.choice(&fur) else {
            return Ok(());
        };
        let triangle = TriangleId(*index as u32);
        let corners = surface.mesh().triangles()[triangle.index()].map(|vertex| {
            let place = surface.in_model().position(vertex).unwrap_or_default();
            surface.world_from_model().transform_point_f32(place)
        });
        let normal = (corners[1] - corners[0])
            .cross(corners[2] - corners[0])
            .normalize_or(DVec3::Y);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let radius = self.climber.config().body.radius;
        let mut state =
            *Climber::new(*self.climber.config(), middle + normal * (radius + 0.1))?.state();
        state.velocity = -normal * 2.0;
        self.climber.restore(state)?;
        self.wish = Wish::Climb(DVec3::Y);
        Ok(())
    }

    /// Gets up again somewhere on the ground.
    pub(super) fn revive(&mut self, place: DVec3) -> Result<(), LifeError> {
        let fresh = Climber::new(*self.climber.config(), place)?;
        self.climber.restore(*fresh.state())?;
        self.until = 0.0;
        Ok(())
    }

    /// The obstacle that is the ground under it, if any: for the check of who fell out of the world.
    pub(super) fn is_lost(&self, ground: &dyn Obstacle) -> bool {
        let place = self.climber.state().position;
        ground
            .cast_ray(place + DVec3::Y * 5.0, -DVec3::Y, 200.0)
            .is_none()
    }
}

/// The place so far ahead of the giant, metres.
fn ahead(giant: &Creature, far: f64) -> DVec3 {
    let yaw = giant.state().yaw();
    giant.state().position() + DVec3::new(libm::sin(yaw), 0.0, libm::cos(yaw)) * far
}

/// True for skin of a joint whose name begins with one of these.
fn belongs(giant: &Creature, triangle: TriangleId, to: &[&str]) -> bool {
    let joint = giant.surface().mesh().joint_of(triangle);
    let name = joint.map(|joint| {
        giant.kind().skeleton().joints()[joint.index()]
            .name
            .as_str()
    });
    name.is_some_and(|name| to.iter().any(|start| name.starts_with(start)))
}
