//! How a clip is repeated. A file does not tell which of its clips are loops: a death or an attack ends in another pose
//! than it begins with. Played as a loop, it throws the skin from one pose to the other within a tick.
//!
//! The seam of each clip is measured at the outermost vertices of every joint: the speed of each vertex in a tick that
//! spans the clip's end and beginning is compared with its largest speed within the clip. If a vertex is much faster at
//! the seam, the clip is not a loop. It is then played to its end and back again, so that all poses come from the file
//! and nothing jumps. (`SkinnedSurface::place` at the seam would report no motion either, but it teleports whatever
//! stands on the skin, and rides exist to test carrying.)

use std::collections::BTreeMap;

use clamber_surface::measure::skin_vertex_reference;
use clamber_surface::mesh::{ColliderMesh, VertexId};
use clamber_surface::rig::{Clip, JointId, Palette, Playback, Pose};
use glam::DVec3;

use super::{BattleError, TICK};
use crate::Creature;

/// Skin that is more than so many times as fast at the seam as anywhere within the clip jumps there. A loop that lacks
/// its closing key frame, a 24th or a 30th of a second, is two to three times as fast, and counts as a jump as well.
const JUMP: f64 = 1.5;

/// Skin that is slower than this at the seam does not jump, however slow the clip is. In heights of the creature per
/// second: 0.2 m/s on a creature of 20 m.
const SLOW: f64 = 0.01;

/// Seconds in which a clip that turns back slows down to rest, at most the clip's length. A shorter time jerks harder.
const TURN: f64 = 0.25;

/// How a clip goes on after its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Repeat {
    /// The clip begins again.
    Loop,
    /// The clip runs backwards to its beginning, and forwards again.
    BackAndForth,
    /// The clip stays at its beginning.
    Hold,
}

impl Repeat {
    /// The time within a clip of length `duration`, `time` seconds after the clip was first played. All in seconds.
    pub(crate) fn time(self, time: f64, duration: f64) -> f64 {
        if duration <= 0.0 || self == Self::Hold {
            return 0.0;
        }
        if self == Self::Loop {
            return time.rem_euclid(duration);
        }
        // A triangle wave with its corners rounded to parabolas over `turn` seconds, which makes each half `turn`
        // longer.
        let turn = TURN.min(duration);
        let half = duration + turn;
        let phase = time.rem_euclid(2.0 * half);
        let along = phase.min(2.0 * half - phase);
        let rounded = |from_end: f64| {
            if from_end < turn {
                0.5 * from_end * from_end / turn
            } else {
                from_end - 0.5 * turn
            }
        };
        if along < 0.5 * half {
            rounded(along)
        } else {
            duration - rounded(half - along)
        }
    }
}

/// Speeds of the vertex that jumps most between a clip's end and its beginning.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Seam {
    /// The vertex's speed across the seam, heights of the creature a second.
    pub(super) speed: f64,
    /// The vertex's largest speed within the clip, heights of the creature a second.
    pub(super) within: f64,
}

impl Seam {
    /// How much faster the vertex is than skin that does not jump, heights of the creature a second; negative if it
    /// does not jump.
    fn excess(self) -> f64 {
        self.speed - (JUMP * self.within).max(SLOW)
    }

    /// How a clip with this seam is repeated.
    pub(crate) fn repeat(self) -> Repeat {
        if self.excess() > 0.0 {
            Repeat::BackAndForth
        } else {
            Repeat::Loop
        }
    }
}

/// Measures the seams of a creature's clips.
pub(crate) struct SeamProbe<'a> {
    creature: &'a Creature,
    /// Height of the creature in model units.
    height: f64,
    /// The outermost vertices of every joint.
    vertices: Vec<VertexId>,
}

impl<'a> SeamProbe<'a> {
    /// A probe for a creature that is `height` model units tall.
    pub(crate) fn new(creature: &'a Creature, height: f64) -> Self {
        Self {
            creature,
            height,
            vertices: outermost(&creature.collider),
        }
    }

    /// Measures the seam of a clip.
    ///
    /// # Errors
    /// [`BattleError::Creature`] if the clip does not fit the skeleton.
    pub(crate) fn measure(&self, clip: &Clip) -> Result<Seam, BattleError> {
        let duration = clip.duration();
        let per_second = 1.0 / (self.height * TICK);
        let speeds = |from: &[DVec3], to: &[DVec3]| -> Vec<f64> {
            let ways = from.iter().zip(to).map(|(a, b)| a.distance(*b));
            ways.map(|way| way * per_second).collect()
        };
        let mut before = self.skinned(clip, 0.0)?;
        let mut within = vec![0.0f64; before.len()];
        for tick in 1..=(duration / TICK) as u32 {
            let now = self.skinned(clip, f64::from(tick) * TICK)?;
            for (fastest, speed) in within.iter_mut().zip(speeds(&before, &now)) {
                *fastest = fastest.max(speed);
            }
            before = now;
        }
        // A tick with the seam in its middle.
        let end = self.skinned(clip, duration - 0.5 * TICK)?;
        let start = self.skinned(clip, 0.5 * TICK)?;
        let seams = speeds(&end, &start).into_iter().zip(within);
        let seams = seams.map(|(speed, within)| Seam { speed, within });
        let worst = seams.max_by(|a, b| a.excess().total_cmp(&b.excess()));
        Ok(worst.unwrap_or_default())
    }

    fn skinned(&self, clip: &Clip, time: f64) -> Result<Vec<DVec3>, BattleError> {
        let skeleton = &self.creature.skeleton;
        let mut pose: Pose = skeleton.rest_pose();
        clip.sample_into(time, Playback::Clamp, &mut pose)?;
        let palette: Palette = skeleton.palette(&pose)?;
        let mesh = &self.creature.collider;
        let place = |v: &VertexId| skin_vertex_reference(mesh, palette.matrices(), *v);
        Ok(self.vertices.iter().filter_map(place).collect())
    }
}

/// For every joint, the outermost vertices along each axis of those that it moves more than any other joint does.
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

#[cfg(test)]
mod tests {
    use clamber_surface::rig::{Channel, Interpolation, Keyframes};
    use glam::Vec3;

    use super::*;
    use crate::beast::beast;

    /// The longest step of a clip's time in one tick, over a minute.
    fn longest_step(repeat: Repeat, duration: f64) -> f64 {
        let at = |tick: u32| repeat.time(f64::from(tick) * TICK, duration);
        let steps = (0..3600).map(|tick| (at(tick + 1) - at(tick)).abs());
        steps.fold(0.0, f64::max)
    }

    #[test]
    fn back_and_forth_covers_the_clip_and_never_jumps() {
        for duration in [0.05, 0.25, 0.62, 3.0] {
            let times: Vec<f64> = (0..36_000)
                .map(|n| Repeat::BackAndForth.time(f64::from(n) * 0.001, duration))
                .collect();
            let (low, high) = times
                .iter()
                .fold((f64::INFINITY, 0.0f64), |(low, high), t| {
                    (low.min(*t), high.max(*t))
                });
            assert!((0.0..1e-4).contains(&low), "{duration}: begins at {low}");
            assert!(
                (duration - 1e-4..=duration).contains(&high),
                "{duration}: ends at {high}"
            );
            // Never faster than forwards, and without sudden changes of speed.
            let speeds: Vec<f64> = times.windows(2).map(|w| (w[1] - w[0]) / 0.001).collect();
            let fastest = speeds.iter().fold(0.0f64, |a, b| a.max(b.abs()));
            assert!(fastest < 1.0 + 1e-9, "{duration}: {fastest} of its speed");
            let jerk = speeds.windows(2).map(|w| (w[1] - w[0]).abs());
            let jerk = jerk.fold(0.0, f64::max);
            assert!(jerk < 0.021, "{duration}: speed changes by {jerk} in 1 ms");
        }
    }

    #[test]
    fn clips_of_a_creature_are_measured() {
        let creature = beast(1_000);
        let (low, high) = creature.bounds(&creature.skeleton.rest_pose()).unwrap();
        let height = f64::from(high.y - low.y);
        let probe = SeamProbe::new(&creature, height);
        for clip in &creature.clips {
            let seam = probe.measure(clip).unwrap();
            assert_eq!(seam.repeat(), Repeat::Loop, "{}: {seam:?}", clip.name);
        }
        // The root moves by the creature's height in a second, and jumps back.
        let way = Vec3::new(height as f32, 0.0, 0.0);
        let mut joints = creature.skeleton.joints().iter();
        let root = joints.position(|joint| joint.parent.is_none()).unwrap();
        let rest = creature.skeleton.joints()[root].rest.translation;
        let there = Keyframes::Translation(vec![rest, rest + way]);
        let linear = Interpolation::Linear;
        let joint = JointId(root as u32);
        let channel = Channel::new(joint, linear, vec![0.0, 1.0], there).unwrap();
        let seam = probe.measure(&Clip::new("leap", vec![channel])).unwrap();
        assert!((seam.within - 1.0).abs() < 1e-3, "{seam:?}");
        assert!((58.0..60.0).contains(&seam.speed), "{seam:?}");
        assert_eq!(seam.repeat(), Repeat::BackAndForth);
    }

    #[test]
    fn only_a_loop_jumps_at_its_end() {
        assert!(longest_step(Repeat::Loop, 1.3) > 1.2);
        assert!(longest_step(Repeat::BackAndForth, 1.3) <= TICK + 1e-9);
    }

    #[test]
    fn a_seam_is_judged_by_the_clip_around_it() {
        let seam = |speed, within| Seam { speed, within }.repeat();
        assert_eq!(seam(12.0, 1.0), Repeat::BackAndForth);
        assert_eq!(seam(1.0, 1.0), Repeat::Loop);
        // A fast clip may be fast at its seam; a still one may creep.
        assert_eq!(seam(12.0, 11.0), Repeat::Loop);
        assert_eq!(seam(0.005, 0.0), Repeat::Loop);
    }
}
