//! Sword and arrows: a gleam along the blade, a ring that closes while a stab is charged, sparks where a weapon hits,
//! and the trails of arrows in flight.

use std::collections::BTreeMap;

use clamber::render::Overlay;
use clamber_fight::{Act, ArenaEvent, ProjectileId, ProjectileMotion};
use clamber_scenes::battle::{Battle, TICK};
use glam::DVec3;

use super::{View, glow};
use crate::colors::{SKY_BLUE, WHITE, YELLOW, seen_through};
use crate::overlays::nearer;

/// Number of ticks of an arrow's flight that its trail shows.
const TRAIL: usize = 14;

/// Time for which sparks fly, seconds.
const SPARKS_LAST: f64 = 0.4;
/// Number of sparks of a hit.
const SPARKS: u32 = 11;
/// Distance that sparks fly, metres.
const SPARKS_FLY: f64 = 1.1;

/// Radius of the ring of a charge around the sword's grip, metres.
const RING: f64 = 0.5;

/// Number of lines of a whole ring.
const SIDES: u32 = 40;

/// Distance by which sparks and rings are drawn nearer to the eye, metres, so that fur does not hide them.
const NEARER: f64 = 0.4;

/// The trails and hits of the weapons in the last ticks.
#[derive(Debug, Default)]
pub(super) struct Weapons {
    trails: BTreeMap<ProjectileId, Vec<DVec3>>,
    hits: Vec<Hit>,
}

#[derive(Clone, Copy, Debug)]
struct Hit {
    place: DVec3,
    hurts: bool,
    seconds: f64,
}

impl Weapons {
    pub(super) fn watch(&mut self, battle: &Battle<'_>) {
        let Some(arena) = battle.arena() else {
            return;
        };
        for hit in &mut self.hits {
            hit.seconds += TICK;
        }
        self.hits.retain(|hit| hit.seconds < SPARKS_LAST);
        for event in arena.events() {
            if let ArenaEvent::Hit { place, damage, .. } = event {
                self.hits.push(Hit {
                    place: *place,
                    hurts: *damage > 0.0,
                    seconds: 0.0,
                });
            }
        }
        let flying = arena
            .projectiles()
            .iter()
            .filter_map(|one| match one.motion {
                ProjectileMotion::Flying { position, .. } => Some((one.id, position)),
                _ => None,
            });
        let flying: BTreeMap<ProjectileId, DVec3> = flying.collect();
        for (id, place) in &flying {
            self.trails.entry(*id).or_default().push(*place);
        }
        // The trail of an arrow that has arrived gets shorter in each tick.
        self.trails.retain(|id, trail| {
            if trail.len() > TRAIL || !flying.contains_key(id) {
                trail.remove(0);
            }
            !trail.is_empty()
        });
    }

    pub(super) fn draw(
        &self,
        over: &mut Overlay,
        battle: &Battle<'_>,
        view: &View,
        sword: Option<[DVec3; 2]>,
    ) {
        for trail in self.trails.values() {
            for (index, pair) in trail.windows(2).enumerate() {
                let share = (index + 1) as f32 / trail.len() as f32;
                over.line(pair[0], pair[1], 2.0, seen_through(WHITE, 0.8 * share));
            }
        }
        for hit in &self.hits {
            sparks(over, view, hit);
        }
        if let Some(sword) = sword {
            blade(over, battle, view, sword);
        }
    }
}

/// The gleam of a blade, and the ring of its charge.
fn blade(over: &mut Overlay, battle: &Battle<'_>, view: &View, [grip, tip]: [DVec3; 2]) {
    let fighter = battle.performer().fighter();
    let charge = fighter.map_or(0.0, |fighter| fighter.charge());
    over.line(
        grip.lerp(tip, 0.12),
        tip,
        2.0,
        [0.75, 0.86, 1.0, 0.55 + 0.45 * charge as f32],
    );
    let strikes = fighter.is_some_and(|fighter| matches!(fighter.act(), Act::Strike { .. }));
    if charge <= 0.0 {
        return;
    }
    let middle = nearer(grip.lerp(tip, 0.5), view.camera.eye, NEARER);
    let color = [0.55, 0.8, 1.0, 0.3 * charge as f32];
    glow(over, view, middle, 0.12 + 0.2 * charge, color);
    let center = nearer(grip, view.camera.eye, NEARER);
    let [right, up] = view.sides(center);
    let at = |side: f64| {
        let (sin, cos) = libm::sincos(side * core::f64::consts::TAU);
        center + (right * sin + up * cos) * RING
    };
    let is_full = charge > 0.995 || strikes;
    let color = if is_full { WHITE } else { YELLOW };
    for side in 0..SIDES {
        let [from, to] = [side, side + 1].map(|side| f64::from(side) / f64::from(SIDES));
        if from >= charge {
            break;
        }
        let ends = [at(from), at(to.min(charge))];
        over.line(ends[0], ends[1], 2.5, seen_through(color, 0.9));
    }
    over.circle(
        center,
        view.camera.eye - center,
        RING,
        1.0,
        seen_through(WHITE, 0.25),
    );
}

/// Lines that fly apart where a weapon hit.
fn sparks(over: &mut Overlay, view: &View, hit: &Hit) {
    let share = hit.seconds / SPARKS_LAST;
    let center = nearer(hit.place, view.camera.eye, NEARER);
    let [right, up] = view.sides(center);
    let fade = (1.0 - share) as f32;
    let color = if hit.hurts { SKY_BLUE } else { YELLOW };
    for spark in 0..SPARKS {
        let angle = f64::from(spark) / f64::from(SPARKS) * core::f64::consts::TAU;
        let (sin, cos) = libm::sincos(angle);
        // Odd sparks fly less far.
        let far = SPARKS_FLY * (1.0 - 0.4 * f64::from(spark % 2));
        let out = right * cos + up * sin;
        let (from, to) = (
            center + out * (far * share),
            center + out * (far * share.sqrt()),
        );
        over.line(from, to, 2.5, seen_through(color, fade));
    }
    let color = [1.0, 1.0, 1.0, 0.5 * fade * fade];
    glow(over, view, center, 0.3 + 0.6 * share, color);
}
