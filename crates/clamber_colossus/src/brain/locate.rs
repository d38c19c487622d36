//! Finds the lines of JSON values in a brain file. serde_json reports a line only for text that it cannot parse, not
//! for a value that parses but is invalid, such as the name of a state that does not exist.

use std::collections::BTreeMap;

use serde_json::value::RawValue;

/// The lines of a file's states, transitions and moods, found in one pass.
#[derive(Debug, Default)]
pub(super) struct Lines {
    /// Per state, by its path such as `calm/idle`: the state's line, and the lines of its transitions.
    states: BTreeMap<String, (usize, Vec<usize>)>,
    moods: BTreeMap<String, usize>,
    start: usize,
}

impl Lines {
    pub(super) fn of(text: &str) -> Self {
        let mut lines = Self::default();
        let text = Text::new(text);
        let Some(mut root) = text.raw().and_then(entries) else {
            return lines;
        };
        lines.start = root.get("start").map_or(0, |raw| text.line(raw));
        let moods = root.get("moods").and_then(|raw| entries(raw));
        let moods = moods.into_iter().flatten();
        lines.moods = moods.map(|(name, raw)| (name, text.line(raw))).collect();
        if let Some(states) = root.remove("states") {
            lines.gather(&text, states, "");
        }
        lines
    }

    fn gather(&mut self, text: &Text<'_>, states: &RawValue, around: &str) {
        for (name, raw) in entries(states).into_iter().flatten() {
            let path = format!("{around}{name}");
            let mut members = entries(raw).unwrap_or_default();
            let transitions = members.get("transitions");
            let transitions = transitions.and_then(|raw| serde_json::from_str(raw.get()).ok());
            let transitions: Vec<&RawValue> = transitions.unwrap_or_default();
            let transitions = transitions.iter().map(|raw| text.line(raw)).collect();
            let inner = members.remove("states");
            if let Some(inner) = inner {
                self.gather(text, inner, &format!("{path}/"));
            }
            self.states.insert(path, (text.line(raw), transitions));
        }
    }

    /// The line of a state; 0 if it is unknown.
    pub(super) fn state(&self, path: &str) -> usize {
        self.states.get(path).map_or(0, |(line, _)| *line)
    }

    /// The line of a state's transition; 0 if it is unknown.
    pub(super) fn transition(&self, path: &str, number: usize) -> usize {
        let found = self
            .states
            .get(path)
            .and_then(|(_, lines)| lines.get(number));
        found.copied().unwrap_or(0)
    }

    /// The line of a mood; 0 if it is unknown.
    pub(super) fn mood(&self, name: &str) -> usize {
        self.moods.get(name).copied().unwrap_or(0)
    }

    /// The line of the brain's `start`; 0 if it is unknown.
    pub(super) fn start(&self) -> usize {
        self.start
    }
}

/// The path of the innermost state whose text includes a line, such as `calm/idle`.
pub(super) fn state_on(text: &str, line: usize) -> Option<String> {
    let text = Text::new(text);
    let mut path: Vec<String> = Vec::new();
    let mut raw = text.raw()?;
    while let Some(states) = entries(raw).and_then(|mut entries| entries.remove("states")) {
        let around = entries(states)?.into_iter().find(|(_, state)| {
            let start = text.offset(state);
            (text.line_at(start)..=text.line_at(start + state.get().len())).contains(&line)
        });
        let Some((name, state)) = around else { break };
        path.push(name);
        raw = state;
    }
    (!path.is_empty()).then(|| path.join("/"))
}

/// A text with the offsets of its line ends.
struct Text<'a> {
    text: &'a str,
    ends: Vec<usize>,
}

impl<'a> Text<'a> {
    fn new(text: &'a str) -> Self {
        let bytes = text.bytes().enumerate();
        let ends = bytes.filter(|(_, byte)| *byte == b'\n').map(|(at, _)| at);
        let ends = ends.collect();
        Self { text, ends }
    }

    fn raw(&self) -> Option<&'a RawValue> {
        serde_json::from_str(self.text).ok()
    }

    /// The byte offset of a part of the text.
    fn offset(&self, part: &RawValue) -> usize {
        // `part` borrows from the text, so its address lies within the text.
        (part.get().as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize)
    }

    /// The line, from 1, of a part of the text.
    fn line(&self, part: &RawValue) -> usize {
        self.line_at(self.offset(part))
    }

    fn line_at(&self, offset: usize) -> usize {
        self.ends.partition_point(|end| *end < offset) + 1
    }
}

fn entries(raw: &RawValue) -> Option<BTreeMap<String, &RawValue>> {
    serde_json::from_str(raw.get()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file whose states, transitions and start are on known lines.
    const TEXT: &str = "{\n \"start\": \"a\",\n \"states\": {\n  \"a\": {\n   \"transitions\": [\n    {\"to\": \"b\"},\n    {\"to\": \"c\"}]},\n  \"b\": {}}}";

    #[test]
    fn places_are_found() {
        let lines = Lines::of(TEXT);
        assert_eq!(lines.transition("a", 1), 7);
        assert_eq!(
            (lines.state("a"), lines.state("b"), lines.start()),
            (4, 8, 2)
        );
        assert_eq!(
            (lines.state("c"), lines.transition("a", 2), lines.mood("m")),
            (0, 0, 0)
        );
        assert_eq!(state_on(TEXT, 6).as_deref(), Some("a"));
        assert_eq!(state_on(TEXT, 2), None);
    }
}
