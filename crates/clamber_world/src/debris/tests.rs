//! Debris on creatures whose skin is known in closed form, so that nothing of the library judges itself.

mod bookkeeping;
mod riding;
mod scene;
mod stamping;
mod sweeping;
