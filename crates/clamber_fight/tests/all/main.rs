//! Fights, seen from outside: weapons, rooms, snapshots, and what must not happen.

mod afar;
mod aims;
mod arrows;
mod behind;
mod debris;
mod fair;
mod joining;
mod moving;
mod orders;
mod people;
#[cfg(feature = "ggrs")]
mod rollback;
mod room;
mod snapshots;
mod stab;
mod support;
mod terrain;
mod wild;
