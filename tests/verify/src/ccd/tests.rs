//! Queries in the format of the files, and wrong answers to them.

use std::path::Path;

use crate::queries::parse_queries;

use super::*;

/// Two vertex-face queries in the files' format: a vertex that falls from 1 through a face at 0 to -1, and one that
/// stops above the face.
const VERTICES: &str = "\
    1,4,1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n\
    1,4,-1,1,1,4,1\n0,1,0,1,0,1,1\n1,1,0,1,0,1,1\n0,1,0,1,1,1,1\n\
    1,4,1,1,1,4,0\n0,1,0,1,0,1,0\n1,1,0,1,0,1,0\n0,1,0,1,1,1,0\n\
    1,4,1,9,1,4,0\n0,1,0,1,0,1,0\n1,1,0,1,0,1,0\n0,1,0,1,1,1,0\n";
/// Two edge-edge queries with the same two motions, of an edge above another edge.
const EDGES: &str = "\
    -1,2,1,1,0,1,1\n1,2,1,1,0,1,1\n0,1,0,1,-1,2,1\n0,1,0,1,1,2,1\n\
    -1,2,-1,1,0,1,1\n1,2,-1,1,0,1,1\n0,1,0,1,-1,2,1\n0,1,0,1,1,2,1\n\
    -1,2,1,1,0,1,0\n1,2,1,1,0,1,0\n0,1,0,1,-1,2,0\n0,1,0,1,1,2,0\n\
    -1,2,1,9,0,1,0\n1,2,1,9,0,1,0\n0,1,0,1,-1,2,0\n0,1,0,1,1,2,0\n";

fn queries() -> [[FileQuery; 2]; 2] {
    [("vertex-face", VERTICES), ("edge-edge", EDGES)].map(|(kind, rows)| {
        let read = parse_queries(Path::new(kind), rows).unwrap();
        read.try_into().unwrap()
    })
}

fn count(query: &FileQuery, time: Option<f64>) -> CcdReport {
    let mut report = CcdReport::default();
    let claim = Claim {
        time,
        undecided: false,
    };
    report.count(query, &claim);
    report
}

#[test]
fn the_library_answers_correctly() {
    let mut stage = Stage::new().unwrap();
    for [falls, stops] in queries() {
        let [hit, miss] = [&falls, &stops].map(|query| {
            let answer = stage.sweep(&query.rounded(), query.tolerance()).unwrap();
            let report = count(query, answer.claim().time);
            assert!(report.holds(), "{report}");
            answer.claim().time
        });
        // The extent is 2, so the radius is 2e-5. The contact is at that height, just before half of the motion.
        let time = hit.unwrap();
        assert!((0.5 - 2e-5..=0.5 - 0.9e-5).contains(&time), "{time}");
        assert_eq!(miss, None);
    }
}

#[test]
fn each_kind_of_wrong_answer_has_its_count() {
    for [falls, stops] in queries() {
        let missed = count(&falls, None);
        assert_eq!((missed.false_negatives, missed.late), (1, 1), "{missed}");
        let late = count(&falls, Some(0.5));
        assert_eq!((late.false_negatives, late.late), (0, 1), "{late}");
        assert!(!missed.holds() && !late.holds());
        // The claim is early, but the motion does touch, so it is not a false contact.
        assert!(count(&falls, Some(0.4)).holds());
        let invented = count(&stops, Some(1.0));
        assert_eq!(
            (invented.false_positives, invented.late),
            (1, 0),
            "{invented}"
        );
        assert!(!invented.holds());
        assert!(count(&stops, None).holds());
    }
}

#[test]
fn queries_with_all_vertices_at_one_point_are_hits() {
    let rows = ["1,3,1,7,1,9,1\n"; 8].concat();
    let mut stage = Stage::new().unwrap();
    for kind in ["vertex-face", "edge-edge"] {
        let query = &parse_queries(Path::new(kind), &rows).unwrap()[0];
        let answer = stage.sweep(&query.rounded(), query.tolerance()).unwrap();
        let report = count(query, answer.claim().time);
        assert!(report.holds() && report.hits == 1, "{kind} {report}");
    }
}
