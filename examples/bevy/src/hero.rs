//! The hero: a climber, drawn as a person. It starts behind the creature, and again when it has died.

use bevy::prelude::*;
use bevy_clamber::clamber_climber::{ClimberConfig, ClimberMode};
use bevy_clamber::events::ClimberHurt;
use bevy_clamber::prelude::*;

use crate::body::Person;
use crate::creature::Creature;
use crate::giant;
use crate::hud::Message;
use crate::valley;

/// Speed on the ground, metres a second: faster than the giant.
const RUN: f64 = 6.0;

/// Speed at which it jumps up, metres a second: 2.1 m high, where the giant's fur begins.
const JUMP: f64 = 6.5;

/// Seconds for which the dead lie.
const DEAD: f32 = 2.5;

/// Whoever is so low has left the valley, metres.
const ABYSS: f32 = -30.0;

/// Who stands above this share of the creature's height has won.
const TOP: f32 = 0.9;

/// The player's climber.
#[derive(Component, Debug, Default)]
pub struct Hero {
    /// Seconds since it died.
    dead: Option<f32>,
    /// It has stood on the creature's top.
    pub has_won: bool,
}

pub fn plugin(app: &mut App) {
    app.add_observer(tell_harm).add_systems(
        Update,
        (
            spawn.run_if(resource_added::<Creature>),
            die.run_if(resource_exists::<Creature>),
            win.run_if(resource_exists::<Creature>),
        )
            .chain(),
    );
}

/// Behind the creature, looking at it.
fn start(creature: &Creature) -> Transform {
    let away = creature.radius + 8.0;
    let place = giant::start(creature.height) - Vec3::Z * away;
    let above = Vec3::Y * (valley::height(place.x, place.z) + 1.0);
    Transform::from_translation(place + above).looking_to(Vec3::Z, Vec3::Y)
}

fn spawn(
    creature: Res<Creature>,
    camera: Single<Entity, With<Camera3d>>,
    person: Res<Person>,
    mut commands: Commands,
) {
    let mut config = ClimberConfig::colossus_climber();
    config.ground.walk_speed = RUN;
    config.ground.jump_speed = JUMP;
    let hero = (
        Hero::default(),
        Climber::new(config),
        ClimberControls::default(),
        start(&creature),
        person.figure(&mut commands),
    );
    let hero = commands.spawn(hero).id();
    commands.entity(*camera).insert(ClimberCamera {
        distance: 9.0,
        ..ClimberCamera::new(hero)
    });
}

fn tell_harm(hurt: On<ClimberHurt>, mut message: ResMut<Message>) {
    if hurt.left > 0.0 {
        message.say(format!("Hurt: {:.0} % left", 100.0 * hurt.left), 2.0);
    }
}

/// Lets the hero lie when it has died, and start again after a while or when the player asks for it.
fn die(
    time: Res<Time>,
    creature: Res<Creature>,
    keys: Option<Res<ButtonInput<KeyCode>>>,
    gamepads: Query<&Gamepad>,
    mut heroes: Query<(
        Entity,
        &mut Hero,
        &mut ClimberState,
        &mut ClimberInput,
        &mut Transform,
    )>,
    mut message: ResMut<Message>,
    mut commands: Commands,
) {
    let by_key = keys.is_some_and(|keys| keys.just_pressed(KeyCode::KeyR));
    let by_pad = gamepads
        .iter()
        .any(|pad| pad.just_pressed(GamepadButton::Select));
    for (entity, mut hero, mut state, mut input, mut place) in &mut heroes {
        if let Some(dead) = &mut hero.dead {
            *dead += time.delta_secs();
        } else if state.hit_points <= 0.0 {
            hero.dead = Some(0.0);
            *input = ClimberInput::default();
            commands.entity(entity).remove::<ClimberControls>();
            message.say("You died", DEAD);
        }
        let has_left = place.translation.y < ABYSS;
        if has_left || by_key || by_pad || hero.dead.is_some_and(|dead| dead > DEAD) {
            *hero = Hero::default();
            commands.entity(entity).insert(ClimberControls::default());
            // Another translation than the one that was drawn teleports a climber.
            *place = start(&creature);
            state.0.hit_points = 1.0;
            state.0.stamina = 1.0;
        }
    }
}

fn win(
    creature: Res<Creature>,
    surfaces: Query<(), With<PosedSurface>>,
    mut heroes: Query<(&mut Hero, &ClimberState)>,
    mut message: ResMut<Message>,
) {
    for (mut hero, state) in &mut heroes {
        let on = state.support.map(|support| support.attachment.obstacle.0);
        let on = on.and_then(Entity::try_from_bits);
        let is_up = state.position.y as f32 > TOP * creature.height;
        let stands = state.mode == ClimberMode::Standing;
        if stands && is_up && on.is_some_and(|on| surfaces.contains(on)) && !hero.has_won {
            hero.has_won = true;
            message.say("You stand on top of it. You have won!", 6.0);
        }
    }
}
