//! The limbs that threw a bot off.

use clamber_surface::rig::JointId;

use super::{BotConfig, View};
use crate::ClimbGraph;

/// Time for which a limb is avoided, seconds.
const LIMB_AVOIDED_TIME: f64 = 60.0;

/// A look at most this long ago, seconds, counts as the tick before.
const LAST_TICK_AGE: f64 = 0.1;

/// The limbs that threw the bot off lately. Its plans go round them where possible.
#[derive(Clone, Debug, Default)]
pub(super) struct Limbs {
    /// The limbs' joints, each with the time until which it is avoided, seconds.
    avoided: Vec<(JointId, f64)>,
    /// The limb on which the bot was last shaken, and when.
    shaken_on: Option<(JointId, f64)>,
}

impl Limbs {
    /// Updates the list: a limb that has thrown the bot off is avoided.
    pub(super) fn watch(&mut self, config: &BotConfig, view: &View<'_>) {
        // `seconds` may have been set back, as in a new fight.
        self.avoided.retain(|(_, until)| {
            let left = until - view.seconds;
            left > 0.0 && left <= LIMB_AVOIDED_TIME
        });
        let before = self.shaken_on.take();
        let state = view.climber.state();
        if let Some((triangle, _)) = view.material() {
            let throws = view.climber.config().ground.throw_acceleration;
            let is_shaken = state.shake.length() > config.stands_in * throws;
            let limb = view.surface.mesh().joint_of(triangle);
            self.shaken_on = limb.filter(|_| is_shaken).map(|limb| (limb, view.seconds));
        } else if let Some((limb, since)) = before
            && view.seconds - since <= LAST_TICK_AGE
        {
            self.avoided.retain(|(other, _)| *other != limb);
            self.avoided.push((limb, view.seconds + LIMB_AVOIDED_TIME));
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.avoided.is_empty()
    }

    /// True if a way leads onto an avoided limb from elsewhere.
    pub(super) fn lead_onto(
        &self,
        graph: &ClimbGraph,
        view: &View<'_>,
        [from, to]: [usize; 2],
    ) -> bool {
        let [from, to] = [from, to].map(|patch| self.has(graph, view, patch));
        to && !from
    }

    /// True if a patch is on an avoided limb.
    pub(super) fn has(&self, graph: &ClimbGraph, view: &View<'_>, patch: usize) -> bool {
        let triangle = graph.patches().get(patch).map(|patch| patch.triangle);
        let limb = triangle.and_then(|triangle| view.surface.mesh().joint_of(triangle));
        limb.is_some_and(|limb| self.avoided.iter().any(|(other, _)| *other == limb))
    }
}
