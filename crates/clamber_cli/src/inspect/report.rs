use std::collections::BTreeMap;
use std::fmt;

use clamber_gltf::Model;
use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
use serde::{Serialize, Serializer};

/// A report on a creature's file: the results of its import, and the measurements. Lengths are in the file's metres.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inspection {
    /// Vertices of the collider, after welding.
    pub vertices: usize,
    /// Vertices that were merged into an equal one.
    pub welded: usize,
    /// Vertices at the position of another vertex that move differently from it: the skin can open there.
    pub cracks: usize,
    /// Triangles of the collider.
    pub triangles: usize,
    /// Triangles that were dropped as they have no area or are duplicates.
    pub dropped_triangles: usize,
    /// Joints of the skeleton.
    pub joints: usize,
    /// The largest number of influences of a vertex.
    pub max_influences: usize,
    /// The largest difference from 1 of the sum of a vertex's weights in the file.
    #[serde(serialize_with = "number")]
    pub worst_weight_error: f64,
    /// Names and lengths of the clips.
    pub clips: Vec<ClipLine>,
    /// Parts of the collider.
    pub parts: usize,
    /// Number of triangles by tag.
    pub tags: BTreeMap<String, usize>,
    /// The weak points.
    pub weak_points: Vec<WeakPointLine>,
    /// Number of visual meshes.
    pub visual_meshes: usize,
    /// Vertices of all visual meshes.
    pub visual_vertices: usize,
    /// The parts of the file that the import skipped or repaired.
    pub warnings: Vec<String>,
    /// Number of poses in which the numbers below were measured.
    pub poses: usize,
    /// Largest error of a skinned coordinate against skinning in f64, as a share of the stated bound.
    #[serde(serialize_with = "number")]
    pub skinning_error_share: f64,
    /// Answers that were compared with brute force. Half of them were skinned lazily, half with all vertices skinned
    /// ahead.
    pub answers: usize,
    /// Hits and contacts in the answers that agree with brute force.
    pub hits: usize,
    /// Answers that differ from brute force in any bit.
    pub wrong_answers: usize,
    /// The first wrong answer: its question, the answer, and the answer of brute force.
    pub first_wrong_answer: Option<String>,
    /// How often a skinned vertex was outside of a bounding sphere of its part.
    pub bound_violations: usize,
    /// Distances between the visual meshes and the collider; `None` without visual meshes.
    pub collision_to_visual: Option<Distances>,
    /// Median time to skin all vertices, microseconds.
    pub skin_us: f64,
    /// Median time to refit the parts' spheres, microseconds.
    pub refit_us: f64,
}

/// A clip of the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClipLine {
    /// The clip's name.
    pub name: String,
    /// The clip's length, seconds.
    pub seconds: f64,
}

/// A weak point of the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WeakPointLine {
    /// The weak point's name.
    pub name: String,
    /// Name of the joint that carries the weak point.
    pub joint: String,
    /// Damage that the weak point takes before it is used up.
    pub hit_points: f64,
    /// True if the creature dies when the weak point is used up.
    pub major: bool,
}

/// Distances between the visual meshes and the collider, from random vertices of each to the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distances {
    /// The median, metres.
    #[serde(serialize_with = "number")]
    pub median_m: f64,
    /// The largest, metres.
    #[serde(serialize_with = "number")]
    pub worst_m: f64,
}

impl Inspection {
    /// The report on an import, before any measurement.
    pub(super) fn of_import(model: &Model) -> Self {
        let build = &model.report.build;
        let mut tags = BTreeMap::new();
        for tag in model.rig.collider.tags().iter() {
            *tags.entry(name_of(*tag)).or_default() += 1;
        }
        let clip = |clip: &clamber_surface::rig::Clip| ClipLine {
            name: clip.name.clone(),
            seconds: clip.duration(),
        };
        let joint_name = |joint: clamber_surface::rig::JointId| {
            let joint = model.rig.skeleton.joints().get(joint.0 as usize);
            joint.map(|joint| joint.name.clone()).unwrap_or_default()
        };
        let weak_point = |point: &clamber_gltf::WeakPoint| WeakPointLine {
            name: point.name.clone(),
            joint: joint_name(point.joint),
            hit_points: point.hit_points,
            major: point.major,
        };
        Self {
            vertices: build.vertices,
            welded: build.welded,
            cracks: build.cracks,
            triangles: build.triangles,
            dropped_triangles: build.degenerate_triangles + build.duplicate_triangles,
            joints: model.rig.skeleton.joints().len(),
            max_influences: build.max_influences,
            worst_weight_error: build.worst_weight_error,
            clips: model.rig.clips.iter().map(clip).collect(),
            parts: model.rig.collider.part_count(),
            tags,
            weak_points: model.rig.weak_points.iter().map(weak_point).collect(),
            visual_meshes: model.visual.len(),
            visual_vertices: model.visual.iter().map(|seen| seen.positions.len()).sum(),
            warnings: model
                .report
                .warnings
                .iter()
                .map(ToString::to_string)
                .collect(),
            ..Self::default()
        }
    }

    /// The report as one JSON object. Errors and distances that are not finite are written as text: `inf`, `NaN`.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|error| error.to_string())
    }

    /// True if the library's promises held for this creature: the skinning error is within its bound, no answer is
    /// wrong, and no vertex is outside of a bound.
    pub fn holds(&self) -> bool {
        self.skinning_error_share <= 1.0 && self.wrong_answers == 0 && self.bound_violations == 0
    }
}

fn name_of(tag: SurfaceTag) -> String {
    let kind = match tag.kind {
        SurfaceKind::Skin => "skin",
        SurfaceKind::Fur => "fur",
        SurfaceKind::Stone => "stone",
    };
    format!("{kind}{}", if tag.ledge { " ledge" } else { "" })
}

/// The rows of a table.
#[derive(Default)]
struct Rows(String);

impl Rows {
    fn push(&mut self, name: &str, value: impl fmt::Display) {
        self.0.push_str(&format!("  {name:<24}{value}\n"));
    }
}

impl Inspection {
    /// The results of the import, as rows of a table.
    pub fn import(&self) -> String {
        let mut rows = Rows::default();
        let mut row = |name: &str, value: String| rows.push(name, value);
        row(
            "vertices",
            format!("{} ({} welded)", self.vertices, self.welded),
        );
        row("cracks", self.cracks.to_string());
        let dropped = self.dropped_triangles;
        row(
            "triangles",
            format!("{} ({dropped} dropped)", self.triangles),
        );
        row("joints, parts", format!("{}, {}", self.joints, self.parts));
        row("max influences", self.max_influences.to_string());
        row(
            "worst weight error",
            format!("{:.1e}", self.worst_weight_error),
        );
        let clips = self
            .clips
            .iter()
            .map(|c| format!("{} {:.2} s", c.name, c.seconds));
        row("clips", list(clips));
        let tags = self
            .tags
            .iter()
            .map(|(tag, count)| format!("{tag} {count}"));
        row("triangles by tag", list(tags));
        let points = self.weak_points.iter().map(|point| {
            let major = if point.major { ", major" } else { "" };
            format!(
                "{} on {} ({}{major})",
                point.name, point.joint, point.hit_points
            )
        });
        row("weak points", list(points));
        let vertices = self.visual_vertices;
        row(
            "visual meshes",
            format!("{} ({vertices} vertices)", self.visual_meshes),
        );
        for warning in &self.warnings {
            row("warning", warning.clone());
        }
        rows.0
    }

    /// The measurements, as rows of a table.
    pub fn measured(&self) -> String {
        let mut rows = Rows::default();
        let mut row = |name: &str, value: String| rows.push(name, value);
        row("measured in", format!("{} poses", self.poses));
        let verdict = |holds: bool| if holds { "ok" } else { "FAILED" };
        let share = self.skinning_error_share;
        row(
            "skinning error",
            format!("{share:.3} of the bound  {}", verdict(share <= 1.0)),
        );
        let (wrong, answers) = (self.wrong_answers, self.answers);
        row(
            "wrong answers",
            format!(
                "{wrong} of {answers}, with {} hits  {}",
                self.hits,
                verdict(wrong == 0)
            ),
        );
        if let Some(first) = &self.first_wrong_answer {
            row("first wrong answer", first.clone());
        }
        let violations = self.bound_violations;
        row(
            "bound violations",
            format!("{violations}  {}", verdict(violations == 0)),
        );
        if let Some(distance) = self.collision_to_visual {
            let Distances { median_m, worst_m } = distance;
            row(
                "collision to visual",
                format!("median {median_m:.3} m, worst {worst_m:.3} m"),
            );
        }
        row("skinning, all vertices", format!("{:.1} us", self.skin_us));
        row("refitting spheres", format!("{:.1} us", self.refit_us));
        rows.0
    }
}

impl fmt::Display for Inspection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", self.import(), self.measured())
    }
}

/// Serialises a finite number as a number and any other as text (`inf`, `NaN`), where JSON would have `null`.
fn number<S: Serializer>(number: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    if number.is_finite() {
        serializer.serialize_f64(*number)
    } else {
        serializer.serialize_str(&number.to_string())
    }
}

/// Joins items with commas, in lines that fit beside the rows' names. Returns `none` if there are no items.
fn list(items: impl Iterator<Item = String>) -> String {
    let mut text = String::new();
    let mut column = 0;
    for item in items {
        if !text.is_empty() {
            text.push(',');
            column += 1 + item.len();
            let (gap, start) = if column > WIDTH {
                (BREAK, item.len())
            } else {
                (" ", column + 1)
            };
            text.push_str(gap);
            column = start;
        } else {
            column = item.len();
        }
        text.push_str(&item);
    }
    if text.is_empty() { "none".into() } else { text }
}

/// Number of characters that fit beside the rows' names.
const WIDTH: usize = 70;

/// A line break with an indent to the column of the first item: 2 spaces and the 24 columns of `Rows::push`.
const BREAK: &str = "\n                          ";
