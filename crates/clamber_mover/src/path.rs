//! A movement of a body over a tick, and its result.

use clamber_world::{Others, WorldCapsule};
use glam::DVec3;

use crate::MoverBody;

/// A movement over the tick, for [`Mover::slide`](crate::Mover::slide).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// The body that moves.
    pub body: MoverBody,
    /// Position a tick ago, in world space.
    pub start: DVec3,
    /// Ends of the body's axis at the start of the tick, relative to `start`, metres, for a body that turns. The axis
    /// at the tick's end is always `body.axis`.
    pub start_axis: [DVec3; 2],
    /// The wanted position at the tick's end, in world space. It includes the displacement by which the ground, or the
    /// frame that the body is in, has carried the body.
    pub target: DVec3,
    /// Displacement over the tick of the body's support, or of the frame that it is in, metres. The solver gives up all
    /// motion relative to it before it accepts an overlap; a crushed body keeps this displacement. With it, results are
    /// the same in every inertial frame.
    pub frame: DVec3,
    /// Treats slopes that are too steep as vertical walls, so that walking does not climb them.
    pub walking: Option<Walking>,
    /// The arm that the body hangs by, if it hangs.
    pub arm: Option<Arm>,
    /// Whether the body moves from start to target, or was placed at the target.
    pub begin: Begin,
    /// Set this if the last movement ended crushed ([`Moved::missing_room`] above the margin). It limits the speed at
    /// which the body leaves an overlap to 30 radii a second; pushes by obstacles that the body meets on its way are
    /// added to this. So a body that was pressed through an obstacle does not jump to the other side.
    pub crushed: bool,
}

/// Where a movement begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Begin {
    /// At the start: the body is swept from there.
    Start,
    /// At the target: the body was placed there, and is only pushed out of obstacles that it overlaps there.
    Target,
}

/// The slopes that a walking body may climb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walking {
    /// Unit vector that points up.
    pub up: DVec3,
    /// The steepest slope that the body may climb, radians from level ground.
    pub max_slope: f64,
}

/// A body as a character among others ([`Obstacle::character`](clamber_world::Obstacle::character)), which may overlap
/// the sides of other characters as far as `others` allows. A character below still stops the body, and so does a
/// character above that has a greater mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntoOthers {
    /// Unit vector that points up.
    pub up: DVec3,
    /// Whether the body blocks, pushes or passes other characters. The result of [`Others::between`] for both applies.
    pub others: Others,
    /// Mass of the body, kilograms. The body carries a character that is above it and has no greater mass, and may move
    /// up into it.
    pub mass: f64,
}

/// An arm that the body hangs by: it keeps the body's position within `length` of `pivot`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// Fixed end of the arm at the tick's end, in world space.
    pub pivot: DVec3,
    /// Length, metres.
    pub length: f64,
}

/// The result of [`Mover::slide`](crate::Mover::slide).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Moved {
    /// Position at the tick's end, in world space.
    pub position: DVec3,
    /// Room that the body lacks between obstacles, metres. If it is more than the margin, the body is crushed.
    pub missing_room: f64,
    /// Depth of the core inside an obstacle, metres; 0 if the core is clear of all obstacles.
    pub penetration: f64,
    /// Rounds of sweeping and pushing that the movement took, at most 8; 0 for an invalid path.
    pub rounds: u32,
    /// True if no obstacle is in the way from start to position, except obstacles that the body started inside of or is
    /// crushed by. Always true for a body that was placed ([`Begin::Target`]), which is not swept, unless the path is
    /// invalid.
    pub is_clear: bool,
}

impl Path {
    /// A movement from `start` to `target`, both in world space. The body does not turn, walk or hang, is not crushed,
    /// and its frame is at rest.
    pub const fn new(body: MoverBody, start: DVec3, target: DVec3) -> Self {
        Self {
            body,
            start,
            start_axis: body.axis,
            target,
            frame: DVec3::ZERO,
            walking: None,
            arm: None,
            begin: Begin::Start,
            crushed: false,
        }
    }

    /// A movement that pushes a body placed at `position`, in world space, out of obstacles that it overlaps there.
    pub const fn placed(body: MoverBody, position: DVec3) -> Self {
        Self {
            begin: Begin::Target,
            ..Self::new(body, position, position)
        }
    }

    /// The core at the start.
    pub(crate) fn core(&self) -> WorldCapsule {
        let core = self.body.core_at(self.start);
        WorldCapsule {
            ends: self.start_axis.map(|end| self.start + end),
            ..core
        }
    }

    /// The displacement that the solver approximates: the wanted one, or the frame's if the body is crushed.
    pub(crate) fn aim(&self, moved: &Moved) -> DVec3 {
        if moved.missing_room > self.body.margin {
            self.frame
        } else {
            self.target - self.start
        }
    }

    /// Displacements of the core's ends if the position moves by `way`.
    pub(crate) fn ways(&self, way: DVec3) -> [DVec3; 2] {
        let turn = |k: usize| self.body.axis[k] - self.start_axis[k];
        [way + turn(0), way + turn(1)]
    }

    /// Finds the point of the axis that is nearest to `place` at `time`, a fraction of a movement by `way`. Returns its
    /// place at the end of the tick, relative to the body's position.
    pub(crate) fn end_of(&self, way: DVec3, time: f64, place: DVec3) -> DVec3 {
        let then = self
            .core()
            .with_ends_moved(self.ways(way).map(|way| way * time));
        let [a, b] = self.body.axis;
        a + (b - a) * then.share_of_axis(place)
    }

    pub(crate) fn is_finite(&self) -> bool {
        // Zero times a number is zero, unless the number is infinite or NaN: one test for all of them.
        let [a, b] = self.start_axis;
        let vectors =
            (self.start * 0.0 + self.target * 0.0) + self.frame * 0.0 + (a * 0.0 + b * 0.0);
        let arm = self
            .arm
            .is_none_or(|arm| arm.pivot.is_finite() && arm.length.is_finite());
        let walking = self
            .walking
            .is_none_or(|walking| walking.up.is_finite() && walking.max_slope.is_finite());
        vectors == DVec3::ZERO && arm && walking && self.body.validate().is_ok()
    }
}
