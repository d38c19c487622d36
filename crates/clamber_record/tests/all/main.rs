//! Recordings are read back, by this crate and by other programs.

mod arena;
mod battle;
mod damage;
mod elsewhere;
mod figure;
mod hostile;
mod python;
mod stage;
