use clamber_surface::mesh::{ColliderMesh, TriangleId};

use super::PlateFile;
use crate::brain::{BrainError, BrainProblem, check, whole};

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
        let (stagger, range) = (file.stagger, "finite and more than 0");
        let is_within = stagger > 0.0 && stagger.is_finite();
        check(is_within, "stagger", range, stagger).map_err(whole)?;
        check(file.count > 0, "count", "at least 1", 0.0).map_err(whole)?;
        let users = mesh.tags().iter().map(|tag| tag.user);
        let all = users.clone().enumerate();
        let ours = all.filter(|(_, user)| file.user > 0 && *user == file.user);
        let triangles: Vec<TriangleId> = ours.map(|(index, _)| TriangleId(index as u32)).collect();
        if triangles.is_empty() {
            let mut known: Vec<u32> = users.filter(|user| *user > 0).collect();
            known.sort_unstable();
            known.dedup();
            let (what, name) = ("triangle with the user number", file.user.to_string());
            let known = known.iter().map(ToString::to_string);
            return Err(whole(BrainProblem::unknown(what, &name, known)));
        }
        Ok(Self {
            name: file.name.clone(),
            stagger: file.stagger,
            count: file.count,
            triangles,
        })
    }
}
