use clamber_world::{Contact, Obstacle, ObstacleId};

/// Accepts or rejects a contact with an obstacle. It must be a pure function during a tick: the mover calls it any
/// number of times and in any order, with contacts at any time of the tick.
pub type ContactFilter<'a> = dyn Fn(ObstacleId, &dyn Obstacle, &Contact) -> bool + 'a;

/// The filters of a body's contacts, for [`Mover::with_filters`](crate::Mover::with_filters). Without a filter, all
/// contacts are accepted, at no cost.
#[derive(Clone, Copy, Default)]
pub struct ContactFilters<'a> {
    /// Accepts contacts that block a body. All queries and movements ignore the others, as if they were not there.
    pub solid: Option<&'a ContactFilter<'a>>,
    /// Accepts contacts that can hold a body up. The others are not ground, however level they are.
    pub ground: Option<&'a ContactFilter<'a>>,
    /// Accepts contacts onto which a body may climb by walking: steps, slopes, and edges that it rolls over. The others
    /// block a walk like vertical walls.
    pub step: Option<&'a ContactFilter<'a>>,
}

/// True if there is no filter, or if it accepts the contact.
pub(crate) fn accepts(
    filter: Option<&ContactFilter<'_>>,
    id: ObstacleId,
    obstacle: &dyn Obstacle,
    contact: &Contact,
) -> bool {
    filter.is_none_or(|filter| filter(id, obstacle, contact))
}
