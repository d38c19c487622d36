//! The body of a climber, updated in each drawn frame.

mod carry;
mod climb;
mod context;
mod detour;
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

pub use event::Plant;
pub use frame::BodyInput;
pub use play::OverlayClip;

use memory::Memory;
use play::Player;

use crate::figure::Place;
use crate::{BodyError, Extremity, Figure, Side};

/// The body of one climber. In each drawn frame it is posed from the climber's state and the obstacles around it.
///
/// A body is for display alone and is not part of saved states. A new body, or one whose climber was teleported, is in
/// place at once. It remembers where hands and feet are, so each climber needs a body of its own.
#[derive(Clone, Debug)]
pub struct Body {
    pose: Pose,
    player: Player,
    memory: Option<Memory>,
    plants: Vec<Plant>,
}

/// Number of plants for which a new body reserves memory, so that steady frames do not allocate.
const RESERVED_PLANTS: usize = 8;

impl Body {
    /// A body of a figure. It has no place until the first [`Body::update`].
    pub fn new(figure: &Figure) -> Self {
        Self {
            pose: figure.animations().rest().clone(),
            player: Player::new(),
            memory: None,
            plants: Vec::with_capacity(RESERVED_PLANTS),
        }
    }

    /// Poses the body, `dt` seconds after the last frame, at any frame rate. It allocates only in frames in which the
    /// climber begins another motion.
    ///
    /// # Errors
    /// [`BodyError`] for numbers that are not finite, a negative `dt`, or a figure with another number of joints than
    /// the body's own: nothing changes then. Also for limbs or a head that cannot be posed, such as a limb that a clip
    /// scales to nothing: [`Body::world_from_model`] and [`Body::hold`] stay as after the last update then, but the
    /// clips have advanced, [`Body::pose`] is their pose, with some limbs bent already, and [`Body::plants`] has this
    /// frame's plants, which later updates may list again.
    pub fn update(
        &mut self,
        figure: &Figure,
        frame: &BodyInput<'_>,
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

    /// The transforms of the joints after the last update, each relative to its parent, for
    /// [`Skeleton::palette`](clamber_surface::rig::Skeleton::palette). The rest pose before the first update.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Position, rotation and scale of the model in the world after the last update: from model space to world space,
    /// metres. The identity before the first update, and from [`Body::reset`] until the next one.
    pub fn world_from_model(&self) -> Similarity {
        self.memory
            .map_or(Similarity::IDENTITY, |memory| memory.similarity())
    }

    /// The hands and feet that came down on an obstacle in the last update, one [`Plant`] for each.
    pub fn plants(&self) -> &[Plant] {
        &self.plants
    }

    /// Markers and ends that clips passed in the last update, such as the marker `loose` of an overlay clip that looses
    /// an arrow. The overlay clip is the last layer; names and markers of the clips are in [`Figure::animations`].
    pub fn events(&self) -> &[AnimationEvent] {
        self.player.events()
    }

    /// The material point that a hand or foot is on. `None` if the hand or foot is in the air, on its way, or free;
    /// also before the first update, and from [`Body::reset`] until the next one. Hands arrive 0.2 to 0.3 seconds after
    /// the climber has grabbed.
    pub fn hold(&self, extremity: Extremity) -> Option<&Attachment> {
        let limb = &self.memory.as_ref()?.limbs[extremity.index()];
        limb.hold().map(|hold| &hold.attachment)
    }

    /// The point at which a hand or foot touches its hold or its ground, in world space, metres, in the pose of the last
    /// update: the middle of a palm, or the part of a foot that is down: the sole below the ankle, the heel, the ball
    /// or the toes. A hand or foot in the air has such a point, too; [`Body::hold`] tells whether it is on anything.
    /// `None` before the first update, and from [`Body::reset`] until the next one.
    pub fn touching_point(&self, figure: &Figure, extremity: Extremity) -> Option<DVec3> {
        let memory = self.memory.as_ref()?;
        let limb = &memory.limbs[extremity.index()];
        let shape = figure.limb(extremity);
        let place: Place = shape.place(figure.skeleton(), &self.pose, figure.scale())?;
        let touching = limb.hold().map_or(shape.contact, |hold| hold.touching);
        Some(memory.root.point(place.point(touching)))
    }

    /// The heel and the ball of a foot, both on the sole, in world space, metres, in the pose of the last update.
    /// `None` before the first update, and from [`Body::reset`] until the next one.
    pub fn sole(&self, figure: &Figure, side: Side) -> Option<[DVec3; 2]> {
        let root = self.memory.as_ref()?.root;
        let shape = figure.limb(Extremity::Foot(side));
        let place: Place = shape.place(figure.skeleton(), &self.pose, figure.scale())?;
        Some([shape.heel, shape.ball].map(|point| root.point(place.point(point))))
    }

    /// Forgets where the body, its hands and its feet are, as after a teleport. Until the next update,
    /// [`Body::world_from_model`] is the identity, and no hand or foot has a place; [`Body::pose`], [`Body::plants`]
    /// and [`Body::events`] stay those of the last update. The next update puts the body in place at once, and
    /// [`Body::plants`] is empty after it.
    pub fn reset(&mut self) {
        self.memory = None;
        self.player.restart();
    }

    /// Plays a clip over the body's own, such as a raised weapon or a gesture, faded in within `fade` seconds. `None`
    /// ends the clip, faded out in the same way.
    ///
    /// # Errors
    /// [`AnimationError`] for a clip or mask that the figure does not have, or numbers that are out of range. The body
    /// does not change then.
    pub fn set_overlay(
        &mut self,
        figure: &Figure,
        clip: Option<OverlayClip>,
        fade: f64,
    ) -> Result<(), AnimationError> {
        if let Some(clip) = &clip {
            figure.animations().clip(clip.layer.clip)?;
        }
        self.player.set_overlay(figure, clip, fade)
    }

    /// The layer of the overlay clip, to set its time; `None` without such a clip.
    pub fn overlay_mut(&mut self) -> Option<&mut Layer> {
        self.player.overlay_mut()
    }
}
