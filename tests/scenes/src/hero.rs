//! The project's hero as the body of a battle's climber.

use std::path::PathBuf;

use clamber_body::clamber_animation::{AnimationSet, Layer};
use clamber_body::{Body, BodyInput, Figure, Humanoid, OverlayClip};
use clamber_fight::{ArenaEvent, Fighter, WeaponAction};
use clamber_surface::geometry::Similarity;
use clamber_surface::mesh::Rig;
use clamber_surface::rig::{Palette, Pose, Skeleton};
use glam::Vec3;

use crate::battle::{Battle, SceneError};
use crate::giant;

/// The time at which the clip `stab_strike` hits, seconds: its marker `hit`.
const HIT: f64 = 0.2;

/// Share of a full draw at which the clip `draw` is over and `aim` begins.
const NOCKED: f64 = 0.6;

/// Lengths of fades to the clips `stab_strike` and `loose`, to other clips of weapons, and to none, seconds.
const FADES: [f64; 3] = [0.06, 0.14, 0.3];

/// A humanoid that is posed for each tick of a battle. In a fight it shows its sword and its bow.
#[derive(Clone, Debug)]
pub struct Hero {
    figure: Figure,
    body: Body,
    palette: Palette,
    /// The clip of its weapons that is played, and which hands play it.
    shown: Option<(&'static str, [bool; 2])>,
    /// Seconds since it let an arrow go.
    loosed: f64,
}

/// Path of the hero's file.
pub fn hero_path() -> PathBuf {
    giant::path().with_file_name("hero.glb")
}

impl Hero {
    /// A hero from a file's rig.
    pub fn new(rig: Rig) -> Result<Self, SceneError> {
        let humanoid = Humanoid::find(&rig.skeleton)?;
        let figure = Figure::new(rig.skeleton, humanoid, rig.clips)?;
        let body = Body::new(&figure);
        Ok(Self {
            palette: figure.skeleton().palette(body.pose())?,
            body,
            figure,
            shown: None,
            loosed: f64::INFINITY,
        })
    }

    /// The hero of the project's file.
    pub fn load() -> Result<Self, SceneError> {
        Self::new(clamber_gltf::load(hero_path())?.rig)
    }

    /// Poses the hero for the battle's current tick, `dt` seconds after the last one that it was posed for.
    pub fn watch(&mut self, battle: &Battle<'_>, dt: f64) -> Result<(), SceneError> {
        let head = battle.creature.rig.skeleton.find("head");
        let head = head.and_then(|head| battle.palette().model_from_joint(head));
        let root = battle.surface().world_from_model();
        let look_at = head.map(|head| root.transform_point(head.translation));
        if let Some(arena) = battle.arena() {
            let shot = |event: &ArenaEvent| matches!(event, ArenaEvent::Shot { .. });
            let has_shot = arena.events().iter().any(shot);
            self.loosed = if has_shot { 0.0 } else { self.loosed + dt };
            self.play(&arena.fighters()[0])?;
        }
        let posed = battle.touched(|obstacles| {
            let frame = BodyInput {
                look_at,
                ..BodyInput::new(battle.climber(), obstacles)
            };
            self.body.update(&self.figure, &frame, dt)
        });
        posed?;
        let mut pose = self.body.pose().clone();
        show_sword(self.figure.skeleton(), &mut pose);
        self.palette = self.figure.skeleton().palette(&pose)?;
        Ok(())
    }

    /// Plays the clip for what a fighter does with its weapons.
    fn play(&mut self, fighter: &Fighter) -> Result<(), SceneError> {
        let set = self.figure.animations();
        let wanted = weapon_clip(set, fighter, self.loosed);
        let holds = fighter.climber().state().mode.is_holding();
        let shown = wanted.map(|(clip, _)| (clip, [!holds, true]));
        if shown != self.shown {
            let act = shown.and_then(|(name, hands)| {
                let clip = set.find(name)?;
                let mut layer = match name {
                    "stab_hold" | "aim" => Layer::new(clip),
                    _ => Layer::once(clip),
                };
                layer.mask = Some(self.figure.upper_body());
                Some(OverlayClip { layer, hands })
            });
            let [quick, usual, end] = FADES;
            let fade = match shown {
                Some(("stab_strike" | "loose", _)) => quick,
                Some(_) => usual,
                None => end,
            };
            self.body.set_overlay(&self.figure, act, fade)?;
            self.shown = shown;
        }
        if let (Some((_, Some(time))), Some(layer)) = (wanted, self.body.overlay_mut()) {
            (layer.time, layer.speed) = (time, 0.0);
        }
        Ok(())
    }

    /// The skeleton.
    pub fn skeleton(&self) -> &Skeleton {
        self.figure.skeleton()
    }

    /// The pose: the rest pose until the hero is [watched](Hero::watch).
    pub fn palette(&self) -> &Palette {
        &self.palette
    }

    /// The place at which the hero is drawn.
    pub fn world_from_model(&self) -> Similarity {
        self.body.world_from_model()
    }
}

/// The clip for what a fighter does with its weapons, and the time in it, seconds; `None` as time for a clip that plays
/// by itself. An arrow was let go `loosed` seconds ago.
fn weapon_clip(
    set: &AnimationSet,
    fighter: &Fighter,
    loosed: f64,
) -> Option<(&'static str, Option<f64>)> {
    let length = |name: &str| {
        let clip = set.find(name).and_then(|id| set.clip(id).ok());
        clip.map_or(0.0, |clip| clip.duration())
    };
    let at =
        |name: &'static str, share: f64| Some((name, Some(share.clamp(0.0, 1.0) * length(name))));
    let sword = fighter.config().sword;
    match fighter.act() {
        WeaponAction::Raise { seconds, .. } => at("stab_raise", seconds / sword?.raise.max(1e-3)),
        WeaponAction::Charge { .. } => Some(("stab_hold", None)),
        WeaponAction::Strike { seconds, .. } => {
            let share = (seconds / sword?.strike).clamp(0.0, 1.0);
            Some(("stab_strike", Some(share * HIT)))
        }
        WeaponAction::Plunge { .. } => Some(("stab_strike", Some(HIT))),
        WeaponAction::PullOut { seconds, .. } => {
            let left = (seconds / sword?.pull_out.max(1e-3)).clamp(0.0, 1.0);
            let rest = (length("stab_strike") - HIT).max(0.0);
            Some(("stab_strike", Some(HIT + (1.0 - left) * rest)))
        }
        WeaponAction::Cut { seconds, .. } => {
            let sword = sword?;
            let whole = sword.wind_up + sword.cut + sword.recover;
            at("swing", seconds / whole)
        }
        WeaponAction::Draw { drawn } if *drawn < NOCKED => at("draw", drawn / NOCKED),
        WeaponAction::Draw { .. } => Some(("aim", None)),
        WeaponAction::Ready | WeaponAction::Throw { .. } => {
            (loosed < length("loose")).then_some(("loose", None))
        }
    }
}

/// Shows the sword either in the hand or in its sheath: clips fade between the two by their scale.
fn show_sword(skeleton: &Skeleton, pose: &mut Pose) {
    let (Some(sword), Some(sheathed)) = (skeleton.find("sword"), skeleton.find("sword_sheathed"))
    else {
        return;
    };
    let is_out = pose.transforms[sword.index()].scale.x > 0.5;
    for (joint, is_shown) in [(sword, is_out), (sheathed, !is_out)] {
        pose.transforms[joint.index()].scale = Vec3::splat(f32::from(u8::from(is_shown)));
    }
}
