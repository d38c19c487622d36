//! Plays every scenario in every setting: plain, on own obstacles, in moving frames, at other scales.
//!
//! | setting | obstacles | requirement |
//! |---|---|---|
//! | plain | root, joint, body | the scenario's own limits; the same result on each |
//! | at rest | own | the scenario's own limits; the same result as on a root |
//! | each of three frames | own, root, and body in the slow one | the limits; [`Allowed`] from the result at rest |
//! | each of four scales | own, and root or joint | the limits; on own, within 1 mm of the result in metres |
//!
//! Some combinations are left out. In frames, a joint is redundant, since its root moves as in the case of the root. In
//! the fast frames, the f32 positions of bodies are off by centimetres after a minute. At scales, bodies would test
//! rapier's own margins and tolerances, which are in metres, and not the climber. At scales, root and joint alternate.

use std::panic::resume_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;

use crate::scenarios::open;
use crate::stage::{Allowed, Played, Setting, Trace, assert_alike, play};

/// Obstacles of triangles in f64 only.
const OWN: &[Played] = &[Played::Own];

/// Surfaces whose root moves only.
const ROOT: &[Played] = &[Played::Root];

/// Surfaces whose joint moves only.
const JOINT: &[Played] = &[Played::Joint];

/// Rapier's bodies only.
const BODY: &[Played] = &[Played::Body];

/// Velocities of the frames, metres a second, along different axes. The slow one is first.
const FRAMES: [DVec3; 3] = [
    DVec3::new(30.0, 0.0, 0.0),
    DVec3::new(0.0, -30.0, 0.0),
    DVec3::new(0.0, 0.0, 300.0),
];

/// Scales of the world, relative to metres.
const SCALES: [f64; 4] = [0.02, 0.1, 10.0, 100.0];

/// Allowed difference between own triangles and a root: the effect on a tour of f32 corners, and of sweeps that stop
/// 0.1 mm early.
const ON_SKIN: Allowed = Allowed {
    position: 3e-4,
    velocity: f64::INFINITY,
};

/// Allowed difference between own triangles at a scale and in metres, in the scenario's units.
const SCALED: Allowed = Allowed {
    position: 1e-3,
    velocity: f64::INFINITY,
};

/// Scenarios whose runs are not compared between settings on some obstacles, with the reason. Their own limits still
/// apply.
const NOT_COMPARED: &[(&str, &[Played], &str)] = &[
    (
        "not_finite_answers_of_an_obstacle_do_not_spread",
        &[Played::Root, Played::Joint, Played::Body, Played::Own],
        "a velocity that is not finite counts as zero, whatever the frame",
    ),
    (
        "no_velocity_enters_any_of_seventeen_planes",
        &[Played::Root, Played::Joint, Played::Body, Played::Own],
        "all planes touch the ball, so rounding decides which one it stands on",
    ),
    (
        "a_held_stick_crosses_a_belly_as_a_direction_does",
        &[Played::Root],
        "velocities on bumps multiply the rounding of f32",
    ),
    (
        "a_notch_stops_a_climber_that_left_a_train",
        &[Played::Root],
        "a narrow notch multiplies the rounding of f32 by up to 16",
    ),
    (
        "ground_moves_on_below_a_climber_held_back_by_a_wall",
        &[Played::Body],
        "the ground's end passes after 1.5 km, where f32 rounds it by 0.1 mm, and the ball rolls off that end",
    ),
];

/// The runs of a setting, or the reason why the scenario failed.
type Outcome = Result<Vec<Trace>, String>;

/// All settings; those at rest come first.
fn settings() -> Vec<Setting> {
    let mut all = vec![Setting::PLAIN];
    all.extend([OWN, ROOT, BODY].map(Setting::on));
    for frame in FRAMES {
        let kinds = if frame == FRAMES[0] {
            vec![OWN, ROOT, BODY]
        } else {
            vec![OWN, ROOT]
        };
        all.extend(kinds.into_iter().map(|kinds| Setting {
            frame,
            ..Setting::on(kinds)
        }));
    }
    for (index, scale) in SCALES.into_iter().enumerate() {
        let skin = [ROOT, JOINT][index % 2];
        all.extend([OWN, skin].map(|kinds| Setting {
            scale,
            ..Setting::on(kinds)
        }));
    }
    all
}

/// Plays a scenario in every setting. Open settings have to fail, so that an entry whose setting passes does not stay
/// open.
pub(crate) fn in_every_setting(name: &'static str, scenario: fn()) {
    let settings = settings();
    let outcomes = outcomes(name, &settings, scenario);
    let at_rest = |kinds: &[Played]| {
        let place = settings.iter().position(|s| {
            *s == Setting::on(match kinds {
                [Played::Own] => OWN,
                [Played::Body] => BODY,
                _ => ROOT,
            })
        });
        place.and_then(|place| outcomes[place].as_ref().ok())
    };
    let mut ended = Vec::new();
    for (setting, outcome) in settings.iter().zip(&outcomes) {
        let held = outcome.as_ref().map_err(Clone::clone).and_then(|runs| {
            let is_known = |kinds: &[Played]| setting.kinds.iter().all(|kind| kinds.contains(kind));
            let mut excused = NOT_COMPARED.iter();
            if excused.any(|(test, kinds, _)| *test == name && is_known(kinds)) {
                Ok(())
            } else if setting.frame != DVec3::ZERO {
                let rest = at_rest(setting.kinds).ok_or("fails at rest")?;
                assert_alike(rest, runs, Allowed::in_frame)
            } else if setting.kinds == OWN && setting.scale == 1.0 {
                let rest = at_rest(ROOT).ok_or("fails on a root")?;
                assert_alike(rest, runs, |_| ON_SKIN)
            } else if setting.kinds == OWN {
                let rest = at_rest(OWN).ok_or("fails at rest")?;
                assert_alike(rest, runs, |_| SCALED)
            } else {
                Ok(())
            }
        });
        ended.push((setting.to_string(), held));
    }
    if std::env::var_os("CLAMBER_OPEN").is_some() {
        list(name, &ended);
        return;
    }
    let each = ended.iter();
    let wrong: Vec<_> = each
        .filter_map(|(setting, held)| judge(name, setting, held))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Prints the open settings of a scenario.
fn list(name: &str, ended: &[(String, Result<(), String>)]) {
    let everywhere = ended.iter().all(|(_, held)| held.is_err());
    for (setting, held) in ended {
        if let Err(found) = held {
            let setting = if everywhere { EVERYWHERE } else { setting };
            let found: String = found.chars().take(LISTED).collect();
            println!("OPEN {name} | {setting} | {found}");
        }
        if everywhere {
            return;
        }
    }
}

/// Number of characters of a reason that are listed.
const LISTED: usize = 120;

/// Marks a scenario that is open in all settings.
const EVERYWHERE: &str = "in every setting";

/// The complaint about a setting's result: an unexpected failure, or an open entry that passes.
fn judge(name: &str, setting: &str, held: &Result<(), String>) -> Option<String> {
    let is_open =
        open::all().any(|(test, known)| test == name && (known == setting || known == EVERYWHERE));
    match (held, is_open) {
        (Ok(()), false) => None,
        (Err(found), true) => {
            println!("OPEN {name} {setting}: {found}");
            None
        }
        (Err(found), false) => Some(format!("{name} {setting}: {found}")),
        (Ok(()), true) => Some(format!("{name} {setting} passes: remove it from open.txt")),
    }
}

/// Plays all settings, on as many threads as there are processors.
fn outcomes(name: &str, settings: &[Setting], scenario: fn()) -> Vec<Outcome> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<Option<Outcome>>> = Mutex::new(vec![None; settings.len()]);
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(setting) = settings.get(index) else {
                return;
            };
            let outcome = play(*setting, scenario);
            if let Ok(mut done) = done.lock() {
                done[index] = Some(outcome);
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        let spawned: Vec<_> = (0..threads.min(settings.len()))
            .map(|_| {
                let thread = std::thread::Builder::new().name(name.to_owned());
                thread.spawn_scoped(scope, work)
            })
            .collect();
        for thread in spawned.into_iter().flatten() {
            if let Err(cause) = thread.join() {
                resume_unwind(cause);
            }
        }
    });
    let done = done.into_inner().unwrap_or_default();
    let all = done.into_iter();
    all.map(|outcome| outcome.unwrap_or_else(|| Err("was not played".to_owned())))
        .collect()
}
