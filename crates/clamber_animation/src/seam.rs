//! Tells whether a clip can be played as a loop. A file does not say so: a death or an attack ends in another pose than
//! it begins with. Played as a loop, it moves the skin from one pose to the other within a tick.

use std::collections::BTreeMap;

use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::mesh::{ColliderMesh, VertexId};
use glam::DVec3;

use crate::rig::{Clip, JointId, Playback, RigError, Skeleton};

/// The skin jumps at the seam if it is faster there than this many times its largest speed within the clip. A loop
/// without its closing key frame, a 24th or a 30th of a second, is two to three times as fast at the seam, and counts
/// as a jump as well.
const JUMP: f64 = 1.5;

/// Skin that is slower than this at the seam does not jump, however slow the clip is. In heights of the creature per
/// second: 0.2 m/s on a creature of 20 m.
const SLOW: f64 = 0.01;

/// Length of a tick over which speeds are measured, seconds.
const TICK: f64 = 1.0 / 60.0;
/// The most ticks of a clip that are measured: ten minutes. It limits the work for very long clips.
const MOST: f64 = 36_000.0;

/// The speeds of the vertex that jumps most between a clip's end and its beginning.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seam {
    /// The vertex's mean speed over the 60th of a second around the seam, heights of the creature per second.
    pub speed: f64,
    /// The vertex's largest speed within the clip, heights of the creature per second.
    pub within: f64,
}

impl Seam {
    /// How much faster the vertex is than the largest speed without a jump, heights of the creature per second;
    /// negative if it does not jump.
    fn excess(self) -> f64 {
        self.speed - (JUMP * self.within).max(SLOW)
    }

    /// True if the clip can be played as a loop: no skin jumps at the seam. Skin jumps if it is there more than 1.5
    /// times as fast as anywhere within the clip, and faster than a hundredth of the creature's height per second.
    pub fn is_loop(self) -> bool {
        self.excess() <= 0.0
    }
}

/// Measures the seams of a creature's clips at up to six vertices of each joint: the outermost ones along the axes.
#[derive(Clone, Debug)]
pub struct SeamProbe<'a> {
    skeleton: &'a Skeleton,
    mesh: &'a ColliderMesh,
    height: f64,
    vertices: Vec<VertexId>,
}

impl<'a> SeamProbe<'a> {
    /// A probe for a creature that is `height` model units tall; a height below 1e-9 counts as 1e-9.
    pub fn new(skeleton: &'a Skeleton, mesh: &'a ColliderMesh, height: f64) -> Self {
        Self {
            skeleton,
            mesh,
            height: height.max(1e-9),
            vertices: outermost(mesh),
        }
    }

    /// Measures the seam of a clip. It poses the skeleton for each 60th of a second of the clip's first ten minutes,
    /// and around the seam.
    ///
    /// # Errors
    /// [`RigError`] if the clip does not fit the skeleton.
    pub fn measure(&self, clip: &Clip) -> Result<Seam, RigError> {
        let duration = clip.duration();
        let per_second = 1.0 / (self.height * TICK);
        let speeds = |from: &[DVec3], to: &[DVec3]| -> Vec<f64> {
            let ways = from.iter().zip(to).map(|(a, b)| a.distance(*b));
            ways.map(|way| way * per_second).collect()
        };
        let mut before = self.skinned(clip, 0.0)?;
        let mut within = vec![0.0f64; before.len()];
        for tick in 1..=(duration / TICK).min(MOST) as u32 {
            let now = self.skinned(clip, f64::from(tick) * TICK)?;
            for (fastest, speed) in within.iter_mut().zip(speeds(&before, &now)) {
                *fastest = fastest.max(speed);
            }
            before = now;
        }
        let end = self.skinned(clip, duration - 0.5 * TICK)?;
        let start = self.skinned(clip, 0.5 * TICK)?;
        let seams = speeds(&end, &start).into_iter().zip(within);
        let seams = seams.map(|(speed, within)| Seam { speed, within });
        let worst = seams.max_by(|a, b| a.excess().total_cmp(&b.excess()));
        Ok(worst.unwrap_or_default())
    }

    fn skinned(&self, clip: &Clip, time: f64) -> Result<Vec<DVec3>, RigError> {
        let mut pose = self.skeleton.rest_pose();
        clip.sample_into(time, Playback::Clamp, &mut pose)?;
        let palette = self.skeleton.palette(&pose)?;
        let place = |v: &VertexId| skin_vertex_reference(self.mesh, palette.matrices(), *v);
        Ok(self.vertices.iter().filter_map(place).collect())
    }
}

/// For each joint, the outermost vertices in both directions of each axis, among the vertices on which this joint has
/// the largest weight. Sorted, without duplicates.
fn outermost(mesh: &ColliderMesh) -> Vec<VertexId> {
    let mut by_joint: BTreeMap<u32, [VertexId; 6]> = BTreeMap::new();
    let along = |v: VertexId, axis: usize| {
        let coordinate = mesh.positions()[v.index()][axis / 2];
        if axis.is_multiple_of(2) {
            coordinate
        } else {
            -coordinate
        }
    };
    for index in 0..mesh.positions().len() {
        let vertex = VertexId(index as u32);
        let strongest = mesh.influences(vertex).max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((JointId(joint), _)) = strongest else {
            continue;
        };
        let farthest = by_joint.entry(joint).or_insert([vertex; 6]);
        for (axis, best) in farthest.iter_mut().enumerate() {
            if along(vertex, axis) > along(*best, axis) {
                *best = vertex;
            }
        }
    }
    let mut vertices: Vec<VertexId> = by_joint.into_values().flatten().collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}
