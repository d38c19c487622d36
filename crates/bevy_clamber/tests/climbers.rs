//! Climbers on entities: spawned, told what to do, moved, changed and removed by the app in any tick.

#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests")]

mod common;

use std::time::Duration;

use bevy_app::{App, FixedUpdate, PreUpdate, Update};
use bevy_asset::Assets;
use bevy_clamber::clamber_climber::{ClimberConfig, ClimberMode, ClimberObstacle, CustomMode};
use bevy_clamber::clamber_climber::{ModeContext, NextMode};
use bevy_clamber::events::{
    ClimberChangedMode, ClimberGrabbed, ClimberHurt, ClimberJumped, ClimberLanded,
    ClimberLostFooting, ClimberModeReported,
};
use bevy_clamber::prelude::*;
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::message::Messages;
use bevy_ecs::prelude::*;
use bevy_math::{DVec3, Vec3};
use bevy_mesh::{Mesh, Mesh3d};
use bevy_time::{Time, TimeUpdateStrategy, Virtual};
use bevy_transform::components::Transform;
use common::{Limb, app_with, limb, limb_mesh, wait};

/// Metres a second that the creature moves along X.
const SPEED: f32 = 2.0;

/// The upper side of the creature, metres.
const TOP: f64 = 2.0;

/// Radius of the climber's ball.
const RADIUS: f64 = 0.4;

fn climbing(rate: f64) -> App {
    app_with(rate, (ClamberPlugins::default(), ClimberPlugin::default()))
}

#[derive(Component)]
struct Moving;

fn carry(time: Res<Time>, mut roots: Query<&mut Transform, With<Moving>>) {
    for mut root in &mut roots {
        root.translation.x += SPEED * time.delta_secs();
    }
}

/// A limb ten times as large that lies along X, from 0 to 20 m: its upper side is a floor of 4 m, at a height of 2 m.
fn floor(app: &mut App, collider: SkinnedCollider) -> Limb {
    let lying = Transform::from_rotation(common::LYING);
    limb(app, lying.with_scale(Vec3::splat(10.0)), collider)
}

fn climber(app: &mut App, at: Vec3) -> Entity {
    let climber = (Climber::colossus_climber(), Transform::from_translation(at));
    app.world_mut().spawn(climber).id()
}

fn state(app: &App, climber: Entity) -> ClimberState {
    *app.world().get::<ClimberState>(climber).unwrap()
}

fn stands(app: &App, climber: Entity) -> bool {
    state(app, climber).mode == ClimberMode::Standing
}

fn updates(app: &mut App, count: usize) {
    for _ in 0..count {
        app.update();
    }
}

/// A climber that stands on a still floor.
fn standing(rate: f64) -> (App, Limb, Entity) {
    let mut app = climbing(rate);
    let floor = floor(&mut app, SkinnedCollider::default());
    let climber = climber(&mut app, Vec3::new(10.0, 2.5, 0.0));
    updates(&mut app, (0.5 * rate) as usize);
    assert!(stands(&app, climber));
    (app, floor, climber)
}

fn input(app: &mut App, climber: Entity) -> Mut<'_, ClimberInput> {
    app.world_mut().get_mut::<ClimberInput>(climber).unwrap()
}

#[derive(Resource, Default)]
struct Told(Vec<String>);

#[test]
fn a_climber_lands_on_skin_is_carried_and_tells_of_it() {
    for collider in [SkinnedCollider::default(), SkinnedCollider::each_tick()] {
        let mut app = climbing(64.0);
        if collider == SkinnedCollider::each_tick() {
            app.add_systems(FixedUpdate, carry);
        } else {
            app.add_systems(Update, carry);
        }
        app.init_resource::<Told>();
        app.add_observer(|landed: On<ClimberLanded>, mut told: ResMut<Told>| {
            told.0.push(format!("{:?}", landed.ground));
        });
        let floor = floor(&mut app, collider);
        app.world_mut().entity_mut(floor.root).insert(Moving);
        let climber = climber(&mut app, Vec3::new(10.0, 4.0, 0.0));
        updates(&mut app, 120);
        let (before, root) = (
            state(&app, climber),
            *app.world().get::<Transform>(floor.root).unwrap(),
        );
        updates(&mut app, 64);
        let (after, now) = (
            state(&app, climber),
            *app.world().get::<Transform>(floor.root).unwrap(),
        );
        assert_eq!(after.mode, ClimberMode::Standing);
        let carried = after.position.x - before.position.x;
        let moved = f64::from(now.translation.x - root.translation.x);
        assert!((carried - moved).abs() < 1e-3, "{carried} {moved}");
        assert!(
            (after.velocity.x - f64::from(SPEED)).abs() < 0.01,
            "{after:?}"
        );
        // An observer and a reader are told the same.
        let told = &app.world().resource::<Told>().0;
        assert_eq!(*told, [format!("{:?}", Some(floor.mesh))]);
        let body = app.world().get::<ClimberBody>(climber).unwrap();
        assert_eq!(
            body.contacts().last().unwrap().obstacle.0,
            floor.mesh.to_bits()
        );
    }
}

/// Ticks and frames: 3 frames a tick, and 2 ticks a frame (the cases of bevy#6183 and leafwing-input-manager#522).
#[test]
fn every_tap_is_one_jump() {
    fn reset(mut climbers: Query<&mut ClimberState>, mut seen: Local<Option<ClimberState>>) {
        // Back to the ground after each jump, so that a second one would be seen.
        for mut state in &mut climbers {
            let ground = *seen.get_or_insert(*state);
            if state.mode != ClimberMode::Standing {
                *state = ground;
            }
        }
    }
    for (frame, taps) in [(1.0 / 192.0, 1000), (1.0 / 32.0, 1000), (1.0 / 77.0, 200)] {
        let (mut app, _, climber) = standing(64.0);
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(
            frame,
        )));
        updates(&mut app, 9);
        app.add_systems(FixedUpdate, reset);
        let mut messages = app.world_mut().resource_mut::<Messages<ClimberJumped>>();
        messages.clear();
        // As an input crate does: it is written anew in each frame.
        #[derive(Resource, Default)]
        struct Tap(bool);
        app.init_resource::<Tap>();
        app.add_systems(
            PreUpdate,
            |tap: Res<Tap>, mut inputs: Query<&mut ClimberInput>| {
                for mut input in &mut inputs {
                    input.jump = tap.0;
                }
            },
        );
        let mut jumps = 0;
        let mut cursor = app
            .world()
            .resource::<Messages<ClimberJumped>>()
            .get_cursor();
        let mut random = fastrand::Rng::with_seed(3);
        for tap in 0..taps {
            app.world_mut().resource_mut::<Tap>().0 = true;
            app.update();
            app.world_mut().resource_mut::<Tap>().0 = false;
            for _ in 0..random.usize(4..10) {
                app.update();
                let all = app.world().resource::<Messages<ClimberJumped>>();
                jumps += cursor.read(all).count();
            }
            assert_eq!(jumps, tap + 1, "{frame} s a frame: tap {tap}");
        }
        assert!(app.world().get::<ClimberState>(climber).is_some());
    }
}

#[test]
fn a_press_in_a_pause_is_forgotten_and_a_short_hold_is_not_lost() {
    let (mut app, _, climber) = standing(64.0);
    app.world_mut().resource_mut::<Time<Virtual>>().pause();
    updates(&mut app, 3);
    input(&mut app, climber).jump = true;
    updates(&mut app, 3);
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    updates(&mut app, 20);
    assert!(stands(&app, climber));
    // Down and up again between two ticks.
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(1)));
    #[derive(Debug)]
    struct Counts;
    impl CustomMode for Counts {
        fn id(&self) -> u16 {
            9
        }
        fn begins(&self, context: &mut ModeContext<'_, '_>) -> bool {
            if context.input().actions == 4 {
                context.report(self.id(), 1, 1.0);
            }
            false
        }
        fn step(&self, _: &mut ModeContext<'_, '_>) -> NextMode {
            NextMode::Stay
        }
    }
    app.insert_resource(ClimberModes(vec![Box::new(Counts)]));
    app.update();
    input(&mut app, climber).actions = 4;
    app.update();
    input(&mut app, climber).actions = 0;
    let mut cursor = app
        .world()
        .resource::<Messages<ClimberModeReported>>()
        .get_cursor();
    let mut reports = 0;
    for _ in 0..60 {
        app.update();
        let all = app.world().resource::<Messages<ClimberModeReported>>();
        reports += cursor.read(all).count();
    }
    assert_eq!(reports, 1);
}

#[test]
fn blows_add_up_and_hurt() {
    let (mut app, floor, climber) = standing(64.0);
    let blow = ClimberBlow {
        velocity: Vec3::Y * 2.0,
        damage: 0.2,
        by: Some(floor.mesh),
    };
    input(&mut app, climber).strike(blow);
    input(&mut app, climber).strike(blow);
    let mut cursor = app.world().resource::<Messages<ClimberHurt>>().get_cursor();
    app.update();
    let hurt: Vec<_> = cursor
        .read(app.world().resource::<Messages<ClimberHurt>>())
        .copied()
        .collect();
    assert_eq!(hurt.len(), 1);
    assert!(
        (hurt[0].damage - 0.4).abs() < 1e-6 && (hurt[0].left - 0.6).abs() < 1e-6,
        "{hurt:?}"
    );
    updates(&mut app, 9);
    assert!((state(&app, climber).hit_points - 0.6).abs() < 1e-6);
}

#[test]
fn blows_that_are_not_finite_are_refused_and_hurt_nobody() {
    let (mut app, _, climber) = standing(64.0);
    for damage in [f32::NAN, 0.2] {
        let blow = ClimberBlow {
            damage,
            ..ClimberBlow::default()
        };
        input(&mut app, climber).strike(blow);
    }
    updates(&mut app, 3);
    assert_eq!(state(&app, climber).hit_points, 1.0);
}

#[test]
fn what_happened_is_told_once_when_input_or_state_are_taken_away() {
    let (mut app, _, climber) = standing(64.0);
    let mut cursor = app
        .world()
        .resource::<Messages<ClimberJumped>>()
        .get_cursor();
    input(&mut app, climber).jump = true;
    let mut jumps = 0;
    for tick in 0..20 {
        app.update();
        jumps += cursor
            .read(app.world().resource::<Messages<ClimberJumped>>())
            .count();
        if tick == 0 {
            app.world_mut().entity_mut(climber).remove::<ClimberInput>();
        }
    }
    assert_eq!(jumps, 1);
    let still = state(&app, climber).position;
    let given = (ClimberInput::default(), Name::new("again"));
    app.world_mut().entity_mut(climber).insert(given);
    app.world_mut().entity_mut(climber).remove::<ClimberState>();
    updates(&mut app, 20);
    assert!(state(&app, climber).position != still);
}

#[test]
fn a_translation_that_the_app_writes_is_a_teleport() {
    // In a frame's schedule, in a tick's, and outside of both.
    for schedule in 0..3 {
        let (mut app, _, climber) = standing(64.0);
        let there = Vec3::new(4.0, 3.0, 0.5);
        let jump = move |mut all: Query<&mut Transform, With<Climber>>, mut done: Local<bool>| {
            if !std::mem::replace(&mut *done, true) {
                all.get_mut(climber).unwrap().translation = there;
            }
        };
        match schedule {
            0 => {
                app.add_systems(Update, jump);
            }
            1 => {
                app.add_systems(FixedUpdate, jump);
            }
            _ => {
                app.world_mut()
                    .get_mut::<Transform>(climber)
                    .unwrap()
                    .translation = there
            }
        }
        updates(&mut app, 2);
        let drawn = app.world().get::<Transform>(climber).unwrap().translation;
        assert!(drawn.distance(there) < 0.02, "{schedule}: {drawn}");
        updates(&mut app, 60);
        let now = state(&app, climber);
        assert_eq!(now.mode, ClimberMode::Standing, "{schedule}");
        assert!(
            (now.position - DVec3::new(4.0, TOP + RADIUS, 0.5)).length() < 0.02,
            "{now:?}"
        );
        assert_eq!(now.hit_points, 1.0);
    }
}

#[test]
fn a_state_that_the_app_writes_is_restored() {
    let (mut app, _, climber) = standing(64.0);
    let saved = state(&app, climber);
    input(&mut app, climber).walk = Vec3::X;
    let mut first = Vec::new();
    for _ in 0..60 {
        app.update();
        first.push(state(&app, climber).0);
    }
    *app.world_mut().get_mut::<ClimberState>(climber).unwrap() = saved;
    for expected in first {
        app.update();
        assert_eq!(state(&app, climber).0, expected);
    }
    // One that no climber can be in is refused, and changes nothing.
    let before = state(&app, climber);
    app.world_mut()
        .get_mut::<ClimberState>(climber)
        .unwrap()
        .0
        .stamina = f64::NAN;
    updates(&mut app, 2);
    let after = state(&app, climber);
    assert!(
        after.stamina == 1.0 && after.position.x > before.position.x,
        "{after:?}"
    );
    // An entity that is spawned with a state starts with it.
    let other = app
        .world_mut()
        .spawn((
            Climber::default(),
            saved,
            Transform::from_xyz(99.0, 99.0, 99.0),
        ))
        .id();
    updates(&mut app, 2);
    assert!(state(&app, other).position.distance(saved.position) < 0.1);
}

#[test]
fn a_configuration_may_change_at_any_time_and_a_bad_one_is_refused() {
    let (mut app, _, climber) = standing(64.0);
    let mut config = ClimberConfig::colossus_climber();
    config.gravity = DVec3::new(0.0, -f64::NAN, 0.0);
    app.world_mut().get_mut::<Climber>(climber).unwrap().config = config;
    updates(&mut app, 5);
    assert!(stands(&app, climber));
    let config = ClimberConfig {
        gravity: DVec3::new(0.0, 9.81, 0.0),
        ..ClimberConfig::walker()
    };
    app.world_mut().get_mut::<Climber>(climber).unwrap().config = config;
    updates(&mut app, 64);
    assert!(state(&app, climber).position.y > 3.0);
    let body = app.world().get::<ClimberBody>(climber).unwrap();
    assert_eq!(*body.config(), config);
    // Refused from the start.
    let mut bad = Climber::default();
    bad.config.shake_time = -1.0;
    let refused = app.world_mut().spawn((bad, Transform::IDENTITY)).id();
    updates(&mut app, 3);
    assert!(app.world().get::<ClimberState>(refused).is_none());
    app.world_mut().get_mut::<Climber>(refused).unwrap().config = ClimberConfig::walker();
    updates(&mut app, 3);
    assert!(app.world().get::<ClimberState>(refused).is_some());
}

#[test]
fn freezing_removing_and_despawning_are_safe_in_any_tick() {
    let (mut app, floor, climber) = standing(64.0);
    app.world_mut().entity_mut(climber).insert(Disabled);
    let frozen = state(&app, climber);
    updates(&mut app, 30);
    assert_eq!(state(&app, climber), frozen);
    app.world_mut().entity_mut(climber).remove::<Disabled>();
    updates(&mut app, 5);
    assert!(stands(&app, climber));

    app.world_mut().entity_mut(climber).remove::<Climber>();
    updates(&mut app, 3);
    assert!(app.world().get::<ClimberState>(climber).is_none());
    assert!(app.world().get::<ClimberBody>(climber).is_none());
    app.world_mut()
        .entity_mut(climber)
        .insert(Climber::default());
    updates(&mut app, 30);
    assert!(stands(&app, climber));

    // Despawned in a tick, before and after climbers are stepped, with what it stands on, and in an observer of its own
    // event.
    let others: Vec<Entity> = (0..4)
        .map(|i| self::climber(&mut app, Vec3::new(4.0 + 2.0 * i as f32, 3.0, 0.0)))
        .collect();
    let doomed = others.clone();
    let despawn = move |mut commands: Commands, mut tick: Local<usize>| {
        if let Some(next) = tick.checked_sub(20).and_then(|tick| doomed.get(tick)) {
            commands.entity(*next).despawn();
        }
        *tick += 1;
    };
    app.add_systems(FixedUpdate, despawn);
    app.add_observer(|jumped: On<ClimberJumped>, mut commands: Commands| {
        commands.entity(jumped.entity).despawn();
    });
    updates(&mut app, 40);
    assert!(
        others
            .iter()
            .all(|other| app.world().get_entity(*other).is_err())
    );
    input(&mut app, climber).jump = true;
    updates(&mut app, 3);
    assert!(app.world().get_entity(climber).is_err());

    let last = self::climber(&mut app, Vec3::new(10.0, 3.0, 0.0));
    updates(&mut app, 40);
    assert!(stands(&app, last));
    let mut cursor = app
        .world()
        .resource::<Messages<ClimberLostFooting>>()
        .get_cursor();
    app.world_mut().entity_mut(floor.root).despawn();
    app.update();
    let lost: Vec<_> = cursor
        .read(app.world().resource::<Messages<ClimberLostFooting>>())
        .copied()
        .collect();
    assert_eq!(lost.len(), 1);
    assert_eq!((lost[0].entity, lost[0].support), (last, Some(floor.mesh)));
    assert!(!stands(&app, last));
}

#[test]
fn another_mesh_is_lost_footing_and_another_tag_is_not() {
    let (mut app, floor, climber) = standing(64.0);
    let mut cursor = app
        .world()
        .resource::<Messages<ClimberLostFooting>>()
        .get_cursor();
    let mut lost = |app: &App| {
        cursor
            .read(app.world().resource::<Messages<ClimberLostFooting>>())
            .count()
    };
    let tag = ColliderTag(SurfaceTag::new(SurfaceKind::Stone));
    app.world_mut().entity_mut(floor.mesh).insert(tag);
    app.update();
    wait(&mut app, floor.mesh);
    updates(&mut app, 5);
    assert_eq!(lost(&app), 0);
    assert!(stands(&app, climber));
    // The same shape with one vertex more, which makes it another mesh.
    let mut other = limb_mesh();
    let positions = other.attribute_mut(Mesh::ATTRIBUTE_POSITION).unwrap();
    if let bevy_mesh::VertexAttributeValues::Float32x3(positions) = positions {
        for position in positions.iter_mut() {
            position[0] *= 1.01;
        }
    }
    let other = app.world_mut().resource_mut::<Assets<Mesh>>().add(other);
    app.world_mut().entity_mut(floor.mesh).insert(Mesh3d(other));
    app.update();
    wait(&mut app, floor.mesh);
    app.update();
    assert_eq!(lost(&app), 1);
    updates(&mut app, 64);
    assert!(stands(&app, climber));
    assert_eq!(lost(&app), 0);
}

#[test]
fn climbers_stand_on_each_other_and_on_obstacles_of_the_app() {
    let (mut app, _, climber) = standing(64.0);
    let at = state(&app, climber).position;
    let above = self::climber(&mut app, (at + DVec3::Y * 3.0).as_vec3());
    // A capsule that stands in the air, as terrain of an app's own.
    let still = bevy_clamber::clamber_climber::Climber::new(
        ClimberConfig::walker(),
        DVec3::new(50.0, 5.0, 0.0),
    )
    .unwrap();
    let own = app
        .world_mut()
        .spawn(CustomObstacle::new(ClimberObstacle::new(&still, 0.1)))
        .id();
    let on_own = self::climber(&mut app, Vec3::new(50.0, 7.0, 0.0));
    app.init_resource::<Told>();
    app.add_observer(|landed: On<ClimberLanded>, mut told: ResMut<Told>| {
        told.0
            .push(format!("{:?} {:?}", landed.entity, landed.ground));
    });
    updates(&mut app, 64);
    let told = &app.world().resource::<Told>().0;
    assert!(
        told.contains(&format!("{on_own:?} {:?}", Some(own))),
        "{told:?}"
    );
    let (lower, upper) = (state(&app, climber).position, state(&app, above).position);
    assert!(
        lower.distance(upper) > 2.0 * RADIUS - 0.03,
        "{lower} {upper}"
    );
    assert!(
        app.world()
            .get::<CustomObstacle>(own)
            .unwrap()
            .get::<ClimberObstacle>()
            .is_some()
    );
    // Whom a filter ignores is passed through.
    let filter = ClimberFilter {
        ignored: [own].into_iter().collect(),
        ..ClimberFilter::default()
    };
    app.world_mut().entity_mut(on_own).insert(filter);
    updates(&mut app, 64);
    assert!(state(&app, on_own).position.y < 3.0);
}

#[test]
fn what_can_be_gripped_is_fur_or_what_a_rule_says() {
    let (mut app, floor, _) = standing(64.0);
    let grip = |app: &mut App| {
        let hanging = self::climber(app, Vec3::new(10.0, 1.0, 2.6));
        input(app, hanging).grip = true;
        let mut cursor = app
            .world()
            .resource::<Messages<ClimberGrabbed>>()
            .get_cursor();
        let mut grabbed = None;
        for _ in 0..6 {
            app.update();
            let all = app.world().resource::<Messages<ClimberGrabbed>>();
            grabbed = cursor
                .read(all)
                .last()
                .map(|grabbed| grabbed.hold)
                .or(grabbed);
        }
        app.world_mut().entity_mut(hanging).despawn();
        grabbed
    };
    assert_eq!(grip(&mut app), None);
    app.insert_resource(GripRule::new(move |grip| grip.entity == Some(floor.mesh)));
    assert_eq!(grip(&mut app), Some(Some(floor.mesh)));
    app.insert_resource(GripRule::new(|_| false));
    let tag = ColliderTag(SurfaceTag::new(SurfaceKind::Fur));
    app.world_mut().entity_mut(floor.mesh).insert(tag);
    app.update();
    wait(&mut app, floor.mesh);
    assert_eq!(grip(&mut app), None);
    app.world_mut().remove_resource::<GripRule>();
    assert_eq!(grip(&mut app), Some(Some(floor.mesh)));
}

#[test]
fn a_teleport_of_its_creature_that_nobody_told_of_hurts_no_rider() {
    for collider in [SkinnedCollider::default(), SkinnedCollider::each_tick()] {
        let mut app = climbing(64.0);
        let floor = floor(&mut app, collider);
        let climber = climber(&mut app, Vec3::new(10.0, 2.5, 0.0));
        updates(&mut app, 32);
        for far in [5.0, 500.0, -800.0] {
            app.world_mut()
                .get_mut::<Transform>(floor.root)
                .unwrap()
                .translation
                .x += far;
            for _ in 0..20 {
                app.update();
                let now = state(&app, climber);
                assert!(now.shake.length() < 1.0, "{far}: {}", now.shake);
                assert_eq!(
                    (now.mode, now.hit_points),
                    (ClimberMode::Standing, 1.0),
                    "{far}"
                );
            }
            let root = app
                .world()
                .get::<Transform>(floor.root)
                .unwrap()
                .translation
                .x;
            let on_it = state(&app, climber).position.x - f64::from(root);
            assert!((on_it - 10.0).abs() < 0.01, "{far}: {on_it}");
        }
    }
}

#[test]
fn many_climbers_on_many_threads_do_as_one_alone() {
    let run = |count: usize| {
        let mut app = climbing(64.0);
        app.add_systems(Update, carry);
        let floor = floor(&mut app, SkinnedCollider::default());
        app.world_mut().entity_mut(floor.root).insert(Moving);
        updates(&mut app, 3);
        app.world_mut()
            .get_mut::<Transform>(floor.root)
            .unwrap()
            .translation
            .x = 0.0;
        app.world_mut()
            .get_mut::<PosedSurface>(floor.mesh)
            .unwrap()
            .forget_motion();
        updates(&mut app, 3);
        let all: Vec<Entity> = (0..count)
            .map(|i| self::climber(&mut app, Vec3::new(3.0 + 2.0 * i as f32, 3.0, 0.0)))
            .collect();
        let mut seen = Vec::new();
        for _ in 0..64 {
            app.update();
            seen.push(state(&app, all[0]).position);
        }
        seen
    };
    let (few, many) = (run(1), run(8));
    // The first frames differ in number, while the collider is built; places relative to each other do not.
    for (few, many) in few.iter().zip(&many) {
        assert!((few.y - many.y).abs() < 1e-9, "{few} {many}");
    }
}

#[test]
fn components_are_reflected_field_by_field() {
    use bevy_ecs::reflect::AppTypeRegistry;
    use bevy_reflect::{PartialReflect, ReflectRef};
    let (app, _, climber) = standing(64.0);
    let registry = app.world().resource::<AppTypeRegistry>().read();
    for path in [
        Climber::type_path_of(),
        ClimberState::type_path_of(),
        ClimberInput::type_path_of(),
        ClimberFilter::type_path_of(),
        SurfaceAnchor::type_path_of(),
        ColliderStatus::type_path_of(),
        ColliderTag::type_path_of(),
        SkinnedCollider::type_path_of(),
    ] {
        let registered = registry.get_with_type_path(path);
        let registered = registered.unwrap_or_else(|| panic!("{path} is not registered"));
        assert!(
            !matches!(registered.type_info(), bevy_reflect::TypeInfo::Opaque(_)),
            "{path} is opaque"
        );
    }
    let state = app.world().get::<ClimberState>(climber).unwrap();
    let ReflectRef::TupleStruct(fields) = state.reflect_ref() else {
        panic!("{state:?}");
    };
    let inner = fields.field(0).unwrap();
    let ReflectRef::Struct(inner) = inner.reflect_ref() else {
        panic!("{inner:?}");
    };
    let stamina = inner.field("stamina").unwrap();
    assert_eq!(stamina.try_downcast_ref::<f64>(), Some(&1.0));
}

trait TypePathOf {
    fn type_path_of() -> &'static str;
}

impl<T: bevy_reflect::TypePath> TypePathOf for T {
    fn type_path_of() -> &'static str {
        T::type_path()
    }
}

#[test]
fn events_of_one_climber_come_in_the_order_in_which_they_happened() {
    let (mut app, _, climber) = standing(64.0);
    app.init_resource::<Told>();
    app.add_observer(|_: On<ClimberJumped>, mut told: ResMut<Told>| told.0.push("jumped".into()));
    app.add_observer(|changed: On<ClimberChangedMode>, mut told: ResMut<Told>| {
        told.0.push(format!("{:?}", changed.to));
    });
    app.add_observer(|_: On<ClimberLanded>, mut told: ResMut<Told>| told.0.push("landed".into()));
    input(&mut app, climber).jump = true;
    updates(&mut app, 100);
    assert_eq!(
        app.world().resource::<Told>().0,
        ["jumped", "Falling", "landed", "Standing"]
    );
}
