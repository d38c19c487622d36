//! Prints a brain's file: its states, its transitions, and the ones that can never happen.

use std::collections::BTreeSet;

use clamber_animation::SeamProbe;
use clamber_colossus::brain::StateAction;
use clamber_colossus::{Brain, CreatureKind};
use clamber_gltf::load;

use super::{InspectError, InspectOptions};

/// Prints a brain. Returns true if all its states and transitions can happen.
pub(super) fn print(options: &InspectOptions) -> Result<bool, InspectError> {
    let file = || options.file.clone();
    let text = std::fs::read_to_string(&options.file).map_err(|error| InspectError::Read {
        file: file(),
        error,
    })?;
    let brain = Brain::from_json(&text, 1.0 / f64::from(options.rate)).map_err(|error| {
        InspectError::Brain {
            file: file(),
            error,
        }
    })?;
    let report = match &options.creature {
        Some(creature) => {
            let rig = load(creature)?.rig;
            let kind = CreatureKind::new(&rig, brain).map_err(|error| InspectError::Colossus {
                file: file(),
                error,
            })?;
            print_body(&kind);
            print_jumps(&kind)?;
            println!();
            kind.report()
        }
        None => brain.report(),
    };
    print!("{report}");
    if options.creature.is_none() {
        println!(
            "joints, clips and markers were not looked for: name the creature's file by --creature"
        );
    }
    Ok(report.never.is_empty())
}

/// Largest angle between the model's forward direction (+Z) and the way that its feet walk, degrees. A larger one is
/// warned of.
const ASIDE: f64 = 45.0;

/// Prints the sizes, speeds and directions that follow from the creature's file and the brain's file.
fn print_body(kind: &CreatureKind) {
    let body = &kind.brain().file().body;
    let height = kind.height();
    print!("{height:.3} units tall, posed at rest");
    match body.height {
        Some(metres) => println!(", and {metres} m as `height` says"),
        None => println!(", which are metres, since `height` is not given"),
    }
    match body.made_for {
        Some(metres) => println!("clips made for {metres} m"),
        None => println!("`made_for` is not given, so clips keep their speed at any size"),
    }
    if let Some(speed) = kind.walking_speed() {
        let source = if kind.is_speed_measured() {
            "measured by its feet"
        } else {
            "as told"
        };
        println!(
            "walks {:.3} heights in a second of the clip, {source}",
            speed / height
        );
    }
    if let Some(aside) = kind.walks_aside().filter(|aside| aside.abs() > ASIDE) {
        println!(
            "WARNING: its feet walk {aside:.0} degrees aside of where the model looks (+Z): if it looks another way in its \
             file, set `facing`"
        );
    }
}

/// Warns of clips that are played in a loop but do not end as they begin.
fn print_jumps(kind: &CreatureKind) -> Result<(), InspectError> {
    let brain = kind.brain();
    let mut names: BTreeSet<&str> = BTreeSet::new();
    for state in brain.states() {
        if let Some(StateAction::Play(clip)) = brain.act(state) {
            names.insert(clip);
        }
    }
    if let Some(gait) = &brain.file().body.gait {
        names.extend([gait.idle.as_str(), gait.walk.as_str()]);
        names.extend(gait.turn.iter().flatten().map(String::as_str));
    }
    let probe = SeamProbe::new(kind.skeleton(), kind.mesh(), kind.height());
    let clips = names.into_iter().filter_map(|name| kind.clips().find(name));
    for clip in clips.filter_map(|id| kind.clips().clip(id).ok()) {
        let seam = probe.measure(clip)?;
        if !seam.is_loop() {
            println!(
                "WARNING: `{}` is played again and again, but does not end as it begins: skin jumps at {:.2} heights a second \
                 there and goes at {:.2} elsewhere, which throws off riders. `close` it in the body's `clips`",
                clip.name, seam.speed, seam.within
            );
        }
    }
    Ok(())
}
