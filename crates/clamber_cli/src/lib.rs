#![doc = include_str!("../README.md")]

pub mod climbability;
pub mod compare;
pub mod inspect;
mod progress;
