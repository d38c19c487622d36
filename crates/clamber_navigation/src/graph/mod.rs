//! The graph: patches, and the ways between them.

mod entries;
mod flood;
mod leaps;
mod locate;
mod patch;
mod spot;
mod ways;

use std::ops::ControlFlow;

use clamber_surface::mesh::{Rig, TriangleId};
use clamber_surface::surface::SkinnedSurface;

use crate::clips::ClipFacts;
use crate::progress::Tell;
use crate::survey::Survey;
use crate::{GraphConfig, NavigationError, Progress, Start};

pub use entries::Entry;
pub(crate) use entries::highest_entry;
pub use flood::Footing;
pub(crate) use flood::Reachable;
pub(crate) use leaps::{Aim, Leap, Leaps};
use locate::Locator;
pub use patch::Patch;
pub(crate) use patch::{NO_PATCH, axes, corners};
pub(crate) use spot::{Spot, spot_on};
pub(crate) use ways::{Corner, Ways};

/// The places where a climber can be on a creature, and the ways between them.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "cache", derive(serde::Serialize, serde::Deserialize))]
pub struct ClimbGraph {
    pub(crate) config: GraphConfig,
    pub(crate) patches: Vec<Patch>,
    pub(crate) ways: Ways,
    pub(crate) leaps: Leaps,
    pub(crate) entries: Vec<Entry>,
    pub(crate) clips: ClipFacts,
    pub(crate) locator: Locator,
}

impl ClimbGraph {
    /// Builds the graph of a creature.
    ///
    /// `progress` is called repeatedly. If it returns [`ControlFlow::Break`], the build is cancelled.
    ///
    /// # Errors
    /// [`NavigationError`] if a number of the configuration is out of its range, if a plate has a triangle that the
    /// skin does not have, if the creature has no skin or cannot be posed, if it has too many patches or too long
    /// clips, and if the caller cancels.
    pub fn build(
        rig: &Rig,
        config: &GraphConfig,
        mut progress: impl FnMut(Progress) -> ControlFlow<()>,
    ) -> Result<Self, NavigationError> {
        let mut tell = Tell(&mut progress);
        let survey = Survey::new(rig, config, &mut tell)?;
        Ok(Self::of_survey(&survey, rig, &mut tell)?.0)
    }

    /// Builds the graph of a survey. Also returns the patch of each piece.
    pub(crate) fn of_survey(
        survey: &Survey,
        rig: &Rig,
        tell: &mut Tell<'_>,
    ) -> Result<(Self, Vec<u32>), NavigationError> {
        let (patches, patch_of) = patch::merge(survey);
        let clips = ClipFacts::measure(rig, &survey.config, &patches, tell)?;
        let mut graph = Self {
            config: survey.config.clone(),
            ways: patch::ways(survey, &patches, &patch_of),
            leaps: Leaps::default(),
            entries: entries::entries(survey, &patches, &patch_of),
            locator: Locator::new(survey, &patch_of, &rig.collider),
            clips,
            patches,
        };
        graph.leaps = Leaps::find(&graph, rig, tell)?;
        Ok((graph, patch_of))
    }

    /// The patches: the places on the skin where a climber can be. Other items refer to a patch by its index in this
    /// list.
    pub fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// The patches onto which a climber gets from the ground by hand or by a jump, with the creature at rest. Left out
    /// are patches on which a climber can only hold on, if a jump passes them faster than hands catch
    /// ([`GripConfig::catch_speed`](clamber_climber::GripConfig::catch_speed)).
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The starts of plans for a climber that leaves the ground with some stamina, 0 to 1. Each entry gives one start
    /// that stands, with all of this stamina, and one that holds on, with what is left after the catch at the end of
    /// the jump ([`StaminaConfig::catch_cost`](clamber_climber::StaminaConfig::catch_cost)). Holds that hands do not
    /// catch are left out: the jump passes them too fast, or stamina does not suffice. [`ClimbGraph::plan`] ignores
    /// starts with a footing that their patch does not allow.
    pub fn starts_on_ground(&self, stamina: f64) -> impl Iterator<Item = Start> + '_ {
        let climber = &self.config.climber;
        let walks = climber.ground.walk_speed;
        let catch_cost = climber.stamina.map_or(0.0, |costs| costs.catch_cost);
        self.entries.iter().flat_map(move |entry| {
            let start = |footing, stamina| Start {
                patch: entry.patch,
                footing,
                seconds: 0.0,
                stamina,
            };
            let left = stamina - catch_cost * (entry.speed - walks).max(0.0);
            let catches = left >= 0.0 && entry.is_caught(climber);
            let stands = Some(start(Footing::Stands, stamina));
            let holds = catches.then(|| start(Footing::Holds, left));
            stands.into_iter().chain(holds)
        })
    }

    /// Index in [`ClimbGraph::patches`] of the patch that a point of the skin belongs to; `None` where a climber can
    /// neither stand nor hold on at rest.
    pub fn patch_of(&self, triangle: TriangleId, barycentric: [f32; 3]) -> Option<usize> {
        let (patch, is_on_it) = self.locator.find(triangle, barycentric)?;
        is_on_it.then_some(patch)
    }

    /// Index in [`ClimbGraph::patches`] of the patch that a point of the skin belongs to, or else of the nearest one at
    /// rest; `None` if no patch is within five radii of the climber.
    pub fn patch_near(&self, triangle: TriangleId, barycentric: [f32; 3]) -> Option<usize> {
        Some(self.locator.find(triangle, barycentric)?.0)
    }

    /// True if a climber finds a patch on the skin in its present state: the patch's own triangle is enabled, and no
    /// plate covers the patch. A plate ([`Patch::below`]) covers it until its triangles are disabled. False if the
    /// graph has no such patch.
    pub fn is_there(&self, patch: usize, surface: &SkinnedSurface) -> bool {
        self.patches.get(patch).is_some_and(|patch| {
            // One triangle of a plate tells whether it is removed.
            let plate = patch.below.and_then(|plate| {
                let plate = self.config.plates.get(usize::from(plate))?;
                plate.first()
            });
            surface.is_enabled(patch.triangle)
                && plate.is_none_or(|triangle| !surface.is_enabled(*triangle))
        })
    }

    /// For each patch, whether a climber that does not tire reaches it from the ground, on the creature at rest.
    pub fn reachable(&self) -> Vec<bool> {
        let reached = self.flood(self.entries.iter().map(|entry| entry.patch));
        (0..self.patches.len())
            .map(|patch| reached.has(patch))
            .collect()
    }

    /// For each patch, whether a climber reaches it that has this stamina, 0 to 1, when it leaves the ground. The
    /// creature is at rest. Wherever the climber can stand, it rests until its stamina is full, whatever it began with.
    /// It cannot rest if [`StaminaConfig::refill`](clamber_climber::StaminaConfig::refill) is 0.
    pub fn reachable_with(&self, stamina: f64) -> Vec<bool> {
        self.strength(self.starts_on_ground(stamina))
            .chunks_exact(2)
            .map(|footings| footings.iter().any(|left| *left >= 0.0))
            .collect()
    }

    /// Number of ways between patches; each counts twice, once per direction.
    pub fn ways(&self) -> usize {
        self.ways.len()
    }

    /// Number of jumps from one part of the creature to another that land at rest. A plan uses a jump only in clips in
    /// which it lands whenever it begins.
    pub fn jumps(&self) -> usize {
        self.leaps.len()
    }

    /// The settings that the graph was built with.
    pub fn config(&self) -> &GraphConfig {
        &self.config
    }
}
