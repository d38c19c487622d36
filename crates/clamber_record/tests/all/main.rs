//! Recordings: what is written is read back, by this crate and by others.

mod arena;
mod battle;
mod damage;
mod elsewhere;
mod figure;
mod hostile;
mod python;
