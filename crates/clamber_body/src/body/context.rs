use clamber_climber::ClimberState;
use glam::DVec3;

use super::event::Plant;
use super::hold::{Hold, Surroundings};
use super::root::Root;
use crate::figure::{LimbShape, Place};
use crate::{Extremity, Figure};

/// Data that all parts of a body read in one frame.
pub(crate) struct Context<'a> {
    pub(crate) figure: &'a Figure,
    pub(crate) state: &'a ClimberState,
    pub(crate) around: Surroundings<'a>,
    pub(crate) up: DVec3,
    /// Velocity of the climber relative to its support, along the skin on a wall.
    pub(crate) motion: DVec3,
    /// True in the first frame and after a teleport: all limbs are in place at once, and no plants are reported.
    pub(crate) is_fresh: bool,
    pub(crate) dt: f64,
    /// Places of hands and feet in the clips' pose, metres in model space.
    pub(crate) clip: [Place; 4],
}

impl Context<'_> {
    pub(crate) fn shape(&self, extremity: Extremity) -> &LimbShape {
        self.figure.limb(extremity)
    }

    /// Size of the body relative to the one for which this crate's lengths are given, by the legs' lengths.
    pub(crate) fn size(&self) -> f64 {
        self.figure.leg_length() / super::walk::REFERENCE_LEG_LENGTH
    }

    /// The place of a hand or foot in the clips' pose, in world space.
    pub(crate) fn clip_in_world(&self, root: &Root, extremity: Extremity) -> Place {
        let clip = self.clip[extremity.index()];
        Place {
            position: root.point(clip.position),
            rotation: (root.rotation * clip.rotation).normalize(),
        }
    }

    /// Reports that a hand or foot came down, unless this frame is fresh.
    pub(crate) fn tell(
        &self,
        plants: &mut Vec<Plant>,
        extremity: Extremity,
        hold: &Hold,
        speed: f64,
    ) {
        if !self.is_fresh {
            plants.push(Plant {
                extremity,
                obstacle: hold.attachment.obstacle,
                point: hold.point(),
                normal: hold.normal(),
                tag: hold.tag,
                speed,
            });
        }
    }
}
