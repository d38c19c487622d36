//! The modes of the example `modes`.

#[path = "../../examples/modes/dash.rs"]
pub(crate) mod dash;
#[path = "../../examples/modes/swim.rs"]
pub(crate) mod swim;
#[path = "../../examples/modes/vault.rs"]
pub(crate) mod vault;
#[path = "../../examples/modes/wall_run.rs"]
pub(crate) mod wall_run;
