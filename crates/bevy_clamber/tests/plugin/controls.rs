//! Keyboard, mouse and gamepads steer a climber, in the directions of its camera.

use bevy_app::App;
use bevy_clamber::ControlDevice;
use bevy_clamber::prelude::*;
use bevy_ecs::message::Messages;
use bevy_ecs::prelude::*;
use bevy_input::InputPlugin;
use bevy_input::gamepad::{
    Gamepad, GamepadAxis, GamepadButton, GamepadConnection, GamepadConnectionEvent,
    RawGamepadAxisChangedEvent, RawGamepadButtonChangedEvent, RawGamepadEvent,
};
use bevy_input::keyboard::KeyCode;
use bevy_input::mouse::MouseMotion;
use bevy_input::prelude::ButtonInput;
use bevy_math::{Quat, Vec2, Vec3};
use bevy_transform::components::Transform;

use super::common::app_with;

fn app() -> (App, Entity, Entity) {
    let plugins = (
        InputPlugin,
        ClamberPlugins::default(),
        ClimberPlugin::default(),
        ClimberControlsPlugin,
    );
    let mut app = app_with(60.0, plugins);
    let climber = (Climber::default(), ClimberControls::default());
    let climber = app.world_mut().spawn(climber).id();
    // Without its plugin, the camera stays where it is: it looks along +X, and down.
    let look = Transform::IDENTITY.looking_to(Vec3::new(1.0, -0.5, 0.0), Vec3::Y);
    let camera = app
        .world_mut()
        .spawn((ClimberCamera::new(climber), look))
        .id();
    app.update();
    (app, climber, camera)
}

fn keys(app: &mut App) -> Mut<'_, ButtonInput<KeyCode>> {
    app.world_mut().resource_mut::<ButtonInput<KeyCode>>()
}

fn input(app: &App, climber: Entity) -> ClimberInput {
    *app.world().get::<ClimberInput>(climber).unwrap()
}

#[test]
fn keys_walk_where_the_camera_looks() {
    let (mut app, climber, camera) = app();
    for (key, expected) in [
        (KeyCode::KeyW, Vec3::X),
        (KeyCode::ArrowDown, Vec3::NEG_X),
        (KeyCode::KeyD, Vec3::Z),
        (KeyCode::KeyA, Vec3::NEG_Z),
    ] {
        keys(&mut app).press(key);
        app.update();
        let walk = input(&app, climber).walk;
        assert!(walk.distance(expected) < 1e-5, "{key:?}: {walk}");
        keys(&mut app).release(key);
    }
    keys(&mut app).press(KeyCode::KeyW);
    keys(&mut app).press(KeyCode::KeyD);
    keys(&mut app).press(KeyCode::ShiftLeft);
    app.update();
    let both = input(&app, climber);
    assert!(
        (both.walk.length() - 1.0).abs() < 1e-5 && both.grip,
        "{both:?}"
    );
    // Straight down, its top is ahead.
    let down = Transform::from_rotation(Quat::from_rotation_arc(Vec3::NEG_Z, Vec3::NEG_Y));
    app.world_mut().entity_mut(camera).insert(down);
    keys(&mut app).release(KeyCode::KeyD);
    app.update();
    let walk = input(&app, climber).walk;
    assert!(walk.distance(Vec3::NEG_Z) < 1e-4, "{walk}");
}

#[test]
fn a_mouse_turns_the_camera() {
    let (mut app, _, camera) = app();
    let motion = MouseMotion {
        delta: Vec2::new(100.0, 50.0),
    };
    app.world_mut()
        .resource_mut::<Messages<MouseMotion>>()
        .write(motion);
    app.update();
    let turned = *app.world().get::<ClimberCameraInput>(camera).unwrap();
    assert!(
        turned.swing.distance(Vec2::new(0.3, -0.15)) < 1e-5,
        "{turned:?}"
    );
}

#[test]
fn a_gamepad_walks_looks_jumps_and_grips() {
    let (mut app, climber, camera) = app();
    let gamepad = app.world_mut().spawn_empty().id();
    let connection = GamepadConnection::Connected {
        name: "pad".into(),
        vendor_id: None,
        product_id: None,
    };
    let send = |app: &mut App, event: RawGamepadEvent| {
        app.world_mut()
            .resource_mut::<Messages<RawGamepadEvent>>()
            .write(event);
    };
    let axis = |axis, value| {
        RawGamepadEvent::Axis(RawGamepadAxisChangedEvent {
            gamepad,
            axis,
            value,
        })
    };
    let button = |button, value| {
        RawGamepadEvent::Button(RawGamepadButtonChangedEvent {
            gamepad,
            button,
            value,
        })
    };
    let connected = GamepadConnectionEvent {
        gamepad,
        connection,
    };
    app.world_mut().write_message(connected);
    app.update();
    send(&mut app, axis(GamepadAxis::LeftStickY, 0.5));
    send(&mut app, axis(GamepadAxis::RightStickX, -1.0));
    send(&mut app, button(GamepadButton::RightTrigger, 1.0));
    app.update();
    let told = input(&app, climber);
    assert!(
        told.walk.y.abs() < 1e-6 && told.walk.x > 0.3 && told.walk.x < 0.5,
        "{told:?}"
    );
    assert!(told.grip);
    assert_eq!(
        app.world()
            .get::<ClimberCameraInput>(camera)
            .unwrap()
            .stick
            .x,
        -1.0
    );
    // The dead zone.
    send(&mut app, axis(GamepadAxis::LeftStickY, 0.1));
    send(&mut app, button(GamepadButton::RightTrigger, 0.0));
    app.update();
    assert_eq!(input(&app, climber).walk, Vec3::ZERO);
    assert!(!input(&app, climber).grip);
}

#[test]
fn without_its_controls_a_climber_has_no_input() {
    let (mut app, climber, camera) = app();
    keys(&mut app).press(KeyCode::KeyW);
    keys(&mut app).press(KeyCode::ShiftLeft);
    app.update();
    assert_ne!(input(&app, climber).walk, Vec3::ZERO);
    app.world_mut()
        .get_mut::<ClimberCameraInput>(camera)
        .unwrap()
        .stick = Vec2::X;
    app.world_mut()
        .entity_mut(climber)
        .remove::<ClimberControls>();
    app.update();
    assert_eq!(input(&app, climber), ClimberInput::default());
    let turn = app.world().get::<ClimberCameraInput>(camera).unwrap();
    assert_eq!(*turn, ClimberCameraInput::default());
}

/// Two players, each with a device of its own, on keys of their own.
#[test]
fn each_player_has_a_device_and_bindings_of_its_own() {
    let (mut app, first, _) = app();
    let world = app.world_mut();
    let pads = [(); 2].map(|()| world.spawn(Gamepad::default()).id());
    let device = |device| ClimberControls {
        device,
        ..ClimberControls::default()
    };
    world
        .entity_mut(first)
        .insert(device(ControlDevice::Keyboard));
    let mut controls = device(ControlDevice::Gamepad(pads[1]));
    controls.bindings.jump = vec![GamepadButton::North.into(), KeyCode::KeyX.into()];
    // One bit with two bindings, of which the second one is not pressed.
    controls.bindings.actions = [GamepadButton::South, GamepadButton::East]
        .map(|button| (1 << 20, vec![button.into()]))
        .into();
    let second = world.spawn((Climber::default(), controls)).id();
    let gone = world.spawn_empty().id();
    world.despawn(gone);
    let third = device(ControlDevice::Gamepad(gone));
    let third = world.spawn((Climber::default(), third)).id();
    for key in [KeyCode::KeyW, KeyCode::KeyX, KeyCode::ShiftLeft] {
        keys(&mut app).press(key);
    }
    let press = |app: &mut App, pad: Entity, button| {
        let mut pad = app.world_mut().get_mut::<Gamepad>(pad).unwrap();
        pad.digital_mut().press(button);
    };
    press(&mut app, pads[0], GamepadButton::DPadLeft);
    press(&mut app, pads[1], GamepadButton::North);
    press(&mut app, pads[1], GamepadButton::South);
    press(&mut app, pads[1], GamepadButton::DPadRight);
    app.update();
    let [first, second, third] = [first, second, third].map(|climber| input(&app, climber));
    assert!(first.walk.distance(Vec3::X) < 1e-5 && first.grip && !first.jump_held);
    assert!(second.walk.distance(Vec3::X) < 1e-5, "{second:?}");
    assert!(second.jump_held && !second.grip && second.actions == 1 << 20);
    assert_eq!((third.walk, third.jump_held), (Vec3::ZERO, false));
}

#[test]
fn up_is_down_for_who_likes_it_so() {
    let (mut app, climber, camera) = app();
    let mut controls = app.world_mut().get_mut::<ClimberControls>(climber).unwrap();
    controls.is_inverted = true;
    let motion = MouseMotion {
        delta: Vec2::new(100.0, 50.0),
    };
    app.world_mut().write_message(motion);
    app.update();
    let turned = *app.world().get::<ClimberCameraInput>(camera).unwrap();
    let expected = Vec2::new(0.3, 0.15);
    assert!(turned.swing.distance(expected) < 1e-5, "{turned:?}");
}
