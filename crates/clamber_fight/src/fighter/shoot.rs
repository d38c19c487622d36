//! Shooting arrows and throwing stones.

use clamber_surface::geometry::rotation_from_axis_angle;
use glam::DVec3;

use super::{BowConfig, Fighter, FighterFrame, StoneConfig, Wielding};
use crate::projectile::{
    Projectile, ProjectileBody, ProjectileId, ProjectileKind, ProjectileMotion,
};

/// Largest angle by which an arrow strays, radians, however fast the archer moves.
const MOST_STRAY: f64 = 0.5;

impl BowConfig {
    /// The properties of this bow's arrow in flight and at a hit: its radius, drag, depth and damage, and its speed
    /// from a fully drawn bow. Creatures do not hear its impact.
    pub fn arrow(&self) -> ProjectileBody {
        ProjectileBody {
            radius: self.radius,
            drag: self.drag,
            depth: self.depth,
            damage: self.damage,
            speed: self.speed,
            loudness: 0.0,
        }
    }
}

impl StoneConfig {
    /// The properties of a stone in flight and at a hit: its radius, the speed at which it leaves the hand, and its
    /// loudness. It has no drag, does no damage, and does not stick.
    pub fn stone(&self) -> ProjectileBody {
        ProjectileBody {
            radius: self.radius,
            drag: 0.0,
            depth: 0.0,
            damage: 0.0,
            speed: self.speed,
            loudness: self.loudness,
        }
    }
}

impl Fighter {
    /// Direction of the aim: the input's aim, or straight ahead if that is zero.
    pub(super) fn aim(&self, aim: DVec3) -> DVec3 {
        let ahead = || FighterFrame::of(&self.climber).direction(DVec3::Z);
        aim.try_normalize().unwrap_or_else(ahead)
    }

    /// Position of an arrow's tip when it is released, in world space, metres; `None` without a bow. If terrain or skin
    /// is between the centre of the climber's ball and this position, a shot begins just before that obstacle.
    pub fn nock(&self) -> Option<DVec3> {
        let bow = self.config.bow.as_ref()?;
        Some(FighterFrame::of(&self.climber).at(bow.nock))
    }

    /// Velocity of an arrow that is released now without straying, in world space, metres a second: its speed along
    /// `aim`, plus the fighter's own velocity. `aim` is a direction in world space, of any length; zero is straight
    /// ahead of the body ([`FighterFrame`]). `drawn` is the draw, clamped to 0 to 1. `None` without a bow.
    pub fn arrow_velocity(&self, aim: DVec3, drawn: f64) -> Option<DVec3> {
        let bow = self.config.bow.as_ref()?;
        let own = self.climber.state().velocity;
        Some(self.aim(aim) * (bow.speed * drawn.clamp(0.0, 1.0)) + own)
    }

    /// Shoots an arrow. `None` without a bow or arrows.
    pub(super) fn shoot(
        &mut self,
        tick: &Wielding<'_>,
        drawn: f64,
        id: ProjectileId,
    ) -> Option<Projectile> {
        let bow = self.config.bow?;
        if bow.arrows.is_some() {
            self.state.arrows = self.state.arrows.checked_sub(1)?;
        }
        let velocity = self.arrow_velocity(tick.input.aim, drawn)?;
        let state = self.climber.state();
        let nock = self.nock()?;
        let position = tick.around.reached(state.position, nock, bow.radius);
        let moves = (state.velocity - state.base_velocity).length();
        let velocity = self.stray(velocity, (bow.stray * moves).min(MOST_STRAY));
        Some(Projectile {
            id,
            kind: ProjectileKind::Arrow,
            by: self.id,
            body: bow.arrow(),
            seconds: 0.0,
            motion: ProjectileMotion::Flying { position, velocity },
        })
    }

    /// Throws a stone. `None` without stones.
    pub(super) fn throw(&mut self, tick: &Wielding<'_>, id: ProjectileId) -> Option<Projectile> {
        let stones = self.config.stones?;
        let hand = FighterFrame::of(&self.climber).at(stones.hand);
        let state = self.climber.state();
        let position = tick.around.reached(state.position, hand, stones.radius);
        let velocity = self.aim(tick.input.aim) * stones.speed + state.velocity;
        Some(Projectile {
            id,
            kind: ProjectileKind::Stone,
            by: self.id,
            body: stones.stone(),
            seconds: 0.0,
            motion: ProjectileMotion::Flying { position, velocity },
        })
    }

    /// Turns a velocity by a random angle up to `angle`, in a random direction. Hits are spread evenly over the cone's
    /// disc.
    fn stray(&mut self, velocity: DVec3, angle: f64) -> DVec3 {
        if angle <= 0.0 {
            return velocity;
        }
        let mut random = fastrand::Rng::with_seed(self.state.random);
        let (around, off) = (
            random.f64() * core::f64::consts::TAU,
            random.f64().sqrt() * angle,
        );
        self.state.random = random.get_seed();
        let along = velocity.normalize_or(DVec3::Y);
        let aside = along.any_orthonormal_vector();
        let axis = rotation_from_axis_angle(along, around) * aside;
        rotation_from_axis_angle(axis, off) * velocity
    }
}
