use core::f64::consts::FRAC_1_SQRT_2;

use clamber_surface::surface::TargetMotion;
use clamber_world::Obstacle;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{MOST_AT_A_TIME, moved_off, wave_of};
use crate::brain::{StateId, Wave, WaveOf};
use crate::creature::report::{CreatureEvent, StrikeHit};
use crate::creature::state::is_far;
use crate::creature::{Creature, Person, Surroundings};

/// Height above the ground at which a wave begins, metres, so that lower rocks and bumps do not stop it.
const WAVE_START_HEIGHT: f64 = 0.5;

/// The same height as a share of the wave's radius; the larger of both counts.
const LIFT_SHARE: f64 = 1.0 / 30.0;

/// Distance from a limb's end within which the ground is looked for, as a share of the creature's height: below the
/// end, or above it if the end is in the ground.
const GROUND_SEARCH_DISTANCE: f64 = 0.2;

/// Smallest vertical component of a normal that counts as ground, in magnitude.
const LEAST_GROUND_NORMAL: f64 = 0.5;

/// Largest distance between the hits of two rays on the same ground, metres.
const SAME_GROUND_DISTANCE: f64 = 1e-3;

/// A shock wave of an attack that still spreads: a growing ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveWave {
    /// State of the brain whose attack sent out the wave; the creature may have left it since.
    pub state: StateId,
    /// Centre of the growing ball, in world space, metres. If ground that moves carries the creature, it carries the
    /// centre of a limb's wave along; a wave of a shot stays.
    pub place: DVec3,
    /// Current radius of the ball, metres.
    pub reach: f64,
    /// Radius at which the wave ends, metres.
    pub radius: f64,
}

/// A wave as it is saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct WaveState {
    pub(super) state: StateId,
    pub(super) of: WaveOf,
    pub(super) place: DVec3,
    /// Number of the attack that sent it out.
    pub(super) attack: u32,
    /// Current radius, metres.
    pub(super) reach: f64,
    /// Ids of the people that the wave strikes no more: those struck by it, by its limb and beam, or by its shot.
    pub(super) struck: Vec<u64>,
}

/// How far from the ground, or from the obstacle that a shot met, a wave begins, metres.
pub(super) fn lift(wave: &Wave) -> f64 {
    WAVE_START_HEIGHT.max(LIFT_SHARE * wave.radius)
}

impl Creature {
    /// Waves of the creature's attacks that still spread, the oldest first.
    pub fn waves(&self) -> impl Iterator<Item = ActiveWave> + '_ {
        self.state.ranged.waves.iter().filter_map(move |wave| {
            let file = wave_of(&self.kind, wave)?;
            Some(ActiveWave {
                state: wave.state,
                place: wave.place,
                reach: wave.reach,
                radius: file.radius,
            })
        })
    }

    /// Sends out a wave from just above the ground where a limb came down.
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
            struck: self.state.striking.struck().to_vec(),
        };
        self.begin_wave(wave, file, around, dt);
    }

    /// The ground nearest to a limb's end: below it, or above it if the limb is in the ground.
    fn ground_at(&self, end: DVec3, around: &Surroundings<'_>) -> Option<DVec3> {
        let near = GROUND_SEARCH_DISTANCE * self.size.height;
        let first = |from: DVec3, direction: DVec3, most: f64| {
            let hits = around.terrain.iter().filter_map(|terrain| {
                let hit = terrain.cast_ray(from, direction, most)?;
                (hit.distance > 0.0 && hit.normal.y.abs() >= LEAST_GROUND_NORMAL)
                    .then_some(hit.distance)
            });
            hits.min_by(f64::total_cmp)
        };
        let below = first(end, DVec3::NEG_Y, near);
        let above = first(end + DVec3::Y * near, DVec3::NEG_Y, near).map(|down| near - down);
        // If the limb is in the ground, there is no surface between its end and the ground above. A nearer surface is
        // the underside of a bridge.
        let above = above.filter(|above| {
            let up = first(end, DVec3::Y, *above);
            up.is_none_or(|up| up > above - SAME_GROUND_DISTANCE)
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
        if is_far(place) {
            return;
        }
        self.report.events.push(CreatureEvent::Wave {
            state,
            place,
            radius: file.radius,
        });
        let goes_on = match file.speed {
            // People at the origin are struck in this tick.
            Some(_) => self.spread(&mut wave, file, around, 0.0),
            None => self.spread(&mut wave, file, around, dt),
        };
        if !goes_on {
            return;
        }
        let waves = &mut self.state.ranged.waves;
        if waves.len() >= MOST_AT_A_TIME {
            waves.remove(0);
        }
        waves.push(wave);
    }

    /// Grows a wave over `dt` seconds, and strikes the people that it reaches. Returns false once the wave has its
    /// final radius.
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
            let nearest = person.body.nearest_on_axis(wave.place);
            let distance = (nearest.distance(wave.place) - person.body.radius).max(0.0);
            let share = 1.0 - distance / file.radius;
            // The wave strikes a body only while its front is within the body, which spares a person that comes down
            // behind the front.
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
                self.state.striking.mark_struck(person.id);
            }
            self.report.blows.push(StrikeHit {
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

/// True if a body would touch no terrain if it moved down by `height` metres.
fn is_above(person: &Person, height: f64, around: &Surroundings<'_>) -> bool {
    let down = [DVec3::NEG_Y * height; 2];
    let touches = |obstacle: &&dyn Obstacle| {
        let hit = obstacle.cast_capsule(&person.body, down, TargetMotion::Still);
        hit.is_some()
    };
    !around.terrain.iter().any(touches)
}
