use clamber_climber::{Climber, ClimberMode};
use clamber_colossus::{Person, Riding};
use clamber_world::ObstacleId;

/// A climber as a creature senses it. `creature` is the creature's obstacle id.
pub fn person(climber: &Climber, id: u64, creature: ObstacleId) -> Person {
    let state = climber.state();
    let support = state
        .support
        .filter(|support| support.attachment.obstacle == creature);
    Person {
        id,
        body: climber.body(),
        riding: support.map(|support| Riding {
            at: support.attachment.material,
            hangs: state.mode == ClimberMode::Hanging,
        }),
    }
}
