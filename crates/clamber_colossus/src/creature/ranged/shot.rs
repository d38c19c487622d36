use core::f64::consts::FRAC_PI_2;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::line::Line;
use super::wave::{self, WaveState};
use super::{MOST_AT_A_TIME, moved_off, reachable, shot_of};
use crate::brain::{Shot, StateId, WaveOf};
use crate::creature::report::{CreatureEvent, StrikeHit};
use crate::creature::{Creature, Surroundings};

/// Upper bound for the speed of a shot, metres a second: a little above the fastest possible shot, which has 1,000 m/s
/// at the start and 60,000 m/s from gravity.
const FASTEST_SHOT: f64 = 62_000.0;

/// Distance behind a shot from which obstacles are looked for, metres, so that its paths in consecutive ticks leave no
/// gap.
const SEARCH_BEHIND: f64 = 0.01;

/// A shot in flight, which a creature has thrown, spat or fired.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveShot {
    /// State of the brain whose attack released the shot; the creature may have left it since.
    pub state: StateId,
    /// Number of the shot: 0 for the creature's first shot, 1 for the next, and so on.
    pub number: u64,
    /// Position of the shot's centre, in world space, metres.
    pub place: DVec3,
    /// Velocity in world space, metres a second.
    pub velocity: DVec3,
    /// Radius of the ball that touches people, metres.
    pub radius: f64,
}

/// A shot as it is saved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct ShotState {
    pub(super) state: StateId,
    pub(super) number: u64,
    pub(super) place: DVec3,
    pub(super) velocity: DVec3,
    pub(super) ticks: u32,
}

/// True if a shot can have this velocity.
pub(super) fn is_reached(velocity: DVec3) -> bool {
    velocity.is_finite() && velocity.length() <= FASTEST_SHOT
}

impl Creature {
    /// Shots of the creature's attacks that are in flight, the oldest first.
    pub fn shots(&self) -> impl Iterator<Item = ActiveShot> + '_ {
        self.state.ranged.shots.iter().filter_map(|shot| {
            let file = shot_of(&self.kind, shot)?;
            Some(ActiveShot {
                state: shot.state,
                number: shot.number,
                place: shot.place,
                velocity: shot.velocity,
                radius: file.radius,
            })
        })
    }

    /// Releases a shot towards the target.
    pub(super) fn shoot(&mut self, state: StateId, end: DVec3, file: &Shot) {
        let way = self.state.ranged.mark - end;
        let velocity = direction(way, file).unwrap_or(self.state.heading()) * file.speed;
        let ranged = &mut self.state.ranged;
        if ranged.shots.len() >= MOST_AT_A_TIME {
            ranged.shots.remove(0);
        }
        ranged.shots.push(ShotState {
            state,
            number: ranged.next_shot,
            place: end,
            velocity,
            ticks: 0,
        });
        let number = ranged.next_shot;
        ranged.next_shot += 1;
        self.report.events.push(CreatureEvent::Threw {
            state,
            number,
            place: end,
            velocity,
        });
    }

    /// Advances a shot by a tick. Returns false if the shot has ended.
    pub(super) fn fly(
        &mut self,
        shot: &mut ShotState,
        file: &Shot,
        around: &Surroundings<'_>,
        dt: f64,
    ) -> bool {
        let pull = DVec3::NEG_Y * file.gravity;
        let line = Line {
            from: shot.place,
            way: shot.velocity * dt + pull * (0.5 * dt * dt),
            radius: file.radius,
        };
        // In its first tick, a shot has no path behind it.
        let behind = if shot.ticks > 0 { SEARCH_BEHIND } else { 0.0 };
        let stop = line.meet(behind, around);
        let end = stop.map_or(1.0, |(share, _)| share);
        let touches = around.people.iter().filter_map(|person| {
            let share = line.touch(person, around)?;
            let gap = line.at(share).distance(person.middle());
            (share <= end).then_some((share, gap, person))
        });
        // If the shot touches several people at once, for example where it begins, it strikes the nearest one.
        let first = touches.min_by(|a, b| {
            let by_share = a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
            by_share.then(a.2.id.cmp(&b.2.id))
        });
        let (place, out, struck) = match (first, stop) {
            (Some((share, _, person)), _) => {
                let place = line.at(share);
                let mut struck = Vec::new();
                if file.strikes() {
                    self.report.blows.push(StrikeHit {
                        person: person.id,
                        velocity: line.way.normalize_or_zero() * file.throw,
                        damage: file.damage,
                        place,
                        state: shot.state,
                    });
                    struck.push(person.id);
                }
                (place, DVec3::Y, struck)
            }
            (None, Some((share, out))) => (line.at(share), out, Vec::new()),
            (None, None) => {
                shot.place = line.at(1.0);
                shot.velocity += pull * dt;
                shot.ticks = shot.ticks.saturating_add(1);
                let is_near = shot.place == reachable(shot.place) && is_reached(shot.velocity);
                return is_near && f64::from(shot.ticks) * dt < file.lasts;
            }
        };
        let (state, number) = (shot.state, shot.number);
        self.report.events.push(CreatureEvent::Burst {
            state,
            number,
            place,
        });
        if let Some(wave) = &file.wave {
            let begun = WaveState {
                state,
                of: WaveOf::Shot,
                attack: self.state.ranged.attack,
                place: moved_off(place, out, wave::lift(wave), around),
                reach: 0.0,
                struck,
            };
            self.begin_wave(begun, wave, around, dt);
        }
        false
    }
}

/// Initial direction of a shot along the vector `way` to its target, by the lower of two arcs. If no arc reaches the
/// target, the shot goes as far as it can in that direction. `None` for a vector that is zero or not finite.
fn direction(way: DVec3, file: &Shot) -> Option<DVec3> {
    let level = DVec3::new(way.x, 0.0, way.z);
    let (length, up) = (level.length(), way.y);
    let ahead = level.try_normalize().unwrap_or(DVec3::ZERO);
    let (square, pull) = (file.speed * file.speed, file.gravity);
    // A shot that starts with the slope k is at the height k * length - pull * length^2 * (1 + k^2) / (2 * square) when
    // it has gone `length` ahead. This is the smaller of the two solutions k, in a form without a difference of nearly
    // equal numbers:
    let rise = pull * length * length + 2.0 * up * square;
    let root = square * square - pull * rise;
    let angle = if root >= 0.0 {
        libm::atan2(rise, (square + root.sqrt()) * length)
    } else {
        // The shot that goes farthest along a slope starts half way between the slope and straight up.
        0.5 * (FRAC_PI_2 + libm::atan2(up, length))
    };
    let (sin, cos) = libm::sincos(angle);
    let is_way = way.is_finite() && way != DVec3::ZERO;
    is_way
        .then_some(ahead * cos + DVec3::Y * sin)?
        .try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shot(speed: f64, gravity: f64) -> Shot {
        Shot {
            speed,
            radius: 0.5,
            gravity,
            lasts: 20.0,
            damage: 0.1,
            throw: 1.0,
            wave: None,
        }
    }

    #[test]
    fn shots_get_where_they_are_aimed_or_as_far_as_they_go() {
        let mut random = fastrand::Rng::with_seed(3);
        let mut lot = |size: f64| (random.f64() - 0.5) * 2.0 * size;
        let (mut reached, mut short) = (0, 0);
        for case in 0..2_000 {
            let way = match case % 10 {
                0 => DVec3::Y * lot(20.0),
                _ => DVec3::new(lot(60.0), lot(30.0), lot(60.0)),
            };
            let gravity = [9.81, 0.0, 1e-12, 3.7][case % 4];
            let speed = 8.0 + lot(4.0).abs() * 6.0;
            let level = DVec3::new(way.x, 0.0, way.z);
            let velocity = direction(way, &shot(speed, gravity)).unwrap() * speed;
            let highest = if gravity == 0.0 {
                f64::INFINITY
            } else {
                let length = level.length_squared();
                speed * speed / (2.0 * gravity) - gravity * length / (2.0 * speed * speed)
            };
            let what = format!("case {case}: {way} at {speed} m/s, {gravity} m/s^2");
            if way.y <= highest {
                // The horizontal speed gives the time at which the shot is there; straight up, there are two times.
                let [from, to] = [velocity.dot(level), level.length_squared()];
                let times = if to > 0.0 {
                    vec![to / from]
                } else if gravity < 1e-9 {
                    vec![way.y / velocity.y]
                } else {
                    let root = (velocity.y * velocity.y - 2.0 * gravity * way.y)
                        .max(0.0)
                        .sqrt();
                    [-1.0, 1.0]
                        .map(|side| (velocity.y + side * root) / gravity)
                        .to_vec()
                };
                let miss = |t: &f64| {
                    let at = velocity * *t - DVec3::Y * (0.5 * gravity * t * t);
                    at.distance(way)
                };
                let least = times.iter().map(miss).fold(f64::INFINITY, f64::min);
                assert!(least < 1e-6, "{what}: {least} m");
                assert!(times.iter().any(|time| *time >= 0.0), "{what}");
                reached += 1;
            } else if level.length() > 1.0 {
                // No arc of another angle crosses the straight line to the target farther away.
                let slope = way.y / level.length();
                let range = |angle: f64| {
                    let (sin, cos) = libm::sincos(angle);
                    2.0 * speed * speed * cos * (sin - slope * cos) / gravity
                };
                let ours = range(libm::asin(velocity.y / speed));
                let best = (0..9_000).map(|step| range(f64::from(step) * 1e-4 * FRAC_PI_2 * 1.1));
                let best = best.fold(0.0, f64::max);
                assert!(ours >= best * 0.999_999, "{what}: {ours} of {best} m");
                short += 1;
            }
        }
        assert!(reached > 500 && short > 100, "{reached} {short}");
        assert_eq!(direction(DVec3::ZERO, &shot(10.0, 9.81)), None);
        assert_eq!(direction(DVec3::ZERO, &shot(10.0, 0.0)), None);
    }
}
