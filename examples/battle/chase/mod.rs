//! The camera that follows the climber.
//!
//! It keeps a direction from the climber, and turns it towards the best of some [choices](choice) at a bounded rate, so that
//! it neither flips nor jumps when the climber's support changes. It stays in front of skin that would hide the climber,
//! and keeps a distance from all skin. While the climber stabs near the giant's face, it goes to where both are seen.

mod choice;
mod face;
mod skin;

use clamber::geometry::rotation_from_axis_angle;
use clamber::render::Camera;
use clamber_fight::{Act, ArenaEvent};
use clamber_scenes::battle::{Battle, TICK};
use clamber_scenes::valley;
use glam::DVec3;

use choice::{Choice, Scene};
use face::Face;
use skin::{KEPT, LEAST, Skin};

/// Distance from the climber, metres.
const FAR: f64 = 7.5;

/// In a stab: for each metre between the climber and the face, and at least, metres.
const FAR_IN_STAB: f64 = 1.3;
const LEAST_IN_STAB: f64 = 8.0;

/// Distance from a giant that falls dead, as a share of its height; and seconds of the way there.
const FAR_FROM_DEAD: f64 = 0.75;
const RETREATS: f64 = 2.5;

/// The face is shown in stabs that are nearer to it than this, metres.
const NEAR_FACE: f64 = 15.0;

/// Seconds for which the camera stays after a stab, for the next one; and seconds of its way there and back.
const STAYS: f64 = 1.5;
const CHANGES: f64 = 1.2;

/// The fastest turn around the climber, radians a second: usually, and for a stab or where something is in the way; how fast
/// it gets that fast, radians a second squared; and the share of the way that it turns in a second.
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

/// Ticks between two choices of a direction.
const CHOOSES: u32 = 3;

/// Height above the ground that it keeps, metres.
const ABOVE_GROUND: f64 = 1.0;

/// A climber that moves farther than this in a tick was put elsewhere, metres: the camera is there at once.
const PUT: f64 = 8.0;

/// The camera and its memory.
#[derive(Debug)]
pub(crate) struct Chase {
    skin: Option<Skin>,
    face: Option<Face>,
    view: Option<View>,
    ticks: u32,
    /// Height of the creature, metres.
    height: f64,
    /// The giant was killed.
    is_dead: bool,
}

/// What the camera remembers of the last tick.
#[derive(Clone, Copy, Debug)]
struct View {
    climber: DVec3,
    /// The place that it circles, and the one that it looks at.
    pivot: DVec3,
    target: DVec3,
    /// Unit vector from the pivot to the eye, as it is and as it should be, and how fast it turns.
    away: DVec3,
    wanted: DVec3,
    turns: f64,
    /// Share of the distance that is free.
    free: f64,
    /// 0 for the usual view to 1 for that of a stab, and how many seconds more it is wanted.
    stab: f64,
    stays: f64,
    /// The same for the view of a giant that falls dead.
    wide: f64,
    eye: DVec3,
    /// Unit vector.
    look: DVec3,
}

impl Chase {
    /// For a creature `height` metres tall.
    pub(crate) fn new(height: f64) -> Self {
        Self {
            skin: None,
            face: None,
            view: None,
            ticks: 0,
            height,
            is_dead: false,
        }
    }

    /// The camera after another tick.
    pub(crate) fn follow(&mut self, battle: &Battle<'_>) -> Camera {
        let skin = match &mut self.skin {
            Some(skin) => skin,
            None => {
                self.face = Face::find(battle.creature());
                self.skin.insert(Skin::new(battle))
            }
        };
        skin.pose(battle);
        let climber = battle.climber().state().position;
        let face = self.face.as_ref().and_then(|face| face.now(battle));
        let scene = Scene::new(battle, skin, face);
        let last = self
            .view
            .filter(|view| view.climber.distance(climber) < PUT);
        let mut view = last.unwrap_or_else(|| first(&scene));
        view.climber = climber;
        let killed = |event: &ArenaEvent| matches!(event, ArenaEvent::Killed { .. });
        self.is_dead |= battle
            .arena()
            .is_some_and(|arena| arena.events().iter().any(killed));
        if self.is_dead {
            view.wide = (view.wide + TICK / RETREATS).min(1.0);
        }
        view.stays = if stabs(battle, &scene) && !self.is_dead {
            STAYS
        } else {
            (view.stays - TICK).max(0.0)
        };
        let goal = if view.stays > 0.0 { 1.0 } else { 0.0 };
        let step = TICK / CHANGES;
        view.stab += (goal - view.stab).clamp(-step, step);
        let (center, distance) = middle(&scene, view.stab);
        let wide = eased(view.wide);
        let far = FAR_FROM_DEAD * self.height;
        let (center, distance) = (
            center.lerp(scene.giant, 0.4 * wide),
            distance + (far - distance) * wide,
        );
        // Less where something comes between, so that the climber stays in the picture.
        let near = (view.eye.distance(climber) / FAR).min(1.0);
        let raised = scene.up * (scene.looks_up * near * (1.0 - view.stab) * (1.0 - wide));
        if last.is_none() {
            (view.pivot, view.target) = (center, center + raised);
        }
        view.pivot = view.pivot.lerp(center, share(PIVOT));
        view.target = view.target.lerp(center + raised, share(TARGET));
        if self.ticks.is_multiple_of(CHOOSES) {
            let choice = Choice {
                pivot: center,
                distance,
                away: view.away,
                wanted: view.wanted,
                stab: goal > 0.0,
            };
            view.wanted = scene.choose(&choice);
        }
        self.ticks += 1;
        view.turn();
        view.place(&scene, distance, last.is_none());
        self.view = Some(view);
        Camera::new(view.eye, view.eye + view.look * distance)
    }
}

impl View {
    /// Turns towards the wanted direction.
    fn turn(&mut self) {
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
    fn place(&mut self, scene: &Scene<'_>, distance: f64, is_new: bool) {
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
}

/// The view of a battle that begins, and of a climber that was put elsewhere.
fn first(scene: &Scene<'_>) -> View {
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

/// True while the climber stabs near the face.
fn stabs(battle: &Battle<'_>, scene: &Scene<'_>) -> bool {
    let Some(fighter) = battle.performer().fighter() else {
        return false;
    };
    let stabs = matches!(
        fighter.act(),
        Act::Raise { .. } | Act::Charge { .. } | Act::Strike { .. } | Act::PullOut { .. }
    );
    let face = scene.face.map(|face| face.place);
    stabs && face.is_some_and(|face| face.distance(scene.climber) < NEAR_FACE)
}

/// What the camera circles, and how far from it, at a share of the way from the usual view to that of a stab.
fn middle(scene: &Scene<'_>, stab: f64) -> (DVec3, f64) {
    let climber = scene.climber + scene.up * 0.5;
    let Some(face) = scene.face else {
        return (climber, FAR);
    };
    let eased = eased(stab);
    let between = climber.distance(face.place);
    let far = (FAR_IN_STAB * between).max(LEAST_IN_STAB);
    let center = climber.lerp(face.place, 0.55 * eased);
    (center, FAR + (far - FAR) * eased)
}

/// A share that begins and ends slowly.
fn eased(share: f64) -> f64 {
    share * share * (3.0 - 2.0 * share)
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
