//! The order of the tasks: the same for the same seed, whatever the time.

use clamber_fuzz::stress::{Case, MeshFamily, Place, PoseFamily};

use crate::task::{Target, Task};

/// Sizes of stress cases, triangles. Every [`LARGE_EVERY`]th round has the last size.
const SIZES: [usize; 3] = [600, 6_000, 60_000];
const LARGE_EVERY: u64 = 16;

/// Ticks of a stress case.
const TICKS: usize = 3;

/// Inputs of each fuzz target after each stress case.
const INPUTS: u64 = 20;

/// Number of stress cases for each battle.
const BATTLE_EVERY: usize = 18;

/// Arenas after each battle.
const ARENAS: u64 = 3;

/// An endless sequence of tasks. Each round goes over every mesh in every pose; each task has a seed of its own.
pub(crate) fn tasks(seed: u64) -> impl Iterator<Item = Task> {
    let mut seeds = fastrand::Rng::with_seed(seed);
    (0u64..).flat_map(move |round| {
        let size = if round % LARGE_EVERY == LARGE_EVERY - 1 {
            SIZES[2]
        } else {
            SIZES[(round % 2) as usize]
        };
        let mut tasks = Vec::new();
        let pairs = MeshFamily::ALL.iter().flat_map(|mesh| {
            let poses = PoseFamily::ALL.iter();
            poses.map(move |pose| (*mesh, *pose))
        });
        for (index, (mesh, pose)) in pairs.enumerate() {
            // The place changes from case to case, and from round to round of the same size.
            let place = (index as u64 + round / 2) % Place::ALL.len() as u64;
            tasks.push(Task::Stress(Case {
                mesh,
                pose,
                place: Place::ALL[place as usize],
                triangles: size,
                ticks: TICKS,
                seed: seeds.u64(..),
            }));
            for _ in 0..INPUTS {
                tasks.extend(Target::ALL.map(|target| Task::Fuzz(target, seeds.u64(..))));
            }
            if index % BATTLE_EVERY == 0 {
                tasks.push(Task::Battle(seeds.u64(..)));
                tasks.extend((0..ARENAS).map(|_| Task::Arena(seeds.u64(..))));
            }
        }
        tasks
    })
}
