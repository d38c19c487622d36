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
