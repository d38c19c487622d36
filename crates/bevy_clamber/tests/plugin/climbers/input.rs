//! What a climber is asked for, and what it tells.

use super::*;

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
fn blows_that_are_out_of_range_are_refused_and_hurt_nobody() {
    let sane = ClimberBlow {
        velocity: Vec3::Y,
        damage: 0.2,
        by: None,
    };
    let blows = [
        ClimberBlow {
            damage: f32::NAN,
            ..sane
        },
        ClimberBlow {
            damage: f32::INFINITY,
            ..sane
        },
        ClimberBlow {
            damage: -0.2,
            ..sane
        },
        ClimberBlow {
            damage: 1.5,
            ..sane
        },
        ClimberBlow {
            velocity: Vec3::new(0.0, f32::NAN, 0.0),
            ..sane
        },
        ClimberBlow {
            velocity: Vec3::X * f32::INFINITY,
            ..sane
        },
    ];
    for wrong in blows {
        for blows in [&[wrong][..], &[wrong, sane], &[sane, wrong]] {
            let (mut app, _, climber) = standing(64.0);
            for blow in blows {
                input(&mut app, climber).strike(*blow);
            }
            updates(&mut app, 3);
            let after = state(&app, climber);
            assert_eq!(after.hit_points, 1.0, "{blows:?}");
            assert!(after.position.is_finite(), "{blows:?}");
        }
    }
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

#[test]
fn presses_and_blows_in_a_pause_are_forgotten_however_the_game_pauses() {
    #[derive(Resource)]
    struct Running;
    type Switch = fn(&mut App, bool);
    let pauses: [(&str, Switch); 3] = [
        ("Time<Virtual>::pause", |app, runs| {
            let mut time = app.world_mut().resource_mut::<Time<Virtual>>();
            if runs { time.unpause() } else { time.pause() }
        }),
        ("speed 0", |app, runs| {
            let mut time = app.world_mut().resource_mut::<Time<Virtual>>();
            time.set_relative_speed(f32::from(u8::from(runs)));
        }),
        ("a run condition", |app, runs| {
            if runs {
                app.insert_resource(Running);
            } else {
                app.world_mut().remove_resource::<Running>();
            }
        }),
    ];
    for (name, set_running) in pauses {
        for rate in [32.0, 64.0, 240.0] {
            let (mut app, _, climber) = standing(64.0);
            app.insert_resource(Running);
            app.configure_sets(
                FixedPostUpdate,
                ClamberSystems::Climb.run_if(resource_exists::<Running>),
            );
            app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(
                1.0 / rate,
            )));
            updates(&mut app, 8);
            set_running(&mut app, false);
            updates(&mut app, 8);
            let blow = ClimberBlow {
                velocity: Vec3::Y * 8.0,
                damage: 0.5,
                by: None,
            };
            input(&mut app, climber).jump = true;
            input(&mut app, climber).strike(blow);
            updates(&mut app, 8);
            set_running(&mut app, true);
            updates(&mut app, 20);
            let now = state(&app, climber);
            assert_eq!(now.mode, ClimberMode::Standing, "{name}, {rate}");
            assert_eq!(now.hit_points, 1.0, "{name}, {rate}");
            // What is pressed now counts.
            input(&mut app, climber).strike(blow);
            updates(&mut app, 8);
            assert!(state(&app, climber).hit_points < 1.0, "{name}, {rate}");
        }
    }
}

/// A game that removes its dead, and adds sounds and dust to who changes its mode.
#[test]
fn a_climber_that_an_observer_despawns_has_no_more_events() {
    let (mut app, _, climber) = standing(64.0);
    app.world_mut()
        .add_observer(|hurt: On<ClimberHurt>, mut commands: Commands| {
            if hurt.left == 0.0 {
                commands.entity(hurt.entity).despawn();
            }
        });
    app.world_mut()
        .add_observer(|changed: On<ClimberChangedMode>, mut commands: Commands| {
            commands.entity(changed.entity).insert(Moving);
        });
    input(&mut app, climber).strike(ClimberBlow {
        velocity: Vec3::Y * 8.0,
        damage: 1.0,
        by: None,
    });
    let mut cursor = app
        .world()
        .resource::<Messages<ClimberChangedMode>>()
        .get_cursor();
    updates(&mut app, 2);
    assert!(app.world().get_entity(climber).is_err());
    // Readers learn of the whole tick.
    let all = app.world().resource::<Messages<ClimberChangedMode>>();
    assert_eq!(cursor.read(all).count(), 1);
}

#[test]
fn points_of_events_are_in_the_space_of_bevy() {
    let (mut app, floor, _) = standing(64.0);
    let tag = ColliderTag(SurfaceTag::new(SurfaceKind::Fur));
    app.world_mut().entity_mut(floor.mesh).insert(tag);
    app.insert_resource(WorldOrigin(DVec3::new(1e6, 0.0, -3e6)));
    updates(&mut app, 2);
    wait(&mut app, floor.mesh);
    let hanging = climber(&mut app, Vec3::new(15.0, TOP as f32 + 0.5, 0.0));
    input(&mut app, hanging).grip = true;
    let mut cursor = app
        .world()
        .resource::<Messages<ClimberGrabbed>>()
        .get_cursor();
    let mut points = Vec::new();
    for _ in 0..30 {
        app.update();
        let all = app.world().resource::<Messages<ClimberGrabbed>>();
        points.extend(cursor.read(all).map(|grabbed| grabbed.point));
    }
    let drawn = app.world().get::<Transform>(hanging).unwrap().translation;
    assert!(!points.is_empty());
    for point in points {
        assert!(point.distance(drawn) < 1.5, "{point} {drawn}");
    }
}
