//! Climbers as obstacles to each other: they part, ride, land on and follow each other.

mod carrying;
mod circles;
mod crowd;
mod landing;
mod parting;
mod pushing;
mod riding;
mod room;
mod weight;
