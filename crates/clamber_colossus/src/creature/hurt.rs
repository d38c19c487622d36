//! Damage to a creature: wounds of weak points, blows to plates.

use clamber_world::MaterialPoint;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::Creature;
use super::report::CreatureEvent;
use crate::kind::{CreatureKind, Plate};

/// The damage to a creature, and the wounds and events that the next step senses and reports.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Damage {
    /// Hit points left of each weak point.
    hit_points: Vec<f64>,
    /// State of each plate.
    plates: Vec<PlateState>,
    /// Plates that staggered since the last step.
    staggered: u32,
    /// Events since the last step, for the next report.
    told: Vec<CreatureEvent>,
    /// Wounds since the last step.
    wounds: Vec<Felt>,
}

/// State of a plate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct PlateState {
    /// Damage since the last stagger.
    strain: f64,
    /// Number of staggers until the plate breaks; 0 if it is broken.
    left: u32,
}

/// A hit on the creature: the joint of the skin, and the damage done.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Felt {
    pub(super) joint: u32,
    pub(super) damage: f64,
}

impl Damage {
    /// All weak points and plates of a new creature.
    pub(super) fn none(kind: &CreatureKind) -> Self {
        let points = kind.weak_points().iter();
        let plates = kind.plates().iter();
        Self {
            hit_points: points.map(|point| point.hit_points).collect(),
            plates: plates
                .map(|plate| PlateState {
                    strain: 0.0,
                    left: plate.count,
                })
                .collect(),
            staggered: 0,
            told: Vec::new(),
            wounds: Vec::new(),
        }
    }

    /// The same damage to a creature of the kind `to`, whose weak points and plates are matched by name.
    pub(super) fn carry_over(&self, from: &CreatureKind, to: &CreatureKind) -> Self {
        let fresh = Self::none(to);
        let mut told = self.told.clone();
        // The ids of states differ between brains.
        told.retain(|event| !matches!(event, CreatureEvent::Entered { .. }));
        Self {
            hit_points: kept(
                (from.weak_points(), to.weak_points()),
                |point| point.name.as_str(),
                &self.hit_points,
                fresh.hit_points,
                |left, most| left.min(most),
            ),
            plates: kept(
                (from.plates(), to.plates()),
                |plate| plate.name.as_str(),
                &self.plates,
                fresh.plates,
                |had, fresh| PlateState {
                    left: had.left.min(fresh.left),
                    ..had
                },
            ),
            staggered: self.staggered,
            told,
            wounds: self.wounds.clone(),
        }
    }

    pub(super) fn hit_points(&self) -> &[f64] {
        &self.hit_points
    }

    /// Number of staggers until a plate breaks; 0 if it is broken or does not exist.
    pub(super) fn plate(&self, index: usize) -> u32 {
        self.plates.get(index).map_or(0, |plate| plate.left)
    }

    /// Number of plates that are not broken.
    pub(super) fn whole_plates(&self) -> usize {
        self.plates.iter().filter(|plate| plate.left > 0).count()
    }

    /// Adds an event to the report of the next step.
    pub(super) fn tell(&mut self, event: CreatureEvent) {
        self.told.push(event);
    }

    /// Moves the events since the last step to a report.
    pub(super) fn report(&mut self, events: &mut Vec<CreatureEvent>) {
        events.append(&mut self.told);
    }

    /// Takes the wounds since the last step.
    pub(super) fn take_wounds(&mut self) -> Vec<Felt> {
        std::mem::take(&mut self.wounds)
    }

    /// Takes the number of plates that staggered since the last step.
    pub(super) fn take_staggered(&mut self) -> u32 {
        std::mem::take(&mut self.staggered)
    }

    /// True if hit points and wounds are numbers, and not negative.
    pub(super) fn is_valid(&self) -> bool {
        let is_left = |left: &f64| (0.0..=f64::MAX).contains(left);
        let is_hurt = |felt: &Felt| (0.0..=f64::MAX).contains(&felt.damage);
        self.hit_points.iter().all(is_left) && self.wounds.iter().all(is_hurt)
    }

    /// True if a creature of this kind can have these plates.
    pub(super) fn fits_plates(&self, kind: &CreatureKind) -> bool {
        let fits = |state: &PlateState, plate: &Plate| {
            state.left <= plate.count && (0.0..=f64::MAX).contains(&state.strain)
        };
        let mut plates = self.plates.iter().zip(kind.plates());
        self.plates.len() == kind.plates().len() && plates.all(|(state, plate)| fits(state, plate))
    }
}

impl Creature {
    /// Strikes the creature with a blade, an arrow or the like. Returns the damage done to a weak point: 0 if there is
    /// no open weak point at that place, or if a plate took the blow. The brain senses the wound in the next step, and
    /// the report of that step has its events.
    ///
    /// `at` is the point of the skin: it gives the region, and the plate that takes the blow if there is one. For a hit
    /// on the creature's surface, this is `MaterialPoint::on_triangle(hit.triangle, hit.barycentric)`; for a contact
    /// with an [`Obstacle`](clamber_world::Obstacle), the contact's `material`. `place` is the point of impact, in
    /// world space, metres: the first open weak point whose ball contains it takes the `damage`.
    pub fn hurt(&mut self, at: &MaterialPoint, place: DVec3, damage: f64) -> f64 {
        if !place.is_finite() || !(0.0..=f64::MAX).contains(&damage) {
            return 0.0;
        }
        let Some(joint) = self.joint_at(at) else {
            return 0.0;
        };
        let done = match self.struck_at(at, place) {
            (_, Some(plate)) => {
                self.strain(plate, damage);
                0.0
            }
            (Some(weak_point), None) => self.wound(weak_point, damage),
            (None, None) => 0.0,
        };
        self.state.damage.wounds.push(Felt {
            joint: joint.0,
            damage: done,
        });
        done
    }

    /// Applies a blow to a plate, which staggers and may break.
    fn strain(&mut self, plate: usize, damage: f64) {
        let stagger = self.kind.plates()[plate].stagger;
        let damaged = &mut self.state.damage;
        let state = &mut damaged.plates[plate];
        state.strain += damage;
        // Damage beyond the threshold is lost, so that one blow causes one stagger at most.
        if state.strain < stagger {
            return;
        }
        state.strain = 0.0;
        state.left -= 1;
        let breaks = state.left == 0;
        damaged.staggered += 1;
        damaged.tell(CreatureEvent::Staggered { plate, breaks });
        if breaks {
            self.show_plate(plate, false);
        }
    }

    /// Finds the open weak point that a blow at a point of the skin would strike, and the unbroken plate that would
    /// take the blow instead. `at` and `place` are as for [`Creature::hurt`]. Returns their indices in
    /// [`CreatureKind::weak_points`] and [`CreatureKind::plates`].
    pub fn struck_at(&self, at: &MaterialPoint, place: DVec3) -> (Option<usize>, Option<usize>) {
        let plate = at
            .triangle()
            .and_then(|triangle| self.kind.plate_of(triangle))
            .filter(|plate| self.state.plate(*plate) > 0);
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

    /// Position of a point of the skin after the last step, in world space, metres.
    fn skin_at(&self, at: &MaterialPoint) -> Option<DVec3> {
        let anchor = at.anchor_on(&self.surface)?;
        let tick = self.kind.brain().tick();
        let motion = self.surface.in_world().motion(&anchor, tick).ok()?;
        Some(motion.position)
    }

    /// Applies damage to a weak point and returns the damage done. Damage beyond its hit points is lost.
    pub(super) fn wound(&mut self, weak_point: usize, damage: f64) -> f64 {
        let left = &mut self.state.damage.hit_points[weak_point];
        let damage = damage.min(*left);
        *left -= damage;
        let used_up = *left <= 0.0;
        if damage > 0.0 {
            self.state.damage.tell(CreatureEvent::Hurt {
                weak_point,
                damage,
                used_up,
            });
        }
        damage
    }

    /// The hit points that all weak points together have left, as a share of those that they have when unhurt, 0 to 1.
    /// It is 0 as soon as a major weak point ([`WeakPoint::major`](clamber_surface::rig::WeakPoint::major)) is used up,
    /// and always 1 without weak points.
    pub fn health(&self) -> f64 {
        let points = self.kind.weak_points().iter().zip(self.state.hit_points());
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

    /// Position of a weak point's centre after the last step, in world space, metres. `index` is an index into
    /// [`CreatureKind::weak_points`]; `None` if there is no such weak point.
    pub fn weak_point(&self, index: usize) -> Option<DVec3> {
        let point = self.kind.weak_points().get(index)?;
        let frame = self.palette.model_from_joint(point.joint)?;
        let place = frame.transform_point3(point.position.as_dvec3());
        Some(self.surface.world_from_model().transform_point(place))
    }

    /// True if a weak point can be hurt now: it has hit points left, and either the current state exposes it
    /// ([`StateFile::exposes`](crate::brain::StateFile::exposes)), or all weak points of lower order
    /// ([`WeakPoint::order`](clamber_surface::rig::WeakPoint::order)) are used up. So a weak point of the lowest order
    /// is open until it is used up. A plate above it does not count here, but takes hits in its place. `weak_point` is
    /// an index into [`CreatureKind::weak_points`]; false if there is no such weak point.
    pub fn is_open(&self, weak_point: usize) -> bool {
        let points = self.kind.weak_points();
        let hit_points = self.state.hit_points();
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
            let shows = self.state.plate(plate) > 0;
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

/// Carries values over to the parts with the same names, limited by `limit`. Parts without a namesake get their fresh
/// value. Names need not be unique: the second part of a name matches the second part of that name.
fn kept<T, S: Copy>(
    (from, to): (&[T], &[T]),
    name: impl Fn(&T) -> &str,
    had: &[S],
    fresh: Vec<S>,
    limit: impl Fn(S, S) -> S,
) -> Vec<S> {
    let find = |index: usize| {
        let ours = name(&to[index]);
        let before = to[..index].iter().filter(|part| name(part) == ours);
        let mut same = (0..from.len()).filter(|old| name(&from[*old]) == ours);
        had.get(same.nth(before.count())?).copied()
    };
    let parts = fresh.into_iter().enumerate();
    parts
        .map(|(index, fresh)| find(index).map_or(fresh, |had| limit(had, fresh)))
        .collect()
}
