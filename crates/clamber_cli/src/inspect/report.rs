use std::collections::{BTreeMap, HashMap};
use std::fmt;

use clamber_gltf::Model;
use clamber_surface::mesh::{ColliderMesh, SurfaceKind, SurfaceTag, VertexId};
use clamber_surface::skin::skin;
use clamber_surface::surface::SkinnedSurface;
use glam::Vec3;
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
    /// Edges of the collider at which its triangles do not pair off in opposite directions: 0 if it is closed.
    pub open_edges: usize,
    /// Size of the collider along x, y and z, posed at rest; 0 if it cannot be posed at rest.
    pub size: [f32; 3],
    /// Memory of the collider, bytes. Queries add caches to it, which grow with the clusters that they touch.
    pub memory: usize,
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
    /// Number of poses in which distances were measured.
    pub poses: usize,
    /// Distances between the visual meshes and the collider; `None` without visual meshes.
    pub collision_to_visual: Option<Distances>,
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
            open_edges: open_edges(&model.rig.collider),
            size: size(model),
            memory: SkinnedSurface::new(model.rig.collider.clone()).memory(),
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

    /// The report as one JSON object. Numbers that are not finite are written as text: `inf`, `NaN`.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|error| error.to_string())
    }
}

/// The number of edges at which the triangles do not pair off in opposite directions.
fn open_edges(mesh: &ColliderMesh) -> usize {
    let mut directions: HashMap<[VertexId; 2], i32> = HashMap::new();
    for &[a, b, c] in mesh.triangles() {
        for [from, to] in [[a, b], [b, c], [c, a]] {
            let direction = if from < to { 1 } else { -1 };
            *directions.entry([from.min(to), from.max(to)]).or_default() += direction;
        }
    }
    directions.values().filter(|sum| **sum != 0).count()
}

/// Size of the collider along x, y and z, posed at rest.
fn size(model: &Model) -> [f32; 3] {
    let palette = model.rig.skeleton.palette(&model.rig.skeleton.rest_pose());
    let positions = palette.map(|palette| skin(&model.rig.collider, palette.matrices()));
    let Ok(Ok(positions)) = positions else {
        return [0.0; 3];
    };
    let corners = model.rig.collider.triangles().iter().flatten();
    let corners = corners.map(|corner| positions[corner.index()]);
    let low = corners.clone().reduce(Vec3::min).unwrap_or_default();
    let high = corners.reduce(Vec3::max).unwrap_or_default();
    (high - low).to_array()
}

fn name_of(tag: SurfaceTag) -> String {
    let kind = match tag.kind {
        SurfaceKind::Skin => "skin",
        SurfaceKind::Fur => "fur",
        SurfaceKind::Stone => "stone",
    };
    kind.to_owned()
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
        row(
            "closed",
            match self.open_edges {
                0 => "yes".into(),
                edges => format!("no, {edges} open edges"),
            },
        );
        let [x, y, z] = self.size;
        row("size at rest", format!("{x:.3} x {y:.3} x {z:.3} m"));
        row("memory", format!("{:.1} MB", self.memory as f64 / 1e6));
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
        if let Some(distance) = self.collision_to_visual {
            let Distances { median_m, worst_m } = distance;
            row(
                "collision to visual",
                format!("median {median_m:.3} m, worst {worst_m:.3} m"),
            );
        }
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
