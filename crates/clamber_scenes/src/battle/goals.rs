//! Where the script of a fight has to go on the creature: to its weak points, to what covers them, and to its top.

use clamber_colossus::CreatureKind;
use clamber_surface::mesh::VertexId;
use glam::Vec3;

use super::Performer;
use crate::Creature;
use crate::tour::{Ascent, Ways};

/// How far above a weak point what covers it may be, in the units of the creature's file.
const COVER: f32 = 1.2;

/// What to strike.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Aim {
    /// The weak point, by its index; `None` for the top.
    pub(super) weak_point: Option<usize>,
    /// The plate over the weak point, by its index.
    pub(super) plate: Option<usize>,
}

/// A place to go to, and the ways there.
#[derive(Clone, Debug)]
pub(super) struct Goal {
    pub(super) aim: Aim,
    pub(super) ascent: Ascent,
}

/// All of them; the top is the last.
#[derive(Clone, Debug)]
pub(super) struct Goals(Vec<Goal>);

impl Goals {
    pub(super) fn new(creature: &Creature, kind: Option<&CreatureKind>, ways: &Ways) -> Self {
        let mut goals = Vec::new();
        if let Some(kind) = kind {
            for index in 0..kind.weak_points().len() {
                goals.extend(around(kind, index, ways));
            }
        }
        goals.push(Goal {
            aim: Aim::default(),
            ascent: Ascent::new(creature, ways),
        });
        Self(goals)
    }

    pub(super) fn get(&self, index: usize) -> &Goal {
        &self.0[index.min(self.0.len() - 1)]
    }

    /// The top.
    pub(super) fn top(&self) -> usize {
        self.0.len() - 1
    }

    /// The goals that there are now: open weak points without a cover, and plates that cover one. The top if there are none.
    pub(super) fn open(&self, performer: &Performer<'_>) -> Vec<usize> {
        let Some(life) = performer.life() else {
            return vec![self.top()];
        };
        let is_whole = |plate: usize| life.state().plate(plate) > 0;
        let is_covered = |weak_point: usize| {
            let covers = self
                .0
                .iter()
                .filter(|goal| goal.aim.weak_point == Some(weak_point));
            covers.filter_map(|goal| goal.aim.plate).any(is_whole)
        };
        let is_there = |goal: &Goal| {
            let Some(weak_point) = goal.aim.weak_point else {
                return false;
            };
            let is_next = match goal.aim.plate {
                Some(plate) => is_whole(plate),
                None => !is_covered(weak_point),
            };
            is_next && life.is_open(weak_point) && goal.ascent.leads_anywhere()
        };
        let all = 0..self.0.len();
        let open: Vec<usize> = all.filter(|index| is_there(&self.0[*index])).collect();
        if open.is_empty() {
            vec![self.top()]
        } else {
            open
        }
    }
}

/// A weak point, and the plates over it.
fn around(kind: &CreatureKind, weak_point: usize, ways: &Ways) -> Vec<Goal> {
    let point = &kind.weak_points()[weak_point];
    let palette = kind.skeleton().palette(&kind.skeleton().rest_pose());
    let palette = palette.unwrap_or_default();
    let frame = palette.model_from_joint(point.joint);
    let Some(frame) = frame else {
        return Vec::new();
    };
    let place = frame.transform_point3(point.position.as_dvec3()).as_vec3();
    let rest = ways.rest();
    let mut covers: Vec<Vec<u32>> = vec![Vec::new(); kind.plates().len()];
    for (plate, vertices) in covers.iter_mut().enumerate() {
        let corners = kind.plates()[plate].triangles.iter();
        let corners = corners.filter_map(|id| kind.mesh().triangles().get(id.index()));
        vertices.extend(corners.flatten().map(|vertex: &VertexId| vertex.0));
        vertices.sort_unstable();
        vertices.dedup();
    }
    let near = |vertex: &u32, reach: f32| place.distance(at(rest, *vertex)) <= reach;
    let mut goals = Vec::new();
    for (plate, vertices) in covers.iter().enumerate() {
        let above: Vec<u32> = vertices
            .iter()
            .copied()
            .filter(|v| near(v, COVER))
            .collect();
        if !above.is_empty() {
            goals.push(Goal {
                aim: Aim {
                    weak_point: Some(weak_point),
                    plate: Some(plate),
                },
                ascent: Ascent::to(ways, &above),
            });
        }
    }
    let is_skin = |vertex: &u32| {
        !covers
            .iter()
            .any(|plate| plate.binary_search(vertex).is_ok())
    };
    let used = ways.used().filter(|vertex| is_skin(vertex));
    let here: Vec<u32> = used.filter(|vertex| near(vertex, point.radius)).collect();
    goals.push(Goal {
        aim: Aim {
            weak_point: Some(weak_point),
            plate: None,
        },
        ascent: Ascent::to(ways, &here),
    });
    goals
}

fn at(rest: &[Vec3], vertex: u32) -> Vec3 {
    rest.get(vertex as usize).copied().unwrap_or(Vec3::INFINITY)
}
