use clamber_climber::Climber;
use clamber_surface::mesh::TriangleId;
use clamber_surface::surface::{SkinnedSurface, SurfacePoint};
use clamber_world::ObstacleId;
use glam::DVec3;

use super::Target;
use crate::graph::{Corner, Patch, Spot, spot_on};
use crate::{Forecast, Goal};

/// How dangerous the creature is now to a climber on the ground, in three levels: the game sets [`View::danger`] in
/// each tick from what the creature does, and the bot only reads it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Danger {
    /// The creature keeps still: the bot approaches it and gets on.
    #[default]
    None,
    /// The creature walks about: the bot stays [`BotConfig::keeps_away`](crate::BotConfig::keeps_away) radii away from
    /// the place where it wants to get on.
    Moves,
    /// The creature strikes: the bot runs away from it, once this has lasted for
    /// [`BotConfig::reaction`](crate::BotConfig::reaction) seconds.
    Attacks,
}

/// The state of the world that a bot reads in a tick.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The present time of the simulation, seconds, by a clock that starts anywhere. It grows by the length of a tick
    /// in each tick, and never goes back: the bot takes differences of it.
    pub seconds: f64,
    /// The climber that the bot drives.
    pub climber: &'a Climber,
    /// The creature's obstacle id.
    pub creature: ObstacleId,
    /// The creature's skin, as posed in this tick.
    pub surface: &'a SkinnedSurface,
    /// The bot's goal.
    pub goal: &'a Goal,
    /// The clips that the creature is expected to play from now on; the present clip begins at its present time. Plans
    /// are made on it now and then, so it may be a rough guess. But a jump from one part of the creature to another
    /// relies on the next second or two. With [`Forecast::still`], the bot judges jumps by the motion that it sees.
    pub forecast: &'a Forecast,
    /// How dangerous the creature is now to a climber on the ground; the game sets it. Unless it is [`Danger::None`],
    /// the bot keeps away from the creature. While the creature attacks, the bot runs away.
    pub danger: Danger,
    /// The hardest shake that the climber's place is about to get, metres per second squared:
    /// [`FutureSkin::shake_ahead`](crate::FutureSkin::shake_ahead), half a second ahead in steps of a tenth. With 0 the
    /// bot does not look ahead, and is thrown off more often.
    pub shake_ahead: f64,
}

impl View<'_> {
    /// True if the climber stands on the creature, or holds on to it.
    pub fn is_on_creature(&self) -> bool {
        let support = self.climber.state().support;
        support.is_some_and(|support| support.attachment.obstacle == self.creature)
    }

    /// The point of the creature's skin that the climber stands on or holds.
    pub(super) fn material(&self) -> Option<(TriangleId, [f32; 3])> {
        let support = self.climber.state().support?;
        let material = support.attachment.material;
        let on_skin = support.attachment.obstacle == self.creature;
        let triangle = material.triangle().filter(|_| on_skin)?;
        Some((triangle, material.coordinates.map(|weight| weight as f32)))
    }

    /// True if the skin under the climber is no steeper than this share of the steepest slope that it can stand on.
    pub(super) fn is_level(&self, share: f64) -> bool {
        let config = self.climber.config();
        let support = self.climber.state().support;
        support.is_some_and(|support| {
            let cosine = support.normal_in_world().dot(config.up());
            cosine > libm::cos(share * config.ground.max_slope)
        })
    }

    /// The direction to a target. In a corner it also presses against the skin that the climber is to take hold of, the
    /// more the nearer that is.
    pub(super) fn against(&self, target: &Target) -> DVec3 {
        let (state, radius) = (self.climber.state(), self.climber.config().body.radius);
        let toward = target.place - state.position;
        let share = if target.in_corner {
            2.0 - toward.length() / radius
        } else {
            let held = state
                .support
                .map_or(DVec3::ZERO, |support| support.normal_in_world());
            2.0 * toward.normalize_or_zero().dot(held)
        };
        toward - target.normal * (share.clamp(0.0, 1.0) * radius)
    }

    /// A patch in the creature's present pose.
    pub(super) fn spot(&self, patch: &Patch) -> Spot {
        Spot::of(self.surface, patch)
    }

    /// Velocity of a patch: its motion in the last tick, divided by `dt` seconds.
    pub(super) fn velocity(&self, patch: &Patch, dt: f64) -> Option<DVec3> {
        let point = SurfacePoint {
            mesh: self.surface.mesh().id(),
            triangle: patch.triangle,
            barycentric: patch.barycentric.map(|weight| weight as f32),
        };
        Some(self.surface.in_world().path(point, dt).ok()?.velocity)
    }

    /// True if a ball at a place is no deeper in the skin than the share `deep` of its radius.
    pub(super) fn has_room(&self, place: DVec3, deep: f64) -> bool {
        let radius = self.climber.config().body.radius;
        let hit = self.surface.in_world().closest_point(place, radius);
        hit.is_none_or(|hit| {
            let is_outside = (place - hit.point).dot(hit.normal) >= 0.0;
            is_outside && hit.distance >= radius * (1.0 - deep)
        })
    }

    /// The position of the climber's ball in a corner, in the creature's present pose.
    pub(super) fn corner(&self, corner: &Corner) -> Option<DVec3> {
        let (point, [.., here]) = spot_on(self.surface, corner.triangle, corner.barycentric)?;
        let (_, [.., there]) = spot_on(self.surface, corner.other, [1.0, 0.0, 0.0])?;
        let place = self.surface.world_from_model();
        let away = here * corner.apart[0] + there * corner.apart[1];
        Some(place.transform_point(point) + place.rotation * away)
    }
}
