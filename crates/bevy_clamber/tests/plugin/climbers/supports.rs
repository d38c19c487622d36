//! What a climber stands on and grips.

use super::*;

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
    let mut all = lost(&app);
    wait_with(&mut app, floor.mesh, |app| all += lost(app));
    app.update();
    assert_eq!(all + lost(&app), 1);
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
        .spawn(CustomObstacle::new(ClimberObstacle::new(&still, &[], 0.1)))
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
    app.insert_resource(DefaultClimberRule(ClimberRule::new(move |at| {
        at.usual().with_grip(at.entity == Some(floor.mesh))
    })));
    assert_eq!(grip(&mut app), Some(Some(floor.mesh)));
    app.insert_resource(DefaultClimberRule(ClimberRule::new(|at| {
        at.usual().with_grip(false)
    })));
    let tag = ColliderTag(SurfaceTag::new(SurfaceKind::Fur));
    app.world_mut().entity_mut(floor.mesh).insert(tag);
    app.update();
    wait(&mut app, floor.mesh);
    assert_eq!(grip(&mut app), None);
    app.world_mut().remove_resource::<DefaultClimberRule>();
    assert_eq!(grip(&mut app), Some(Some(floor.mesh)));
}

/// By entities, as a resource for all, and as a component for one.
#[test]
fn a_door_lets_its_owner_pass_and_nobody_else() {
    let walks_to = |app: &mut App, climber: Entity| {
        input(app, climber).walk = Vec3::X;
        updates(app, 64);
        state(app, climber).position.x
    };
    for as_component in [false, true] {
        let (mut app, _, owner) = standing(64.0);
        let guest = self::climber(&mut app, Vec3::new(10.0, 2.5, 1.0));
        updates(&mut app, 32);
        let wall =
            bevy_clamber::clamber_world::HalfSpace::behind(DVec3::X * 12.0, DVec3::NEG_X).unwrap();
        let door = app.world_mut().spawn(CustomObstacle::new(wall)).id();
        let rule = ClimberRule::new(move |at| {
            if at.entity == Some(door) && at.climber == owner {
                ContactRule::PASS
            } else {
                at.usual()
            }
        });
        if as_component {
            app.world_mut().entity_mut(owner).insert(rule);
        } else {
            app.insert_resource(DefaultClimberRule(rule));
        }
        let passed = walks_to(&mut app, owner);
        assert!(passed > 12.5, "{as_component}: {passed}");
        let stopped = walks_to(&mut app, guest);
        assert!(
            (stopped - 12.0 + RADIUS).abs() < 0.02,
            "{as_component}: {stopped}"
        );
    }
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

/// On Bevy 0.20, a type that is a component and a resource is one for all as soon as one entity has it.
#[test]
fn a_rule_of_one_climber_is_no_rule_for_others() {
    let (mut app, floor, wizard) = standing(64.0);
    let tag = ColliderTag(SurfaceTag::new(SurfaceKind::Stone));
    app.world_mut().entity_mut(floor.mesh).insert(tag);
    updates(&mut app, 2);
    wait(&mut app, floor.mesh);
    let grips = || ClimberRule::new(|at| at.usual().with_grip(true));
    let plain = climber(&mut app, Vec3::new(5.0, 2.5, 0.0));
    let other = climber(&mut app, Vec3::new(15.0, 2.5, 0.0));
    app.world_mut().entity_mut(wizard).insert(grips());
    app.world_mut().entity_mut(other).insert(grips());
    for climber in [wizard, plain, other] {
        input(&mut app, climber).grip = true;
    }
    updates(&mut app, 30);
    let modes = [wizard, plain, other].map(|climber| state(&app, climber).mode);
    let [holds, stands] = [ClimberMode::Holding, ClimberMode::Standing];
    assert_eq!(modes, [holds, stands, holds]);
    // The rule for all others does not replace their own.
    app.insert_resource(DefaultClimberRule(ClimberRule::new(|at| {
        at.usual().with_grip(false)
    })));
    updates(&mut app, 30);
    assert_eq!(state(&app, wizard).mode, holds);
    app.world_mut().despawn(wizard);
    updates(&mut app, 2);
    assert_eq!(state(&app, other).mode, holds);
}
