//! Kinds of events.

use clamber_climber::ClimberEvent;

/// The number of events of a kind.
pub(crate) fn count(events: &[ClimberEvent], is_counted: impl Fn(&ClimberEvent) -> bool) -> usize {
    events.iter().filter(|event| is_counted(event)).count()
}

pub(crate) fn is_lost_footing(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::LostFooting { .. })
}

pub(crate) fn is_landed(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::Landed { .. })
}

/// True if the climber gripped a hold, caught a ledge or landed.
pub(crate) fn is_attached(event: &ClimberEvent) -> bool {
    is_landed(event) || is_grabbed(event) || is_caught(event)
}

pub(crate) fn is_crushed(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::Crushed { .. })
}

pub(crate) fn is_hurt(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::Hurt { .. })
}

pub(crate) fn is_tumbled(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::Tumbled { .. })
}

pub(crate) fn is_caught(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::LedgeCaught { .. })
}

pub(crate) fn is_grabbed(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::Grabbed { .. })
}

pub(crate) fn is_turned_corner(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::TurnedCorner { .. })
}

pub(crate) fn is_moved_twice(event: &ClimberEvent) -> bool {
    matches!(event, ClimberEvent::SkippedTicks { .. })
}
