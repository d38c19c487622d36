//! What an app changes: places, states, configurations, entities.

use super::*;

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

/// A game that lets its hero begin anew.
#[test]
fn a_transform_elsewhere_beside_other_hit_points_is_a_teleport() {
    let (mut app, _, climber) = standing(64.0);
    let there = Vec3::new(4.0, 3.0, 0.5);
    let world = app.world_mut();
    world.get_mut::<Transform>(climber).unwrap().translation = there;
    world.get_mut::<ClimberState>(climber).unwrap().0.hit_points = 0.5;
    updates(&mut app, 2);
    let drawn = app.world().get::<Transform>(climber).unwrap().translation;
    assert!(drawn.distance(there) < 0.02, "{drawn}");
    updates(&mut app, 30);
    let now = state(&app, climber);
    assert_eq!((now.mode, now.hit_points), (ClimberMode::Standing, 0.5));
}

/// A quick load, a plugin that saves worlds and one that rolls them back write all components.
#[test]
fn a_transform_that_is_written_beside_a_state_is_no_teleport() {
    for in_flight in [true, false] {
        let (mut app, _, climber) = standing(64.0);
        input(&mut app, climber).walk = Vec3::X * f32::from(u8::from(in_flight));
        input(&mut app, climber).jump = in_flight;
        updates(&mut app, 12);
        assert_eq!(stands(&app, climber), !in_flight);
        let saved = (
            state(&app, climber),
            *app.world().get::<Transform>(climber).unwrap(),
        );
        let mut first = Vec::new();
        for _ in 0..60 {
            app.update();
            first.push(state(&app, climber));
        }
        let mut loaded = saved;
        // Where it stands, the state is the same as before. It is drawn elsewhere nevertheless.
        loaded.1.translation.y += 0.01;
        app.world_mut().entity_mut(climber).insert(loaded);
        for (tick, expected) in first.iter().enumerate() {
            app.update();
            assert_eq!(state(&app, climber), *expected, "{in_flight}, {tick}");
        }
        let drawn = app.world().get::<Transform>(climber).unwrap().translation;
        let apart = drawn.as_dvec3().distance(first.last().unwrap().position);
        assert!(apart < 0.1, "{apart}");
    }
}
