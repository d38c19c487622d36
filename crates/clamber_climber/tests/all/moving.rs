use clamber_world::{
    Contact, HalfSpace, MaterialPoint, Obstacle, PointMotion, SweepContact, TargetMotion,
    WorldCapsule,
};
use glam::DVec3;

/// A half-space that moves without turning. All its numbers are f64, so its velocities do not have the rounding of
/// skin.
pub(crate) struct MovingHalfSpace {
    pub(crate) at_rest: HalfSpace,
    /// Displacements at the tick's beginning and at its end.
    pub(crate) shifts: [DVec3; 2],
}

fn moved(capsule: &WorldCapsule, by: DVec3) -> WorldCapsule {
    WorldCapsule {
        ends: capsule.ends.map(|end| end + by),
        ..*capsule
    }
}

impl Obstacle for MovingHalfSpace {
    fn overlap_capsule(&self, capsule: &WorldCapsule, contacts: &mut Vec<Contact>) {
        let (first, now) = (contacts.len(), self.shifts[1]);
        self.at_rest
            .overlap_capsule(&moved(capsule, -now), contacts);
        for contact in &mut contacts[first..] {
            contact.point += now;
        }
    }

    fn cast_capsule(
        &self,
        capsule: &WorldCapsule,
        displacements: [DVec3; 2],
        target: TargetMotion,
    ) -> Option<SweepContact> {
        let [before, now] = match target {
            TargetMotion::Still => [self.shifts[1]; 2],
            TargetMotion::Moving => self.shifts,
        };
        let ways = displacements.map(|way| way - (now - before));
        let start = moved(capsule, -before);
        let mut hit = self
            .at_rest
            .cast_capsule(&start, ways, TargetMotion::Still)?;
        hit.contact.point += before + (now - before) * hit.fraction;
        Some(hit)
    }

    fn motion(&self, point: &MaterialPoint, dt: f64) -> Option<PointMotion> {
        let at = DVec3::from(point.coordinates);
        let [before, now] = self.shifts.map(|shift| at + shift);
        Some(PointMotion {
            was_teleported: false,
            ..PointMotion::translated(before, now, dt)
        })
    }
}
