//! The brain of a creature, as numbers and text.

use clamber_colossus::brain::StateId;
use clamber_colossus::{Creature, CreatureEvent as Event};
use foxglove::messages::Log;
use foxglove::messages::log::Level;
use glam::DVec3;

use super::log;
use crate::messages::{Brain, Named};

/// Log lines of the events and blows of a creature that the log calls `name`.
pub(crate) fn brain_lines(creature: &Creature, name: &str) -> Vec<Log> {
    let report = creature.report();
    let events = report.events.iter();
    let events = events.filter_map(|event| line(creature, event));
    let blows = report.blows.iter().map(|blow| {
        let by = creature.kind().brain().path(blow.state);
        format!("struck person {} with {by}", blow.person)
    });
    let lines = events.chain(blows);
    lines.map(|text| log(Level::Info, name, text)).collect()
}

/// The brain of a creature, as a message.
pub(crate) fn brain(creature: &Creature) -> Brain {
    let (brain, state) = (creature.kind().brain(), creature.state());
    let named = |(name, value): (&str, f64)| Named {
        name: name.to_owned(),
        value,
    };
    let moods = brain.moods().enumerate();
    let moods = moods.map(|(index, name)| (name, state.brain().mood(brain, index)));
    // Senses that are 0 or not finite are left out below.
    let senses =
        clamber_colossus::Sense::all().map(|sense| (sense.name(), state.senses().get(sense)));
    let own = brain.own_senses().iter().enumerate();
    let own = own.map(|(index, name)| (name.as_str(), state.senses().own(index)));
    let ticks = state.brain().ticks_in_state(brain);
    let legs = 0..brain.file().body.legs.len();
    Brain {
        state: brain.path(state.current()).to_owned(),
        seconds: f64::from(ticks) * brain.tick(),
        moods: moods.map(named).collect(),
        senses: senses
            .chain(own)
            .filter(|(_, value)| *value != 0.0 && value.is_finite())
            .map(named)
            .collect(),
        hit_points: state.hit_points().to_vec(),
        planted: legs.map(|leg| state.is_planted(leg)).collect(),
    }
}

/// The text of an event; `None` for footfalls and markers, which are frequent.
pub(crate) fn line(creature: &Creature, event: &Event) -> Option<String> {
    let path = |state: &StateId| creature.kind().brain().path(*state);
    Some(match event {
        Event::Entered { from, to } => format!("{} to {}", path(from), path(to)),
        Event::Hurt {
            weak_point,
            damage,
            used_up,
        } => {
            let end = if *used_up { ", which is used up" } else { "" };
            let points = creature.kind().weak_points();
            let point = points.get(*weak_point).map_or("", |point| &point.name);
            format!("hurt at weak point {weak_point} ({point}) by {damage:.3}{end}")
        }
        Event::Staggered { plate, breaks } => {
            let end = if *breaks { ", which breaks off" } else { "" };
            let plates = &creature.kind().brain().file().body.plates;
            let name = plates.get(*plate).map_or("", |plate| &plate.name);
            format!("staggered by a blow on plate {plate} ({name}){end}")
        }
        Event::Arrived { place } => format!("is where it was sent, at {}", in_words(place)),
        Event::Stopped { place } => {
            let to = in_words(place);
            format!("does not get on to where it was sent, to {to}")
        }
        Event::Threw { state, place, .. } => {
            let (by, from) = (path(state), in_words(place));
            format!("threw something with {by}, from {from}")
        }
        Event::Burst { state, place, .. } => {
            let (by, at) = (path(state), in_words(place));
            format!("what it threw with {by} ended at {at}")
        }
        Event::Wave {
            state,
            place,
            radius,
        } => {
            let (by, from) = (path(state), in_words(place));
            format!("sent out a wave of {radius:.1} m with {by}, from {from}")
        }
        Event::Marker { .. } | Event::Plant { .. } => return None,
        // An event that is newer than this list.
        other => format!("{other:?}"),
    })
}

fn in_words(place: &DVec3) -> String {
    let [x, y, z] = place.to_array();
    format!("{x:.1}, {y:.1}, {z:.1}")
}
