//! The transitions as a table in Markdown.

use clamber_climber::TRANSITIONS;

pub(crate) fn markdown() -> String {
    let mut text = "| | from | to | because |\n|---|---|---|---|\n".to_owned();
    for (number, (from, to, why)) in (1..).zip(TRANSITIONS) {
        text += &format!("| {number} | `{from:?}` | `{to:?}` | {why} |\n");
    }
    text
}
