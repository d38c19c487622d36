#![doc = include_str!("guide/start.md")]
// `include_str!` drops the blank lines at a page's ends, which Markdown needs around a picture and a table.
#![doc = ""]
#![doc = include_str!("guide/modes.svg")]
#![doc = ""]
#![doc = include_str!("guide/modes.md")]
#![doc = ""]
#![doc = include_str!("guide/details.md")]
#![cfg_attr(feature = "serde", doc = "")]
#![cfg_attr(feature = "serde", doc = include_str!("guide/saving.md"))]

/// The items that the pages link to.
#[cfg(doc)]
use crate::*;
