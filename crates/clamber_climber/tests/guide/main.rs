//! The guide's diagram and table of modes match the code.
//!
//! The diagram and the table are generated here from `TRANSITIONS`, and stored in `src/guide`. After a change of the
//! transitions, `CLAMBER_BLESS=1 cargo test -p clamber_climber --test guide` writes them again. Then look at the
//! diagram: the routes of its arrows are placed by hand, in `routes.rs`.

#![expect(
    clippy::unwrap_used,
    reason = "a test's helpers may fail like the test"
)]

mod diagram;
mod routes;
mod table;

use std::path::Path;

use clamber_climber::{ClimberMode, TRANSITIONS};
use routes::ROUTES;

/// Asserts that a file of the guide has a text. With `CLAMBER_BLESS` set, writes the text first.
fn assert_stored(name: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("src/guide")
        .join(name);
    if std::env::var_os("CLAMBER_BLESS").is_some() {
        std::fs::write(&path, text).unwrap();
        eprintln!("stored {}", path.display());
    }
    // A checkout may have other line ends.
    let stored = std::fs::read_to_string(&path)
        .unwrap()
        .replace("\r\n", "\n");
    assert!(
        stored == text,
        "{} is out of date; CLAMBER_BLESS=1 writes it again",
        path.display()
    );
}

#[test]
fn the_table_matches_the_code() {
    assert_stored("modes.md", &table::markdown());
}

#[test]
fn the_diagram_matches_the_code() {
    let svg = diagram::svg();
    // In a Markdown page, an empty line would end the picture.
    assert!(!svg.contains("\n\n"), "{svg}");
    assert_stored("modes.svg", &svg);
    assert_stored("modes_link.md", &diagram::link(&svg));
}

#[test]
fn every_transition_is_drawn_once_and_nothing_else() {
    let drawn = |from, to| {
        let routes = ROUTES.iter();
        routes
            .filter(|route| (route.from, route.to) == (from, to))
            .count()
    };
    for from in ClimberMode::ALL {
        for to in ClimberMode::ALL {
            let listed = TRANSITIONS.iter();
            let listed = listed.filter(|(a, b, _)| (*a, *b) == (from, to)).count();
            assert_eq!(drawn(from, to), listed, "{from:?} to {to:?}");
        }
    }
}

#[test]
fn arrows_lead_from_box_to_box() {
    for route in ROUTES {
        let (first, last) = (route.way[0], route.way[route.way.len() - 1]);
        let (from, to) = (diagram::place(route.from), diagram::place(route.to));
        assert!(from.has_on_edge(first), "{route:?}, {from:?}");
        assert!(to.has_on_edge(last), "{route:?}, {to:?}");
        for leg in route.way.windows(2) {
            let is_straight = (leg[0].0 == leg[1].0) != (leg[0].1 == leg[1].1);
            assert!(is_straight, "{route:?}");
        }
    }
}
