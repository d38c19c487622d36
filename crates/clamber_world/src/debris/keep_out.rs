//! Keeps skin from passing through a body: a body that rapier let skin into is put back in front of it.

use clamber_surface::geometry::{Capsule, Similarity, rotation_from_axis_angle};
use clamber_surface::surface::{CastOptions, Motion, SkinnedSurface, SweepHit};
use glam::{DVec3, Vec3};

use super::inner_capsule::InnerCapsule;

/// Radius of the swept part of a body's inside, as a fraction of the inner radius. Skin that rapier pushes out by
/// itself must not reach this part; skin that reaches it must not have passed the middle yet.
pub(super) const SWEPT: f64 = 0.5;

/// Tolerance of a sweep, as a fraction of the swept radius.
const TOLERANCE: f64 = 1e-3;

/// A sweep meets no skin that stays farther than this from the core's segment, as a fraction of the core's radius.
pub(super) const MET: f64 = SWEPT * (1.0 + 2.0 * TOLERANCE);

/// A body that is pushed out of skin by less than this fraction of the core's radius is free: that is rounding, or
/// within the tolerance of a sweep.
const FREE: f64 = 2.0 * TOLERANCE;

/// Rounds of pushing out: one for each piece of skin that a body can be caught between, and one to find that it is
/// free. More rounds would not help a body in a closing fold.
const ROUNDS: usize = 4;

/// Result of [`keep_out`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Kept {
    /// Displacement that puts the body in front of the skin, in world space, metres.
    pub(super) shift: DVec3,
    /// Normal and velocity of the skin that pushed last, in world space; `None` if none did.
    pub(super) pushed: Option<(DVec3, DVec3)>,
    /// False if skin still passes through the body.
    pub(super) free: bool,
}

impl Kept {
    /// No skin was in the body's way.
    pub(super) const FREE: Self = Self {
        shift: DVec3::ZERO,
        pushed: None,
        free: true,
    };
}

/// True if the core cannot have touched skin in the tick. It ends at `end` in world space. Skin and core have moved by
/// at most `motion` metres relative to each other. `None` if the core is out of reach.
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

/// Sweeps the core from its ends `start` to `end`, in world space, against skin that moves over a tick of `dt` seconds,
/// and pushes it out of the skin that it meets. `None` if the core is out of reach.
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
        let world_from_model = surface.world_from_model();
        let anchor = surface.anchor_at(&hit).ok()?;
        let motion = surface.in_model().motion(&anchor, dt).ok()?;
        let normal = world_from_model.rotation * outward(&hit, &motion, dt);
        let skin = world_from_model.transform_point_f32(motion.position);
        let touching = touching(world_from_model, &hit, start, shifted);
        let depth = core.radius - (touching - skin).dot(normal);
        // The core was behind the skin at the start and is in front of it at the end: it came out.
        if depth <= 0.0 {
            kept.free = true;
            return Some(kept);
        }
        kept.free = depth <= core.radius * FREE;
        kept.shift += normal * depth;
        let velocity = world_from_model.transform_vector(motion.velocity.as_dvec3());
        kept.pushed = Some((normal, velocity));
    }
    Some(kept)
}

/// Direction from the skin to the body at the end of the tick: the separation normal at contact, turned as the triangle
/// has turned since then. If the body came from behind the skin, the skin's outward normal.
fn outward(hit: &SweepHit, motion: &Motion, dt: f64) -> DVec3 {
    if hit.separation_normal.dot(hit.hit.normal) <= 0.0 {
        return motion.normal.as_dvec3().normalize_or(DVec3::Y);
    }
    let turned = motion.angular_velocity.as_dvec3() * (dt * (1.0 - hit.fraction));
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

/// The touched point of the core's segment, at its position at the end of the tick.
fn touching(
    world_from_model: &Similarity,
    hit: &SweepHit,
    start: [DVec3; 2],
    end: [DVec3; 2],
) -> DVec3 {
    let at = |side: usize| start[side] + (end[side] - start[side]) * hit.fraction;
    let axis = at(1) - at(0);
    let touched = world_from_model.transform_point_f32(hit.hit.point);
    let length_sq = axis.length_squared();
    let along = if length_sq > 0.0 {
        ((touched - at(0)).dot(axis) / length_sq).clamp(0.0, 1.0)
    } else {
        0.0
    };
    end[0] + (end[1] - end[0]) * along
}
