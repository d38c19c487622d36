//! Additions of the brain's file to a creature's own file: markers and closed ends of clips, fur, and weak points.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use clamber_animation::joint_in_model;
use clamber_animation::rig::{
    Channel, Clip, Interpolation, JointId, Keyframes, Marker, RigError, WeakPoint,
};
use clamber_surface::mesh::{ColliderMesh, SurfaceKind, SurfaceTag, TriangleId};
use glam::{DVec3, Quat, Vec3};

use super::Names;
use super::file::{BodyFile, FurFile, WeakPointFile};
use crate::brain::{BrainError, BrainProblem, check, whole};

/// Adds the brain file's markers to the clips, and extends clips that have a `close` there.
pub(crate) fn changed(clips: Vec<Clip>, body: &BodyFile) -> Result<Vec<Clip>, BrainError> {
    for name in body.clips.keys() {
        if !clips.iter().any(|clip| clip.name == *name) {
            let known = clips.iter().map(|clip| &clip.name);
            return Err(whole(BrainProblem::unknown("clip", name, known)));
        }
    }
    let mut seen = BTreeSet::new();
    let marked = clips.into_iter().map(|clip| {
        // If several clips have the same name, only the first one is changed.
        let is_first = seen.insert(clip.name.clone());
        let Some(file) = body.clips.get(&clip.name).filter(|_| is_first) else {
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
        let in_words = |error: RigError| {
            let fault = format!("clip `{}`: {error}", clip.name);
            whole(BrainProblem::Text(fault))
        };
        let marked = clip.clone().with_markers(markers).map_err(in_words)?;
        let Some(seconds) = file.close else {
            return Ok(marked);
        };
        let is_within = seconds > 0.0 && seconds <= LONGEST_CLOSE;
        check(is_within, "close", "more than 0 and at most 10 s", seconds).map_err(whole)?;
        closed(&marked, seconds).map_err(in_words)
    });
    marked.collect()
}

/// The longest time that [`ClipFile::close`](super::ClipFile::close) may add to a clip, seconds.
const LONGEST_CLOSE: f64 = 10.0;

/// Extends a clip by `seconds`, in which it returns from its end to its first pose.
fn closed(clip: &Clip, seconds: f64) -> Result<Clip, RigError> {
    let spans = || clip.channels().iter().map(Channel::span);
    let end = spans().map(|span| span.1).fold(f32::NEG_INFINITY, f32::max);
    let back = (f64::from(end) + seconds) as f32;
    let channels = clip.channels().iter().map(|channel| {
        let (mut times, interpolation) = (channel.times().to_vec(), channel.interpolation());
        // A channel that ends before the clip holds its last value until the clip's end.
        let is_held = channel.span().1 < end;
        times.extend(is_held.then_some(end));
        times.push(back);
        let spline = interpolation == Interpolation::CubicSpline;
        let vector = |values: &[Vec3]| extended(values, spline, Vec3::ZERO, is_held);
        let values = match channel.values() {
            Keyframes::Translation(values) => Keyframes::Translation(vector(values)),
            Keyframes::Scale(values) => Keyframes::Scale(vector(values)),
            Keyframes::Rotation(values) => {
                let still = Quat::from_xyzw(0.0, 0.0, 0.0, 0.0);
                let mut values = extended(values, spline, still, is_held);
                // The same rotation with the sign that is nearer to the value before it; otherwise a spline takes the
                // long way round.
                let last = values.len() - 1 - usize::from(spline);
                let before = last.checked_sub(if spline { 3 } else { 1 });
                if before.is_some_and(|before| {
                    values[before].as_dquat().dot(values[last].as_dquat()) < 0.0
                }) {
                    values[last] = -values[last];
                }
                Keyframes::Rotation(values)
            }
        };
        Channel::new(channel.joint(), interpolation, times, values)
    });
    with_channels(clip, channels.collect::<Result<_, _>>()?)
}

/// The clip with other channels.
pub(super) fn with_channels(clip: &Clip, channels: Vec<Channel>) -> Result<Clip, RigError> {
    Clip::new(clip.name.clone(), channels)
        .with_markers(clip.markers().to_vec())?
        .with_ground_speed(clip.ground_speed())
}

/// The values of a channel, followed by its last value once more if it `is_held`, and by its first value. `still` are
/// the tangents of splines at these values.
fn extended<T: Copy>(values: &[T], is_spline: bool, still: T, is_held: bool) -> Vec<T> {
    let mut values = values.to_vec();
    let middle = usize::from(is_spline);
    let (Some(&first), Some(&last)) = (values.get(middle), values.iter().rev().nth(middle)) else {
        return values;
    };
    if is_spline {
        let end = values.len() - 1;
        values[end] = still;
    }
    for value in is_held.then_some(last).into_iter().chain([first]) {
        if is_spline {
            values.extend([still, value, still]);
        } else {
            values.push(value);
        }
    }
    values
}

/// The mesh with the fur of the brain's file.
pub(crate) fn furred(
    names: &Names<'_>,
    fur: &FurFile,
    mesh: Arc<ColliderMesh>,
    materials: &BTreeMap<String, Vec<TriangleId>>,
) -> Result<Arc<ColliderMesh>, BrainError> {
    let mut joints: BTreeSet<JointId> = BTreeSet::new();
    for pattern in &fur.joints {
        joints.extend(names.joints(pattern).map_err(whole)?);
    }
    let mut all: BTreeSet<TriangleId> = BTreeSet::new();
    for name in &fur.materials {
        let Some(triangles) = materials.get(name) else {
            let known = materials.keys();
            return Err(whole(BrainProblem::unknown("material", name, known)));
        };
        all.extend(triangles);
    }
    if joints.is_empty() && all.is_empty() {
        return Ok(mesh);
    }
    let is_of = |triangle| {
        mesh.joint_of(triangle)
            .is_some_and(|joint| joints.contains(&joint))
    };
    let furred = mesh.with_tags(|triangle, tag| {
        let grows = tag.kind != SurfaceKind::Stone && is_of(triangle);
        if grows || all.contains(&triangle) {
            SurfaceTag {
                kind: SurfaceKind::Fur,
                ..tag
            }
        } else {
            tag
        }
    });
    Ok(Arc::new(furred))
}

/// A weak point of the brain's file, for a creature whose height in the model's units is `height`.
pub(crate) fn weak_point(
    names: &Names<'_>,
    file: &WeakPointFile,
    height: f64,
) -> Result<WeakPoint, BrainError> {
    let range = |what, range, found: f64, least: f64, most: f64| {
        check((least..=most).contains(&found), what, range, found).map_err(whole)
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
