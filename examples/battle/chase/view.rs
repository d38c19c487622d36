//! Where the camera is and where it looks, and how it moves from tick to tick.

use clamber::geometry::rotation_from_axis_angle;
use clamber_scenes::battle::TICK;
use clamber_scenes::valley;
use glam::DVec3;

use super::FAR;
use super::choice::{Choice, Scene};
use super::skin::{KEPT, LEAST};

/// Seconds for which the camera stays after a stab, for the next one; of its way there and back; and of its way from a
/// giant that falls dead.
const STAYS: f64 = 1.5;
const CHANGES: f64 = 1.2;
const RETREATS: f64 = 2.5;

/// The fastest turn around the climber, radians a second: usually, and for a stab or where something is in the way; how
/// fast it gets that fast, radians a second squared; and the share of the way that it turns in a second.
const TURN: f64 = 0.9;
const FAST_TURN: f64 = 1.7;
const SPEEDS_UP: f64 = 4.0;
const SHARE: f64 = 2.0;

/// The fastest turn of the view, radians a second.
const LOOK: f64 = 2.6;

/// Times for half of a change, seconds: of the place that it circles, of the place that it looks at, of the eye, of the
/// distance when something comes between, and when that is gone.
const PIVOT: f64 = 0.11;
const TARGET: f64 = 0.05;
const EYE: f64 = 0.04;
const NEARER: f64 = 0.15;
const FARTHER: f64 = 0.5;

/// The fastest motion of the eye that skin does not push, metres a second.
const FASTEST: f64 = 30.0;

/// Height above the ground that it keeps, metres.
pub(super) const ABOVE_GROUND: f64 = 1.0;

/// What the camera remembers of the last tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) climber: DVec3,
    /// The place that it circles, and the one that it looks at.
    pub(super) pivot: DVec3,
    pub(super) target: DVec3,
    /// Unit vector from the pivot to the eye, as it is and as it should be, and how fast it turns.
    pub(super) away: DVec3,
    pub(super) wanted: DVec3,
    pub(super) turns: f64,
    /// Share of the distance that is free.
    pub(super) free: f64,
    /// 0 for the usual view to 1 for that of a stab, and how many seconds more it is wanted.
    pub(super) stab: f64,
    pub(super) stays: f64,
    /// The same for the view of a giant that falls dead.
    pub(super) wide: f64,
    pub(super) eye: DVec3,
    /// Unit vector.
    pub(super) look: DVec3,
}

impl View {
    /// Goes on towards the view of a stab or of a dead giant, or back.
    pub(super) fn advance(&mut self, stabs: bool, is_dead: bool) {
        if is_dead {
            self.wide = (self.wide + TICK / RETREATS).min(1.0);
        }
        self.stays = if stabs {
            STAYS
        } else {
            (self.stays - TICK).max(0.0)
        };
        let goal = if self.stays > 0.0 { 1.0 } else { 0.0 };
        let step = TICK / CHANGES;
        self.stab += (goal - self.stab).clamp(-step, step);
    }

    /// Turns towards the wanted direction.
    pub(super) fn turn(&mut self) {
        let across = self.away.cross(self.wanted);
        let angle = libm::atan2(across.length(), self.away.dot(self.wanted));
        let hurry = self.stab.max(2.0 * (1.0 - self.free)).min(1.0);
        let most = TURN + (FAST_TURN - TURN) * hurry;
        let rate = (SHARE * angle).min(most);
        let step = SPEEDS_UP * TICK;
        self.turns += (rate - self.turns).clamp(-step, step);
        self.away = turned(self.away, self.wanted, self.turns * TICK);
    }

    /// Moves the eye, and turns the view to the target. `is_new` puts both in place at once.
    pub(super) fn place(&mut self, scene: &Scene<'_>, distance: f64, is_new: bool) {
        let way = self.pivot + self.away * distance - scene.climber;
        let free = scene.free(scene.climber, way) / way.length().max(1e-9);
        // With the face in the picture, a way past the head is better than one into it.
        let free = free.max(self.stab).max(self.wide);
        let half = if free < self.free { NEARER } else { FARTHER };
        self.free = if is_new {
            free
        } else {
            self.free + (free - self.free) * share(half)
        };
        let wanted = above_ground(self.pivot + self.away * (distance * self.free));
        let wanted = scene.skin.keep_out(wanted);
        let eye = if is_new {
            wanted
        } else {
            // Skin on another side of the eye may push `wanted` far away at once.
            let way = (wanted - self.eye) * share(EYE);
            self.eye + way.clamp_length_max(FASTEST * TICK)
        };
        // In a cleft that closes, less motion may come of staying.
        let ways = [eye, if is_new { eye } else { self.eye }].map(|eye| {
            let place = above_ground(scene.skin.keep_out(eye));
            (place, place.distance(self.eye))
        });
        let [moves, stays] = ways;
        let goes = is_new || moves.1 <= FASTEST * TICK || moves.1 <= stays.1;
        let place = if goes { moves.0 } else { stays.0 };
        // The rest of a long way is for the next ticks, unless skin is too near meanwhile.
        let part = (place - self.eye).clamp_length_max(FASTEST * TICK);
        let parts = [1.0, 0.5, 0.0].map(|share| self.eye + part * share);
        let is_free = |eye: &DVec3| scene.skin.room(*eye, KEPT) > LEAST;
        let nearer = parts.into_iter().find(is_free).filter(|_| !is_new);
        self.eye = nearer.unwrap_or(place);
        let look = (self.target - self.eye).normalize_or(self.look);
        self.look = if is_new {
            look
        } else {
            turned(self.look, look, LOOK * TICK)
        };
    }

    /// Moves the place that it circles and the one that it looks at towards others. `is_new` puts both there at once.
    pub(super) fn aim(&mut self, pivot: DVec3, target: DVec3, is_new: bool) {
        let [to_pivot, to_target] = if is_new {
            [1.0, 1.0]
        } else {
            [PIVOT, TARGET].map(share)
        };
        self.pivot = self.pivot.lerp(pivot, to_pivot);
        self.target = self.target.lerp(target, to_target);
    }
}

/// The view of a battle that begins, and of a climber that was put elsewhere.
pub(super) fn first(scene: &Scene<'_>) -> View {
    let away = scene.ideal(DVec3::X);
    let choice = Choice {
        pivot: scene.climber,
        distance: FAR,
        away,
        wanted: away,
        stab: false,
    };
    let away = scene.choose(&choice);
    View {
        climber: scene.climber,
        pivot: scene.climber,
        target: scene.climber,
        away,
        wanted: away,
        turns: 0.0,
        free: 1.0,
        stab: 0.0,
        stays: 0.0,
        wide: 0.0,
        eye: scene.climber + away * FAR,
        look: -away,
    }
}

/// A unit vector turned towards another one by at most an angle.
fn turned(from: DVec3, to: DVec3, most: f64) -> DVec3 {
    let across = from.cross(to);
    let angle = libm::atan2(across.length(), from.dot(to));
    let axis = across.normalize_or(from.any_orthonormal_vector());
    (rotation_from_axis_angle(axis, angle.min(most)) * from).normalize_or(from)
}

fn above_ground(eye: DVec3) -> DVec3 {
    let least = valley::height(eye.x, eye.z) + ABOVE_GROUND;
    eye.with_y(eye.y.max(least))
}

/// Share of a difference that goes in a tick, if half of it goes in a time.
fn share(half: f64) -> f64 {
    1.0 - libm::exp2(-TICK / half)
}
