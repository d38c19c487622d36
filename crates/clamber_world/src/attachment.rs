use glam::{DQuat, DVec3};

use crate::{Contact, MaterialPoint, Obstacle, ObstacleId, PointMotion};

/// A gap between ticks counts as several moves in one tick up to this many times the last move: up to nine moves at a
/// steady speed. A larger gap is another obstacle under the same id.
const MOST_MOVES: f64 = 8.0;

/// A gap of this share of the last move or more is other moves before it: two in one tick leave a gap as long as the last.
const PART: f64 = 0.5;

/// Below this share of the slack a gap is rounding: 0.2 mm of 10 mm, the steps of f32 some kilometres out. What is between
/// is part of the motion, or a slow creature that is advanced twice would be said to move at half its speed.
const ROUNDING: f64 = 0.02;

/// Something fixed to a point of an obstacle's material: a foot, a hand, an arrow, a camera.
///
/// A small plain value that survives any deformation. [`Attachment::follow`] it once a tick; [`Attachment::position`] is
/// where the attached thing is then.
///
/// ```
/// use clamber_world::{Attachment, Obstacle, ObstacleId};
/// # use clamber_surface::geometry::{Affine, Similarity};
/// # use clamber_surface::mesh::{BuildOptions, ColliderMesh, Influence, MeshSource};
/// # use clamber_surface::rig::{JointId, Palette};
/// # use clamber_surface::surface::SkinnedSurface;
/// # use glam::{DVec3, Vec3};
/// # let source = MeshSource {
/// #     positions: &[Vec3::ZERO, Vec3::X, Vec3::Y],
/// #     triangles: &[[0, 1, 2]],
/// #     influences: &[Influence { joint: JointId(0), weight: 1.0 }; 3],
/// #     joint_count: 1,
/// #     ..MeshSource::default()
/// # };
/// # let mut creature = SkinnedSurface::new(ColliderMesh::build(&source, &BuildOptions::default())?.0.into());
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
/// It does not know a creature's mesh: whoever saves it keeps [`ColliderMesh::id`] beside it, and asks
/// [`ColliderMesh::continues`] before it is followed on what was loaded.
///
/// [`ColliderMesh::id`]: clamber_surface::mesh::ColliderMesh::id
/// [`ColliderMesh::continues`]: clamber_surface::mesh::ColliderMesh::continues
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Attachment {
    /// The obstacle.
    pub obstacle: ObstacleId,
    /// The point of its material.
    pub material: MaterialPoint,
    /// Where that point was when it was last followed, in world space.
    pub point: DVec3,
    /// The frame of the material then; where the skin collapses it stays.
    pub frame: DQuat,
    /// From the point to the attached thing, metres, in the frame of the material.
    pub offset: DVec3,
}

/// How the material came to where it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Continuity {
    /// It moved there from where it was last followed.
    Moved,
    /// It was put there (a teleport), which is no motion.
    Placed,
    /// It moved several times since it was last followed, as if a creature was advanced twice in one tick. The motion
    /// covers all of it; sweeps against the obstacle cover only its last move.
    MovedRepeatedly,
}

/// Where an [`Attachment`] was carried.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Followed {
    /// Motion of the material point, from where it was last followed to where it is now. For [`Continuity::Placed`]:
    /// the motion that the obstacle reports, which starts elsewhere.
    pub motion: PointMotion,
    /// How it came there.
    pub continuity: Continuity,
}

impl Attachment {
    /// Fixes something at `place`, in world space, to a contact of an obstacle as it stands now. A point that has no
    /// motion is taken to be at [`Contact::point`], with the identity as its frame.
    pub fn new(
        obstacle: ObstacleId,
        touched: &dyn Obstacle,
        contact: &Contact,
        place: DVec3,
    ) -> Self {
        // The frame and the place of a point do not depend on how long the tick was.
        let motion = touched.motion(&contact.material, 1.0);
        Self::with_motion(obstacle, contact, motion.as_ref(), place)
    }

    /// [`Attachment::new`] where the motion of the contact's point is known already; `None` if it has none.
    pub fn with_motion(
        obstacle: ObstacleId,
        contact: &Contact,
        motion: Option<&PointMotion>,
        place: DVec3,
    ) -> Self {
        let frame = motion.and_then(|motion| motion.frame);
        let frame = frame.unwrap_or(DQuat::IDENTITY);
        // The material point's own position, which it will be carried by: the contact's may differ by rounding.
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

    /// Fixes the attached thing somewhere else relative to the same material point; `place` is in world space.
    #[must_use]
    pub fn moved_to(&self, place: DVec3) -> Self {
        Self {
            offset: self.frame.conjugate() * (place - self.point),
            ..*self
        }
    }

    /// Goes with the material over the tick of `dt` seconds that ends now; call it once a tick.
    ///
    /// `slack` is the largest allowed distance, metres, between the stored position and the obstacle's previous one:
    /// 0.01 for a person, more than rounding and less than a player sees. It must be at least 0. A larger distance is
    /// allowed for an obstacle that was [placed](Continuity::Placed), and up to 8 times its last move
    /// ([`Continuity::MovedRepeatedly`]).
    ///
    /// `None`, with nothing changed, if the material is gone, or if the distance is too large: the id names another
    /// obstacle now.
    pub fn follow(&mut self, obstacle: &dyn Obstacle, dt: f64, slack: f64) -> Option<Followed> {
        let mut motion = obstacle.motion(&self.material, dt)?;
        let frame = motion.frame.unwrap_or(self.frame);
        let gap = motion.previous_position.distance(self.point);
        let step = motion.position.distance(motion.previous_position);
        let continuity = if gap <= slack * ROUNDING || motion.placed && gap <= slack {
            Continuity::Moved
        } else if motion.placed {
            Continuity::Placed
        } else {
            if gap > slack.max(MOST_MOVES * step) {
                return None;
            }
            motion.previous_position = self.point;
            motion.velocity = (motion.position - self.point) / dt;
            motion.turn = (frame * self.frame.conjugate()).normalize();
            if gap >= PART * step {
                Continuity::MovedRepeatedly
            } else {
                Continuity::Moved
            }
        };
        self.frame = frame;
        self.point = motion.position;
        Some(Followed { motion, continuity })
    }

    /// Whether all numbers are finite.
    pub fn is_finite(&self) -> bool {
        let point = DVec3::from_array(self.material.coordinates);
        let vectors = [self.point, self.offset, point];
        vectors.iter().all(|v| v.is_finite()) && self.frame.is_finite()
    }
}
