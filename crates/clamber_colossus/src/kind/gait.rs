use clamber_animation::ClipId;
use clamber_animation::rig::{Clip, Playback};
use glam::DVec3;

use super::file::GaitFile;
use super::{Contacts, Leg, Names};
use crate::brain::{check, whole};
use crate::error::ColossusError;

/// Below this speed of the feet, in heights a second, the direction of the walk is unknown.
const STILL_SPEED: f64 = 0.02;

/// The clips of a kind of creature that stand, walk and turn.
#[derive(Clone, Debug)]
pub(crate) struct Gait {
    pub(crate) idle: ClipId,
    pub(crate) walk: ClipId,
    /// Speed of the walk over ground, the model's units a second of the clip, and whether it was measured at the feet.
    pub(crate) speed: f64,
    pub(crate) is_measured: bool,
    /// Direction in which the feet walk in the clip, degrees to the left of +Z; `None` if they hardly move or there are
    /// no legs.
    pub(crate) walks_aside: Option<f64>,
    /// The clips of turning to the left and to the right.
    pub(crate) turn: Option<[ClipId; 2]>,
    /// Rates of turning on the spot and while walking, radians a second at the clips' own speed.
    pub(crate) turn_rate: f64,
    pub(crate) steer_rate: f64,
    /// Per leg, when it stands in the clips of standing, walking and turning.
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
            let range = "more than 0 and at most 360 degrees a second";
            check(found > 0.0 && found <= 360.0, what, range, found).map_err(whole)?;
        }
        let clip = names.clips.clip(walk)?;
        let told = file.speed.map(|speed| speed * height);
        let told = told.or(clip.ground_speed());
        let ground = ground(names, clip, legs)?;
        let measured = ground.map_or(0.0, |ground| -ground.z);
        let speed = told.unwrap_or(measured);
        let range = "more than 0 and finite: no foot stands and moves back in the clip, so give it here, \
            in heights a second";
        check(speed > 0.0 && speed.is_finite(), "speed", range, speed).map_err(whole)?;
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
                .filter(|ground| ground.length() > STILL_SPEED * height)
                .map(|ground| libm::atan2(-ground.x, -ground.z).to_degrees()),
            turn,
            turn_rate,
            steer_rate: file.steer_deg.to_radians(),
            idle_contacts: contacts(idle, [0.0, 0.0])?,
            walk_contacts: contacts(walk, [speed, 0.0])?,
            turn_contacts,
        })
    }

    /// All clips that are played on the spot: all but the walk.
    pub(crate) fn on_spot(&self) -> impl Iterator<Item = ClipId> {
        let turns = self.turn.into_iter().flatten();
        core::iter::once(self.idle).chain(turns)
    }
}

/// Velocity of the ground below a walk on the spot, the model's units a second: the mean over all legs of the velocity
/// of the standing foot. `None` without legs.
fn ground(names: &Names<'_>, clip: &Clip, legs: &[Leg]) -> Result<Option<DVec3>, ColossusError> {
    let mut sum = DVec3::ZERO;
    for leg in legs {
        sum += leg.ground(names, clip)?;
    }
    Ok((!legs.is_empty()).then(|| sum / legs.len() as f64))
}
