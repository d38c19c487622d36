use clamber_surface::mesh::{ColliderMesh, TriangleId};

use super::PlateFile;
use crate::brain::{BrainError, BrainProblem, check, whole};

/// A piece of armour that all creatures of a kind have: some triangles of the skin. A hit on them hurts no weak point
/// below. Instead its damage counts against the plate, which staggers each time that the damage since its last stagger
/// reaches `stagger`, and breaks off at the last of `count` staggers. Nothing here changes in a fight;
/// [`CreatureState::plate`](crate::CreatureState::plate) counts down.
#[derive(Clone, Debug)]
pub struct Plate {
    /// Name of the plate, from the brain's file, for the game.
    /// [`CreatureState::carry_over`](crate::CreatureState::carry_over) matches plates by name, and plates of the same
    /// name in their order, so names need not be unique. Elsewhere a plate is given by its index in
    /// [`CreatureKind::plates`](crate::CreatureKind::plates).
    pub name: String,
    /// Damage at which the plate staggers, in the same unit as hit points of weak points. The damage of all hits on the
    /// plate adds up. When the sum reaches this number, the plate staggers, and the sum begins at 0 again. What the
    /// last hit did beyond this number does not count towards the next stagger, so one hit causes one stagger at most.
    /// A stagger is an event ([`CreatureEvent::Staggered`](crate::CreatureEvent::Staggered)) and a sense of the brain
    /// ([`Sense::Staggered`](crate::Sense::Staggered)); what the creature does then is up to its brain.
    pub stagger: f64,
    /// Number of this plate's own staggers after which it breaks off, at least 1. The staggers of other plates do not
    /// count.
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
