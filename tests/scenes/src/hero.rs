//! The project's hero as the body of a battle's climber.

mod arms;

use std::path::PathBuf;

use arms::Arms;
use clamber_body::clamber_animation::AnimationError;
use clamber_body::clamber_animation::ik::IkError;
use clamber_body::{Body, BodyError, BodyFrame, Figure, FigureError, Humanoid, HumanoidError};
use clamber_fight::ArenaEvent;
use clamber_gltf::{GltfError, Model};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::{Palette, Pose, RigError, Skeleton};
use glam::DVec3;
use thiserror::Error;

use crate::battle::Battle;

/// A humanoid that is posed for each tick of a battle.
#[derive(Clone, Debug)]
pub struct Hero {
    figure: Figure,
    body: Body,
    /// The body's pose with its hands at its weapons.
    pose: Pose,
    palette: Palette,
    arms: Option<Arms>,
}

/// Why there is no hero.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HeroError {
    /// Its file cannot be loaded.
    #[error(transparent)]
    Load(#[from] GltfError),
    /// Its skeleton is no humanoid.
    #[error(transparent)]
    Humanoid(#[from] HumanoidError),
    /// Its clips do not fit.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// Its body cannot be posed.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// Its body cannot be posed.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// The clips of its weapons cannot be played.
    #[error(transparent)]
    Animation(#[from] AnimationError),
    /// Its hands cannot be brought to its weapons.
    #[error(transparent)]
    Ik(#[from] IkError),
}

/// Path of the hero's file.
pub fn hero_path() -> PathBuf {
    PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../assets/hero.glb"
    ))
}

impl Hero {
    /// A hero from a file's rig.
    ///
    /// # Errors
    /// [`HeroError`].
    pub fn new(model: Model) -> Result<Self, HeroError> {
        let humanoid = Humanoid::find(&model.rig.skeleton)?;
        let figure = Figure::new(model.rig.skeleton, humanoid, model.rig.clips)?;
        let body = Body::new(&figure);
        Ok(Self {
            palette: figure.skeleton().palette(body.pose())?,
            pose: body.pose().clone(),
            body,
            figure,
            arms: None,
        })
    }

    /// Shows what it does with its weapons. Without it, the sword stays in its sheath and the bow on its back.
    #[must_use]
    pub fn with_arms(mut self) -> Self {
        self.arms = Some(Arms::new(&self.figure));
        self
    }

    /// The hero of the project's file.
    ///
    /// # Errors
    /// [`HeroError`].
    pub fn load() -> Result<Self, HeroError> {
        Self::new(clamber_gltf::load(hero_path())?)
    }

    /// Poses the hero for the battle's current tick, `dt` seconds after the last one that it was posed for.
    ///
    /// # Errors
    /// [`HeroError`].
    pub fn watch(&mut self, battle: &Battle<'_>, dt: f64) -> Result<(), HeroError> {
        let surface = battle.surface();
        let head = battle.creature().skeleton.find("head");
        let head = head.and_then(|head| battle.palette().model_from_joint(head));
        let look_at = head.map(|head| {
            let root = surface.world_from_model();
            root.transform_point(head.translation)
        });
        let fighter = battle.performer().fighter();
        if let (Some(arms), Some(fighter)) = (&mut self.arms, fighter) {
            let shot = |event: &ArenaEvent| matches!(event, ArenaEvent::Shot { .. });
            let has_shot = battle
                .arena()
                .is_some_and(|arena| arena.events().iter().any(shot));
            let aim = (battle.input().aim, has_shot);
            arms.play(&self.figure, &mut self.body, fighter, aim, dt)?;
        }
        battle.touched(|obstacles| {
            let frame = BodyFrame {
                look_at,
                ..BodyFrame::new(battle.climber(), obstacles)
            };
            self.body.update(&self.figure, &frame, dt)
        })?;
        self.pose.clone_from(self.body.pose());
        if let (Some(arms), Some(fighter)) = (&mut self.arms, fighter) {
            let root = self.body.world_from_model();
            arms.reach(&self.figure, &mut self.pose, &root, fighter, dt)?;
        }
        self.palette = self.figure.skeleton().palette(&self.pose)?;
        Ok(())
    }

    /// The grip and the tip of the sword in its hand, in world space; `None` while it is in its sheath, and without
    /// [arms](Hero::with_arms).
    pub fn sword(&self) -> Option<[DVec3; 2]> {
        let arms = self.arms.as_ref()?;
        let ends = arms.sword(self.figure.skeleton(), &self.pose)?;
        let root = self.world_from_model();
        Some(ends.map(|end| root.transform_point(end)))
    }

    /// Its skeleton.
    pub fn skeleton(&self) -> &Skeleton {
        self.figure.skeleton()
    }

    /// Its pose: the rest pose until it is [watched](Hero::watch).
    pub fn palette(&self) -> &Palette {
        &self.palette
    }

    /// Where it is drawn.
    pub fn world_from_model(&self) -> Similarity {
        self.body.world_from_model()
    }
}
