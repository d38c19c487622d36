//! The order of the tasks. It depends on the seed alone, not on the time.

use clamber_verify::stress::{Case, MeshFamily, Place, PoseFamily};

use crate::task::{Target, Task};

/// Sizes of stress cases, triangles. Rounds alternate between the first two sizes.
const SIZES: [usize; 3] = [600, 6_000, 60_000];

/// One in this many rounds has the last of [`SIZES`].
const LARGE_EVERY: u64 = 16;

/// Number of ticks of a stress case.
const TICKS: usize = 3;

/// Number of inputs for each fuzz target after each stress case.
const INPUTS: u64 = 20;

/// Number of stress cases per battle.
const BATTLE_EVERY: usize = 18;

/// Number of arenas after each battle.
const ARENAS: u64 = 3;

/// An endless sequence of tasks. Each round goes over every mesh in every pose. Each task has its own seed.
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
