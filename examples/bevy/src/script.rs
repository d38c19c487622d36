//! Plays the hero from a file, and writes such files.
//!
//! Each line is a JSON object, or empty, or a remark after `#`. It holds from its time on, until another line says
//! otherwise:
//!
//! | field | meaning |
//! |---|---|
//! | `at` | seconds since the game began |
//! | `walk` | direction to walk and climb in, in the world, \[x, y, z\]; length 1 is full speed |
//! | `climb` | direction to climb in, in the world, in place of `walk` on holds |
//! | `grip` | true: holds on |
//! | `look` | how the camera is turned, \[right, up\], -1 to 1 |
//! | `jump` | true: jumps once |
//! | `swing` | turns the camera once, \[right, up\], radians |
//! | `shoot` | an arrow flies to this point of the picture, \[right, down\], 0 to 1 |
//! | `end` | true: the script ends; otherwise it does so with its last line |

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use bevy::camera::{Camera, NormalizedRenderTarget, RenderTarget};
use bevy::ecs::system::SystemParam;
use bevy::picking::pointer::{Location, PointerAction, PointerButton, PointerId, PointerInput};
use bevy::prelude::*;
use bevy::window::PrimaryWindow;
use bevy_clamber::prelude::*;
use serde::{Deserialize, Serialize};

use crate::creature::Creature;
use crate::hero::Hero;

/// A line of a script.
#[derive(Deserialize, Serialize, Clone, Debug, Default, PartialEq)]
#[serde(deny_unknown_fields)]
struct Line {
    at: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    walk: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    climb: Option<[f32; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    grip: Option<bool>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    look: Option<[f32; 2]>,
    #[serde(default, skip_serializing_if = "is_false")]
    jump: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    swing: Option<[f32; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    shoot: Option<[f32; 2]>,
    #[serde(default, skip_serializing_if = "is_false")]
    end: bool,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// What a player does, by time.
#[derive(Resource, Clone, Debug)]
pub struct Script {
    lines: Vec<Line>,
    /// Number of lines that have been played.
    played: usize,
    /// Seconds of the last frame.
    now: f64,
    /// It shot an arrow in that frame.
    shot: bool,
}

impl Script {
    /// Reads a script.
    pub fn read(file: &Path) -> Result<Self, String> {
        let called = file.display();
        let text = std::fs::read_to_string(file).map_err(|error| format!("{called}: {error}"))?;
        let mut lines = Vec::<Line>::new();
        for (number, text) in text.lines().enumerate() {
            let said = text.trim();
            if said.is_empty() || said.starts_with('#') {
                continue;
            }
            let line: Line = serde_json::from_str(said)
                .map_err(|error| format!("{called}, line {}: {error}", number + 1))?;
            let before = lines.last().map_or(0.0, |line| line.at);
            if !(line.at >= before && line.at.is_finite()) {
                let number = number + 1;
                return Err(format!(
                    "{called}, line {number}: it is at {} s, but must not be before {before} s",
                    line.at
                ));
            }
            lines.push(line);
        }
        if lines.is_empty() {
            return Err(format!("{called} is an empty script"));
        }
        Ok(Self {
            lines,
            played: 0,
            now: 0.0,
            shot: false,
        })
    }

    /// True if an arrow flies within two frames: pointers hit only what a camera has drawn.
    pub fn shoots_soon(&self) -> bool {
        let next = self.lines.iter().skip(self.played);
        let mut soon = next.take_while(|line| line.at <= self.now + 2.5 / 64.0);
        self.shot || soon.any(|line| line.shoot.is_some())
    }

    /// True if all of it has been played.
    pub fn has_ended(&self) -> bool {
        self.played == self.lines.len()
    }
}

/// Seconds since the game began.
#[derive(Resource, Debug, Default)]
struct Clock(f64);

fn pass(time: Res<Time<Virtual>>, mut clock: ResMut<Clock>) {
    clock.0 += time.delta_secs_f64();
}

/// Plays a script.
pub fn plays(script: Script) -> impl Plugin {
    move |app: &mut App| {
        app.insert_resource(script.clone())
            .init_resource::<Clock>()
            // Before pointers are moved and pressed.
            .add_systems(
                First,
                (play, pass).chain().run_if(resource_exists::<Creature>),
            );
    }
}

type Steered = (With<Hero>, With<ClimberControls>);

fn play(
    clock: Res<Clock>,
    mut script: ResMut<Script>,
    mut heroes: Query<&mut ClimberInput, Steered>,
    mut cameras: Query<&mut ClimberCameraInput>,
    mut bow: Bow,
) {
    let Some(mut input) = heroes.iter_mut().next() else {
        return;
    };
    let Some(mut turn) = cameras.iter_mut().next() else {
        return;
    };
    (script.now, script.shot) = (clock.0, false);
    while let Some(line) = script.lines.get(script.played)
        && line.at <= clock.0
    {
        let now = line.clone();
        script.played += 1;
        if let Some(walk) = now.walk {
            input.walk = walk.into();
        }
        if let Some(climb) = now.climb {
            input.climb = climb.into();
        }
        if let Some(grip) = now.grip {
            input.grip = grip;
        }
        if let Some(look) = now.look {
            turn.stick = look.into();
        }
        if let Some(swing) = now.swing {
            turn.swing += Vec2::from(swing);
        }
        if let Some(point) = now.shoot {
            bow.shoot(point.into());
            script.shot = true;
        }
        input.jump |= now.jump;
        if now.end {
            script.played = script.lines.len();
        }
    }
}

/// Presses where an arrow should fly.
#[derive(SystemParam)]
struct Bow<'w, 's> {
    camera: Query<'w, 's, (&'static Camera, &'static RenderTarget)>,
    windows: Query<'w, 's, Entity, With<PrimaryWindow>>,
    pointer: MessageWriter<'w, PointerInput>,
}

impl Bow<'_, '_> {
    /// Presses at a point of the picture, 0 to 1 from its left and its top.
    fn shoot(&mut self, point: Vec2) {
        let Some((camera, target)) = self.camera.iter().next() else {
            return;
        };
        let target = target.normalize(self.windows.iter().next());
        let (Some(target), Some(size)) = (target, camera.logical_viewport_size()) else {
            return;
        };
        let position = point * size;
        for action in [
            PointerAction::Move { delta: Vec2::ZERO },
            PointerAction::Press(PointerButton::Primary),
            PointerAction::Release(PointerButton::Primary),
        ] {
            let location = Location {
                target: NormalizedRenderTarget::clone(&target),
                position,
            };
            self.pointer
                .write(PointerInput::new(PointerId::Mouse, location, action));
        }
    }
}

/// The file that is written, and its last line.
#[derive(Resource)]
struct Recorder {
    file: BufWriter<File>,
    last: Line,
    called: PathBuf,
}

/// Writes what the player does to a file.
pub fn records(path: PathBuf) -> Result<impl Plugin, String> {
    let file = File::create(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let file = std::sync::Mutex::new(Some(file));
    Ok(move |app: &mut App| {
        let taken = file.lock().ok().and_then(|mut file| file.take());
        let Some(file) = taken else {
            return;
        };
        app.insert_resource(Recorder {
            file: BufWriter::new(file),
            last: Line::default(),
            called: path.clone(),
        })
        .init_resource::<Clock>()
        // After the controls have filled the input, before a tick takes its presses.
        .add_systems(
            RunFixedMainLoop,
            (record, pass)
                .chain()
                .before(RunFixedMainLoopSystems::BeforeFixedMainLoop)
                .run_if(resource_exists::<Creature>),
        );
    })
}

fn record(
    clock: Res<Clock>,
    heroes: Query<&ClimberInput, Steered>,
    cameras: Query<&ClimberCameraInput>,
    buttons: Res<ButtonInput<MouseButton>>,
    mut recorder: ResMut<Recorder>,
    mut exits: MessageReader<AppExit>,
) {
    let (Some(input), Some(turn)) = (heroes.iter().next(), cameras.iter().next()) else {
        return;
    };
    let now = Line {
        at: clock.0,
        walk: Some(input.walk.into()),
        climb: None,
        grip: Some(input.grip),
        look: Some(turn.stick.into()),
        jump: input.jump,
        swing: (turn.swing != Vec2::ZERO).then_some(turn.swing.into()),
        shoot: buttons
            .just_pressed(MouseButton::Left)
            .then_some([0.5, 0.5]),
        end: exits.read().next().is_some(),
    };
    let last = &recorder.last;
    let is_same = (now.walk, now.grip, now.look) == (last.walk, last.grip, last.look);
    let is_quiet = !now.jump && !now.end && now.swing.is_none() && now.shoot.is_none();
    if is_same && is_quiet {
        return;
    }
    let written = serde_json::to_string(&now).map_err(|error| error.to_string());
    let written = written.and_then(|line| {
        let file = &mut recorder.file;
        writeln!(file, "{line}")
            .and_then(|()| file.flush())
            .map_err(|error| error.to_string())
    });
    if let Err(error) = written {
        error!("{}: {error}", recorder.called.display());
    }
    recorder.last = now;
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(name: &str, text: &str) -> Result<Script, String> {
        let file = std::env::temp_dir().join(format!("clamber-{name}-{}", std::process::id()));
        std::fs::write(&file, text).map_err(|error| error.to_string())?;
        let read = Script::read(&file);
        std::fs::remove_file(&file).map_err(|error| error.to_string())?;
        read
    }

    #[test]
    fn a_script_is_read_line_by_line() -> Result<(), String> {
        let text =
            "# a remark\n\n{\"at\": 0, \"walk\": [0, 0, 1]}\n{\"at\": 1.5, \"jump\": true}\n";
        let script = read("good", text)?;
        assert_eq!(script.lines.len(), 2);
        assert_eq!(script.lines[0].walk, Some([0.0, 0.0, 1.0]));
        assert!(script.lines[1].jump && !script.has_ended());
        Ok(())
    }

    #[test]
    fn what_is_recorded_can_be_read() -> Result<(), String> {
        let line = Line {
            at: 2.25,
            walk: Some([0.1, 0.0, -0.7]),
            grip: Some(true),
            look: Some([0.5, -1.0]),
            jump: true,
            swing: Some([0.01, 0.02]),
            shoot: Some([0.5, 0.5]),
            ..Line::default()
        };
        let text = serde_json::to_string(&line).map_err(|error| error.to_string())?;
        assert_eq!(read("recorded", &text)?.lines, [line]);
        Ok(())
    }

    #[test]
    fn a_bad_script_is_refused_with_its_line() {
        for (text, says) in [
            ("", "empty"),
            (
                "{\"at\": 0}\n{\"at\": 1, \"wlak\": [0, 0, 1]}",
                "line 2: unknown field `wlak`",
            ),
            ("{\"at\": 2}\n{\"at\": 1}", "line 2: it is at 1 s"),
            ("{\"at\": -1}", "line 1: it is at -1 s"),
            ("{\"at\": 0, \"walk\": [0, 1]}", "line 1: invalid length 2"),
            ("walk", "line 1: "),
        ] {
            let said = read("bad", text).err().unwrap_or_default();
            assert!(said.contains(says), "{text}: {said}");
        }
    }
}
