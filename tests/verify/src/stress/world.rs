//! Checks that answers in world space are as exact 100 km from the origin as at the origin.

use crate::agreement::{point_of, weights};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Palette;
use clamber_surface::surface::SkinnedSurface;
use clamber_world::{Contact, MaterialPoint, Obstacle};
use glam::{DVec3, Vec3};

use super::posed::Posed;

/// Length of a tick, seconds.
const TICK: f64 = 1.0 / 60.0;

/// The positions, the place and the reach of the last tick.
pub(super) struct Before {
    pub(super) positions: Vec<Vec3>,
    pub(super) place: Similarity,
    pub(super) reach: f64,
}

impl Before {
    pub(super) fn of(posed: &Posed<'_>, palette: &Palette) -> Self {
        Self {
            positions: posed.positions.clone(),
            place: *posed.surface.world_from_model(),
            reach: reach(posed.surface, palette),
        }
    }
}

/// Upper bound of the products that skinning adds up, in model units. The rounding error of skinning is a share of it.
fn reach(surface: &SkinnedSurface, palette: &Palette) -> f64 {
    let radius = f64::from(surface.mesh().radius());
    let of = |map: glam::DAffine3| {
        let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
        let linear = x.length() + y.length() + z.length();
        linear * radius + map.translation.length()
    };
    let all = palette.matrices().iter().map(|m| of(m.to_f64()));
    all.fold(0.0, f64::max)
}

/// Compares answers at the creature's place with answers at the origin, and motions of points with f64; returns the
/// number of checks.
pub(super) fn check(
    posed: &Posed<'_>,
    palette: &Palette,
    before: Option<&Before>,
    rng: &mut fastrand::Rng,
    count: usize,
) -> usize {
    let far = posed.surface;
    let place = *far.world_from_model();
    let mut home = far.clone();
    let at_home = Similarity {
        translation: DVec3::ZERO,
        ..place
    };
    if let Err(error) = home.teleport(palette, at_home) {
        panic!("rejected at the origin: {error}");
    }
    let away = place.translation;
    // A query point is rounded to f32 model space once, and so is a point that is found. World coordinates are off by
    // about 2^-52 of their own size.
    let world = 1e-15 * away.length();
    let mut checked = 0;
    for _ in 0..count {
        let mut aims = posed.aims(rng);
        let skin = aims.skin();
        let near = aims.off(skin, 0.1);
        let size = f64::from(posed.farthest.max(near.abs().max_element()));
        let exact = place.scale * size * 4e-7 + 8.0 * world;

        let point = home.world_from_model().transform_point_f32(near);
        let here = home.closest_point(point, f64::INFINITY);
        let there = far.closest_point(point + away, f64::INFINITY);
        let (Some(here), Some(there)) = (here, there) else {
            panic!("no closest point to {point}, with the creature at {away}");
        };
        let off = (here.distance - there.distance).abs();
        assert!(
            off <= exact,
            "{off} m off, {exact} allowed, with the creature at {away}: {here:?} {there:?}"
        );
        check_contact(posed, &there, exact);

        let target = home.world_from_model().transform_point_f32(skin);
        let along = target - point;
        if let Some(hit) = far.cast_ray(point + away, along, f64::INFINITY) {
            check_contact(posed, &hit, exact);
            let from = hit.point - (point + away);
            let aside = from.cross(along.normalize_or(DVec3::X)).length();
            // The direction is rounded as well.
            let turned = from.length() * 2e-7;
            assert!(
                aside <= exact + turned,
                "{hit:?} is {aside} m beside its ray"
            );
        }
        checked += 2;
        if let Some(before) = before {
            check_motion(posed, palette, before, rng);
            checked += 1;
        }
    }
    checked
}

/// Checks that a contact is at its material point.
fn check_contact(posed: &Posed<'_>, contact: &Contact, exact: f64) {
    let corners = posed.triangles[contact.material.key as usize];
    // Computed in model space: the f32 weights do not add up to exactly 1, which matters far from the origin.
    let weights = contact.material.coordinates.map(|weight| weight as f32);
    let place = posed.surface.world_from_model();
    let point = place.transform_point_f32(point_of(corners, weights));
    let off = contact.point.distance(point);
    assert!(
        off <= exact,
        "{contact:?} is {off} m from its material point"
    );
    let unit = (contact.normal.length() - 1.0).abs() < 1e-6;
    assert!(unit && contact.distance.is_finite(), "{contact:?}");
}

/// Checks the motion of a material point against its positions at both ends of the tick.
fn check_motion(posed: &Posed<'_>, palette: &Palette, before: &Before, rng: &mut fastrand::Rng) {
    let triangle = posed.any_triangle(rng);
    let weights = weights(rng);
    let material = MaterialPoint {
        key: triangle as u64,
        coordinates: weights.map(f64::from),
    };
    let Some(motion) = posed.surface.motion(&material, TICK) else {
        panic!("{material:?} has no motion");
    };
    let place = *posed.surface.world_from_model();
    let now = place.transform_point_f32(point_of(posed.triangles[triangle], weights));
    let corners = posed.corner_ids(triangle).map(|v| before.positions[v]);
    let then = before.place.transform_point_f32(point_of(corners, weights));
    let moved = now - then;
    let relative = place.relative(&before.place).translation.length();
    // The rounding error of two skinnings and a matrix is a share of the products that they add up.
    let size = reach(posed.surface, palette) + before.reach + relative;
    let exact = place.scale * size * 2e-6 + 1e-14 * place.translation.length();
    let off = (motion.velocity * TICK - moved).length();
    assert!(
        off <= exact,
        "{motion:?} differs by {off} m from {moved}, {exact} allowed"
    );
    assert!(
        motion.position.distance(now) <= exact,
        "{motion:?} is not at {now}"
    );
    let sound = motion.area_ratio >= 0.0 && motion.stretches.iter().all(|s| *s >= 0.0);
    assert!(sound && motion.turn.is_finite(), "{motion:?}");
}
