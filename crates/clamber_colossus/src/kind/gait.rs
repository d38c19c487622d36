use clamber_animation::ClipId;
use clamber_animation::rig::Playback;

use super::file::GaitFile;
use super::{Contacts, Leg, Names, whole};
use crate::brain::BrainProblem;
use crate::error::ColossusError;

/// How a kind of creature walks.
#[derive(Clone, Debug)]
pub(crate) struct Gait {
    pub(crate) idle: ClipId,
    pub(crate) walk: ClipId,
    /// Speed of the walk, the model's units a second.
    pub(crate) speed: f64,
    /// To the left, to the right.
    pub(crate) turn: Option<[ClipId; 2]>,
    /// Radians a second.
    pub(crate) turn_rate: f64,
    pub(crate) steer_rate: f64,
    /// Of each leg, when it stands in the clips of standing, walking and turning.
    pub(crate) idle_contacts: Vec<Contacts>,
    pub(crate) walk_contacts: Vec<Contacts>,
    pub(crate) turn_contacts: [Vec<Contacts>; 2],
}

impl Gait {
    pub(crate) fn new(
        names: &Names<'_>,
        file: &GaitFile,
        legs: &[Leg],
    ) -> Result<Self, ColossusError> {
        let idle = names.clip(&file.idle).map_err(whole)?;
        let walk = names.clip(&file.walk).map_err(whole)?;
        let turn = match &file.turn {
            Some([left, right]) => Some([
                names.clip(left).map_err(whole)?,
                names.clip(right).map_err(whole)?,
            ]),
            None => None,
        };
        for (what, found) in [("turn_deg", file.turn_deg), ("steer_deg", file.steer_deg)] {
            if !(found > 0.0 && found <= 360.0) {
                let range = "more than 0 and at most 360 degrees a second";
                return Err(whole(BrainProblem::OutOfRange { what, range, found }).into());
            }
        }
        let clip = names.clips.clip(walk)?;
        let speed = file.speed.or(clip.ground_speed()).unwrap_or(0.0);
        if !(speed > 0.0 && speed.is_finite()) {
            let (what, range) = (
                "speed",
                "given here or in the clip's extras, finite and more than 0",
            );
            return Err(whole(BrainProblem::OutOfRange {
                what,
                range,
                found: speed,
            })
            .into());
        }
        let turn_rate = file.turn_deg.to_radians();
        let contacts = |clip: ClipId, ground: [f64; 2]| -> Result<Vec<Contacts>, ColossusError> {
            let clip = names.clips.clip(clip)?;
            legs.iter()
                .map(|leg| leg.contacts(names, clip, Playback::Loop, ground))
                .collect()
        };
        let turn_contacts = match turn {
            Some([left, right]) => [
                contacts(left, [0.0, turn_rate])?,
                contacts(right, [0.0, -turn_rate])?,
            ],
            None => [Vec::new(), Vec::new()],
        };
        Ok(Self {
            idle,
            walk,
            speed,
            turn,
            turn_rate,
            steer_rate: file.steer_deg.to_radians(),
            idle_contacts: contacts(idle, [0.0, 0.0])?,
            walk_contacts: contacts(walk, [speed, 0.0])?,
            turn_contacts,
        })
    }
}
