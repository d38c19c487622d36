//! Where hands and feet belong while the body holds on: on walls, below ledges, above the head.

use glam::DVec3;

use super::context::Context;
use super::hold::{Found, Hold};
use super::root::Root;
use super::stance::Stance;
use crate::Extremity;

/// How far before and behind a wall a place to hold is looked for, and how far around where there is none, metres.
const BEFORE: f64 = 0.35;
const BEHIND: f64 = 0.5;
const AROUND: f64 = 0.4;

/// How far above and below a ledge's edge.
const OVER: f64 = 0.3;
const UNDER: f64 = 0.4;

/// A hand is looked for around what it hangs from within this distance, metres.
const NEAR: f64 = 0.35;

/// Least cosine between the skin's normal and the way from which it is looked for.
const FACES: f64 = 0.1;

/// How fingers lean inward, and how far toes point up where feet stand on a wall.
const INWARD: f64 = 0.18;
const TOES_UP: f64 = 0.28;

/// The toes' tips before the ball of the foot, as a multiple of its distance from the ankle.
const TIP: f64 = 1.3;

/// Where a hand or foot belongs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Goal {
    /// In the world.
    pub(crate) point: DVec3,
    /// Unit vector out of what is held.
    pub(crate) out: DVec3,
    /// Where the head points, and where the body faces.
    above: DVec3,
    ahead: DVec3,
    /// The body's left or right, as the hand or foot is.
    pub(crate) aside: DVec3,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Wall,
    Edge,
    Overhead,
}

/// The goals of hands and feet; `None` for those that are free.
pub(crate) fn goals(context: &Context<'_>, stance: Stance, root: &Root) -> [Option<Goal>; 4] {
    let figure = context.figure;
    let postures = figure.postures();
    let facing = figure.humanoid().facing;
    let [left, ahead, above] =
        [DVec3::Y.cross(facing), facing, DVec3::Y].map(|axis| root.rotation * axis);
    let Some(support) = &context.state.support else {
        return [None; 4];
    };
    let held = support.attachment.point;
    let goal = |extremity: Extremity, point: DVec3, out: DVec3, kind: Kind| {
        let aside = if extremity.index() & 1 == 0 {
            left
        } else {
            -left
        };
        Some(Goal {
            point,
            out,
            above,
            ahead,
            aside,
            kind,
        })
    };
    let sides = |width: f64| [left * width, left * -width];
    match stance {
        Stance::Wall => Extremity::ALL.map(|extremity| {
            goal(
                extremity,
                root.point(postures.wall[extremity.index()]),
                -ahead,
                Kind::Wall,
            )
        }),
        Stance::Hang => {
            let mut goals = [None; 4];
            let out = support.normal_in_world();
            for (index, side) in sides(postures.above_width.min(0.15 * context.size()))
                .into_iter()
                .enumerate()
            {
                goals[index] = goal(Extremity::ALL[index], held + side, out, Kind::Overhead);
            }
            goals
        }
        Stance::Ledge => {
            let mut goals = [None; 4];
            if context.state.ledge_hanging.pull_up < HANDS_LEAVE {
                for (index, side) in sides(postures.edge_width).into_iter().enumerate() {
                    goals[index] = goal(Extremity::ALL[index], held + side, context.up, Kind::Edge);
                }
            }
            if context.state.ledge_hanging.pull_up == 0.0 {
                for (index, foot) in postures.edge_feet.into_iter().enumerate() {
                    goals[2 + index] = goal(
                        Extremity::ALL[2 + index],
                        root.point(foot),
                        -ahead,
                        Kind::Wall,
                    );
                }
            }
            goals
        }
        _ => [None; 4],
    }
}

/// Progress of a pull-up at which hands leave the edge: the hero's clip has them down at the hips then.
const HANDS_LEAVE: f64 = 0.6;

impl Goal {
    /// The same goal elsewhere.
    pub(crate) fn moved(self, way: DVec3) -> Self {
        Self {
            point: self.point + way,
            ..self
        }
    }

    /// The place nearest to the goal that can be held. Feet on walls that are not there find none.
    pub(crate) fn find(&self, context: &Context<'_>, extremity: Extremity) -> Option<Hold> {
        let size = context.size();
        let around = &context.around;
        let (before, length, radius) = match self.kind {
            Kind::Wall => (BEFORE * size, (BEFORE + BEHIND) * size, AROUND * size),
            Kind::Edge => (OVER * size, (OVER + UNDER) * size, 0.5 * AROUND * size),
            Kind::Overhead => (0.0, 0.0, NEAR * size),
        };
        let from = self.point + self.out * before;
        let faces = |normal: DVec3| normal.dot(self.out) > FACES;
        let ahead = if self.kind == Kind::Overhead {
            None
        } else {
            around
                .cast(from, -self.out, length)
                .filter(|found| faces(found.contact.normal))
        };
        let found = ahead.or_else(|| {
            let found = around.nearest(self.point, radius)?;
            // What is nearest from within a wall would be its back.
            (found.contact.normal.dot(self.out) > -0.5).then_some(found)
        })?;
        Some(self.hold(context, extremity, &found))
    }

    /// Whatever is nearest to the goal, within a distance.
    pub(crate) fn near(
        &self,
        context: &Context<'_>,
        extremity: Extremity,
        reach: f64,
    ) -> Option<Hold> {
        let found = context.around.nearest(self.point, reach)?;
        Some(self.hold(context, extremity, &found))
    }

    fn hold(&self, context: &Context<'_>, extremity: Extremity, found: &Found<'_>) -> Hold {
        let normal = found.contact.normal;
        let shape = context.shape(extremity);
        let (along, outward, touching) = if extremity.is_hand() {
            let along = match self.kind {
                Kind::Edge => self.ahead,
                _ => self.above - self.aside * INWARD,
            };
            (along, normal, shape.contact)
        } else {
            let into = -normal * (1.0 - TOES_UP * TOES_UP).sqrt() + self.above * TOES_UP;
            let tip = DVec3::new(shape.ball.x * TIP, 0.6 * shape.ball.y, shape.ball.z);
            (into, self.above, tip)
        };
        Hold::new(found, along, outward, touching)
    }
}
