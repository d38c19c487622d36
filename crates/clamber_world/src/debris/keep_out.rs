//! No skin passes through a body: what rapier let through is put back in front of it.

use clamber_surface::geometry::{Capsule, Similarity, rotation_from_axis_angle};
use clamber_surface::surface::{CastOptions, Motion, SkinnedSurface, SweepHit};
use glam::{DVec3, Vec3};

use super::inner_capsule::InnerCapsule;

/// How much of a body's inside is swept, as a share of its radius: skin that rapier pushes out by itself
/// must not reach it, and skin that does has not yet passed the middle.
pub(super) const SWEPT: f64 = 0.5;

/// How near a sweep comes, as a share of the swept radius.
const TOLERANCE: f64 = 1e-3;

/// Skin farther than this from a core, as a share of its radius, is met by no sweep.
pub(super) const MET: f64 = SWEPT * (1.0 + 2.0 * TOLERANCE);

/// Rounds of pushing out: one for each piece of skin that a body can be caught between, and one to find
/// that it is free. More would help a body in a closing fold no more.
const ROUNDS: usize = 4;

/// What keeping out came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kept {
    /// By how much the body has to be moved, in world space.
    pub(super) shift: DVec3,
    /// The normal of the skin that pushed last, and how fast it moves.
    pub(super) pushed: Option<(DVec3, DVec3)>,
    /// False if skin passes through it still.
    pub(super) free: bool,
}

impl Kept {
    /// Nothing was in its way.
    pub(super) const FREE: Self = Self {
        shift: DVec3::ZERO,
        pushed: None,
        free: true,
    };
}

/// True if the core, which ends there in world space, has met no skin, where skin and it have moved
/// by at most `motion` metres past each other.
pub(super) fn stays_clear(
    surface: &SkinnedSurface,
    core: &InnerCapsule,
    end: [DVec3; 2],
    motion: f64,
) -> Option<bool> {
    let world_from_model = surface.world_from_model();
    let [a, b] = end.map(|end| world_from_model.inverse_transform_point_f32(end));
    let radius = (core.radius * MET / world_from_model.scale) as f32;
    let near = (motion / world_from_model.scale) as f32;
    let core = Capsule::new(a, b, radius)?;
    Some(surface.in_model().closest_to_capsule(&core, near).is_none())
}

/// Sweeps the core from its ends `start` to `end`, in world space, against skin that moves over a tick of
/// `dt` seconds.
pub(super) fn keep_out(
    surface: &SkinnedSurface,
    core: &InnerCapsule,
    [start, end]: [[DVec3; 2]; 2],
    dt: f64,
) -> Option<Kept> {
    let mut kept = Kept::FREE;
    for _ in 0..ROUNDS {
        let shifted = end.map(|end| end + kept.shift);
        let Some(hit) = sweep(surface, core, start, shifted)? else {
            kept.free = true;
            return Some(kept);
        };
        kept.free = false;
        let world_from_model = surface.world_from_model();
        let anchor = surface.anchor_at(&hit).ok()?;
        let motion = surface.in_model().motion(&anchor, dt).ok()?;
        let normal = world_from_model.rotation * outward(&hit, &motion, dt);
        let skin = world_from_model.transform_point_f32(motion.position);
        let touching = touching(world_from_model, &hit, start, shifted);
        let depth = core.radius - (touching - skin).dot(normal);
        // Behind the skin at the start and in front of it at the end: it came out.
        if depth <= 0.0 {
            kept.free = true;
            return Some(kept);
        }
        kept.shift += normal * depth;
        let velocity = world_from_model.transform_vector(motion.velocity.as_dvec3());
        kept.pushed = Some((normal, velocity));
    }
    Some(kept)
}

/// From the skin to the body, now: as they touched, turned as the triangle turned since then; out of the
/// skin where the body came from behind it.
fn outward(hit: &SweepHit, motion: &Motion, dt: f64) -> DVec3 {
    if hit.separation_normal.dot(hit.normal) <= 0.0 {
        return motion.normal.as_dvec3().normalize_or(DVec3::Y);
    }
    let turned = motion.angular_velocity.as_dvec3() * (dt * (1.0 - hit.time));
    let angle = turned.length();
    let normal = hit.separation_normal.as_dvec3().normalize_or(DVec3::Y);
    if angle > 0.0 {
        rotation_from_axis_angle(turned / angle, angle) * normal
    } else {
        normal
    }
}

fn sweep(
    surface: &SkinnedSurface,
    core: &InnerCapsule,
    start: [DVec3; 2],
    end: [DVec3; 2],
) -> Option<Option<SweepHit>> {
    let world_from_model = surface.world_from_model();
    let radius = core.radius * SWEPT / world_from_model.scale;
    let tolerance = radius * TOLERANCE;
    let radius = radius as f32;
    let start = start.map(|end| world_from_model.inverse_transform_point(end));
    let motions: [Vec3; 2] = std::array::from_fn(|side| {
        let end = world_from_model.inverse_transform_point(end[side]);
        (end - start[side]).as_vec3()
    });
    let [a, b] = start.map(|end| end.as_vec3());
    let usable = motions.iter().all(|motion| motion.is_finite());
    let core = Capsule::new(a, b, radius).filter(|_| usable)?;
    let options = CastOptions::MOVING.with_tolerance(tolerance);
    Some(surface.in_model().cast_capsule(&core, motions, &options))
}

/// The point of the core's segment that was touched, where it is at the end of the tick.
fn touching(
    world_from_model: &Similarity,
    hit: &SweepHit,
    start: [DVec3; 2],
    end: [DVec3; 2],
) -> DVec3 {
    let at = |side: usize| start[side] + (end[side] - start[side]) * hit.time;
    let axis = at(1) - at(0);
    let touched = world_from_model.transform_point_f32(hit.point);
    let length_sq = axis.length_squared();
    let along = if length_sq > 0.0 {
        ((touched - at(0)).dot(axis) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    end[0] + (end[1] - end[0]) * along
}
