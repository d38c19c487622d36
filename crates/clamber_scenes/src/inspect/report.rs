use std::collections::BTreeMap;
use std::fmt;

use clamber_gltf::Rig;
use clamber_surface::mesh::{SurfaceKind, SurfaceTag};
use serde::Serialize;

use crate::json::number;

/// What the import found, and what was measured. Lengths are in the file's metres.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inspection {
    /// Vertices of the collider, after welding.
    pub vertices: usize,
    /// Vertices merged into an equal one.
    pub welded: usize,
    /// Vertices that stand where another one stands, but move differently: the skin can gape there.
    pub cracks: usize,
    /// Triangles of the collider.
    pub triangles: usize,
    /// Triangles without area, or given twice.
    pub dropped_triangles: usize,
    /// Joints of the skeleton.
    pub joints: usize,
    /// The most influences of one vertex.
    pub max_influences: usize,
    /// The largest difference from 1 of a vertex's weights as given.
    #[serde(serialize_with = "number")]
    pub worst_weight_error: f64,
    /// Names and lengths of the clips.
    pub clips: Vec<ClipLine>,
    /// Joints that move triangles most.
    pub parts: usize,
    /// Triangles by tag.
    pub tags: BTreeMap<String, usize>,
    /// Where the creature can be wounded.
    pub weak_points: Vec<WeakPointLine>,
    /// Meshes to be seen.
    pub visual_meshes: usize,
    /// Their vertices.
    pub visual_vertices: usize,
    /// What was passed over or mended.
    pub warnings: Vec<String>,
    /// Poses that all below was measured in.
    pub poses: usize,
    /// Worst error of a skinned coordinate against f64, as a share of the stated bound.
    #[serde(serialize_with = "number")]
    pub skinning_error_share: f64,
    /// Hits of the queries, lazy and skinned ahead, that were compared with brute force.
    pub query_hits: usize,
    /// Queries that differ from brute force in any bit.
    pub query_mismatches: usize,
    /// Vertices outside a bound that is to hold them.
    pub bound_violations: usize,
    /// Between what is to be seen and the collider; none if nothing is to be seen.
    pub collision_to_visual: Option<Distances>,
    /// What it costs to skin all vertices, median of all poses.
    pub skin_us: f64,
    /// What it costs to refit the parts' spheres, median of all poses.
    pub refit_us: f64,
}

/// A clip of the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClipLine {
    /// Its name.
    pub name: String,
    /// Its length.
    pub seconds: f64,
}

/// A weak point of the file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WeakPointLine {
    /// Its name.
    pub name: String,
    /// The joint that it is on.
    pub joint: String,
    /// What it takes.
    pub hit_points: f64,
    /// True if the creature dies of it.
    pub major: bool,
}

/// Distances between what is to be seen and the collider, at random vertices of both.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Distances {
    /// Half of the places are at most so far.
    #[serde(serialize_with = "number")]
    pub median_m: f64,
    /// The farthest of these places.
    #[serde(serialize_with = "number")]
    pub worst_m: f64,
}

impl Inspection {
    /// What the import says, nothing measured yet.
    pub(super) fn of_import(rig: &Rig) -> Self {
        let build = &rig.report.build;
        let mut tags = BTreeMap::new();
        for tag in rig.collider.tags() {
            *tags.entry(name_of(*tag)).or_default() += 1;
        }
        let clip = |clip: &clamber_surface::rig::Clip| ClipLine {
            name: clip.name.clone(),
            seconds: clip.duration(),
        };
        let joint_name = |joint: clamber_surface::rig::JointId| {
            let joint = rig.skeleton.joints().get(joint.0 as usize);
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
            joints: rig.skeleton.joints().len(),
            max_influences: build.max_influences,
            worst_weight_error: build.worst_weight_error,
            clips: rig.clips.iter().map(clip).collect(),
            parts: rig.collider.parts().len(),
            tags,
            weak_points: rig.weak_points.iter().map(weak_point).collect(),
            visual_meshes: rig.visual.len(),
            visual_vertices: rig.visual.iter().map(|seen| seen.positions.len()).sum(),
            warnings: rig
                .report
                .warnings
                .iter()
                .map(ToString::to_string)
                .collect(),
            ..Self::default()
        }
    }

    /// As one JSON object; what is not a number is `null`.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_else(|error| error.to_string())
    }

    /// True if everything that is promised of every creature held for this one.
    pub fn holds(&self) -> bool {
        self.skinning_error_share <= 1.0 && self.query_mismatches == 0 && self.bound_violations == 0
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

impl fmt::Display for Inspection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut row = |name: &str, value: String| writeln!(f, "  {name:<24}{value}");
        row(
            "vertices",
            format!("{} ({} welded)", self.vertices, self.welded),
        )?;
        row("cracks", self.cracks.to_string())?;
        let dropped = self.dropped_triangles;
        row(
            "triangles",
            format!("{} ({dropped} dropped)", self.triangles),
        )?;
        row("joints, parts", format!("{}, {}", self.joints, self.parts))?;
        row("max influences", self.max_influences.to_string())?;
        row(
            "worst weight error",
            format!("{:.1e}", self.worst_weight_error),
        )?;
        let clips = self
            .clips
            .iter()
            .map(|c| format!("{} {:.2} s", c.name, c.seconds));
        row("clips", list(clips))?;
        let tags = self
            .tags
            .iter()
            .map(|(tag, count)| format!("{tag} {count}"));
        row("triangles by tag", list(tags))?;
        let points = self.weak_points.iter().map(|point| {
            let major = if point.major { ", major" } else { "" };
            format!(
                "{} on {} ({}{major})",
                point.name, point.joint, point.hit_points
            )
        });
        row("weak points", list(points))?;
        let vertices = self.visual_vertices;
        row(
            "visual meshes",
            format!("{} ({vertices} vertices)", self.visual_meshes),
        )?;
        for warning in &self.warnings {
            row("warning", warning.clone())?;
        }
        row("measured in", format!("{} poses", self.poses))?;
        let verdict = |holds: bool| if holds { "ok" } else { "FAILED" };
        let share = self.skinning_error_share;
        row(
            "skinning error",
            format!("{share:.3} of the bound  {}", verdict(share <= 1.0)),
        )?;
        let mismatches = self.query_mismatches;
        let hits = self.query_hits;
        row(
            "query mismatches",
            format!("{mismatches} in {hits} hits  {}", verdict(mismatches == 0)),
        )?;
        let violations = self.bound_violations;
        row(
            "bound violations",
            format!("{violations}  {}", verdict(violations == 0)),
        )?;
        if let Some(distance) = self.collision_to_visual {
            let Distances { median_m, worst_m } = distance;
            row(
                "collision to visual",
                format!("median {median_m:.3} m, worst {worst_m:.3} m"),
            )?;
        }
        row("skinning, all vertices", format!("{:.1} us", self.skin_us))?;
        row("refitting spheres", format!("{:.1} us", self.refit_us))
    }
}

/// Items one after the other, in lines that fit beside the names of the rows.
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

/// Columns beside the names of the rows.
const WIDTH: usize = 70;

/// To the next line, under the first item.
const BREAK: &str = "\n                          ";
