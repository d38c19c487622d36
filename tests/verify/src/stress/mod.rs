//! Stress cases that are hard in known ways: every family of meshes in every family of poses at every place, at the
//! sizes of real creatures.
//!
//! [`run`] poses a case for some ticks and asks every kind of query at random places of its skin. It checks that
//!
//! - every number is finite, and nothing panics;
//! - answers are equal in every bit with lazy skinning, with everything skinned ahead, on another instruction set and
//!   by brute force;
//! - every bound holds all its vertices;
//! - no ray gets through closed skin, judged by the winding numbers at both ends of the ray;
//! - closest points are the closest, compared with f64;
//! - no contact is missed or late: casts and sweeps touch skin whose motion is known in f64;
//! - a palette with NaN, infinity or a number beyond the limit is rejected with an error that names the joint, and
//!   leaves no trace in that tick or the next;
//! - answers in the world are as exact 100 km from the origin as at the origin.

mod bounds;
mod contacts;
mod families;
mod leaks;
mod nearest;
mod places;
mod posed;
mod poses;
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

/// A stress case. It runs the same way every time. Its text form is `mesh/pose/place/triangles/ticks/seed`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// The mesh.
    pub mesh: MeshFamily,
    /// The poses of the mesh's joints.
    pub pose: PoseFamily,
    /// The creature's place in the world, and its size.
    pub place: Place,
    /// Approximate number of triangles.
    pub triangles: usize,
    /// Number of ticks to run.
    pub ticks: usize,
    /// Seed for everything random.
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
        let number = |text: &str| {
            text.parse()
                .map_err(|_| format!("{text:?} is not a number"))
        };
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
