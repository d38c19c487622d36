//! Whether a body and a creature's skin collide, or skin passes through the body.

use clamber_surface::surface::{CastOptions, SkinnedSurface, SurfaceHit};
use glam::DVec3;
use rapier3d::math::Pose;

use super::enclosed::is_enclosed;
use super::inner_capsule::InnerCapsule;
use super::put_out::PutOut;
use crate::WorldCapsule;

/// Radius of the point that is swept against the skin, as a fraction of the inner radius. A body nearer to the skin
/// than this may count as on either side of it.
const POINT: f64 = 0.01;

/// Whether a body and a creature's skin collide, or skin passes through the body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Passage {
    /// They collide.
    #[default]
    Closed,
    /// Skin passes through the body until it is outside.
    LetThrough,
    /// Skin passes through the body while it is put out of the creature.
    PutOut(PutOut),
}

/// A body that is tested for skin around it, with its way through a tick if nothing stops it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Looked<'a> {
    pub(super) core: &'a InnerCapsule,
    pub(super) course: &'a [Pose; 2],
    /// World position of rapier's origin.
    pub(super) origin: DVec3,
}

impl Looked<'_> {
    /// The core's ends before the tick and after it, in world space.
    fn ends(&self) -> [[DVec3; 2]; 2] {
        let ends = |pose| self.core.ends_at(pose).map(|end| end + self.origin);
        [ends(&self.course[0]), ends(&self.course[1])]
    }
}

impl Passage {
    pub(super) const fn is_let_through(&self) -> bool {
        matches!(self, Self::LetThrough)
    }

    pub(super) const fn is_put_out(&self) -> bool {
        matches!(self, Self::PutOut(_))
    }

    /// For a body that skin may have appeared around: [`Passage::Closed`] if the body is outside. A body that partly
    /// shows is put out if its place outside is free of skin. A deeper body is let through.
    ///
    /// Skin and body are taken as they are at the end of the tick. A body that skin reaches during the tick collides
    /// with it, so it counts as outside. `hits` is reused memory.
    pub(super) fn around(
        body: &Looked<'_>,
        surface: &SkinnedSurface,
        hits: &mut Vec<SurfaceHit>,
    ) -> Self {
        let [start, end] = body.ends();
        let middle = (end[0] + end[1]) * 0.5;
        let Some((center, radius)) = surface.bounding_ball() else {
            return Self::Closed;
        };
        // Written so that a middle that is not finite is outside.
        let near = (middle - center).length() <= radius;
        let (space, world_from_model) = (surface.in_model(), surface.world_from_model());
        let in_model = |place| world_from_model.inverse_transform_point_f32(place);
        if !near || !is_enclosed(space, in_model(middle), hits) {
            return Self::Closed;
        }
        let from = (start[0] + start[1]) * 0.5;
        let radius = body.core.radius * POINT;
        if enters(surface, [from, middle], radius) {
            return Self::Closed;
        }
        let core = WorldCapsule {
            ends: end,
            radius: 0.0,
        };
        let put_out = PutOut::new(surface, &core, body.core.radius);
        match put_out.filter(|(_, place)| !is_enclosed(space, in_model(*place), hits)) {
            Some((put_out, _)) => Self::PutOut(put_out),
            None => Self::LetThrough,
        }
    }
}

/// True if a point that moves straight over the tick is in front of the skin that it meets first.
fn enters(surface: &SkinnedSurface, [from, to]: [DVec3; 2], radius: f64) -> bool {
    let options = CastOptions::MOVING.with_tolerance(radius * POINT);
    let point = WorldCapsule::ball(from, radius);
    let hit = surface
        .in_world()
        .cast_capsule(&point, [to - from; 2], &options);
    hit.is_some_and(|hit| hit.separation_normal.dot(hit.hit.normal) > 0.0)
}
