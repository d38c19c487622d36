use core::f64::consts::FRAC_1_SQRT_2;

use clamber_surface::surface::TargetMotion;
use clamber_world::Obstacle;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{MOST, attack_of, moved_off};
use crate::brain::{StateId, Wave, WaveOf};
use crate::creature::report::{Blow, CreatureEvent};
use crate::creature::state::FARTHEST;
use crate::creature::{Creature, Person, Surroundings};

/// A wave begins so far above the ground, metres, or this share of its radius if that is more: lower rocks and swells do
/// not stop it.
const LIFT: f64 = 0.5;
const LIFT_SHARE: f64 = 1.0 / 30.0;

/// The ground is looked for so far below a limb's end, and above one that is in it, as a share of the creature's height.
const NEAR: f64 = 0.2;

/// Ground is no steeper than this: the height of its normal.
const LEVEL: f64 = 0.5;

/// Two rays meet the same ground if they do so within this, metres.
const SAME: f64 = 1e-3;

/// A wave that spreads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveWave {
    /// The state whose attack it is of.
    pub state: StateId,
    /// Where it began, in world space.
    pub place: DVec3,
    /// How far it has come, metres.
    pub reach: f64,
    /// How far it goes, metres.
    pub radius: f64,
}

/// A wave, as it is saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct WaveState {
    pub(super) state: StateId,
    pub(super) of: WaveOf,
    pub(super) place: DVec3,
    /// Number of the attack.
    pub(super) attack: u32,
    /// How far it has come, metres.
    pub(super) reach: f64,
    /// Whom it has struck.
    pub(super) struck: Vec<u64>,
}

/// How far above what it begins at a wave does.
pub(super) fn lift(wave: &Wave) -> f64 {
    LIFT.max(LIFT_SHARE * wave.radius)
}

impl Creature {
    /// The waves of its attacks that spread, the oldest first.
    pub fn waves(&self) -> impl Iterator<Item = ActiveWave> + '_ {
        self.state.ranged.waves.iter().filter_map(move |wave| {
            let file = attack_of(&self.kind, wave.state)?.wave_of(wave.of)?;
            Some(ActiveWave {
                state: wave.state,
                place: wave.place,
                reach: wave.reach,
                radius: file.radius,
            })
        })
    }

    /// Sends out a wave where a limb came down: from just above the ground there.
    pub(super) fn send_wave(
        &mut self,
        state: StateId,
        end: DVec3,
        file: &Wave,
        around: &Surroundings<'_>,
        dt: f64,
    ) {
        let ground = self.ground_at(end, around).unwrap_or(end);
        let wave = WaveState {
            state,
            of: WaveOf::Limb,
            attack: self.state.ranged.attack,
            place: moved_off(ground, DVec3::Y, lift(file), around),
            reach: 0.0,
            struck: self.state.struck.clone(),
        };
        self.begin_wave(wave, file, around, dt);
    }

    /// The ground that is nearest to a limb's end: below it, or above it if the limb is in the ground.
    fn ground_at(&self, end: DVec3, around: &Surroundings<'_>) -> Option<DVec3> {
        let near = NEAR * self.size.height;
        let first = |from: DVec3, direction: DVec3, most: f64| {
            let hits = around.terrain.iter().filter_map(|terrain| {
                let hit = terrain.cast_ray(from, direction, most)?;
                (hit.distance > 0.0 && hit.normal.y.abs() >= LEVEL).then_some(hit.distance)
            });
            hits.min_by(f64::total_cmp)
        };
        let below = first(end, DVec3::NEG_Y, near);
        let above = first(end + DVec3::Y * near, DVec3::NEG_Y, near).map(|down| near - down);
        // Nothing is between a limb and the ground that it is in: that is no bridge above it.
        let above = above.filter(|above| {
            let up = first(end, DVec3::Y, *above);
            up.is_none_or(|up| up > above - SAME)
        });
        match (below, above) {
            (Some(below), Some(above)) if below < above => Some(-below),
            (_, Some(above)) => Some(above),
            (below, None) => below.map(|below| -below),
        }
        .map(|rise| end + DVec3::Y * rise)
    }

    pub(super) fn begin_wave(
        &mut self,
        mut wave: WaveState,
        file: &Wave,
        around: &Surroundings<'_>,
        dt: f64,
    ) {
        let (state, place) = (wave.state, wave.place);
        if !place.is_finite() || place.abs().max_element() > FARTHEST {
            return;
        }
        self.report.events.push(CreatureEvent::Wave {
            state,
            place,
            radius: file.radius,
        });
        let goes_on = match file.speed {
            // Who is there is struck in this tick.
            Some(_) => self.spread(&mut wave, file, around, 0.0),
            None => self.spread(&mut wave, file, around, dt),
        };
        if !goes_on {
            return;
        }
        let waves = &mut self.state.ranged.waves;
        if waves.len() >= MOST {
            waves.remove(0);
        }
        waves.push(wave);
    }

    /// Lets a wave grow, and strikes whom it reaches. Returns false if it is at its end.
    pub(super) fn spread(
        &mut self,
        wave: &mut WaveState,
        file: &Wave,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> bool {
        let from = wave.reach;
        let grown = |speed: f64| (from + speed * dt).min(file.radius);
        let to = file.speed.map_or(file.radius, grown);
        wave.reach = to;
        let people = if file.strikes() { around.people } else { &[] };
        for person in people {
            if person.riding.is_some()
                || !person.body.is_valid()
                || wave.struck.contains(&person.id)
            {
                continue;
            }
            let nearest = nearest_on(person, wave.place);
            let distance = (nearest.distance(wave.place) - person.body.radius).max(0.0);
            let share = 1.0 - distance / file.radius;
            // It strikes while its front is within the body: who comes down behind it is spared.
            let is_over = distance + 2.0 * person.body.radius < from;
            if distance > to || is_over || share <= 0.0 {
                continue;
            }
            if file
                .height
                .is_some_and(|height| is_above(person, height, around))
                || around.hides(wave.place, person)
            {
                continue;
            }
            let way = person.middle() - wave.place;
            let away = DVec3::new(way.x, 0.0, way.z).try_normalize();
            let direction = away.map_or(DVec3::Y, |away| (away + DVec3::Y) * FRAC_1_SQRT_2);
            wave.struck.push(person.id);
            if wave.of == WaveOf::Limb && wave.attack == self.state.ranged.attack {
                self.state.struck.push(person.id);
            }
            self.report.blows.push(Blow {
                person: person.id,
                velocity: direction * (file.throw * share),
                damage: file.damage * share,
                place: nearest,
                state: wave.state,
            });
        }
        to < file.radius
    }
}

/// The point of a body's axis that is nearest to a place.
fn nearest_on(person: &Person, place: DVec3) -> DVec3 {
    let [start, end] = person.body.ends;
    let axis = end - start;
    let length = axis.length_squared();
    let share = if length > 0.0 {
        ((place - start).dot(axis) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    start + axis * share
}

/// True if a body would touch no terrain if it were lower by a height.
fn is_above(person: &Person, height: f64, around: &Surroundings<'_>) -> bool {
    let down = [DVec3::NEG_Y * height; 2];
    let touches = |obstacle: &&dyn Obstacle| {
        let hit = obstacle.cast_capsule(&person.body, down, TargetMotion::Still);
        hit.is_some()
    };
    !around.terrain.iter().any(touches)
}
