//! Messages from which a recording is replayed.

use clamber_climber::StepReport;
use glam::DVec3;
use prost::bytes::Bytes;

use super::{Input, Mirror, State, Struck, Vector, message};

message! {
    /// A summary of the step's report.
    Report {
        pushed_out: Vector (message, required, tag = 1),
        penetration: f64 (double, required, tag = 2),
        rounds: u32 (uint32, tag = 3),
        is_clear: bool (bool, tag = 4),
        /// Sum of the impulses of all pushes, newton seconds.
        impulse: Vector (message, required, tag = 5),
        /// Number of pushes.
        pushes: u32 (uint32, tag = 6),
    }
}

message! {
    /// One tick of a climber.
    Tick {
        tick: u64 (uint64, tag = 1),
        input: Input (message, required, tag = 2),
        state: State (message, required, tag = 3),
        report: Report (message, required, tag = 4),
        state_fingerprint: u64 (uint64, tag = 5),
        palette_fingerprint: u64 (uint64, tag = 6),
        scene_fingerprint: u64 (uint64, tag = 7),
        knockback: Option<Struck> (message, optional, tag = 8),
    }
}

message! {
    /// One tick of an arena.
    ArenaTick {
        tick: u64 (uint64, tag = 1),
        /// One input for each fighter; empty before the first step.
        inputs: Vec<Input> (message, repeated, tag = 2),
        /// Fingerprints of the creatures, of the fighters, and of the rest, in this order.
        parts: Vec<u64> (uint64, repeated, tag = 3),
        /// Numbers of the creatures.
        creatures: Vec<u32> (uint32, repeated, tag = 4),
        /// Numbers of the fighters.
        fighters: Vec<u32> (uint32, repeated, tag = 5),
        /// The orders of the step, as `Order::to_bytes` writes them; empty if there are none.
        orders: Bytes (bytes = "bytes", tag = 6),
    }
}

message! {
    /// A state from which a run can resume after a tick: the text of a climber's scene, or the bytes of an arena.
    Saved {
        tick: u64 (uint64, tag = 1),
        state: Bytes (bytes = "bytes", tag = 2),
    }
}

impl From<&StepReport> for Report {
    fn from(report: &StepReport) -> Self {
        let impulse: DVec3 = report.pushes.iter().map(|push| push.impulse).sum();
        Self {
            pushed_out: Vector::of(&report.pushed_out),
            penetration: report.penetration,
            rounds: report.rounds,
            is_clear: report.is_clear,
            impulse: Vector::of(&impulse),
            pushes: u32::try_from(report.pushes.len()).unwrap_or(u32::MAX),
        }
    }
}
