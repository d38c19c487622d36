//! Debris on creatures whose skin is known in closed form, so that nothing of the library judges itself.

mod bookkeeping;
mod outside;
mod riding;
mod scene;
mod several;
mod stamping;
mod sweeping;
