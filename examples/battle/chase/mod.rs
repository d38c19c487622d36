//! The camera that follows the climber.
//!
//! The camera keeps a direction from the climber, and turns it towards the best of some [choices](choice) at a bounded
//! rate, so that it neither flips nor jumps when the climber's support changes. It stays in front of skin that would
//! hide the climber, and keeps a distance from all skin. While the climber stabs near the giant's face, it moves to a
//! place from which both are seen.

mod choice;
mod face;
mod skin;
mod view;

use clamber::render::Camera;
use clamber_fight::{Act, ArenaEvent};
use clamber_scenes::battle::Battle;
use glam::DVec3;

use choice::{Choice, Scene};
use face::Face;
use skin::Skin;
use view::{View, first};

/// Usual distance from the climber, metres.
const FAR: f64 = 7.5;

/// Distance of the camera in a stab, as a multiple of the distance between the climber and the face.
const FAR_IN_STAB: f64 = 1.3;
/// Least distance of the camera in a stab, metres.
const LEAST_IN_STAB: f64 = 8.0;

/// Distance from a giant that falls dead, as a share of its height.
const FAR_FROM_DEAD: f64 = 0.75;

/// A stab within this distance of the face shows the face as well, metres.
const NEAR_FACE: f64 = 15.0;

/// Number of ticks between two choices of a direction: each choice casts many rays.
const CHOOSES: u32 = 3;

/// A climber that moves farther than this in a tick was teleported, metres; the camera follows at once.
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
    /// True once the giant was killed.
    is_dead: bool,
}

impl Chase {
    /// A camera for a creature `height` metres tall.
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
        let arena = battle.arena();
        self.is_dead |= arena.is_some_and(|arena| arena.events().iter().any(killed));
        let stabs = stabs(battle, &scene) && !self.is_dead;
        view.advance(stabs, self.is_dead);
        let shot = shot(&scene, &view, self.height);
        view.aim(shot.center, shot.target, last.is_none());
        if self.ticks.is_multiple_of(CHOOSES) {
            let choice = Choice {
                pivot: shot.center,
                distance: shot.distance,
                away: view.away,
                wanted: view.wanted,
                stab: view.stays > 0.0,
            };
            view.wanted = scene.choose(&choice);
        }
        self.ticks += 1;
        view.turn();
        view.place(&scene, shot.distance, last.is_none());
        self.view = Some(view);
        Camera::new(view.eye, view.eye + view.look * shot.distance)
    }
}

/// The point that the camera circles, the point that it looks at, and its distance from the first.
struct Shot {
    center: DVec3,
    target: DVec3,
    distance: f64,
}

/// The shot of this tick. It shows the climber; during a stab, the face as well; or all of a giant, `height` metres
/// tall, that falls dead.
fn shot(scene: &Scene<'_>, view: &View, height: f64) -> Shot {
    let (center, distance) = middle(scene, view.stab);
    let wide = eased(view.wide);
    let far = FAR_FROM_DEAD * height;
    let center = center.lerp(scene.giant, 0.4 * wide);
    // Less if the camera is near the climber because skin is in the way, so that the climber stays in the picture.
    let near = (view.eye.distance(scene.climber) / FAR).min(1.0);
    let raised = scene.looks_up * near * (1.0 - view.stab) * (1.0 - wide);
    Shot {
        center,
        target: center + scene.up * raised,
        distance: distance + (far - distance) * wide,
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

/// The point that the camera circles, and its distance from there. `stab` is the share of the change from the usual
/// view to the view of a stab.
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

/// The share of a change that begins and ends slowly.
fn eased(share: f64) -> f64 {
    share * share * (3.0 - 2.0 * share)
}
