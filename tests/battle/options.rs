use std::path::PathBuf;

use clamber_scenes::battle::BattleOptions;
use clamber_scenes::giant;

#[test]
fn the_height_is_the_options_or_the_brains_or_the_default() {
    let text = std::fs::read_to_string(giant::brain_path()).unwrap();
    let mut brain: serde_json::Value = serde_json::from_str(&text).unwrap();
    brain["body"]["height"] = 15.into();
    let name = format!("clamber-height-{}.json", std::process::id());
    let path = std::env::temp_dir().join(name);
    std::fs::write(&path, brain.to_string()).unwrap();
    let options = |brain: Option<&PathBuf>, height| BattleOptions {
        creature: Some(giant::path()),
        brain: brain.cloned(),
        height,
        ..BattleOptions::default()
    };
    assert_eq!(options(Some(&path), None).height(), 15.0);
    assert_eq!(options(Some(&path), Some(9.0)).height(), 9.0);
    assert_eq!(options(None, None).height(), 20.0);
    let missing = PathBuf::from("no such file");
    assert_eq!(options(Some(&missing), None).height(), 20.0);
    std::fs::remove_file(&path).unwrap();
}
