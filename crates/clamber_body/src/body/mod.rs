//! The body of a climber, frame by frame.

mod carry;
mod climb;
mod context;
mod detour;
mod error;
mod event;
mod feet;
mod frame;
mod goals;
mod ground;
mod hold;
mod legs;
mod limb;
mod memory;
mod play;
mod reach;
mod root;
mod solve;
mod stance;
mod update;
mod walk;

use clamber_animation::{AnimationError, AnimationEvent, Layer};
use clamber_surface::geometry::Similarity;
use clamber_surface::rig::Pose;
use clamber_world::Attachment;
use glam::DVec3;

pub use error::BodyError;
pub use event::Plant;
pub use frame::BodyFrame;
pub use play::Act;

use memory::Memory;
use play::Player;

use crate::figure::Place;
use crate::{Extremity, Figure, Side};

/// The body of one climber: it is posed in every drawn frame, from what the climber does and what it touches.
///
/// It is for the eye alone. It belongs to no saved state; a body that is made anew, or whose climber was teleported, is
/// in place at once. It remembers where hands and feet are, so give each climber one of its own.
#[derive(Clone, Debug)]
pub struct Body {
    pose: Pose,
    player: Player,
    memory: Option<Memory>,
    plants: Vec<Plant>,
}

/// Plants in one frame for which memory is kept.
const PLANTS: usize = 8;

impl Body {
    /// A body of a figure. It has no place until its first [`Body::update`].
    pub fn new(figure: &Figure) -> Self {
        Self {
            pose: figure.animations().rest().clone(),
            player: Player::new(),
            memory: None,
            plants: Vec::with_capacity(PLANTS),
        }
    }

    /// Poses the body, `dt` seconds after the last frame. Any frame rate is right. Allocates only where the climber
    /// begins something else.
    ///
    /// # Errors
    /// [`BodyError`] for numbers that are not finite, another figure's body, or limbs that cannot be posed, such as those
    /// that a clip scales to nothing. The body is where it was; in the last case its pose is the clips' own.
    pub fn update(
        &mut self,
        figure: &Figure,
        frame: &BodyFrame<'_>,
        dt: f64,
    ) -> Result<(), BodyError> {
        self.check(figure)?;
        frame.check(dt)?;
        self.plants.clear();
        let updated = update::Update::new(figure, frame, dt, self.memory);
        self.memory = Some(updated.run(&mut self.player, &mut self.pose, &mut self.plants)?);
        Ok(())
    }

    fn check(&self, figure: &Figure) -> Result<(), BodyError> {
        let [body, other] = [self.pose.transforms.len(), figure.skeleton().joints().len()];
        if body == other {
            return Ok(());
        }
        let figure = other;
        Err(BodyError::OtherFigure { body, figure })
    }

    /// The pose, for [`Skeleton::palette`](clamber_surface::rig::Skeleton::palette).
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Where the model stands. The identity before the first update.
    pub fn world_from_model(&self) -> Similarity {
        self.memory
            .map_or(Similarity::IDENTITY, |memory| memory.similarity())
    }

    /// Hands and feet that came down in the last update.
    pub fn plants(&self) -> &[Plant] {
        &self.plants
    }

    /// Markers and ends that clips came past in the last update, such as `loose` of an act that looses an arrow. An act
    /// is the last layer; the clips' names and markers are in [`Figure::animations`].
    pub fn events(&self) -> &[AnimationEvent] {
        self.player.events()
    }

    /// What a hand or foot is on; `None` if it is in the air, on its way, or free: hands
    /// arrive 0.2 to 0.3 seconds after the climber has grabbed.
    pub fn hold(&self, extremity: Extremity) -> Option<&Attachment> {
        let limb = &self.memory.as_ref()?.limbs[extremity.index()];
        limb.hold().map(|hold| &hold.attachment)
    }

    /// Where the part of a hand or foot is that touches what it is on, in world space: the middle of the palm, or the
    /// sole. `None` before the first update.
    pub fn touching_point(&self, figure: &Figure, extremity: Extremity) -> Option<DVec3> {
        let memory = self.memory.as_ref()?;
        let limb = &memory.limbs[extremity.index()];
        let shape = figure.limb(extremity);
        let place: Place = shape.place(figure.skeleton(), &self.pose, figure.scale())?;
        let touching = limb.hold().map_or(shape.contact, |hold| hold.touching);
        Some(memory.root.point(place.point(touching)))
    }

    /// The heel and the ball of a foot on its sole, in world space. `None` before the first update.
    pub fn sole(&self, figure: &Figure, side: Side) -> Option<[DVec3; 2]> {
        let root = self.memory.as_ref()?.root;
        let shape = figure.limb(Extremity::Foot(side));
        let place: Place = shape.place(figure.skeleton(), &self.pose, figure.scale())?;
        Some([shape.heel, shape.ball].map(|point| root.point(place.point(point))))
    }

    /// Forgets all places, as after a teleport: the next update puts the body in place at once, and tells nothing.
    pub fn reset(&mut self) {
        self.memory = None;
        self.player.restart();
    }

    /// Plays a clip over the body's own, within `fade` seconds: a weapon that is raised, a gesture. `None` ends it.
    ///
    /// # Errors
    /// [`AnimationError`] for a clip or mask that the figure does not have, or numbers that are out of range. Nothing is
    /// changed then.
    pub fn set_act(
        &mut self,
        figure: &Figure,
        act: Option<Act>,
        fade: f64,
    ) -> Result<(), AnimationError> {
        if let Some(act) = &act {
            figure.animations().clip(act.layer.clip)?;
        }
        self.player.set_act(figure, act, fade)
    }

    /// The layer of the act that is played, to drive its time; `None` if there is none.
    pub fn act_mut(&mut self) -> Option<&mut Layer> {
        self.player.act_mut()
    }
}
