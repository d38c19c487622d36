//! What the brain's file says about a creature's own file: markers of clips, and weak points.

use clamber_animation::joint_in_model;
use clamber_animation::rig::{Clip, Marker, WeakPoint};
use glam::DVec3;

use super::file::{BodyFile, WeakPointFile};
use super::{Names, whole};
use crate::brain::{BrainError, BrainProblem, list};

/// Adds the brain's file's markers to clips.
pub(crate) fn mark(clips: Vec<Clip>, body: &BodyFile) -> Result<Vec<Clip>, BrainError> {
    for name in body.clips.keys() {
        if !clips.iter().any(|clip| clip.name == *name) {
            return Err(whole(BrainProblem::Unknown {
                what: "clip",
                name: name.clone(),
                known: list(clips.iter().map(|clip| &clip.name)),
            }));
        }
    }
    let marked = clips.into_iter().map(|clip| {
        let Some(file) = body.clips.get(&clip.name) else {
            return Ok(clip);
        };
        let kept = clip.markers().iter();
        let kept = kept.filter(|marker| !file.markers.contains_key(&marker.name));
        let mut markers: Vec<Marker> = kept.cloned().collect();
        for (name, times) in &file.markers {
            markers.extend(times.all().iter().map(|time| Marker {
                name: name.clone(),
                time: *time,
            }));
        }
        let marked = clip.with_markers(markers);
        marked.map_err(|error| whole(BrainProblem::Text(error.to_string())))
    });
    marked.collect()
}

/// A weak point of the brain's file, for a creature of a height in the model's units.
pub(crate) fn weak_point(
    names: &Names<'_>,
    file: &WeakPointFile,
    height: f64,
) -> Result<WeakPoint, BrainError> {
    let range = |what, range, found: f64, least: f64, most: f64| {
        if (least..=most).contains(&found) {
            Ok(())
        } else {
            Err(whole(BrainProblem::OutOfRange { what, range, found }))
        }
    };
    range("radius", "from 0 to 10 heights", file.radius, 0.0, 10.0)?;
    let (least, most) = (f64::MIN_POSITIVE, f64::MAX);
    range(
        "hit_points",
        "finite and more than 0",
        file.hit_points,
        least,
        most,
    )?;
    for found in file.at {
        range("at", "from -10 to 10 heights", found, -10.0, 10.0)?;
    }
    let joint = names.joint(&file.joint).map_err(whole)?;
    let frame = joint_in_model(names.skeleton, names.clips.rest(), joint).unwrap_or_default();
    let at = frame.matrix3.inverse() * (DVec3::from_array(file.at) * height);
    if !at.is_finite() {
        let fault = format!("`{}` or a joint above it is scaled by 0", file.joint);
        return Err(whole(BrainProblem::Text(fault)));
    }
    let mut point = WeakPoint::new(file.name.clone(), joint, at.as_vec3());
    point.radius = (file.radius * height) as f32;
    point.hit_points = file.hit_points;
    point.major = file.major;
    point.order = file.order.unwrap_or(u32::from(file.major));
    Ok(point)
}
