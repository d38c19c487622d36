//! Damage to a creature: wounds of weak points, blows to plates.

use clamber_surface::mesh::TriangleId;
use clamber_world::MaterialPoint;
use glam::DVec3;

use super::report::CreatureEvent;
use super::state::Felt;
use super::{Creature, Wound};

impl Creature {
    /// Applies a wound. Returns the damage done to a weak point: 0 if there is no open weak point at that place, or if
    /// a plate took the blow. The brain senses the wound in the next step, and the report of that step has its events.
    pub fn hurt(&mut self, wound: &Wound) -> f64 {
        if !wound.place.is_finite() || !(0.0..=f64::MAX).contains(&wound.damage) {
            return 0.0;
        }
        let triangle = u32::try_from(wound.at.key).ok().map(TriangleId);
        let joint = triangle.and_then(|triangle| self.surface.mesh().joint_of(triangle));
        let Some(joint) = joint else {
            return 0.0;
        };
        let done = match self.struck_at(&wound.at, wound.place) {
            (_, Some(plate)) => {
                self.strain(plate, wound.damage);
                0.0
            }
            (Some(weak_point), None) => self.wound(weak_point, wound.damage),
            (None, None) => 0.0,
        };
        self.state.wounds.push(Felt {
            joint: joint.0,
            damage: done,
        });
        done
    }

    /// Applies a blow to a plate, which staggers and may break.
    fn strain(&mut self, plate: usize, damage: f64) {
        let stagger = self.kind.plates()[plate].stagger;
        let state = &mut self.state.plates[plate];
        state.strain += damage;
        // Damage beyond the threshold is lost, so that one blow causes one stagger at most.
        if state.strain < stagger {
            return;
        }
        state.strain = 0.0;
        state.left -= 1;
        let breaks = state.left == 0;
        self.state.staggered += 1;
        self.state
            .told
            .push(CreatureEvent::Staggered { plate, breaks });
        if breaks {
            self.show_plate(plate, false);
        }
    }

    /// Finds the open weak point that a blow at a point of the skin would strike, and the unbroken plate that would
    /// take the blow instead. Returns their indices.
    pub fn struck_at(&self, at: &MaterialPoint, place: DVec3) -> (Option<usize>, Option<usize>) {
        let triangle = u32::try_from(at.key).ok().map(TriangleId);
        let plate = triangle
            .and_then(|triangle| self.kind.plate_of(triangle))
            .filter(|plate| self.state.plates[*plate].left > 0);
        // The weak points are where they are at the end of the tick, so take the struck point where it is then.
        let place = self.skin_at(at).unwrap_or(place);
        let points = self.kind.weak_points().iter().enumerate();
        let mut near = points.filter(|(index, point)| {
            let radius = f64::from(point.radius) * self.size.scale;
            let middle = self.weak_point(*index);
            middle.is_some_and(|middle| middle.distance(place) <= radius) && self.is_open(*index)
        });
        (near.next().map(|(index, _)| index), plate)
    }

    /// Position of a point of the skin after the last step, in world space.
    fn skin_at(&self, at: &MaterialPoint) -> Option<DVec3> {
        let anchor = at.anchor_on(&self.surface)?;
        let tick = self.kind.brain().tick();
        let motion = self.surface.in_world().motion(&anchor, tick).ok()?;
        Some(motion.position)
    }

    /// Applies damage to a weak point and returns the damage done. Damage beyond its hit points is lost.
    pub(super) fn wound(&mut self, weak_point: usize, damage: f64) -> f64 {
        let left = &mut self.state.hit_points[weak_point];
        let damage = damage.min(*left);
        *left -= damage;
        let used_up = *left <= 0.0;
        if damage > 0.0 {
            self.state.told.push(CreatureEvent::Hurt {
                weak_point,
                damage,
                used_up,
            });
        }
        damage
    }

    /// The remaining share of the hit points of all weak points: 0 once a major one is used up, 1 without weak points.
    pub fn health(&self) -> f64 {
        let points = self.kind.weak_points().iter().zip(&self.state.hit_points);
        let (mut full, mut left) = (0.0, 0.0);
        for (point, hit_points) in points {
            if point.major && *hit_points <= 0.0 {
                return 0.0;
            }
            full += point.hit_points;
            left += hit_points;
        }
        if full > 0.0 { left / full } else { 1.0 }
    }

    /// Position of a weak point, in world space; `None` if there is no such weak point.
    pub fn weak_point(&self, index: usize) -> Option<DVec3> {
        let point = self.kind.weak_points().get(index)?;
        let frame = self.palette.model_from_joint(point.joint)?;
        let place = frame.transform_point3(point.position.as_dvec3());
        Some(self.surface.world_from_model().transform_point(place))
    }

    /// True if a weak point can be hurt now. It must have hit points left. Also, the current state must expose it, or
    /// all weak points of lower order must be used up.
    pub fn is_open(&self, weak_point: usize) -> bool {
        let points = self.kind.weak_points();
        let hit_points = &self.state.hit_points;
        let (Some(point), Some(left)) = (points.get(weak_point), hit_points.get(weak_point)) else {
            return false;
        };
        let mut before = points
            .iter()
            .zip(hit_points)
            .filter(|(other, _)| other.order < point.order);
        let exposed = self.kind.brain().exposes(self.state.current());
        *left > 0.0 && (exposed.contains(&point.name) || before.all(|(_, left)| *left <= 0.0))
    }

    /// Hides the broken plates and shows the others, where the skin does not do so yet.
    pub(super) fn hide_broken_plates(&mut self) {
        for plate in 0..self.kind.plates().len() {
            let shows = self.state.plates[plate].left > 0;
            if self.shows_plate[plate] != shows {
                self.show_plate(plate, shows);
            }
        }
    }

    fn show_plate(&mut self, plate: usize, shows: bool) {
        self.shows_plate[plate] = shows;
        for triangle in &self.kind.plates()[plate].triangles {
            // Fails only for triangles that a game has removed by editing.
            let _ = if shows {
                self.surface.enable_triangle(*triangle)
            } else {
                self.surface.disable_triangle(*triangle)
            };
        }
    }
}
