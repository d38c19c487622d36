//! Proposes a brain's file for a creature, as text for its author to edit.

use std::fmt;

use clamber_colossus::BrainFile;
use clamber_surface::mesh::Rig;
use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};

use super::{InspectError, InspectOptions};

/// Largest width of a line, columns, except where a value cannot be broken. Wide lines keep a file within the 40 lines
/// that `tests/commands.rs` allows.
const WIDTH: usize = 175;

/// The text of a brain's file that fits the creature.
pub(super) fn text(rig: &Rig, options: &InspectOptions) -> Result<String, InspectError> {
    let in_words = |error: &dyn fmt::Display| InspectError::Propose {
        file: options.file.clone(),
        error: error.to_string(),
    };
    let file = BrainFile::propose(rig, options.height).map_err(|error| in_words(&error))?;
    let json = serde_json::to_string(&file).map_err(|error| in_words(&error))?;
    let tree: Tree = serde_json::from_str(&json).map_err(|error| in_words(&error))?;
    let mut text = String::new();
    tree.write("", 0, 0, 0, &mut text);
    text.push('\n');
    Ok(text)
}

/// The entries of a list or an object. A key includes its quotes and colon; it is empty in a list.
type Entries<'a> = Vec<(String, &'a Tree)>;

/// JSON that keeps the order of its keys.
enum Tree {
    /// A number, a string, a boolean or null, as JSON writes it.
    Leaf(String),
    List(Vec<Tree>),
    Object(Vec<(String, Tree)>),
}

impl Tree {
    /// The value as one line.
    fn line(&self) -> String {
        match self {
            Self::Leaf(text) => text.clone(),
            Self::List(items) => {
                let items: Vec<String> = items.iter().map(Self::line).collect();
                format!("[{}]", items.join(", "))
            }
            Self::Object(entries) if entries.is_empty() => "{}".to_owned(),
            Self::Object(entries) => {
                let entries = entries.iter();
                let entries = entries.map(|(key, value)| format!("{key}: {}", value.line()));
                format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
            }
        }
    }

    /// Appends the value to `text`, broken into lines where one line would exceed [`WIDTH`]. The value begins at column
    /// `before`, and its last line leaves room for `after` more characters.
    fn write(&self, name: &str, indent: usize, before: usize, after: usize, text: &mut String) {
        let line = self.line();
        let (open, close, items) = match self.items() {
            Some(items) if before + line.chars().count() + after > WIDTH => items,
            _ => {
                text.push_str(&line);
                return;
            }
        };
        // The entries of an object, or of a list with one item, begin on the line of the bracket. The entries of a
        // longer list, of the whole file, of `body` and of `states` begin on a new line. Short entries share a line,
        // except that each main part of the file and each state has its own.
        let hugs = !matches!(name, "" | "\"body\": " | "\"states\": ")
            && (open == '{' || items.len() == 1);
        let is_alone = matches!(name, "" | "\"states\": ");
        let is_object = open == '{';
        let inner = if hugs { indent } else { indent + 2 };
        text.push(open);
        let mut column = if hugs { before + 1 } else { WIDTH };
        let last = items.len() - 1;
        for (index, (key, value)) in items.iter().enumerate() {
            let key_length = key.chars().count();
            let length = key_length + value.line().chars().count();
            let space = usize::from(is_object || index > 0);
            let end = match (index < last, hugs) {
                (true, _) => 1,
                (false, true) => after + 2,
                (false, false) => 0,
            };
            let fits = !is_alone && column + space + length + end <= WIDTH;
            let opens = value.items().is_some() && column + space + key_length + 1 < WIDTH;
            if fits || hugs && opens {
                text.push_str(&" ".repeat(space));
                column += space;
            } else {
                text.push('\n');
                text.push_str(&" ".repeat(indent + 2));
                column = indent + 2;
            }
            text.push_str(key);
            let start = text.len();
            // An empty name stands for the whole file, so an item of a list gets another name.
            let name = if key.is_empty() { "[" } else { key };
            value.write(name, inner, column + key_length, end, text);
            column = match text[start..].rfind('\n') {
                Some(line) => text[start + line + 1..].chars().count(),
                None => column + length,
            };
            if index < last {
                text.push(',');
                column += 1;
            }
        }
        if hugs {
            text.push_str(if is_object { " " } else { "" });
        } else {
            text.push('\n');
            text.push_str(&" ".repeat(indent));
        }
        text.push(close);
    }

    /// The brackets and the entries of a list or an object; `None` for a leaf and for an empty one.
    fn items(&self) -> Option<(char, char, Entries<'_>)> {
        match self {
            Self::List(items) if !items.is_empty() => {
                let items = items.iter().map(|item| (String::new(), item));
                Some(('[', ']', items.collect()))
            }
            Self::Object(entries) if !entries.is_empty() => {
                let entries = entries.iter();
                let entries = entries.map(|(key, value)| (format!("{key}: "), value));
                Some(('{', '}', entries.collect()))
            }
            _ => None,
        }
    }
}

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

struct Reader;

impl<'de> Visitor<'de> for Reader {
    type Value = Tree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Tree, E> {
        Ok(Tree::Leaf(value.to_string()))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Tree, E> {
        Ok(Tree::Leaf(value.to_string()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Tree, E> {
        Ok(Tree::Leaf(value.to_string()))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Tree, E> {
        Ok(Tree::Leaf(value.to_string()))
    }

    fn visit_unit<E>(self) -> Result<Tree, E> {
        Ok(Tree::Leaf("null".to_owned()))
    }

    fn visit_str<E>(self, value: &str) -> Result<Tree, E> {
        Ok(Tree::Leaf(serde_json::Value::from(value).to_string()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Tree, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            list.push(item);
        }
        Ok(Tree::List(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Tree, A::Error> {
        let mut object = Vec::new();
        while let Some((key, value)) = entries.next_entry::<String, Tree>()? {
            object.push((serde_json::Value::from(key).to_string(), value));
        }
        Ok(Tree::Object(object))
    }
}
