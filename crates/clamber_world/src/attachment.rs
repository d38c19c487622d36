use glam::{DQuat, DVec3};

use crate::{Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion};

/// A gap of up to this many times the last move counts as several moves within one tick: up to nine moves at a steady
/// speed. A larger gap means that the id now names another obstacle.
const MOST_MOVES: f64 = 8.0;

/// A gap of at least this fraction of the last move means that there were moves before it: after two equal moves in a
/// tick, the gap is as long as the last move.
const PART: f64 = 0.5;

/// A gap below this fraction of the slack is rounding: 0.2 mm of 10 mm, the resolution of f32 some kilometres from the
/// origin. A larger gap is part of the motion; otherwise a slow creature that is advanced twice would be reported at
/// half its speed.
const ROUNDING: f64 = 0.02;

/// Fixes a thing to a point of an obstacle's material: a foot, a hand, an arrow, a camera.
///
/// A small plain value that survives any deformation. Call [`Attachment::follow`] once a tick; [`Attachment::position`]
/// is then where the attached thing is.
///
/// ```
/// use clamber_world::{Attachment, Obstacle, ObstacleId};
/// # use clamber_surface::geometry::{Affine, Similarity};
/// # use clamber_surface::mesh::{ColliderBuildOptions, ColliderMesh, MeshSource};
/// # use clamber_surface::rig::Palette;
/// # use clamber_surface::surface::SkinnedSurface;
/// # use glam::{DVec3, Vec3};
/// # let source = MeshSource::rigid(&[Vec3::ZERO, Vec3::X, Vec3::Y], &[[0, 1, 2]]);
/// # let mut creature = SkinnedSurface::new(ColliderMesh::build(&source, &ColliderBuildOptions::default())?.0.into());
/// # let rest = Palette::from_matrices([Affine::IDENTITY]);
/// let id = ObstacleId(7);
/// let above = DVec3::new(0.2, 0.2, 1.0);
/// let hit = creature.closest_point(above, 2.0).ok_or("no skin")?;
/// let mut arrow = Attachment::new(id, &creature, &hit, above);
///
/// creature.advance(&rest, Similarity::from_translation(DVec3::X * 0.5))?;
/// let followed = arrow.follow(&creature, 1.0 / 60.0, 0.01).ok_or("the skin is gone")?;
/// assert_eq!(followed.motion.velocity, DVec3::X * 30.0);
/// assert!(arrow.position().distance(above + DVec3::X * 0.5) < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// An attachment does not store the mesh of a creature. To save one, store [`ColliderMesh::id`] beside it. After
/// loading, follow it only if [`ColliderMesh::continues`] accepts that id.
///
/// [`ColliderMesh::id`]: clamber_surface::mesh::ColliderMesh::id
/// [`ColliderMesh::continues`]: clamber_surface::mesh::ColliderMesh::continues
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
pub struct Attachment {
    /// Id of the obstacle.
    pub obstacle: ObstacleId,
    /// The obstacle's material point.
    pub material: MaterialPoint,
    /// Position of that point when it was last followed, in world space.
    pub point: DVec3,
    /// Frame of the material at that time, in world space. Where the skin has collapsed, the last known frame.
    pub frame: DQuat,
    /// Vector from the point to the attached thing, metres, in the frame of the material.
    pub offset: DVec3,
}

/// How the material got to its current position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
#[non_exhaustive]
pub enum Continuity {
    /// The material moved there from its position when last followed.
    Moved,
    /// The material was teleported there, which is not motion.
    Teleported,
    /// The material moved several times since it was last followed, for example because a creature was advanced twice
    /// in one tick. The motion covers all of these moves; sweeps against the obstacle cover only the last one.
    SkippedTicks,
}

/// The result of [`Attachment::follow`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bevy_reflect", derive(bevy_reflect::Reflect))]
#[non_exhaustive]
pub struct FollowResult {
    /// Motion of the material point, from where it was last followed to where it is now. For
    /// [`Continuity::Teleported`], it is the motion that the obstacle reports for the tick. It does not start where the
    /// point was last followed, so the teleport is not part of it.
    pub motion: PointMotion,
    /// How the point got to its current position.
    pub continuity: Continuity,
}

impl Attachment {
    /// Fixes something at `place`, in world space, to a contact with an obstacle in its current state. If the contact's
    /// point has no motion, the attachment takes [`Contact::point`] as its position and the identity as its frame.
    pub fn new(
        obstacle: ObstacleId,
        touched: &dyn Obstacle,
        contact: &Contact,
        place: DVec3,
    ) -> Self {
        // A point's frame and position do not depend on the length of the tick.
        let motion = touched.motion(&contact.material, 1.0);
        Self::with_motion(obstacle, contact, motion.as_ref(), place)
    }

    /// [`Attachment::new`] with the motion of the contact's point, for a caller that knows it; `None` if the point has
    /// no motion.
    pub fn with_motion(
        obstacle: ObstacleId,
        contact: &Contact,
        motion: Option<&PointMotion>,
        place: DVec3,
    ) -> Self {
        let frame = motion.and_then(|motion| motion.frame);
        let frame = frame.unwrap_or(DQuat::IDENTITY);
        // The position that the material point reports, because it is followed from there. The contact's position may
        // differ by rounding.
        let position = motion.map_or(contact.point, |motion| motion.position);
        Self {
            obstacle,
            material: contact.material,
            point: position,
            frame,
            offset: frame.conjugate() * (place - position),
        }
    }

    /// Where the attached thing is, in world space.
    pub fn position(&self) -> DVec3 {
        self.point + self.offset_in_world()
    }

    /// [`Attachment::offset`] in world space.
    pub fn offset_in_world(&self) -> DVec3 {
        self.frame * self.offset
    }

    /// The same attachment with the attached thing at `place`, in world space. The material point stays the same.
    #[must_use]
    pub fn moved_to(&self, place: DVec3) -> Self {
        Self {
            offset: self.frame.conjugate() * (place - self.point),
            ..*self
        }
    }

    /// Moves the attachment with the material over the tick of `dt` seconds that ends now. Call it once a tick.
    ///
    /// `slack` is the largest allowed distance, metres, between the stored position and the previous position that the
    /// obstacle reports. It must be at least 0. For a character of human size 0.01 is right: more than rounding, less
    /// than a player sees. A larger distance is allowed for an obstacle that was [teleported](Continuity::Teleported),
    /// and up to 8 times its last move ([`Continuity::SkippedTicks`]).
    ///
    /// Returns `None` and changes nothing if the material is gone. The same happens if the distance is too large, which
    /// means that the id now names another obstacle.
    pub fn follow(&mut self, obstacle: &dyn Obstacle, dt: f64, slack: f64) -> Option<FollowResult> {
        let mut motion = obstacle.motion(&self.material, dt)?;
        let frame = motion.frame.unwrap_or(self.frame);
        let gap = motion.previous_position.distance(self.point);
        let step = motion.position.distance(motion.previous_position);
        let continuity = if gap <= slack * ROUNDING || motion.was_teleported && gap <= slack {
            Continuity::Moved
        } else if motion.was_teleported {
            Continuity::Teleported
        } else {
            if gap > slack.max(MOST_MOVES * step) {
                return None;
            }
            motion.previous_position = self.point;
            motion.velocity = (motion.position - self.point) / dt;
            motion.turn = (frame * self.frame.conjugate()).normalize();
            if gap >= PART * step {
                Continuity::SkippedTicks
            } else {
                Continuity::Moved
            }
        };
        self.frame = frame;
        self.point = motion.position;
        Some(FollowResult { motion, continuity })
    }

    /// True if all numbers are finite.
    pub fn is_finite(&self) -> bool {
        // Zero times a number is zero, unless the number is infinite or NaN: one test for all of them.
        let point = DVec3::from_array(self.material.coordinates);
        let vectors = self.point * 0.0 + self.offset * 0.0 + point * 0.0;
        vectors == DVec3::ZERO && self.frame.is_finite()
    }
}
