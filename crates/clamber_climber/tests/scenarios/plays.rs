//! Every scenario in every setting: plain, in moving frames, at other scales, on own obstacles.
//!
//! | setting | obstacles | what is demanded |
//! |---|---|---|
//! | plain | root, joint, body | the scenario's own demands; the same on each |
//! | at rest | own | the scenario's own demands; the same as on a root |
//! | each of three frames | own, root, and body in the slow one | the demands, and the same as at rest: [`Allowed`] |
//! | each of four scales | own, and root or joint | the demands; on own, a millimetre from what it is in metres |
//!
//! Thinned: the joint is left out of frames, where its root moves as the root's does; bodies are left out of the fast
//! frames, where their f32 holds centimetres after a minute, and out of scales, where rapier's own lengths (its margins
//! and its tolerances are in metres) say nothing of the climber; root and joint take turns at scales.

use std::panic::resume_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;

use crate::open;
use crate::stage::{Allowed, Played, Setting, Trace, assert_alike, play};

const OWN: &[Played] = &[Played::Own];
const ROOT: &[Played] = &[Played::Root];
const JOINT: &[Played] = &[Played::Joint];
const BODY: &[Played] = &[Played::Body];

/// Along different axes, the slow one first.
const FRAMES: [DVec3; 3] = [
    DVec3::new(30.0, 0.0, 0.0),
    DVec3::new(0.0, -30.0, 0.0),
    DVec3::new(0.0, 0.0, 300.0),
];

const SCALES: [f64; 4] = [0.02, 0.1, 10.0, 100.0];

/// Between own triangles and a root: what f32 corners and sweeps that stop a tenth of a millimetre early make of a tour.
const ON_SKIN: Allowed = Allowed {
    position: 3e-4,
    velocity: f64::INFINITY,
};

/// Between own triangles at a scale and in metres, in the scenario's units.
const SCALED: Allowed = Allowed {
    position: 1e-3,
    velocity: f64::INFINITY,
};

/// Scenarios whose runs are not compared between settings on some obstacles, and why. Their own demands count all the same.
const NOT_COMPARED: &[(&str, &[Played], &str)] = &[
    (
        "nonsense_of_an_obstacle_does_not_spread",
        &[Played::Root, Played::Joint, Played::Body, Played::Own],
        "a velocity that is no number is taken as none, in whichever frame",
    ),
    (
        "no_velocity_enters_any_of_seventeen_planes",
        &[Played::Root, Played::Joint, Played::Body, Played::Own],
        "of planes that all touch the ball, rounding decides which it is said to stand on",
    ),
    (
        "ground_that_goes_on_leaves_who_is_held_by_a_wall",
        &[Played::Body],
        "the ground's end comes by after 1.5 km, where f32 rounds it by a tenth of a millimetre, and a ball rolls off it",
    ),
];

/// What is compared: the runs of a setting, if it held.
type Outcome = Result<Vec<Trace>, String>;

/// All settings, those at rest first.
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

/// Plays a scenario in every setting. Those that are open have to fail, so that none stays open that holds.
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

/// Prints what is open of a scenario.
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

/// Letters of a reason that are listed.
const LISTED: usize = 120;

/// Open in all settings.
const EVERYWHERE: &str = "in every setting";

/// What is wrong with how a setting ended, if anything.
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
        (Ok(()), true) => Some(format!("{name} {setting} holds: it is open no more")),
    }
}

/// Of each setting, on as many threads as there are processors.
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
