//! A rider of the giant's life: it wanders, runs to the giant, climbs about on it, and gets up again.

use clamber_climber::{Climber, ClimberConfig, ClimberInput, ClimberMode};
use clamber_colossus::Creature;
use clamber_surface::mesh::{SurfaceKind, TriangleId};
use core::f64::consts::TAU;
use fastrand::Rng;
use glam::DVec3;

use super::{Fallible, GIANT, level};

/// The rider that teases the giant.
const TEASER: u64 = 0;

/// With less stamina than this a rider stands still where it can.
const TIRED: f64 = 0.3;

#[derive(Clone, Copy)]
enum Wish {
    /// Walks to a place.
    Wander(DVec3),
    /// Stays at this distance ahead of the giant, metres, where its hands strike.
    Tease(f64),
    /// Runs to the giant.
    Come,
    /// Climbs in a direction.
    Climb(DVec3),
}

pub(super) struct Rider {
    pub(super) climber: Climber,
    pub(super) id: u64,
    wish: Wish,
    /// When it makes its next wish, seconds.
    until: f64,
    random: Rng,
}

impl Rider {
    pub(super) fn new(id: u64, place: DVec3, seed: u64) -> Fallible<Self> {
        Ok(Self {
            climber: Climber::new(ClimberConfig::colossus_climber(), place)?,
            id,
            wish: Wish::Come,
            until: 0.0,
            random: Rng::with_seed(seed ^ id.wrapping_mul(0x9e37_79b9_7f4a_7c15)),
        })
    }

    /// True if it stands on the giant or holds it.
    fn rides(&self) -> bool {
        let support = self.climber.state().support;
        support.is_some_and(|support| support.attachment.obstacle == GIANT)
    }

    pub(super) fn input(&mut self, giant: &Creature, seconds: f64, is_quiet: bool) -> ClimberInput {
        if seconds >= self.until {
            self.think(giant, seconds);
        }
        let state = self.climber.state();
        let (home, yaw) = (giant.state().position(), giant.state().yaw());
        let to = |place: DVec3| (place - state.position).with_y(0.0);
        if is_quiet {
            self.wish = Wish::Wander(home - to(home).normalize_or(DVec3::NEG_X) * 100.0);
        }
        let mut input = ClimberInput::default();
        match self.wish {
            Wish::Tease(far) => input.walk = to(home + level(yaw) * far).clamp_length_max(1.0),
            Wish::Wander(place) => input.walk = (to(place) * 0.3).clamp_length_max(0.6),
            Wish::Come => {
                let is_near = state.mode == ClimberMode::Standing && to(home).length() < 14.0;
                input.walk = to(home).normalize_or_zero();
                input.jump = is_near && self.random.u32(..30) == 0;
                input.grip = true;
            }
            Wish::Climb(direction) => {
                let shake = state.shake.length();
                if state.stamina >= TIRED && shake <= 3.0 {
                    (input.climb, input.walk) = (direction, direction);
                }
                // It stands up to rest where it can.
                let is_level = state.support.is_some_and(|on| on.normal_in_world().y > 0.8);
                input.grip = !(is_level && state.stamina < TIRED && shake < 2.0);
            }
        }
        input
    }

    fn think(&mut self, giant: &Creature, seconds: f64) {
        let rides = self.rides();
        let mut lot = |from: f64, to: f64| from + (to - from) * self.random.f64();
        self.until = seconds + lot(4.0, 14.0);
        let way = level(lot(0.0, TAU));
        self.wish = if rides {
            Wish::Climb(way + DVec3::Y * lot(-0.5, 1.5))
        } else if self.id == TEASER {
            Wish::Tease(lot(15.5, 18.0))
        } else if lot(0.0, 1.0) < 0.35 {
            Wish::Come
        } else {
            Wish::Wander(giant.state().position() + way * lot(10.0, 90.0))
        };
    }

    /// Puts it on fur of the giant, on a joint whose name begins with one of these.
    pub(super) fn lift(&mut self, giant: &Creature, joints: &[&str]) -> Fallible<()> {
        let (surface, mesh) = (giant.surface(), giant.surface().mesh());
        let skeleton = giant.kind().skeleton().joints();
        let belongs = |triangle: &TriangleId| {
            let name = mesh.joint_of(*triangle).map(|j| &skeleton[j.index()].name);
            name.is_some_and(|name| joints.iter().any(|start| name.starts_with(start)))
        };
        let fur: Vec<TriangleId> = (0..mesh.tags().len())
            .filter(|index| mesh.tags()[*index].kind == SurfaceKind::Fur)
            .map(|index| TriangleId(index as u32))
            .filter(belongs)
            .collect();
        let Some(triangle) = self.random.choice(&fur) else {
            return Ok(());
        };
        let [a, b, c] = mesh.triangles()[triangle.index()].map(|vertex| {
            let place = surface.in_model().position(vertex).unwrap_or_default();
            surface.world_from_model().transform_point_f32(place)
        });
        let normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
        let config = *self.climber.config();
        let place = (a + b + c) / 3.0 + normal * (config.body.radius + 0.1);
        let mut state = *Climber::new(config, place)?.state();
        state.velocity = -normal * 2.0;
        self.climber.restore(state)?;
        self.wish = Wish::Climb(DVec3::Y);
        Ok(())
    }

    /// Puts it back on the ground, with full strength.
    pub(super) fn revive(&mut self, place: DVec3) -> Fallible<()> {
        let fresh = Climber::new(*self.climber.config(), place)?;
        self.climber.restore(*fresh.state())?;
        self.until = 0.0;
        Ok(())
    }
}
