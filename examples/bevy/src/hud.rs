//! What is written over the picture: the keys, a message, a ring of stamina, a bar of hit points.

use core::f32::consts::TAU;

use bevy::prelude::*;
use bevy::text::FontSize;
use bevy_clamber::prelude::*;

use crate::hero::Hero;

const KEYS: &str = "WASD: walk, climb   Shift: grip   Space: jump   Mouse: look, shoot   R: again   P: pause   F3: overlay";

/// Colours of a rested and of a tired hero, and of what is used up.
const RESTED: Color = Color::srgb(0.45, 0.85, 0.35);
const TIRED: Color = Color::srgb(0.92, 0.30, 0.15);
const USED: Color = Color::srgba(0.0, 0.0, 0.0, 0.35);

/// Diameter of the ring, hundredths of the picture's height.
const RING: f32 = 12.0;

/// The message in the middle.
#[derive(Resource, Debug, Default)]
pub struct Message {
    text: String,
    /// Seconds for which it is still shown.
    left: f32,
}

impl Message {
    /// Shows a text for some seconds of the game.
    pub fn say(&mut self, text: impl Into<String>, seconds: f32) {
        self.text = text.into();
        self.left = seconds;
    }
}

#[derive(Component)]
struct Middle;

#[derive(Component)]
struct Stamina;

#[derive(Component)]
struct HitPoints;

pub fn plugin(app: &mut App) {
    app.init_resource::<Message>()
        .add_systems(Startup, spawn)
        .add_systems(Update, (show_message, show_state));
}

fn spawn(mut commands: Commands) {
    let at = |node: Node| Node {
        position_type: PositionType::Absolute,
        ..node
    };
    let font = |size: f32| TextFont::from_font_size(FontSize::Vh(size));
    commands.spawn((
        Text::new(KEYS),
        font(2.2),
        TextShadow::default(),
        at(Node {
            top: px(10),
            left: px(14),
            ..default()
        }),
    ));
    commands
        .spawn(at(Node {
            top: percent(24),
            width: percent(100),
            justify_content: JustifyContent::Center,
            ..default()
        }))
        .with_child((Text::default(), font(4.8), TextShadow::default(), Middle));
    // A cross in the middle, for arrows.
    commands
        .spawn(at(Node {
            width: percent(100),
            height: percent(100),
            justify_content: JustifyContent::Center,
            align_items: AlignItems::Center,
            ..default()
        }))
        .with_child((
            Node {
                width: px(5),
                height: px(5),
                ..default()
            },
            BackgroundColor(Color::srgba(1.0, 1.0, 1.0, 0.6)),
        ));
    commands.spawn((
        at(Node {
            bottom: vh(5),
            right: vh(4),
            width: vh(RING),
            height: vh(RING),
            border: UiRect::all(vh(1.8)),
            border_radius: BorderRadius::MAX,
            ..default()
        }),
        BorderGradient::default(),
        Stamina,
    ));
    commands.spawn((
        at(Node {
            bottom: vh(2.5),
            right: vh(4),
            width: vh(RING),
            height: vh(1),
            ..default()
        }),
        BackgroundColor(TIRED),
        HitPoints,
    ));
}

fn show_message(
    time: Res<Time>,
    mut message: ResMut<Message>,
    mut text: Single<&mut Text, With<Middle>>,
) {
    message.left -= time.delta_secs();
    let shown = if message.left > 0.0 {
        message.text.as_str()
    } else {
        ""
    };
    if text.0 != shown {
        text.0 = shown.to_owned();
    }
}

fn show_state(
    heroes: Query<&ClimberState, With<Hero>>,
    mut ring: Single<&mut BorderGradient, With<Stamina>>,
    mut bar: Single<&mut Node, With<HitPoints>>,
) {
    let Some(state) = heroes.iter().next() else {
        return;
    };
    let share = state.stamina as f32;
    let color = TIRED.mix(&RESTED, share);
    let angle = share * TAU;
    let stops = [(color, 0.0), (color, angle), (USED, angle), (USED, TAU)];
    let stops = stops.map(|(color, angle)| AngularColorStop::new(color, angle));
    ring.0 = vec![Gradient::Conic(ConicGradient::new(
        UiPosition::CENTER,
        stops.to_vec(),
    ))];
    bar.width = vh(RING * state.hit_points as f32);
}
