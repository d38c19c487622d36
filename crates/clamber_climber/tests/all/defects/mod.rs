//! Regression tests for defects that a player would notice, here or in other games: one test each.

mod blows;
mod common;
mod contacts;
mod corrections;
mod crushing;
mod errors;
mod frames;
mod grips;
mod impacts;
mod landings;
mod ledges;
mod modes;
mod reach;
mod room;
mod slopes;
mod supports;
mod sweeps;
mod twice;
