use std::path::PathBuf;

use clap::Args;

/// Reports on a creature's file and measures the creature in motion. Reports on a brain's file.
///
/// Loads the file as the library does and prints the results of the import. Then it poses the creature at rest and in
/// its clips, and measures the distance between its collision mesh and its visual meshes. Exits with 2 if the file
/// cannot be loaded.
///
/// With --brain it reads a brain's file and prints its states, its transitions, and the ones that can never happen. It
/// exits with 1 if there are any, and with 2 if the file is not valid. With --propose-brain it writes such a file for a
/// creature.
#[derive(Args, Clone, Debug)]
pub struct InspectOptions {
    /// A .glb or .gltf file; with --brain, a .json file.
    pub file: PathBuf,

    /// Read the file as a creature's brain: print its states, its transitions, and the ones that can never happen.
    #[arg(long, conflicts_with_all = ["json", "scene", "skin", "clips", "poses", "thorough", "humanoid"])]
    pub brain: bool,

    /// With --brain: the creature's .glb or .gltf file. The brain has to fit its clips, joints and weak points.
    #[arg(long, value_name = "FILE", requires = "brain")]
    pub creature: Option<PathBuf>,

    /// With --brain: ticks per second of the game.
    #[arg(long, value_name = "COUNT", requires = "brain", default_value_t = 60)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=1_000))]
    pub rate: u32,

    /// Print one JSON object instead of a table.
    #[arg(long)]
    pub json: bool,

    /// Index of the scene to load [default: the file's default scene, else the first that shows a mesh].
    #[arg(long, value_name = "INDEX")]
    pub scene: Option<usize>,

    /// Index of a skin: inspects the creature that has this skin [default: the creature with the most triangles].
    #[arg(long, value_name = "INDEX")]
    pub skin: Option<usize>,

    /// Measure only in this clip. May be given several times.
    #[arg(long = "clip", value_name = "NAME")]
    pub clips: Vec<String>,

    /// Number of poses of each clip [default: 30, or fewer if there are many clips, for about 300 poses in all].
    #[arg(long, value_name = "COUNT", conflicts_with = "thorough")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub poses: Option<u32>,

    /// Measure 30 poses of each clip, however many clips there are.
    #[arg(long)]
    pub thorough: bool,

    /// Print the joints as a tree, with their places at rest and the number of vertices they move, and measure nothing.
    #[arg(long, conflicts_with_all = ["json", "clips", "poses", "thorough", "humanoid", "brain"])]
    pub joints: bool,

    /// Print a brain's file that fits the creature, as a draft to edit, and measure nothing. It has legs, gait, head,
    /// fur, a weak point, and states for the clips that the creature has.
    #[arg(long, conflicts_with_all = ["json", "clips", "poses", "thorough", "humanoid", "brain", "joints"])]
    pub propose_brain: bool,

    /// With --propose-brain: height of the creature, metres.
    #[arg(
        long,
        value_name = "METRES",
        requires = "propose_brain",
        default_value_t = 20.0
    )]
    pub height: f64,

    /// Print the joints that make a human body, and measure nothing. Exits with 1 if the file has no human body.
    #[arg(long, conflicts_with_all = ["json", "clips", "poses", "thorough"])]
    pub humanoid: bool,

    /// With --humanoid: draw the skeleton at rest into this SVG file.
    #[arg(long, value_name = "SVG", requires = "humanoid")]
    pub draw: Option<PathBuf>,

    /// Seed of the random vertices at which distances are measured. Equal seeds give equal vertices.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
}

/// Number of poses of a clip with `--thorough`, and the largest number by default.
const POSES: u32 = 30;

/// Number of poses of all clips together, by default. More clips than that have one pose each.
const BUDGET: usize = 300;

impl InspectOptions {
    /// The default options for a file.
    pub fn of(file: PathBuf) -> Self {
        Self {
            file,
            brain: false,
            creature: None,
            rate: 60,
            json: false,
            scene: None,
            skin: None,
            clips: Vec::new(),
            poses: None,
            thorough: false,
            joints: false,
            propose_brain: false,
            height: 20.0,
            humanoid: false,
            draw: None,
            seed: 1,
        }
    }

    /// Number of poses of each clip if there are `clips` clips: at least 1.
    pub(super) fn poses_of_each(&self, clips: usize) -> u32 {
        let within_budget = (BUDGET / clips.max(1)).clamp(1, POSES as usize) as u32;
        match self.poses {
            Some(poses) => poses,
            None if self.thorough => POSES,
            None => within_budget,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_budget_is_shared_by_the_clips() {
        let options = InspectOptions::of(PathBuf::new());
        let poses = [0, 1, 7, 10, 76, 300, 1_000].map(|clips| options.poses_of_each(clips));
        assert_eq!(poses, [30, 30, 30, 30, 3, 1, 1]);
        let thorough = InspectOptions {
            thorough: true,
            ..options
        };
        assert_eq!(thorough.poses_of_each(76), 30);
    }
}
