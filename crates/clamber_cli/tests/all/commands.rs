//! The commands of `clamber`: inspections of the giant and of real models, comparisons of recordings, and errors.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use clamber_cli::inspect::{InspectOptions, inspect};
use clamber_climber::Knockback;
use clamber_gltf::load;
use clamber_record::{RecordOptions, Recorder, RecordingInfo, TickView};
use clamber_scenes::battle::{Battle, BattleOptions, BattleRecorder, TICK};
use clamber_scenes::duel::{self, Duel};
use clamber_scenes::{giant, test_data};

#[test]
fn the_giant_is_closed_and_its_collider_is_near_its_skin() {
    let options = InspectOptions {
        poses: Some(4),
        ..InspectOptions::of(giant::path())
    };
    let inspection = inspect(&load(giant::path()).unwrap(), &options).unwrap();
    println!("{inspection}");
    assert_eq!(inspection.open_edges, 0, "{inspection}");
    assert!((inspection.size[1] - 40.991).abs() < 1e-3, "{inspection}");
    let per_vertex = inspection.memory / inspection.vertices;
    assert!((50..500).contains(&per_vertex), "{per_vertex} bytes");
    // The largest distances are at slots between stone and fur, which the collision mesh closes.
    let distance = inspection.collision_to_visual.unwrap();
    assert!(
        distance.median_m < 0.15 && distance.worst_m < 2.0,
        "{distance:?}"
    );
}

#[test]
fn every_model_is_inspected() {
    let files = test_data::gltf_files("inspection of all models").unwrap();
    let mut inspected = 0;
    for (name, path) in files.iter().filter(|(name, _)| name.starts_with("models/")) {
        let Ok(rig) = load(path) else {
            continue;
        };
        let options = InspectOptions {
            poses: Some(1),
            ..InspectOptions::of(path.clone())
        };
        let inspection = inspect(&rig, &options).unwrap();
        let size = inspection.size.iter().all(|side| *side > 0.0);
        assert!(size && inspection.memory > 0, "{name}\n{inspection}");
        inspected += 1;
    }
    assert!(files.is_empty() || inspected == 27, "{inspected}");
}

/// Runs `clamber` with arguments.
fn clamber(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_clamber"));
    command.args(arguments).output().unwrap()
}

/// Runs `clamber` with arguments, and checks that it exits with `code`. Returns its standard error if `code` is 2, as
/// after an error, and its standard output otherwise.
fn said(arguments: &[&str], code: i32) -> String {
    let ended = clamber(arguments);
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    let (output, errors) = (text(&ended.stdout), text(&ended.stderr));
    let found = ended.status.code();
    assert_eq!(found, Some(code), "{arguments:?}: {output}{errors}");
    if code == 2 { errors } else { output }
}

/// Compares a recording with others. Each row is one comparison: the path of the other recording, the exit code, and a
/// part of the text that [`said`] returns.
fn compares(first: &str, rows: &[(String, i32, &str)]) {
    for (other, code, told) in rows {
        let text = said(&["compare", first, other], *code);
        assert!(text.contains(told), "{first} {other}: {text}");
    }
}

#[test]
fn the_import_is_told_before_the_measurements() {
    let file = giant::path();
    let file = file.to_str().unwrap();
    let text = said(&["inspect", file, "--clip", "idle", "--poses", "1"], 0);
    let [import, measured] = ["weak points", "measured in             2 poses"].map(|row| {
        text.find(row)
            .unwrap_or_else(|| panic!("no {row} in {text}"))
    });
    assert!(import < measured, "{text}");

    let json = ["inspect", file, "--json", "--clip", "idle", "--poses", "1"];
    let text = said(&json, 0);
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(report["poses"], 2, "{text}");
    assert_eq!(report["open_edges"], 0, "{text}");
}

/// The giant's brain fits the giant, and all of it can happen. The error for a broken brain names its line.
#[test]
fn brains_are_inspected() {
    let brain = giant::brain_path();
    let (brain, creature) = (brain.to_str().unwrap(), giant::path());
    let creature = creature.to_str().unwrap();
    let text = said(&["inspect", "--brain", brain, "--creature", creature], 0);
    assert!(
        text.contains("stomp_left") && text.contains("all of it can happen"),
        "{text}"
    );

    let broken = std::env::temp_dir().join(format!("clamber-brain-{}.json", std::process::id()));
    let file = std::fs::read_to_string(brain).unwrap();
    std::fs::write(&broken, file.replacen("\"prey_seen\"", "\"prey_sen\"", 1)).unwrap();
    let text = said(&["inspect", "--brain", broken.to_str().unwrap()], 2);
    assert!(
        text.contains("line ") && text.contains("prey_sen"),
        "{text}"
    );
    std::fs::remove_file(&broken).unwrap();
}

/// `--propose-brain` writes a brain for each model, in 40 lines at most, and it fits the model. Without its `close`
/// entries, `--brain` warns of some clips that jump at their ends.
#[test]
fn brains_are_proposed() {
    let file = format!("{}/proposed.json", env!("CARGO_TARGET_TMPDIR"));
    let files = test_data::gltf_files("proposals for all models").unwrap();
    let mut files: Vec<_> = files.into_iter().map(|(_, path)| path).collect();
    let count = files.len();
    files.push(giant::path());
    let (mut proposed, mut warned, mut longest) = (0, 0, 0);
    for path in files {
        let creature = path.to_str().unwrap();
        let propose = ["inspect", "--propose-brain", creature, "--height", "12.5"];
        if load(&path).is_err() {
            said(&propose, 2);
            continue;
        }
        let text = said(&propose, 0);
        let lines = text.lines().count();
        assert!(lines <= 40, "{creature}: {lines} lines\n{text}");
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(json["body"]["height"], 12.5, "{text}");
        let is_giant = path == giant::path();
        assert_eq!(json["body"]["fur"].is_null(), is_giant, "{text}");
        // A flat creature of the edge cases has no room for a weak point.
        let has_none = is_giant || creature.contains("quad_skin");
        let weak_points = &json["body"]["weak_points"];
        assert_eq!(weak_points.is_null(), has_none, "{creature}\n{text}");
        std::fs::write(&file, &text).unwrap();
        let fits = ["inspect", "--brain", file.as_str(), "--creature", creature];
        let report = said(&fits, 0);
        assert!(!report.contains("does not end as it begins"), "{report}");
        (proposed, longest) = (proposed + 1, longest.max(lines));
        // The same brain without the `close` entries, which make clips end as they begin.
        let mut open = json.clone();
        let clips = open["body"]["clips"].as_object_mut();
        let clips = clips.into_iter().flat_map(|clips| clips.values_mut());
        let closed = clips.filter_map(|clip| clip.as_object_mut()?.remove("close"));
        if closed.count() > 0 {
            std::fs::write(&file, open.to_string()).unwrap();
            let report = String::from_utf8(clamber(&fits).stdout).unwrap();
            warned += usize::from(report.contains("does not end as it begins"));
        }
    }
    println!("{proposed} brains of up to {longest} lines, {warned} creatures whose clips jump");
    assert!(count == 0 || proposed > 27 && warned > 0);
    for (arguments, told) in [
        (&["--height", "12"][..], "--propose-brain"),
        (&["--propose-brain", "--joints"], "--joints"),
        (&["--propose-brain", "--height", "0"], "`height` is 0"),
        (&["--propose-brain", "--height", "NaN"], "`height` is NaN"),
    ] {
        let creature = giant::path();
        let all = ["inspect", creature.to_str().unwrap()].into_iter();
        let all: Vec<&str> = all.chain(arguments.iter().copied()).collect();
        let text = said(&all, 2);
        assert!(text.contains(told), "{text}");
    }
}

#[test]
fn errors_name_what_is_wrong() {
    let file = giant::path();
    let file = file.to_str().unwrap();
    for (arguments, told) in [
        (&["inspect", "nowhere.glb"][..], "nowhere.glb"),
        (
            &["inspect", file, "--clip", "jump"],
            "the clips are: breathe, die, expose, idle",
        ),
        (&["inspect", file, "--poses", "0"], "--poses"),
        (
            &["inspect", file, "--poses", "2", "--thorough"],
            "--thorough",
        ),
        (&["compare", "nowhere.mcap", "there.mcap"], "nowhere.mcap"),
        (&["compare", "nowhere.mcap"], "<OTHER.mcap>"),
    ] {
        let text = said(arguments, 2);
        assert!(text.contains(told), "{text}");
    }
}

/// Records a ride with this seed into a file of the target folder.
fn recorded(name: &str, seed: u64, ticks: u64) -> String {
    let options = BattleOptions::ride(0, seed);
    let creature = giant::giant().unwrap();
    let mut battle = Battle::new(&creature, &options).unwrap();
    let how = RecordOptions::waiting();
    let mut recorder = BattleRecorder::new(Vec::new(), &battle, &options, how).unwrap();
    for tick in 0..ticks {
        battle.step(options.input_at(tick)).unwrap();
        recorder.tick(&battle).unwrap();
    }
    let file = format!("{}/{name}.mcap", env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(&file, recorder.finish().unwrap()).unwrap();
    file
}

#[test]
fn recordings_are_equal_or_the_first_field_that_differs_is_told() {
    let first = recorded("first", 1, 60);
    let [again, shorter, other] = [("again", 1, 60), ("shorter", 1, 40), ("other", 2, 60)]
        .map(|(name, seed, ticks)| recorded(name, seed, ticks));
    let rows = [
        (again, 0, "all 60 ticks are equal"),
        (shorter, 1, "40 ticks are equal in every bit; then"),
        (other, 1, "the climber's state differs in"),
    ];
    compares(&first, &rows);
}

/// Records a ride of 60 ticks, with a knockback of the climber at tick 30. Nothing else in the recording depends on the
/// knockback.
fn recorded_knockback(name: &str, knockback: Option<Knockback>) -> String {
    let options = BattleOptions::ride(0, 1);
    let creature = giant::giant().unwrap();
    let mut battle = Battle::new(&creature, &options).unwrap();
    let info = RecordingInfo {
        creature: creature.name.clone(),
        creature_fingerprint: 0,
        tick_seconds: TICK,
        climber: *battle.climber().config(),
        settings: Default::default(),
        version: RecordingInfo::VERSION.to_owned(),
    };
    let (skeleton, how) = (&creature.rig.skeleton, RecordOptions::waiting());
    let mut recorder = Recorder::new(Vec::new(), &info, skeleton, how).unwrap();
    for tick in 0..60 {
        battle.step(options.input_at(tick)).unwrap();
        let view = TickView {
            tick: battle.tick(),
            input: &battle.input,
            knockback: knockback.filter(|_| battle.tick() == 30),
            state: battle.climber().state(),
            report: battle.report(),
            surface: battle.surface(),
            palette: battle.palette(),
            scene_fingerprint: 0,
        };
        recorder.tick(&view).unwrap();
    }
    let file = format!("{}/{name}.mcap", env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(&file, recorder.finish().unwrap()).unwrap();
    file
}

#[test]
fn a_knockback_that_differs_is_told() {
    let blow = Some(Knockback {
        damage: 0.25,
        ..Knockback::default()
    });
    let first = recorded_knockback("struck", blow);
    let told = "the knockback of the climber for the step to tick 30 differs";
    let rows = [
        (
            recorded_knockback("struck_again", blow),
            0,
            "all 60 ticks are equal",
        ),
        (recorded_knockback("not_struck", None), 1, told),
    ];
    compares(&first, &rows);
}

/// Records a duel. The second fighter's walk input is changed for the tick `aims_otherwise`.
fn recorded_duel(name: &str, aims_otherwise: Option<u64>, ticks: u64) -> String {
    let file = format!("{}/{name}.mcap", env!("CARGO_TARGET_TMPDIR"));
    let inputs = (0..ticks).map(|tick| {
        let mut inputs = [0, 1].map(|player| Duel::input(player, tick).to_input());
        if aims_otherwise == Some(tick) {
            inputs[1].walk.x = -inputs[1].walk.x - 0.1;
        }
        inputs.to_vec()
    });
    let steps = inputs.map(|inputs| (inputs, Vec::new()));
    duel::record(&Duel::kind().unwrap(), steps, Path::new(&file)).unwrap();
    file
}

/// Copies a recording without one of its chunks. A recorder whose disk is too slow leaves such a gap.
fn without_chunk(file: &str, index: usize) -> String {
    let bytes = std::fs::read(file).unwrap();
    let (mut at, mut chunks, mut out) = (8, 0, bytes[..8].to_vec());
    while at < bytes.len() - 8 {
        let length = u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize;
        let record = &bytes[at..at + 9 + length];
        at += 9 + length;
        match record[0] {
            0x06 => {
                if chunks != index {
                    out.extend(record);
                }
                chunks += 1;
            }
            // The end of the data, with its checksum; the summary is not needed.
            0x0f => {
                out.extend(&record[..9]);
                out.extend([0; 4]);
                break;
            }
            _ => out.extend(record),
        }
    }
    out.extend(&bytes[..8]);
    let name = format!("{file}.without_{index}.mcap");
    std::fs::write(&name, out).unwrap();
    name
}

/// Only ticks that both recordings have are compared. Ticks that only one of them has are counted.
#[test]
fn recordings_with_gaps_are_compared_where_both_have_ticks() {
    let duel = recorded_duel("gaps", None, 240);
    let [second, third] = [1, 2].map(|index| without_chunk(&duel, index));
    let empty = (0..5).fold(duel.clone(), |file, _| without_chunk(&file, 0));
    let both = "121 ticks are in both, and equal in every bit; 60 are only in the first";
    let less = "60 are only in the first recording and 0 only in the second";
    let more = "0 are only in the first recording and 60 only in the second";
    for (first, other, code, told) in [
        (&second, &second, 0, "all 181 ticks are equal"),
        (&second, &third, 1, both),
        (&duel, &second, 1, less),
        (&second, &duel, 1, more),
        (&empty, &empty, 2, "there is no tick in it"),
    ] {
        compares(first, &[(other.clone(), code, told)]);
    }
}

#[test]
fn recordings_of_arenas_are_equal_or_who_differs_is_told() {
    let first = recorded_duel("duel", None, 90);
    let again = recorded_duel("duel_again", None, 90);
    let shorter = recorded_duel("duel_shorter", None, 50);
    let other = recorded_duel("duel_other", Some(60), 90);
    let archer = "the input of archer for the step to tick 61 differs";
    let rows = [
        (again, 0, "all 91 ticks are equal"),
        (shorter, 1, "51 ticks are equal in every bit; then"),
        (other, 1, archer),
        (recorded("ride", 1, 5), 2, "kinds of scene differ"),
    ];
    compares(&first, &rows);
}

#[test]
fn a_body_is_printed_and_drawn_and_a_file_without_one_is_told() {
    let hero = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/hero.glb");
    let drawing = std::env::temp_dir().join(format!("clamber_body_{}.svg", std::process::id()));
    let path = drawing.to_str().unwrap();
    let text = said(&["inspect", "--humanoid", "--draw", path, hero], 0);
    assert!(text.contains("left hand          hand.L\n"), "{text}");
    let svg = std::fs::read_to_string(&drawing).unwrap();
    std::fs::remove_file(&drawing).unwrap();
    assert!(svg.contains("left lower arm") && svg.matches("<circle").count() > 20);

    if let Some(file) = test_data::file("a file without a body", "models/greenman.glb") {
        let text = said(&["inspect", "--humanoid", file.to_str().unwrap()], 1);
        let told = text.contains("left upper arm") && text.contains("hand_L");
        assert!(told, "{text}");
    }
    let nowhere = "/no/such/folder/a.svg";
    let text = said(&["inspect", "--humanoid", "--draw", nowhere, hero], 2);
    assert!(text.contains("cannot draw /no/such/folder/a.svg"), "{text}");
    said(&["inspect", "--draw", path, hero], 2);
}

#[test]
fn joints_are_printed_as_a_tree_and_a_brain_with_its_sizes() {
    let (giant, brain) = (giant::path(), giant::brain_path());
    let (giant, brain) = (giant.to_str().unwrap(), brain.to_str().unwrap());
    let text = said(&["inspect", "--joints", giant], 0);
    assert!(text.contains("40.991 units tall, posed at rest"), "{text}");
    // The foot is below the shin in space, and a child of it in the tree.
    let line = |name: &str| {
        let named = |line: &&str| line.split_whitespace().next() == Some(name);
        text.lines().find(named).unwrap().to_owned()
    };
    let indent = |line: &str| line.len() - line.trim_start().len();
    let height = |line: &str| -> f64 { line.split_whitespace().nth(2).unwrap().parse().unwrap() };
    let (shin, foot) = (line("shin.L"), line("foot.L"));
    assert_eq!(indent(&foot), indent(&shin) + 2, "{shin}{foot}");
    assert!(
        height(&foot) < height(&shin) && height(&foot) < 0.1,
        "{foot}"
    );

    let text = said(&["inspect", "--brain", brain, "--creature", giant], 0);
    assert!(text.contains("clips made for 41 m"), "{text}");
    let told = "heights in a second of the clip, as told";
    assert!(text.contains(told), "{text}");
    assert!(!text.contains("WARNING"), "{text}");
}

/// Guards the numbers of the giant's climbability: a change of the giant or of the graph that moves them fails here.
#[test]
fn the_giant_can_be_climbed() {
    let giant = giant::path();
    let giant = giant.to_str().unwrap();
    let fur_and_stone = ["climbability", giant, "--grip", "fur,stone", "--json"];
    let wanted = ["--require", "weak_points>=3", "--require", "reachable>0.85"];
    let text = said(&[&fur_and_stone[..], &wanted[..]].concat(), 0);
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let close = |name: &str, wanted: f64| {
        let found = report[name].as_f64().unwrap();
        assert!(
            (found / wanted - 1.0).abs() < 0.01,
            "{name}: {found} for {wanted}"
        );
    };
    close("area", 4102.0);
    close("reachable_area", 3589.0);
    close("rest_area", 523.0);
    // The second weak point is on the arm. A jump leads there; without the jump it takes 21.7 s.
    for (index, seconds) in [26.9, 15.2, 25.3].into_iter().enumerate() {
        let point = &report["weak_points"][index];
        let found = point["seconds"].as_f64().unwrap();
        assert!((found - seconds).abs() < 1.0, "{point}: {seconds}");
    }
    // The recipe shows the same numbers.
    let recipe = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../docs/recipes/climbability.md"
    );
    let recipe = std::fs::read_to_string(recipe).unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let mut shown: Vec<String> = [
        ("skin", "area"),
        ("  can be gripped", "grip_area"),
        ("  can be stood on", "stand_area"),
        ("  reachable", "reachable_area"),
        ("  to rest on", "rest_area"),
    ]
    .map(|(row, name)| format!("{row:17} {:9.1} m2", number(&report[name])))
    .into();
    for point in report["weak_points"].as_array().unwrap() {
        let [seconds, stamina] = ["seconds", "stamina"].map(|key| number(&point[key]));
        let name = point["name"].as_str().unwrap();
        let left = 100.0 * stamina;
        shown.push(format!(
            "reached in {seconds:.1} s with {left:.0} % of its strength left"
        ));
        assert!(recipe.contains(name), "{name}");
    }
    for line in shown {
        assert!(
            recipe.contains(&line),
            "docs/recipes/climbability.md has no {line:?}"
        );
    }
    // On fur alone there is no way up, as the giant wears belts of stone.
    let ended = clamber(&["climbability", giant, "--require", "weak_points=3"]);
    assert_eq!(ended.status.code(), Some(1));
    let (text, error) = (ended.stdout, String::from_utf8(ended.stderr).unwrap());
    assert!(
        String::from_utf8(text)
            .unwrap()
            .contains("m of reach are missing")
    );
    assert!(
        error.contains("weak_points=3 does not hold: it is 0"),
        "{error}"
    );
}

#[test]
fn climbability_refuses_what_it_does_not_know() {
    let giant = giant::path();
    let giant = giant.to_str().unwrap();
    for wrong in [
        ["--require", "legs>=2"],
        ["--spacing", "0"],
        ["--spacing", "5"],
        ["--height", "-1"],
        ["--grip", "ice"],
    ] {
        let error = said(&[&["climbability", giant], &wrong[..]].concat(), 2);
        assert!(!error.contains("panicked"), "{error}");
    }
}

/// The reader of the output, such as `head`, may close it at any time.
#[test]
fn it_ends_with_its_reader() {
    for arguments in [vec!["--joints"], vec!["--propose-brain"]] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_clamber"));
        command.arg("inspect").args(arguments).arg(giant::path());
        let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = piped.spawn().unwrap();
        drop(child.stdout.take());
        let ended = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8_lossy(&ended.stderr), "");
        assert!(ended.status.success(), "{:?}", ended.status);
    }
}
