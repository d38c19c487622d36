//! Cases made to be hard in ways that are known: every family of meshes in every family of poses at every place, at
//! sizes as creatures have them.
//!
//! [`run`] poses a case for some ticks and asks every kind of query about random places of its skin. What must hold:
//!
//! - every number is finite, and nothing panics;
//! - lazily skinned, skinned ahead, on another instruction set and by brute force, answers are equal in every bit;
//! - every bound holds every vertex;
//! - no ray gets through closed skin: proved by how often the skin winds around both its ends;
//! - what is said to be nearest is, against f64;
//! - no contact is missed or late: casts and sweeps meet skin whose way is known in f64;
//! - a palette with NaN or infinity is refused by the joint, and neither that tick nor the next shows it;
//! - 100 km out, answers in the world are as exact as at the origin.

mod aims;
mod bounds;
mod contacts;
mod families;
mod leaks;
mod nearest;
mod places;
mod posed;
mod poses;
mod questions;
mod run;
mod seen;
mod shapes;
mod soups;
mod subject;
mod times;
mod world;

pub use families::{MeshFamily, Place, PoseFamily};
pub use run::run;
pub use seen::Seen;
pub use subject::Subject;
pub use times::{Class, DOUBTFUL, FLOOR, LIMIT, Summary, Times};

use core::fmt;
use core::str::FromStr;

/// What is posed, how, where, and how often. The same one runs the same way every time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// What is skinned.
    pub mesh: MeshFamily,
    /// What its joints do.
    pub pose: PoseFamily,
    /// Where it stands.
    pub place: Place,
    /// About how many triangles it has.
    pub triangles: usize,
    /// For how many ticks.
    pub ticks: usize,
    /// Of all that is random.
    pub seed: u64,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            mesh,
            pose,
            place,
            triangles,
            ticks,
            seed,
        } = self;
        write!(f, "{mesh}/{pose}/{place}/{triangles}/{ticks}/{seed}")
    }
}

impl FromStr for Case {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts: Vec<&str> = text.split('/').collect();
        let &[mesh, pose, place, triangles, ticks, seed] = parts.as_slice() else {
            return Err(format!(
                "{text:?} is not mesh/pose/place/triangles/ticks/seed"
            ));
        };
        let number = |text: &str| text.parse().map_err(|_| format!("{text:?} is no number"));
        Ok(Self {
            mesh: mesh.parse()?,
            pose: pose.parse()?,
            place: place.parse()?,
            triangles: number(triangles)? as usize,
            ticks: number(ticks)? as usize,
            seed: number(seed)?,
        })
    }
}
