//! What the creature does: it looks around, walks on a circle, and shakes itself when it has been ridden for a while.

use std::time::Duration;

use bevy::prelude::*;
use bevy_clamber::prelude::*;

use crate::creature::Creature;
use crate::hero::Hero;

/// Speed of the giant's walk, at its size in the file, metres a second.
const GIANT_WALK: f32 = 5.0;

/// Speed of other creatures, their heights a second.
const WALK: f32 = 0.4;

/// Radius of the circle that it walks on, its heights.
const CIRCLE: f32 = 1.2;

/// Seconds that it bears a rider.
const PATIENCE: f32 = 14.0;

/// Duration of the passage from one clip to the next.
const FADE: Duration = Duration::from_millis(600);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Act {
    Idle,
    Walk,
    Shake,
}

/// What the creature is doing.
#[derive(Resource, Debug)]
pub struct Mood {
    act: Act,
    /// Seconds until it does something else.
    left: f32,
    /// Seconds for which it has been ridden without shaking itself.
    ridden: f32,
    /// Metres that it has walked on its circle.
    walked: f32,
    /// Metres a second.
    speed: f32,
    /// The ground below its feet is this much below its root.
    lift: f32,
}

/// Where a creature of this height begins its walk around the origin. It looks along +Z.
pub fn start(height: f32) -> Vec3 {
    Vec3::NEG_X * CIRCLE * height
}

pub fn plugin(app: &mut App) {
    app.add_systems(
        Update,
        (
            begin.run_if(resource_added::<Creature>),
            live.run_if(resource_exists::<Mood>),
        )
            .chain(),
    );
}

fn begin(
    creature: Res<Creature>,
    transforms: Query<&Transform>,
    mut players: Players,
    mut commands: Commands,
) {
    let lift = transforms
        .get(creature.root)
        .map_or(0.0, |root| root.translation.y);
    players.play(&creature, Act::Idle);
    commands.insert_resource(Mood {
        act: Act::Idle,
        left: 20.0,
        ridden: 0.0,
        walked: 0.0,
        speed: 0.0,
        lift,
    });
}

/// The animation players of the creature.
type Players<'w, 's> = Query<
    'w,
    's,
    (
        &'static mut AnimationPlayer,
        &'static mut AnimationTransitions,
    ),
>;

trait Play {
    fn play(&mut self, creature: &Creature, act: Act) -> bool;
}

impl Play for Players<'_, '_> {
    /// Plays the clip of an act. False if the file has none.
    fn play(&mut self, creature: &Creature, act: Act) -> bool {
        let names: &[&str] = match act {
            Act::Idle => &["idle", "survey", "look", "stand"],
            Act::Walk => &["walk", "run", "gallop"],
            Act::Shake => &["shake", "hit", "jump"],
        };
        let named = |name: &&str| creature.clips.iter().find(|(clip, _)| clip.contains(*name));
        let Some((_, node)) = names.iter().find_map(named) else {
            return false;
        };
        for (mut player, mut transitions) in self {
            transitions.play(&mut player, *node, FADE).repeat();
        }
        true
    }
}

fn live(
    time: Res<Time>,
    creature: Res<Creature>,
    mut mood: ResMut<Mood>,
    mut players: Players,
    riders: Query<&ClimberState, With<Hero>>,
    surfaces: Query<(), With<PosedSurface>>,
    mut roots: Query<&mut Transform>,
) {
    let dt = time.delta_secs();
    let rides = |state: &ClimberState| {
        let on = state.support.map(|support| support.attachment.obstacle.0);
        on.and_then(Entity::try_from_bits)
            .is_some_and(|on| surfaces.contains(on))
    };
    mood.ridden += if riders.iter().any(rides) { dt } else { 0.0 };
    mood.left -= dt;
    if mood.left <= 0.0 {
        let next = match mood.act {
            _ if mood.ridden > PATIENCE => (Act::Shake, 5.2),
            Act::Walk | Act::Shake => (Act::Idle, 12.0),
            Act::Idle => (Act::Walk, 14.0),
        };
        let next = if players.play(&creature, next.0) {
            next
        } else {
            (Act::Idle, 6.0)
        };
        if next.0 == Act::Shake {
            mood.ridden = 0.0;
        }
        (mood.act, mood.left) = next;
    }
    // It starts and stops as slowly as it passes from one clip to the next.
    let full = if creature.clips.iter().any(|(name, _)| name == "stomp") {
        GIANT_WALK * creature.scale
    } else {
        WALK * creature.height
    };
    let wanted = if mood.act == Act::Walk { full } else { 0.0 };
    let change = full * dt / FADE.as_secs_f32();
    mood.speed += (wanted - mood.speed).clamp(-change, change);
    mood.walked += mood.speed * dt;
    if let Ok(mut root) = roots.get_mut(creature.root) {
        let around = Quat::from_rotation_y(mood.walked / (CIRCLE * creature.height));
        root.translation = around * start(creature.height) + Vec3::Y * mood.lift;
        root.rotation = around;
    }
}
