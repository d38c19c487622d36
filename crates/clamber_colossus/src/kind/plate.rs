use clamber_surface::mesh::{ColliderMesh, TriangleId};

use super::{PlateFile, whole};
use crate::brain::{BrainError, BrainProblem, list};

/// A piece of armour of a kind of creature.
#[derive(Clone, Debug)]
pub struct Plate {
    /// Name of the plate, from the brain's file.
    pub name: String,
    /// Damage that makes it stagger.
    pub stagger: f64,
    /// Number of staggers after which it breaks off.
    pub count: u32,
    /// The plate's triangles, in ascending order. They are hidden from queries once it is broken.
    pub triangles: Vec<TriangleId>,
}

impl Plate {
    pub(crate) fn new(file: &PlateFile, mesh: &ColliderMesh) -> Result<Self, BrainError> {
        if !(file.stagger > 0.0 && file.stagger.is_finite()) {
            let (what, range, found) = ("stagger", "finite and more than 0", file.stagger);
            return Err(whole(BrainProblem::OutOfRange { what, range, found }));
        }
        if file.count == 0 {
            let (what, range, found) = ("count", "at least 1", 0.0);
            return Err(whole(BrainProblem::OutOfRange { what, range, found }));
        }
        let users = mesh.tags().iter().map(|tag| tag.user);
        let all = users.clone().enumerate();
        let ours = all.filter(|(_, user)| file.user > 0 && *user == file.user);
        let triangles: Vec<TriangleId> = ours.map(|(index, _)| TriangleId(index as u32)).collect();
        if triangles.is_empty() {
            let mut known: Vec<u32> = users.filter(|user| *user > 0).collect();
            known.sort_unstable();
            known.dedup();
            return Err(whole(BrainProblem::Unknown {
                what: "triangle with the user number",
                name: file.user.to_string(),
                known: list(known.iter().map(ToString::to_string)),
            }));
        }
        Ok(Self {
            name: file.name.clone(),
            stagger: file.stagger,
            count: file.count,
            triangles,
        })
    }
}
