use clamber_animation::ClipId;
use clamber_animation::rig::{Clip, Playback};
use glam::DVec3;

use super::file::GaitFile;
use super::{Contacts, Leg, Names, whole};
use crate::brain::BrainProblem;
use crate::error::ColossusError;

/// Feet that move less than this many heights a second do not walk.
const STILL: f64 = 0.02;

/// How a kind of creature walks.
#[derive(Clone, Debug)]
pub(crate) struct Gait {
    pub(crate) idle: ClipId,
    pub(crate) walk: ClipId,
    /// Speed of the walk, the model's units a second, and whether it was measured.
    pub(crate) speed: f64,
    pub(crate) is_measured: bool,
    /// How far aside of +Z the feet walk in the clip, degrees; `None` if they do not.
    pub(crate) walks_aside: Option<f64>,
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
        height: f64,
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
        let told = file.speed.map(|speed| speed * height);
        let told = told.or(clip.ground_speed());
        let ground = ground(names, clip, legs)?;
        let measured = ground.map_or(0.0, |ground| -ground.z);
        let speed = told.unwrap_or(measured);
        if !(speed > 0.0 && speed.is_finite()) {
            let (what, range) = (
                "speed",
                "more than 0 and finite: no foot stands and moves back in the clip, so give it here, in heights a second",
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
            is_measured: told.is_none(),
            walks_aside: ground
                .filter(|ground| ground.length() > STILL * height)
                .map(|ground| libm::atan2(-ground.x, -ground.z).to_degrees()),
            turn,
            turn_rate,
            steer_rate: file.steer_deg.to_radians(),
            idle_contacts: contacts(idle, [0.0, 0.0])?,
            walk_contacts: contacts(walk, [speed, 0.0])?,
            turn_contacts,
        })
    }
}

impl Gait {
    /// All clips that it plays on the spot: all but the walk.
    pub(crate) fn on_spot(&self) -> impl Iterator<Item = ClipId> {
        let turns = self.turn.into_iter().flatten();
        core::iter::once(self.idle).chain(turns)
    }
}

/// How fast the ground passes below a walk on the spot, by the feet that stand: the mean of all legs, in the model's
/// units a second; `None` without legs.
fn ground(names: &Names<'_>, clip: &Clip, legs: &[Leg]) -> Result<Option<DVec3>, ColossusError> {
    let mut sum = DVec3::ZERO;
    for leg in legs {
        sum += leg.ground(names, clip)?;
    }
    Ok((!legs.is_empty()).then(|| sum / legs.len() as f64))
}
