//! Checks a recording with a third-party reader in Python, if that is installed.

use std::io::Write;
use std::path::Path;
use std::process::Command;

use clamber_record::RecordOptions;
use clamber_scenes::battle::{Battle, BattleOptions, BattleRecorder};
use clamber_scenes::giant::giant;
use clamber_scenes::hero::Hero;

/// Runs a script of `tests/python` on a file and returns what it prints. `None`, with a note, if the third-party reader
/// is not installed.
pub(crate) fn run_python(script: &str, file: &Path) -> Option<String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let imports = "import mcap.reader, mcap.stream_reader, mcap_protobuf.decoder";
    let probe = Command::new(&python).args(["-c", imports]).output();
    if !probe.is_ok_and(|output| output.status.success()) {
        // Written directly, since the output of `eprintln` is not shown for tests that pass.
        let line = format!(
            "SKIPPED {script}: {python} has no packages mcap and mcap-protobuf-support; install them, or set PYTHON to \
             another interpreter\n"
        );
        let _ = std::io::stderr().write_all(line.as_bytes());
        return None;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python");
    let mut command = Command::new(&python);
    let output = command.arg(folder.join(script)).arg(file).output();
    let output = output.unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn python_decodes_a_recording() {
    let creature = giant().unwrap();
    let options = BattleOptions::ride(4, 1);
    let mut battle = Battle::new(&creature, &options).unwrap();
    let how = RecordOptions::waiting();
    let recorder = BattleRecorder::new(Vec::new(), &battle, &options, how).unwrap();
    let mut recorder = recorder.with_hero(Hero::load().unwrap());
    recorder.tick(&battle).unwrap();
    for tick in 0..200 {
        battle.step(options.input_at(tick)).unwrap();
        recorder.tick(&battle).unwrap();
    }
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python.mcap");
    std::fs::write(&file, recorder.finish().unwrap()).unwrap();
    run_python("check.py", &file);
}
