//! Which line of a file a place of its JSON stands on. serde_json knows the line of what it cannot read, but not of a
//! value that reads well and means nothing, such as the name of a state that does not exist.

use std::collections::BTreeMap;

use serde_json::value::RawValue;

/// A step from a JSON value into it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step<'a> {
    Key(&'a str),
    Index(usize),
}

/// The line, from 1, on which the value at a path begins; 0 if there is none.
pub(super) fn line_of(text: &str, path: &[Step<'_>]) -> usize {
    value_at(text, path).map_or(0, |raw| line_at(text, offset_of(text, raw)))
}

/// The path of the innermost state that has a line, such as `calm/idle`.
pub(super) fn state_on(text: &str, line: usize) -> Option<String> {
    let mut path: Vec<String> = Vec::new();
    let mut raw: &RawValue = serde_json::from_str(text).ok()?;
    while let Some(states) = entries(raw).and_then(|mut entries| entries.remove("states")) {
        let around = entries(states)?.into_iter().find(|(_, state)| {
            let start = offset_of(text, state);
            (line_at(text, start)..=line_at(text, start + state.get().len())).contains(&line)
        });
        let Some((name, state)) = around else { break };
        path.push(name);
        raw = state;
    }
    (!path.is_empty()).then(|| path.join("/"))
}

fn value_at<'a>(text: &'a str, path: &[Step<'_>]) -> Option<&'a RawValue> {
    let mut raw: &RawValue = serde_json::from_str(text).ok()?;
    for step in path {
        raw = match step {
            Step::Key(key) => entries(raw)?.remove(*key)?,
            Step::Index(index) => {
                let items: Vec<&RawValue> = serde_json::from_str(raw.get()).ok()?;
                items.get(*index).copied()?
            }
        };
    }
    Some(raw)
}

fn entries(raw: &RawValue) -> Option<BTreeMap<String, &RawValue>> {
    serde_json::from_str(raw.get()).ok()
}

/// Where a part of a text begins in it.
fn offset_of(text: &str, part: &RawValue) -> usize {
    // Borrowed from the text, so its address lies within.
    (part.get().as_ptr() as usize).saturating_sub(text.as_ptr() as usize)
}

fn line_at(text: &str, offset: usize) -> usize {
    let before = text.as_bytes().get(..offset).unwrap_or_default();
    before.iter().filter(|byte| **byte == b'\n').count() + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "{\n \"start\": \"a\",\n \"states\": {\n  \"a\": {\n   \"transitions\": [\n    {\"to\": \"b\"},\n    {\"to\": \"c\"}]},\n  \"b\": {}}}";

    #[test]
    fn places_are_found() {
        let path = [
            Step::Key("states"),
            Step::Key("a"),
            Step::Key("transitions"),
            Step::Index(1),
        ];
        assert_eq!(line_of(TEXT, &path), 7);
        assert_eq!(line_of(TEXT, &[Step::Key("states"), Step::Key("b")]), 8);
        assert_eq!(line_of(TEXT, &[Step::Key("nothing")]), 0);
        assert_eq!(state_on(TEXT, 6).as_deref(), Some("a"));
        assert_eq!(state_on(TEXT, 2), None);
    }
}
