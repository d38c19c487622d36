//! Impulses of a climber on rapier's bodies: its weight, its momentum, and pushes of limited force.

mod carts;
mod hanging;
mod hitting;
mod ice;
mod light;
mod running;
mod scene;
mod weighing;
