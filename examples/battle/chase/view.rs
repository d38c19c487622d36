//! The position and direction of the camera, and their motion from tick to tick.

use clamber::geometry::rotation_from_axis_angle;
use clamber_scenes::battle::TICK;
use clamber_scenes::valley;
use glam::DVec3;

use super::FAR;
use super::choice::{Choice, Scene};
use super::skin::{KEPT, LEAST};

/// Time for which the camera keeps the view of a stab after the stab, in case of another one, seconds.
const STAYS: f64 = 1.5;
/// Time of the change to the view of a stab, and back, seconds.
const CHANGES: f64 = 1.2;
/// Time of the change to the view of a giant that falls dead, seconds.
const RETREATS: f64 = 2.5;

/// Usual fastest turn around the climber, radians a second.
const TURN: f64 = 0.9;
/// Fastest turn around the climber for a stab, or if the view is blocked, radians a second.
const FAST_TURN: f64 = 1.7;
/// Largest change of the rate of turning, radians a second squared.
const SPEEDS_UP: f64 = 4.0;
/// Rate of turning for each radian of the remaining angle, 1 / s.
const SHARE: f64 = 2.0;

/// Fastest turn of the view, radians a second.
const LOOK: f64 = 2.6;

/// Half-life of changes of the point that the camera circles, seconds.
const PIVOT: f64 = 0.11;
/// Half-life of changes of the point that the camera looks at, seconds.
const TARGET: f64 = 0.05;
/// Half-life of changes of the eye's position, seconds.
const EYE: f64 = 0.04;
/// Half-life of a decrease of the distance, when the view gets blocked, seconds.
const NEARER: f64 = 0.15;
/// Half-life of an increase of the distance, when the view gets free, seconds.
const FARTHER: f64 = 0.5;

/// Fastest motion of the eye, unless skin pushes it, metres a second.
const FASTEST: f64 = 30.0;

/// Height above the ground that the eye keeps, metres.
pub(super) const ABOVE_GROUND: f64 = 1.0;

/// The camera's state after the last tick.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) climber: DVec3,
    /// The point that the camera circles, and the point that it looks at.
    pub(super) pivot: DVec3,
    pub(super) target: DVec3,
    /// Unit vector from the pivot to the eye, the wanted one, and the rate of turning, radians a second.
    pub(super) away: DVec3,
    pub(super) wanted: DVec3,
    pub(super) turns: f64,
    /// Share of the distance that is free.
    pub(super) free: f64,
    /// Weight of the stab view in the blend with the usual view, from 0 to 1, and the seconds for which the stab view
    /// is still wanted.
    pub(super) stab: f64,
    pub(super) stays: f64,
    /// Weight of the view of a giant that falls dead, from 0 to 1.
    pub(super) wide: f64,
    pub(super) eye: DVec3,
    /// Unit vector.
    pub(super) look: DVec3,
}

impl View {
    /// Moves the weights towards the view of a stab or of a dead giant, or back.
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

    /// Turns `away` towards the wanted direction.
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
        // With the face in the picture, a way past the head is better than a way into the head.
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
        // In a cleft that closes, a start from the present eye may need less motion.
        let ways = [eye, if is_new { eye } else { self.eye }].map(|eye| {
            let place = above_ground(scene.skin.keep_out(eye));
            (place, place.distance(self.eye))
        });
        let [moves, stays] = ways;
        let goes = is_new || moves.1 <= FASTEST * TICK || moves.1 <= stays.1;
        let place = if goes { moves.0 } else { stays.0 };
        // A long way takes several ticks, unless skin is too near on it.
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

    /// Moves the point that the camera circles and the point that it looks at towards new ones. `is_new` puts both
    /// there at once.
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

/// The first view of a battle, or of a climber that was teleported.
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

/// Share of a difference that is removed in a tick, for a half-life in seconds.
fn share(half: f64) -> f64 {
    1.0 - libm::exp2(-TICK / half)
}
