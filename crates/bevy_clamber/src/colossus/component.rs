use bevy_asset::Handle;
use bevy_ecs::prelude::*;
use clamber_colossus::{Creature, CreatureState};
use clamber_world::Obstacle;
use glam::DVec3;

use super::ColossusBrain;

/// A creature that lives: insert it on the root of a rig that [`RigAssets::spawn`](crate::RigAssets::spawn) spawned,
/// beside its [`RigJoints`](crate::RigJoints), and a [`SkinnedCollider::each_tick`](crate::SkinnedCollider::each_tick)
/// on its meshes.
///
/// Once the brain is loaded, [`ColossusPlugin`](super::ColossusPlugin) inserts a [`ColossusBody`], and from then on
/// writes the `Transform`s of root and joints in every tick: the creature begins where the root is, looks along the
/// root's +Z, and is as large as the root's scale makes it. It senses all climbers, and strikes them. Where its file is
/// changed while the app runs, with Bevy's `file_watcher`, it lives by the new one from the next tick on: it stays in
/// its state if the states are still the same ones, or else begins anew where it stands.
///
/// ```
/// # use bevy_asset::AssetServer;
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// use bevy_clamber::prelude::*;
///
/// #[derive(Resource)]
/// struct Giant(RigAssets);
///
/// fn spawn(mut commands: Commands, giant: Res<Giant>, assets: Res<AssetServer>) {
///     let rig = giant.0.spawn(&mut commands, Transform::IDENTITY);
///     for mesh in rig.meshes {
///         commands.entity(mesh).insert(SkinnedCollider::each_tick());
///     }
///     commands.entity(rig.root).insert(Colossus::new(assets.load("colossus.brain.json")));
/// }
/// # let _ = spawn;
/// ```
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Colossus {
    /// The creature's brain.
    pub brain: Handle<ColossusBrain>,
    /// Seed of its random numbers.
    pub seed: u64,
    /// Radius of the arena around the place where the creature began, metres; 100 by [`Colossus::new`]. The creature
    /// does not walk out of it.
    pub arena: f64,
    /// Steepest ground that it walks onto, radians.
    pub most_slope: f64,
    /// Largest horizontal distance at which the creature sees a person, metres, from the model's origin to the middle
    /// of the person; 150 by [`Colossus::new`]. It sees only people within 103 degrees of its heading to either side,
    /// and none behind terrain. People closer than half its width it notices wherever they are.
    pub sight: f64,
}

impl Colossus {
    /// A creature with a brain, and with the arena, slopes and sight of
    /// [`CreatureConfig`](clamber_colossus::CreatureConfig)'s default.
    pub fn new(brain: Handle<ColossusBrain>) -> Self {
        let config = clamber_colossus::CreatureConfig::default();
        Self {
            brain,
            seed: config.seed,
            arena: config.arena,
            most_slope: config.most_slope,
            sight: config.sight,
        }
    }
}

/// A [`Colossus`] that lives, as of the last tick.
#[derive(Component, Clone, Debug)]
pub struct ColossusBody {
    pub(super) creature: Creature,
}

impl ColossusBody {
    /// The creature: its state, senses, kind and report.
    pub fn creature(&self) -> &Creature {
        &self.creature
    }

    /// The name of the state that it is in, with those around it, such as `alert/hunt`.
    pub fn state(&self) -> &str {
        let brain = self.creature.kind().brain();
        brain.path(self.creature.state().current())
    }

    /// An arrow or a blade strikes it at a place in world space, which is Bevy's plus
    /// [`WorldOrigin`](crate::WorldOrigin). Returns the damage done, which is 0 unless an open weak point is there. It
    /// feels the blow in any case.
    ///
    /// `reach` is how far from its skin the place may be, metres; beyond it nothing happens.
    pub fn strike(&mut self, place: DVec3, damage: f64, reach: f64) -> f64 {
        let near = self.creature.surface().closest_point(place, reach);
        near.map_or(0.0, |near| {
            self.creature.hurt(&near.material, place, damage)
        })
    }

    /// Sets one of the game's own senses, by its name in the brain's file. Returns false and changes nothing if there
    /// is no such sense, or if the value is not finite.
    pub fn set_sense(&mut self, name: &str, value: f64) -> bool {
        self.creature.set_sense(name, value)
    }

    /// Goes back to a state that was saved from [`ColossusBody::creature`].
    ///
    /// # Errors
    /// As [`Creature::restore`].
    pub fn restore(&mut self, state: CreatureState) -> Result<(), clamber_colossus::ColossusError> {
        self.creature.restore(state)
    }
}
