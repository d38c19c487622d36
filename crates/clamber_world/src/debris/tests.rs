//! Debris on creatures whose skin is known in closed form, so that the library is not checked against itself.

mod appearing;
mod bookkeeping;
mod enclosed;
mod folding;
mod outside;
mod riding;
mod scene;
mod several;
mod stamping;
mod sweeping;
