#![doc = include_str!("guide/start.md")]
// Pages lose the empty lines at their ends, which Markdown asks for about a picture and a table.
#![doc = ""]
#![doc = include_str!("guide/modes.svg")]
#![doc = ""]
#![doc = include_str!("guide/modes.md")]
#![doc = ""]
#![doc = include_str!("guide/details.md")]

/// What the pages link to.
#[cfg(doc)]
use crate::*;
