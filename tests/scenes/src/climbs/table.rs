use std::fmt::Write as _;

use super::Climb;

/// The climbs as a Markdown table.
pub fn table(climbs: &[Climb]) -> String {
    let mut table = String::from(
        "| model | patches | reachable | highest, m | least, s | got on, s | there, s | of the least | came up to, m | plans | falls |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for Climb { model, outcome } in climbs {
        // Writing to a string cannot fail.
        let _ = match outcome {
            Err(error) => writeln!(table, "| {model} | refused: {error} |"),
            Ok(climbed) => {
                let time = |seconds: Option<f64>| {
                    seconds.map_or_else(|| "-".to_owned(), |seconds| format!("{seconds:.1}"))
                };
                writeln!(
                    table,
                    "| {model} | {} | {:.1} % | {:.1} | {:.1} | {} | {} | {} | {:.1} | {} | {} |",
                    climbed.patches,
                    100.0 * climbed.reachable,
                    climbed.heights[1],
                    climbed.least,
                    time(climbed.times[0]),
                    time(climbed.times[1]),
                    climbed
                        .ratio()
                        .map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.2}")),
                    climbed.highest,
                    climbed.plans,
                    climbed.falls,
                )
            }
        };
    }
    let climbed = climbs
        .iter()
        .filter_map(|climb| climb.outcome.as_ref().ok());
    let loaded = climbed.clone().count();
    let there = climbed
        .clone()
        .filter(|climbed| climbed.times[1].is_some())
        .count();
    let none = climbed.filter(|climbed| climbed.heights[1] == 0.0).count();
    format!(
        "{table}\nthe bot comes to the highest reachable place of {there} of {loaded} models; {none} cannot be got onto\n"
    )
}
