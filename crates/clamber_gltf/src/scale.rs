//! Scales a creature to a height.
//!
//! One factor multiplies every length: positions of vertices; translations of joints, of inverse bind matrices and of
//! clips, tangents included; speeds of clips; positions and radii of weak points. Rotations and scales are kept, so
//! every pose is the unscaled one times the factor. Each number is multiplied in f64 and rounded once.

use clamber_surface::mesh::ColliderMesh;
use clamber_surface::rig::{Channel, Clip, Keyframes, RigError, Skeleton};
use clamber_surface::skin::skin;
use glam::Vec3;

use crate::{GltfErrorKind, Model};

/// Refuses a height that is not finite or not greater than 0.
pub(crate) fn check(height: Option<f32>) -> Result<(), GltfErrorKind> {
    match height {
        Some(wanted) if !(wanted > 0.0 && wanted.is_finite()) => {
            Err(GltfErrorKind::BadHeight { wanted })
        }
        _ => Ok(()),
    }
}

/// The factor that gives a collider this height in the rest pose.
pub(crate) fn factor(
    height: f32,
    skeleton: &Skeleton,
    collider: &ColliderMesh,
    object: &str,
) -> Result<f64, GltfErrorKind> {
    let found = height_at_rest(skeleton, collider).unwrap_or(f64::NAN);
    if found > 0.0 && found.is_finite() {
        return Ok(f64::from(height) / found);
    }
    Err(GltfErrorKind::NoHeight {
        object: object.to_owned(),
        found,
    })
}

/// The height of all triangles along Y in the rest pose; `None` if the rest pose cannot be skinned.
fn height_at_rest(skeleton: &Skeleton, collider: &ColliderMesh) -> Option<f64> {
    let palette = skeleton.palette(&skeleton.rest_pose()).ok()?;
    let positions = skin(collider, palette.matrices()).ok()?;
    let corners = collider.triangles().iter().flatten();
    let heights = corners.map(|vertex| f64::from(positions[vertex.index()].y));
    let range = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
        (low.min(y), high.max(y))
    });
    Some(range.1 - range.0)
}

/// Scales points.
pub(crate) fn points(points: &mut [Vec3], factor: f64) {
    for point in points {
        *point = times(*point, factor);
    }
}

/// Scales everything in a model except its collider.
pub(crate) fn all_but_collider(
    model: &mut Model,
    factor: f64,
    object: &str,
) -> Result<(), GltfErrorKind> {
    let too_large =
        |object: String| GltfErrorKind::invalid(object, "is too large for f32 at that height");
    let rig = &mut model.rig;
    rig.skeleton = skeleton(&rig.skeleton, factor).map_err(|error| GltfErrorKind::Skeleton {
        object: object.to_owned(),
        error,
    })?;
    for clip in &mut rig.clips {
        let scaled = self::clip(clip, factor);
        *clip = scaled.map_err(|_| too_large(format!("animation {:?}", clip.name)))?;
    }
    for visual in &mut model.visual {
        points(&mut visual.positions, factor);
        if !visual.positions.iter().all(|p| p.is_finite()) {
            return Err(too_large(format!("mesh {:?}", visual.name)));
        }
    }
    for point in &mut model.rig.weak_points {
        point.position = times(point.position, factor);
        point.radius = (f64::from(point.radius) * factor) as f32;
        if !(point.position.is_finite() && point.radius.is_finite()) {
            return Err(too_large(format!("weak point {:?}", point.name)));
        }
    }
    Ok(())
}

fn skeleton(skeleton: &Skeleton, factor: f64) -> Result<Skeleton, RigError> {
    let mut joints = skeleton.joints().to_vec();
    for joint in &mut joints {
        joint.rest.translation = times(joint.rest.translation, factor);
        for row in &mut joint.inverse_bind.rows {
            row[3] = (f64::from(row[3]) * factor) as f32;
        }
    }
    Skeleton::new(joints)
}

fn clip(clip: &Clip, factor: f64) -> Result<Clip, RigError> {
    let scaled = clip.channels().iter().map(|channel| {
        let mut values = channel.values().clone();
        if let Keyframes::Translation(translations) = &mut values {
            points(translations, factor);
        }
        let times = channel.times().to_vec();
        Channel::new(channel.joint(), channel.interpolation(), times, values)
    });
    let channels: Result<Vec<Channel>, RigError> = scaled.collect();
    Clip::new(clip.name.clone(), channels?)
        .with_markers(clip.markers().to_vec())?
        .with_ground_speed(clip.ground_speed().map(|speed| speed * factor))
}

fn times(point: Vec3, factor: f64) -> Vec3 {
    (point.as_dvec3() * factor).as_vec3()
}
