//! Proposes the states of a brain from a creature's clips.

use serde_json::{Map, Value, json};

use super::{PROPOSED_AIM, PROPOSED_WITHIN, Proposal, Strikes};
use crate::brain::{BrainFile, BrainProblem, whole};
use crate::error::ColossusError;
use crate::kind::HUMAN_HEIGHT;

/// The brain file with the proposed body and states.
pub(super) fn file(
    proposal: &Proposal<'_>,
    strikes: Option<&Strikes>,
) -> Result<BrainFile, ColossusError> {
    let mut file: BrainFile = serde_json::from_value(json!({
        "start": "alive",
        "states": {
            "alive": {
                "start": "calm",
                "gaze": "around",
                "transitions": [{ "to": "dies", "when": ["health <= 0"], "priority": 9, "interrupts": true }],
                "states": { "calm": calm(proposal), "alert": alert(proposal, strikes), "ridden": ridden(proposal) }
            },
            "dies": dies(proposal)
        }
    }))
    .map_err(|error| whole(BrainProblem::Text(error.to_string())))?;
    file.body = proposal.body.clone();
    Ok(file)
}

/// A state that stands, with the idle clip if there is one.
fn waits(proposal: &Proposal<'_>, transitions: Value) -> Value {
    match &proposal.clips.idle {
        Some(idle) => json!({ "act": { "play": idle }, "transitions": transitions }),
        None => json!({ "transitions": transitions }),
    }
}

/// A length in metres for a number of heights, rounded to two digits.
fn metres(proposal: &Proposal<'_>, heights: f64) -> f64 {
    let metres = heights * proposal.height();
    let steps = libm::exp10(1.0 - libm::floor(libm::log10(metres.max(1e-9))));
    super::rounded(metres, steps)
}

/// A time in whole seconds for a time at human height, by Froude's law: larger creatures take more time.
fn seconds(proposal: &Proposal<'_>, human: f64) -> u32 {
    let seconds = human * (proposal.height() / HUMAN_HEIGHT).sqrt();
    seconds.round().clamp(1.0, 3600.0) as u32
}

/// The state `calm`: the creature looks about, wanders, and sleeps.
fn calm(proposal: &Proposal<'_>) -> Value {
    let mut states = Map::new();
    let mut leaves = vec![json!({ "to": "sleeps", "after": [6, 15] })];
    if proposal.body.gait.is_some() {
        leaves.push(json!({ "to": "wanders", "after": [6, 15] }));
        let walk = json!({ "to": "patrol", "within": metres(proposal, 0.3) });
        let rests =
            json!([{ "to": "rests", "when": ["done"] }, { "to": "rests", "after": [15, 30] }]);
        let wanders = json!({ "act": { "walk": walk }, "transitions": rests });
        states.insert("wanders".into(), wanders);
    }
    states.insert("rests".into(), waits(proposal, leaves.into()));
    let wakes = json!([{ "to": "rests", "after": [8, 20] }]);
    states.insert(
        "sleeps".into(),
        json!({ "act": "sleep", "transitions": wakes }),
    );
    let mut notices = vec![
        json!({ "to": "ridden", "when": ["riders"] }),
        json!({ "to": "alert", "when": ["prey_seen"] }),
    ];
    if proposal.body.gait.is_some() {
        states.insert("listens".into(), turns("noise", "rests", 0));
        notices.push(json!({ "to": "listens", "when": ["noise"] }));
    }
    json!({ "start": "rests", "transitions": notices, "states": states })
}

/// The state `alert`: the creature turns to its prey, walks there, and attacks.
fn alert(proposal: &Proposal<'_>, strikes: Option<&Strikes>) -> Value {
    let mut states = Map::new();
    let walks = proposal.body.gait.is_some();
    let start = if walks { "turns" } else { "watches" };
    if let Some(Strikes { clip, limb, wave }) = strikes {
        let aim = metres(proposal, PROPOSED_AIM);
        let mut attack =
            json!({ "clip": clip, "limb": limb, "damage": 0.4, "throw": 8, "aim": aim });
        if let Some(radius) = wave {
            let radius = metres(proposal, *radius);
            attack["wave"] = json!({ "radius": radius, "damage": 0.3, "throw": 8 });
        }
        states.insert(
            "strikes".into(),
            json!({ "act": { "attack": attack }, "transitions": [{ "to": start }] }),
        );
    }
    if walks {
        states.insert(
            "turns".into(),
            turns("prey", "nears", seconds(proposal, 1.0)),
        );
        let (walk, next) = match strikes {
            Some(Strikes { clip, .. }) => {
                let within = metres(proposal, PROPOSED_WITHIN);
                (
                    json!({ "to": "prey", "within": within, "strike": clip }),
                    "strikes",
                )
            }
            None => (
                json!({ "to": "prey", "within": metres(proposal, 0.8) }),
                "turns",
            ),
        };
        let gives_up = json!({ "to": "turns", "after": [8, 12] });
        let transitions = json!([{ "to": next, "when": ["done"] }, gives_up]);
        states.insert(
            "nears".into(),
            json!({ "act": { "walk": walk }, "transitions": transitions }),
        );
    } else {
        let mut watches = vec![json!({ "to": "calm", "after": [5, 10] })];
        if strikes.is_some() {
            watches.push(json!({ "to": "strikes", "when": ["prey_seen"], "after": [2, 4] }));
        }
        states.insert("watches".into(), waits(proposal, watches.into()));
    }
    let mut alert = json!({
        "start": start,
        "gaze": "prey",
        "transitions": [
            { "to": "ridden", "when": ["riders"] },
            { "to": "calm", "when": ["prey_unseen_seconds > 8"] }
        ],
        "states": states
    });
    if !walks {
        // The creature looks elsewhere from time to time.
        alert["cooldown"] = 3.into();
    }
    alert
}

/// A state that turns to a place for at least some seconds, and then leads to another state.
fn turns(place: &str, then: &str, seconds: u32) -> Value {
    let mut done = json!({ "to": then, "when": ["done"] });
    if seconds > 0 {
        done["after"] = seconds.into();
    }
    json!({
        "act": { "turn": { "to": place, "within_deg": 20 } },
        "transitions": [done, { "to": then, "after": 15 }]
    })
}

/// The state `ridden`: the creature bears its riders for a while, then shakes.
fn ridden(proposal: &Proposal<'_>) -> Value {
    let mut states = Map::new();
    let shakes = match (&proposal.clips.shake, &proposal.body.gait) {
        (Some(clip), _) => {
            json!({ "act": { "once": clip }, "transitions": [{ "to": "bears" }] })
        }
        (None, Some(_)) => turns("home", "bears", 0),
        (None, None) => {
            json!({ "act": "sleep", "transitions": [{ "to": "bears", "after": [2, 4] }] })
        }
    };
    states.insert("shakes".into(), shakes);
    let bears = json!([{ "to": "shakes", "after": [4, 8] }]);
    states.insert("bears".into(), waits(proposal, bears));
    json!({
        "start": "bears",
        "gaze": "rider",
        "transitions": [{ "to": "alert", "when": ["!riders"] }],
        "states": states
    })
}

fn dies(proposal: &Proposal<'_>) -> Value {
    match &proposal.clips.death {
        Some(death) => json!({ "act": { "once": death }, "final": true }),
        None => json!({ "act": "sleep", "final": true }),
    }
}
