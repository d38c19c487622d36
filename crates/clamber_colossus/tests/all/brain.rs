//! Brain files: mistakes are refused with their place in the file, and valid brains run tick by tick (scenes B37, B38
//! and B48).

use clamber_colossus::{Brain, BrainFile, BrainProblem, BrainState, Sense, Senses};

/// Tick length, seconds.
const TICK: f64 = 1.0 / 60.0;

/// A brain with nested states, a mood, a region and a sense of the game's own, as JSON.
const FILE: &str = r#"{
  "start": "calm",
  "moods": { "anger": { "fades": 10, "raised": [{ "when": ["struck >= 1"], "to": 1 }] } },
  "regions": { "head": ["head"] },
  "senses": ["storm"],
  "states": {
    "calm": {
      "start": "idle",
      "transitions": [
        { "to": "angry", "when": ["anger > 0.5"], "priority": 2 },
        { "to": "dead", "when": ["health <= 0"], "priority": 9, "interrupts": true }
      ],
      "states": {
        "idle": { "act": { "play": "idle" }, "transitions": [
          { "to": "shake", "when": ["riders@head >= 1"], "after": [2, 6] },
          { "to": "roam", "any": ["storm", "prey_distance < 30"] }
        ] },
        "roam": { "transitions": [{ "to": "idle", "after": 1 }] },
        "shake": { "act": { "once": "shake" }, "cooldown": 3, "transitions": [{ "to": "idle" }] }
      }
    },
    "angry": { "act": { "once": "roar" }, "transitions": [
      { "to": "calm", "weight": 2 }, { "to": "roam" },
      { "to": "dead", "when": ["health <= 0"], "priority": 9, "interrupts": true }
    ] },
    "dead": { "final": true }
  }
}"#;

/// The first file in the documentation is complete.
#[test]
fn the_file_of_the_documentation_loads() {
    let form = include_str!("../../src/brain/form.md");
    let file = form.split("```json").nth(1).unwrap();
    let file = file.split("```").next().unwrap();
    let brain = Brain::from_json(file, TICK).unwrap();
    assert!(brain.find("roar").is_some());
}

fn brain() -> Brain {
    Brain::from_json(FILE, TICK).unwrap()
}

/// Steps the brain several times with the same senses. Returns the path of its state after that.
fn after(brain: &Brain, state: &mut BrainState, senses: &Senses, ticks: u32) -> String {
    for _ in 0..ticks {
        brain.step(state, senses, &[], |_| {});
    }
    brain.path(state.current()).to_owned()
}

#[test]
fn a_file_is_the_same_after_a_round_trip() {
    let file = brain().file().clone();
    let again: BrainFile = serde_json::from_str(&serde_json::to_string(&file).unwrap()).unwrap();
    assert_eq!(again, file);
}

#[test]
fn what_does_not_exist_is_refused_with_line_and_state() {
    let broken = [
        (
            r#""to": "roam", "any""#,
            r#""to": "rome", "any""#,
            "calm/idle",
        ),
        ("riders@head", "riders@tail", "calm/idle"),
        (r#""fades": 10"#, r#""fades": -1"#, ""),
        ("prey_distance < 30", "prey_distance less 30", "calm/idle"),
        (r#""weight": 2"#, r#""weight": 0"#, "angry"),
        (r#""final": true"#, r#""finale": true"#, "dead"),
        (
            r#""dead": { "final": true }"#,
            r#""dead": {}, "dead": {}"#,
            "",
        ),
    ];
    for (right, wrong, state) in broken {
        let text = FILE.replacen(right, wrong, 1);
        let line = text.split(wrong).next().unwrap().lines().count();
        let error = Brain::from_json(&text, TICK).unwrap_err();
        assert_eq!(error.line, Some(line), "{wrong}: {error}");
        if !state.is_empty() {
            assert_eq!(error.state.as_deref(), Some(state), "{wrong}: {error}");
        }
        // The message names the line only once.
        assert!(!error.to_string().contains(" at line "), "{error}");
    }
    let text = FILE.replacen(r#""start": "idle""#, r#""start": "dead""#, 1);
    let error = Brain::from_json(&text, TICK).unwrap_err();
    assert_eq!(
        (error.line, error.state.as_deref()),
        (Some(7), Some("calm")),
        "{error}"
    );
}

#[test]
fn a_condition_that_is_misspelt_is_told_what_there_is() {
    for (right, wrong, known) in [
        (
            "prey_distance < 30",
            "prey_distanse < 30",
            ["`prey_distance`", "`storm`"],
        ),
        (
            "riders@head >= 1",
            "riders@haed >= 1",
            ["`riders@head`", "`hurt@head`"],
        ),
    ] {
        let error = Brain::from_json(&FILE.replacen(right, wrong, 1), TICK).unwrap_err();
        let error = error.to_string();
        assert!(known.iter().all(|known| error.contains(known)), "{error}");
    }
}

#[test]
fn transitions_without_conditions_may_not_lead_in_a_circle() {
    let text = r#"{"start": "a", "states": {
        "a": {"transitions": [{"to": "b"}]}, "b": {"transitions": [{"to": "a"}]}}}"#;
    let error = Brain::from_json(text, TICK).unwrap_err();
    assert!(matches!(*error.problem, BrainProblem::Circle(_)), "{error}");
}

#[test]
fn moods_rise_and_fade_in_their_time() {
    let brain = brain();
    let (mut state, mut senses) = (BrainState::new(&brain, 1), brain.no_senses());
    senses.set(Sense::Struck, 1.0);
    after(&brain, &mut state, &senses, 1);
    assert_eq!(state.mood(&brain, 0), 1.0);
    senses.set(Sense::Struck, 0.0);
    after(&brain, &mut state, &senses, 599);
    assert!(state.mood(&brain, 0) > 0.0);
    after(&brain, &mut state, &senses, 1);
    assert_eq!(state.mood(&brain, 0), 0.0);
}

#[test]
fn an_act_is_played_to_its_end_unless_it_is_interrupted() {
    let brain = brain();
    let (mut state, mut senses) = (BrainState::new(&brain, 1), brain.no_senses());
    senses.set(Sense::Struck, 1.0);
    assert_eq!(after(&brain, &mut state, &senses, 1), "angry");
    senses.set(Sense::Struck, 0.0);
    assert_eq!(after(&brain, &mut state, &senses, 200), "angry");
    senses.set(Sense::Health, 0.0);
    assert_eq!(after(&brain, &mut state, &senses, 1), "dead");
    senses.set(Sense::Health, 1.0);
    assert_eq!(after(&brain, &mut state, &senses, 1000), "dead");
}

#[test]
fn lots_decide_when_the_first_shake_comes() {
    let brain = brain();
    let mut times = Vec::new();
    for seed in 0..40 {
        let (mut state, mut senses) = (BrainState::new(&brain, seed), brain.no_senses());
        senses.set_in_region(clamber_colossus::RegionSense::Riders, 0, 1.0);
        let mut ticks = 0;
        while brain.path(state.current()) != "calm/shake" {
            after(&brain, &mut state, &senses, 1);
            ticks += 1;
            assert!(ticks <= 361, "seed {seed}");
        }
        assert!(ticks >= 120, "seed {seed}: {ticks}");
        times.push(ticks);
    }
    times.sort_unstable();
    times.dedup();
    assert!(times.len() > 20, "{times:?}");
}

/// Random senses for many ticks: each tick has few transitions, every state is reached, and the final state is never
/// left. A state that was saved and loaded continues with the same bits. It stays below 1 KB.
#[test]
fn a_brain_lives_through_anything() {
    let brain = brain();
    let mut random = fastrand::Rng::with_seed(5);
    let mut seen = std::collections::BTreeSet::new();
    for seed in 0..50 {
        let (mut state, mut senses) = (BrainState::new(&brain, seed), brain.no_senses());
        for tick in 0..2_000 {
            for sense in Sense::all() {
                if random.u32(..20) == 0 {
                    senses.set(sense, f64::from(random.u32(..3)));
                }
            }
            // Blows are rare, and death is even rarer.
            senses.set(Sense::Struck, f64::from(u8::from(random.u32(..900) == 0)));
            senses.set(Sense::Health, f64::from(random.u32(..5_000).min(1)));
            // Quiet phases let the brain stay in a state.
            let is_quiet = tick % 1_000 < 500;
            senses.set_own(0, f64::from(u8::from(!is_quiet) * random.u8(..2)));
            if is_quiet {
                senses.set(Sense::PreyDistance, f64::INFINITY);
            }
            senses.set_in_region(
                clamber_colossus::RegionSense::Riders,
                0,
                f64::from(u8::from(is_quiet)),
            );
            let text = serde_json::to_string(&state).unwrap();
            let mut loaded: BrainState = serde_json::from_str(&text).unwrap();
            let was_final = brain.is_final(state.current());
            let mut count = 0;
            brain.step(&mut state, &senses, &[], |_| count += 1);
            brain.step(&mut loaded, &senses, &[], |_| {});
            assert_eq!(state, loaded);
            assert!(
                count <= clamber_colossus::brain::MOST_TRANSITIONS,
                "{count}"
            );
            assert!(!was_final || count == 0);
            seen.insert(brain.path(state.current()).to_owned());
        }
        assert!(state.size() <= 1024, "{}", state.size());
    }
    assert_eq!(seen.len(), 5, "{seen:?}");
}

#[test]
fn a_report_tells_what_can_never_happen() {
    let report = brain().report();
    assert!(report.never.is_empty(), "{report}");
    let text = FILE.replace(
        r#""riders@head >= 1""#,
        r#""riders@head >= 1", "riders@head < 1""#,
    );
    let report = Brain::from_json(&text, TICK).unwrap().report();
    let never: Vec<String> = report.never.iter().map(ToString::to_string).collect();
    assert!(
        never[0].contains("riders@head cannot hold together"),
        "{never:?}"
    );
    assert!(
        never
            .iter()
            .any(|never| never.contains("nothing leads here")),
        "{never:?}"
    );
    // An act that plays in a loop never ends.
    for (done, is_told) in [("done", true), ("done >= 1", true), ("!done", false)] {
        let text = FILE.replace(
            r#"[2, 6] }"#,
            &format!(r#"[2, 6] }}, {{ "to": "roam", "when": ["{done}"] }}"#),
        );
        let report = Brain::from_json(&text, TICK).unwrap().report();
        let mut never = report.never.iter();
        let never = never.any(|never| never.what.contains("no end"));
        assert_eq!(never, is_told, "{done}: {report}");
    }
}

/// Every region has its own senses. A file with more than 64 regions is refused.
#[test]
fn more_regions_than_can_be_told_apart_are_refused() {
    let file = |count: usize| {
        let names = (0..count).map(|index| format!(r#""r{index}": ["head"]"#));
        let regions: Vec<String> = names.collect();
        format!(
            r#"{{ "start": "a", "regions": {{ {} }}, "states": {{ "a": {{}} }} }}"#,
            regions.join(", ")
        )
    };
    assert!(Brain::from_json(&file(64), TICK).is_ok());
    let error = Brain::from_json(&file(65), TICK).unwrap_err().to_string();
    assert_eq!(error, "there are 65 regions; a brain has at most 64");
}

/// A mood or a sense of the game's own may not have the name of another sense or mood, as it would never be read.
#[test]
fn names_that_hide_each_other_are_refused() {
    let refused = |moods: &str, senses: &str| {
        let file = format!(
            r#"{{ "start": "a", "moods": {{ {moods} }}, "senses": [{senses}], "states": {{ "a": {{}} }} }}"#
        );
        Brain::from_json(&file, TICK).unwrap_err().to_string()
    };
    let mood = |name: &str| format!(r#""{name}": {{ "fades": 1, "raised": [] }}"#);
    for (moods, senses, name) in [
        (mood("noise"), "", "noise"),
        (String::new(), r#""hurt""#, "hurt"),
        (mood("storm"), r#""storm""#, "storm"),
        (String::new(), r#""storm", "storm""#, "storm"),
    ] {
        let text = format!("there are two senses or moods `{name}`");
        assert_eq!(refused(&moods, senses), text);
    }
}

/// Weights whose sum could be infinite are refused. Large ones still decide in proportion.
#[test]
fn weights_add_up() {
    let file = |weight: &str| {
        format!(
            r#"{{ "start": "a", "states": {{ "a": {{ "transitions": [
                {{ "to": "b", "after": 0.1, "weight": {weight} }}, {{ "to": "c", "after": 0.1, "weight": {weight} }}] }},
                "b": {{ "final": true }}, "c": {{ "final": true }} }} }}"#
        )
    };
    let error = Brain::from_json(&file("1e308"), TICK).unwrap_err();
    let error = error.to_string();
    assert!(
        error.contains("`weight` is 1") && error.contains("at most 1e9"),
        "{error}"
    );
    let brain = Brain::from_json(&file("1e9"), TICK).unwrap();
    let mut seen = [0; 2];
    for seed in 0..200 {
        let mut state = BrainState::new(&brain, seed);
        let end = after(&brain, &mut state, &brain.no_senses(), 20);
        seen[usize::from(end == "c")] += 1;
    }
    assert!(seen.iter().all(|count| *count > 60), "{seen:?}");
}

/// Long files are read or refused quickly: the time grows with their length only.
#[test]
fn long_files_are_read_or_refused_at_once() {
    let states = |count: usize, transitions: usize| {
        let transition = r#"{ "to": "s0", "when": ["struck"], "after": 1 }"#;
        let transitions = vec![transition; transitions].join(",\n");
        let state = |index: usize| format!(r#""s{index}": {{ "transitions": [{transitions}] }}"#);
        let states: Vec<String> = (0..count).map(state).collect();
        format!(
            r#"{{ "start": "s0", "states": {{ {} }} }}"#,
            states.join(",\n")
        )
    };
    let begin = std::time::Instant::now();
    let error = Brain::from_json(&states(8_000, 1), TICK).unwrap_err();
    let error = error.to_string();
    assert_eq!(error, "there are 8000 states; a brain has at most 160");
    let brain = Brain::from_json(&states(2, 16_000), TICK).unwrap();
    assert_eq!(brain.len(), 2);
    let brain = Brain::from_json(&states(160, 100), TICK).unwrap();
    assert_eq!(brain.len(), 160);
    // An earlier implementation took more than a minute for each file.
    assert!(begin.elapsed().as_secs() < 20, "{:?}", begin.elapsed());
    // Line numbers are right in long files, too.
    let text = states(100, 50).replacen(r#""to": "s0""#, r#""to": "nowhere""#, 2);
    let error = Brain::from_json(&text, TICK).unwrap_err();
    assert_eq!(error.line, Some(1), "{error}");
}

/// The state of a changed brain is carried over by names. A brain ignores a state that belongs to another brain.
#[test]
fn a_changed_brain_goes_on_by_names() {
    let old = brain();
    let mut senses = old.no_senses();
    let mut state = BrainState::new(&old, 5);
    // A blow makes it angry.
    senses.set(Sense::Struck, 1.0);
    assert_eq!(after(&old, &mut state, &senses, 2), "angry");
    let text = FILE
        .replace(
            r#""calm": {"#,
            r#""before": { "transitions": [{ "to": "calm" }] }, "calm": {"#,
        )
        .replace(
            r#""moods": {"#,
            r#""moods": { "alarm": { "fades": 3, "raised": [] },"#,
        );
    let new = Brain::from_json(&text, TICK).unwrap();
    assert_eq!(new.len(), old.len() + 1);
    // Without `carry_over`, the saved number would mean another state of the new brain.
    let mut raw = state.clone();
    let before = raw.clone();
    new.step(&mut raw, &new.no_senses(), &[], |_| {});
    assert_eq!(raw, before, "a state of another brain changes nothing");
    let mut carried = new.carry_over(&old, &state).unwrap();
    assert_eq!(new.path(carried.current()), "angry");
    let anger = |brain: &Brain, state: &BrainState| {
        let index = brain.moods().position(|mood| mood == "anger").unwrap();
        state.mood(brain, index)
    };
    assert_eq!(anger(&new, &carried), anger(&old, &state));
    assert_eq!(carried.ticks_in_state(&new), state.ticks_in_state(&old));
    let mut senses = new.no_senses();
    senses.set(Sense::Done, 1.0);
    after(&new, &mut carried, &senses, 100);
    // If the new brain lacks the current state, it starts anew.
    let text = FILE.replace("angry", "furious");
    let other = Brain::from_json(&text, TICK).unwrap();
    let carried = other.carry_over(&old, &state).unwrap();
    assert_eq!(other.path(carried.current()), "calm/idle");
    assert_eq!(carried.ticks_in_state(&other), 0);
    assert_eq!(other.carry_over(&other, &state), None);
}

/// A circle is refused if its transitions have priority over the one that leads out of it.
#[test]
fn a_circle_of_higher_priority_is_refused() {
    let file = |priority: i32| {
        format!(
            r#"{{ "start": "a", "states": {{
                "a": {{ "transitions": [{{ "to": "b" }}, {{ "to": "c", "priority": {priority} }}] }},
                "b": {{}}, "c": {{ "transitions": [{{ "to": "a" }}] }} }} }}"#
        )
    };
    let error = Brain::from_json(&file(1), TICK).unwrap_err();
    assert!(matches!(*error.problem, BrainProblem::Circle(_)), "{error}");
    assert!(Brain::from_json(&file(-1), TICK).is_ok());
}

/// When a state is entered anew, all states inside of it are entered anew, and their times restart.
#[test]
fn what_is_inside_begins_anew_as_well() {
    let file = r#"{ "start": "c", "senses": ["bell"], "states": {
        "c": { "start": "d", "transitions": [{ "to": "c", "when": ["bell"] }], "states": {
            "d": { "start": "e", "transitions": [{ "to": "x", "after": 10 }], "states": {
                "e": { "transitions": [{ "to": "f", "after": 1 }] }, "f": {} } } } },
        "x": {} } }"#;
    let brain = Brain::from_json(file, TICK).unwrap();
    let mut state = BrainState::new(&brain, 1);
    let mut senses = brain.no_senses();
    let ticks = |seconds: f64| (seconds / TICK).round() as u32;
    assert_eq!(after(&brain, &mut state, &senses, ticks(9.0)), "c/d/f");
    senses.set_own(0, 1.0);
    assert_eq!(after(&brain, &mut state, &senses, 1), "c/d/e");
    senses.set_own(0, 0.0);
    assert_eq!(after(&brain, &mut state, &senses, ticks(9.5)), "c/d/f");
    assert_eq!(after(&brain, &mut state, &senses, ticks(1.0)), "x");
}
